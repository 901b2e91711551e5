#include "outline.h"

#include <math.h>
#include <string.h>

/* Corner k of a cuboid: bit i of k tells whether component i is added. */
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

static void set_faces(const struct fmb_frame *frame, struct outline *out)
{
    bool solid = frame->dim == 3 && frame->shape != FMB_FACE;
    if (is_cuboid(frame)) {
        out->face = solid ? cuboid_3d : cuboid_2d;
        out->face_count = solid ? 6 : 1;
    } else {
        out->face = solid ? tetrahedron_3d : triangle;
        out->face_count = solid ? 4 : 1;
    }
}

/* R(q) of fmb.h, [row][column]; numbers of any size. */
static void set_rotation(const struct scene_body *body, double out[3][3])
{
    const double *given = body->orientation;
    double largest = 0, q[4] = {1, 0, 0, 0}, norm = 0;
    for (int i = 0; i < body->orientation_count; i++)
        largest = fmax(largest, fabs(given[i]));
    for (int i = 0; i < body->orientation_count; i++)
        q[body->orientation_count == 2 ? 3 * i : i] = given[i] / largest;
    for (int i = 0; i < 4; i++)
        norm += q[i] * q[i];
    const double w = q[0], *v = q + 1;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i][i] = (w * w + v[i] * v[i] - v[j] * v[j] - v[k] * v[k]) / norm;
        out[i][j] = 2 * (v[i] * v[j] - w * v[k]) / norm;
        out[j][i] = 2 * (v[i] * v[j] + w * v[k]) / norm;
    }
}

/* Corner k of the frame, in body coordinates. */
static void set_corner(const struct fmb_frame *frame, int k, double out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out[axis] = frame->origin[axis];
        for (int i = 0; i < frame->count; i++)
            out[axis] += adds(frame, k, i) ? frame->component[i][axis] : 0;
    }
}

struct outline outline_make(const struct scene_body *body, unsigned index, double time)
{
    const struct fmb_frame *frame = fmb_body_frame(&body->body, index);
    struct outline outline;
    double rotation[3][3], corner[FMB_DIM_MAX];
    memset(&outline, 0, sizeof outline);
    set_faces(frame, &outline);
    set_rotation(body, rotation);
    outline.corner_count = is_cuboid(frame) ? 1 << frame->count : frame->count + 1;
    for (int k = 0; k < outline.corner_count; k++) {
        set_corner(frame, k, corner);
        for (int axis = 0; axis < frame->dim; axis++) {
            const double *row = rotation[axis];
            double at = body->position[axis];
            if (body->orientation_count == 0)
                at += corner[axis];
            else
                at += row[0] * corner[0] + row[1] * corner[1] + row[2] * corner[2];
            if (time > 0)
                at += time * body->velocity[axis];
            outline.corner[k][axis] = at;
            outline.centre[axis] += at / outline.corner_count;
        }
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
            outline.corner[k][axis] = k >> axis & 1 ? high[axis] : low[axis];
    for (int axis = 0; axis < dim; axis++)
        outline.centre[axis] = low[axis] / 2 + high[axis] / 2;
    return outline;
}
