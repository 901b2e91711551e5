#include "view.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Frames ---------------------------------------------------------------------------------- */

/* Corner k of a cuboid is the origin plus the components i whose bit i of k is set. */
static const struct outline_face cuboid_3d[] = {
    {4, {0, 2, 6, 4}}, {4, {1, 3, 7, 5}}, {4, {0, 1, 5, 4}},
    {4, {2, 3, 7, 6}}, {4, {0, 1, 3, 2}}, {4, {4, 5, 7, 6}},
};
static const struct outline_face cuboid_2d[] = {{4, {0, 1, 3, 2}}};

/* Corner 0 of a simplex is the origin, corner i + 1 the end of component i. */
static const struct outline_face tetrahedron_3d[] = {
    {3, {0, 1, 2}}, {3, {0, 2, 3}}, {3, {0, 3, 1}}, {3, {1, 2, 3}}};
static const struct outline_face triangle[] = {{3, {0, 1, 2}}};

static bool is_cuboid(const struct fmb_frame *frame)
{
    return frame->shape == FMB_CUBOID || frame->shape == FMB_BOX;
}

static bool adds(const struct fmb_frame *frame, int corner, int component)
{
    if (is_cuboid(frame))
        return corner >> component & 1;
    return corner == component + 1;
}

/* NaN, as from sums of infinite numbers, becomes low. */
static double clamp(double value, double low, double high)
{
    return value > high ? high : value >= low ? value : low;
}

static double limited(double coordinate)
{
    return clamp(coordinate, -DBL_MAX / 8, DBL_MAX / 8);
}

struct outline outline_make(const struct fmb_placement *placement, unsigned index, double time)
{
    const struct fmb_frame *frame = fmb_body_frame(placement->body, index);
    const bool cuboid = is_cuboid(frame), solid = frame->dim == 3 && frame->shape != FMB_FACE;
    const int dim = frame->dim;
    struct fmb_prepared world; /* origin and components */
    struct outline outline;
    memset(&outline, 0, sizeof outline);
    outline.face = cuboid ? (solid ? cuboid_3d : cuboid_2d) : solid ? tetrahedron_3d : triangle;
    outline.face_count = !solid ? 1 : cuboid ? 6 : 4;
    outline.flat = frame->flat;
    outline.corner_count = cuboid ? 1 << frame->count : frame->count + 1;
    fmb_prepare(placement, index, 1, &world);
    for (int k = 0; k < outline.corner_count; k++)
        for (int axis = 0; axis < dim; axis++) {
            double at = world.number[axis] + (time > 0 ? time * placement->velocity[axis] : 0);
            for (int i = 0; i < frame->count; i++)
                at += adds(frame, k, i) ? world.number[(i + 1) * dim + axis] : 0;
            outline.corner[k][axis] = limited(at);
            outline.centre[axis] += outline.corner[k][axis] / outline.corner_count;
        }
    return outline;
}

struct outline outline_box(int dim, const double low[FMB_DIM_MAX], const double high[FMB_DIM_MAX])
{
    struct outline outline;
    memset(&outline, 0, sizeof outline);
    outline.face = dim == 3 ? cuboid_3d : cuboid_2d;
    outline.face_count = dim == 3 ? 6 : 1;
    outline.corner_count = 1 << dim;
    for (int k = 0; k < outline.corner_count; k++)
        for (int axis = 0; axis < dim; axis++)
            outline.corner[k][axis] = limited(k >> axis & 1 ? high[axis] : low[axis]);
    for (int axis = 0; axis < dim; axis++)
        outline.centre[axis] = limited(low[axis]) / 2 + limited(high[axis]) / 2;
    return outline;
}

/* ---- The view -------------------------------------------------------------------------------- */

/* Where the viewer stands: 58 degrees to the right of looking along y, 24 degrees above. */
static const double azimuth = -1.012, elevation = 0.419;

/* Direction to the light; of length 1. */
static const double light[FMB_DIM_MAX] = {0.36, -0.48, 0.8};

struct view_bounds view_nothing(void)
{
    return (struct view_bounds){.low = {INFINITY, INFINITY, INFINITY},
                                .high = {-INFINITY, -INFINITY, -INFINITY},
                                .paper_low = {INFINITY, INFINITY},
                                .paper_high = {-INFINITY, -INFINITY}};
}

/* Projects coordinates to the plane of the paper: x right, y up. */
static struct point project(int dim, const double u[FMB_DIM_MAX])
{
    if (dim == 2)
        return (struct point){u[0], u[1], 0};
    double ca = cos(azimuth), sa = sin(azimuth), ce = cos(elevation), se = sin(elevation);
    return (struct point){-sa * u[0] + ca * u[1], -se * (ca * u[0] + sa * u[1]) + ce * u[2],
                          ce * (ca * u[0] + sa * u[1]) + se * u[2]};
}

static void add_to_paper(double low[2], double high[2], struct point point)
{
    low[0] = fmin(low[0], point.x);
    low[1] = fmin(low[1], point.y);
    high[0] = fmax(high[0], point.x);
    high[1] = fmax(high[1], point.y);
}

void view_add(struct view_bounds *bounds, const struct outline *outline, int dim)
{
    for (int k = 0; k < outline->corner_count; k++) {
        const double *at = outline->corner[k];
        for (int axis = 0; axis < dim; axis++) {
            bounds->low[axis] = fmin(bounds->low[axis], at[axis]);
            bounds->high[axis] = fmax(bounds->high[axis], at[axis]);
        }
        add_to_paper(bounds->paper_low, bounds->paper_high, project(dim, at));
    }
}

void view_join(struct view_bounds *bounds, const struct view_bounds *other)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        bounds->low[axis] = fmin(bounds->low[axis], other->low[axis]);
        bounds->high[axis] = fmax(bounds->high[axis], other->high[axis]);
    }
    for (int axis = 0; axis < 2; axis++) {
        bounds->paper_low[axis] = fmin(bounds->paper_low[axis], other->paper_low[axis]);
        bounds->paper_high[axis] = fmax(bounds->paper_high[axis], other->paper_high[axis]);
    }
}

/* Space around the bounds, relative to the radius. */
static const double margin = 0.04;

static void set_units(const struct view_bounds *bounds, struct view *out)
{
    out->radius = 0;
    for (int axis = 0; axis < out->dim; axis++) {
        bool empty = bounds->low[axis] > bounds->high[axis];
        double low = empty ? 0 : bounds->low[axis], high = empty ? 0 : bounds->high[axis];
        out->centre[axis] = (low + high) / 2;
        out->radius = fmax(out->radius, (high - low) / 2);
    }
    if (out->radius == 0)
        out->radius = 1;
    for (int axis = 0; axis < out->dim; axis++) {
        double half = (bounds->high[axis] - bounds->low[axis]) / 2 / out->radius;
        half = half > 0 ? fmin(half, 1) : 0; /* also where the bounds are empty */
        out->high[axis] = fmin(half + margin, 1);
        out->low[axis] = -out->high[axis];
    }
}

/* Adds the corners of the floor, or in 2D of the visible region. */
static void add_floor(const struct view *view, double low[2], double high[2])
{
    for (int k = 0; k < 4; k++) {
        double corner[FMB_DIM_MAX] = {k & 1 ? view->high[0] : view->low[0],
                                      k & 2 ? view->high[1] : view->low[1], view->low[2]};
        add_to_paper(low, high, project(view->dim, corner));
    }
}

/* Returns the visible part of the paper's plane, in unit coordinates. */
static struct paper projected_bounds(const struct view *view, const struct view_bounds *bounds)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    struct point centre = project(view->dim, view->centre);
    const double middle[2] = {centre.x, centre.y};
    add_floor(view, low, high);
    for (int axis = 0; axis < 2; axis++) {
        double first = (bounds->paper_low[axis] - middle[axis]) / view->radius;
        double last = (bounds->paper_high[axis] - middle[axis]) / view->radius;
        low[axis] = fmin(low[axis], clamp(first, -2, 2) - margin);
        high[axis] = fmax(high[axis], clamp(last, -2, 2) + margin);
    }
    return (struct paper){low[0], low[1], high[0] - low[0], high[1] - low[1]};
}

struct view view_make(int dim, const struct view_bounds *bounds, struct paper paper)
{
    struct view view = {.dim = dim, .paper = paper};
    set_units(bounds, &view);
    struct paper visible = projected_bounds(&view, bounds);
    view.scale = fmin(paper.width / visible.width, paper.height / visible.height);
    view.x = paper.x + paper.width / 2 - view.scale * (visible.x + visible.width / 2);
    view.y = paper.y + paper.height / 2 + view.scale * (visible.y + visible.height / 2);
    return view;
}

struct point view_unit_point(const struct view *view, const double unit[FMB_DIM_MAX])
{
    struct point point = project(view->dim, unit);
    return (struct point){view->x + view->scale * point.x, view->y - view->scale * point.y,
                          point.depth};
}

/* Returns (p - centre) / radius, clipped to the bounds. */
static double unit_of(const struct view *view, double world, int axis)
{
    return clamp((world - view->centre[axis]) / view->radius, view->low[axis], view->high[axis]);
}

struct point view_point(const struct view *view, const double world[FMB_DIM_MAX])
{
    double unit[FMB_DIM_MAX] = {0};
    for (int axis = 0; axis < view->dim; axis++)
        unit[axis] = unit_of(view, world[axis], axis);
    struct point point = view_unit_point(view, unit);
    point.x = clamp(point.x, view->paper.x, view->paper.x + view->paper.width);
    point.y = clamp(point.y, view->paper.y, view->paper.y + view->paper.height);
    return point;
}

double view_light(const struct view *view, const double a[FMB_DIM_MAX], const double b[FMB_DIM_MAX],
                  const double c[FMB_DIM_MAX])
{
    double u[3], v[3];
    for (int axis = 0; axis < 3; axis++) {
        double at = unit_of(view, a[axis], axis);
        u[axis] = unit_of(view, b[axis], axis) - at;
        v[axis] = unit_of(view, c[axis], axis) - at;
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length == 0)
        return 0.5;
    return fabs(n[0] * light[0] + n[1] * light[1] + n[2] * light[2]) / length;
}
