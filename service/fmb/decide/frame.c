#include "fmb.h"

#include "exact.h"
#include "integer.h"
#include "prepared.h"
#include "rotation.h"
#include "aabb.h"

#include <float.h>
#include <math.h>
#include <string.h>

static bool all_finite(const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return false;
    return true;
}

static void cross(const double u[3], const double v[3], double out[3])
{
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* x 2^-exponent, rounded once. ldexp() takes longer. */
static double scaled_down(double x, int exponent)
{
    if (exponent < -1000 || exponent > 1000)
        return ldexp(x, -exponent);
    const uint64_t bits = (uint64_t) (1023 - exponent) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return x * scale;
}

/* The components times 2^-*exponent, so that the largest number lies in [0.5, 1); a frame in 2D
 * gets the unit vector along z as third. */
static void scale_components(const struct fmb_frame *frame, double scaled[3][3], int *exponent)
{
    double largest = 0;
    for (int i = 0; i < frame->count; i++)
        for (int axis = 0; axis < frame->dim; axis++)
            largest = fmax(largest, fabs(frame->component[i][axis]));
    frexp(largest, exponent);
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            scaled[i][axis] = scaled_down(frame->component[i][axis], *exponent);
    if (frame->dim == 2)
        scaled[2][2] = 1;
}

/* Filter, with u = 2^-53: the determinant is a sum of six products of three numbers of size at
 * most 1. Each product passes through two multiplications and at most three additions or
 * subtractions, so that rounding changes it by a factor within (1 +- u)^5, and the sum by at
 * most 5.01 u times the sum of their magnitudes, the permanent; fused or reordered operations
 * only take factors away. Underflow, in scaling and in products, adds less than 2^-1000 in
 * all. A computed permanent is within the same factor of the exact one. So a determinant
 * beyond 2^-48 permanent + 2^-1000 has the right sign; 2^-48 = 32 u leaves room for the
 * rounding of this bound, and for components that are rounded themselves (3.01 u). Anything else is
 * inverted exactly. */
static bool surely_solid(const double c[3][3], double determinant)
{
    double permanent = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        permanent +=
            fabs(c[2][i]) * (fabs(c[0][j]) * fabs(c[1][k]) + fabs(c[0][k]) * fabs(c[1][j]));
    }
    return fabs(determinant) > 0x1p-48 * permanent + 0x1p-1000;
}

/* With the components scaled by 2^-e, k_0 = c_1 x c_2 and so on around:
 * x_i = k_i . p / (c_2 . k_2) 2^-e. False, and nothing done, unless the frame is surely solid: a
 * determinant that rounding may have eaten is not to be divided by. */
static bool invert_in_doubles(struct fmb_frame *frame)
{
    double c[3][3], k[3][3];
    int exponent;
    scale_components(frame, c, &exponent);
    for (int i = 0; i < 3; i++)
        cross(c[(i + 1) % 3], c[(i + 2) % 3], k[i]);
    double determinant = c[2][0] * k[2][0] + c[2][1] * k[2][1] + c[2][2] * k[2][2];
    if (!surely_solid((const double(*)[3]) c, determinant))
        return false;
    for (int axis = 0; axis < frame->dim; axis++)
        for (int i = 0; i < frame->dim; i++)
            frame->inverse[axis][i] = scaled_down(k[i][axis] / determinant, exponent);
    return true;
}

static void invert(struct fmb_frame *frame)
{
    frame->flat = frame->count < frame->dim || (!invert_in_doubles(frame) && !exact_inverse(frame));
    frame->inverted = !frame->flat && all_finite(frame->inverse[0], FMB_COMPONENTS_MAX);
    if (!frame->inverted)
        memset(frame->inverse, 0, sizeof frame->inverse);
}

/* Sizes whose products of four, sums of a few dozen of them and 2^-53 of those neither overflow
 * nor lose bits to underflow; and no number so small that a product of two underflows. */
static const double least_size = 0x1p-200, largest_size = 0x1p200, least_number = 0x1p-400;

/* A thinner frame might be inverted by the rounding of a rotation, or of vertices: each of three
 * components is off by at most ROTATION_ERROR and 2^-52 of itself, less than 2^-48 together, and
 * the volume by three times that. */
static const double least_thickness = 0x1p-44;

static double square_of(const double v[FMB_DIM_MAX])
{
    return (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2];
}

/* Whether the volume of a solid, or twice the area of a face, against the product of the lengths of
 * its components is large enough; numbers in range. The quotient is off by less than 2^-48. */
static bool is_thick(const struct fmb_frame *frame)
{
    const double(*c)[FMB_DIM_MAX] = frame->component;
    const double square = square_of(c[0]) * square_of(c[1]);
    double normal[3];
    cross(c[0], c[1], normal);
    if (frame->count < 3)
        return square_of(normal) >= least_thickness * least_thickness * square;
    const double volume = normal[0] * c[2][0] + normal[1] * c[2][1] + normal[2] * c[2][2];
    return fabs(volume) >= least_thickness * sqrt(square) * sqrt(square_of(c[2]));
}

/* Whether x y = z w, for products that are doubles with errors that are doubles. */
static bool are_equal(double x, double y, double z, double w)
{
    return x * y == z * w && fma(x, y, -(x * y)) == fma(z, w, -(z * w));
}

/* Whether a face, as its doubles have it, has an area. */
static bool has_area(const struct fmb_frame *frame)
{
    const double *c = frame->component[0], *d = frame->component[1];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        if (!are_equal(c[i], d[j], c[j], d[i]))
            return true;
    }
    return false;
}

static void measure_component(struct fmb_frame *frame, int i, struct dyadic_span *span)
{
    for (int axis = 0; axis < frame->dim; axis++) {
        const double c = frame->component[i][axis], magnitude = fabs(c);
        frame->size[i] = magnitude > frame->size[i] ? magnitude : frame->size[i];
        frame->in_range = frame->in_range && (c == 0 || magnitude >= least_number);
        dyadic_span_add(span, dyadic_of(c));
        dyadic_span_add(span, dyadic_of(frame->remainder[i][axis]));
    }
    frame->in_range =
        frame->in_range && frame->size[i] >= least_size && frame->size[i] <= largest_size;
}

/* in_range: the filter may use the doubles of a frame that is not rotated. They have to be the
 * frame itself, or one close to it that is surely not flat. sturdy: the same for any rotation. */
static void measure(struct fmb_frame *frame)
{
    struct dyadic_span span = dyadic_span_begin();
    memset(frame->size, 0, sizeof frame->size);
    frame->in_range = frame->shape == FMB_FACE || !frame->flat;
    for (int i = 0; i < frame->count; i++)
        measure_component(frame, i, &span);
    frame->in_range = frame->in_range && (frame->shape != FMB_FACE || has_area(frame));
    frame->sturdy = frame->in_range && is_thick(frame);
    frame->in_range = frame->in_range && (frame->sturdy || !frame->rounded);
    frame->bits[0] = (int) span.unit;
    frame->bits[1] = (int) span.top;
}

/* The farthest vertex is no farther than the origin and all components together. */
static double radius_of(const struct fmb_frame *frame)
{
    double radius = 0;
    for (int axis = 0; axis < frame->dim; axis++) {
        radius += fabs(frame->origin[axis]);
        for (int i = 0; i < frame->count; i++)
            radius += fabs(frame->component[i][axis]);
    }
    return radius * (1 + 0x1p-40) + 0x1p-1000;
}

static double sum_of(const double v[FMB_DIM_MAX])
{
    return (fabs(v[0]) + fabs(v[1])) + fabs(v[2]);
}

/* The origin of a box, centre - size / 2, is off by at most half a unit in the last place on each
 * axis, which is counted twice. A vertex whose components have a rest is off by at most one of
 * these. */
static double slack_of(const struct fmb_frame *frame)
{
    double slack = 0;
    for (int axis = 0; axis < frame->dim && frame->shape == FMB_BOX; axis++) {
        const double size = frame->component[axis][axis], half = 0.5 * size;
        if (2 * half != size ||
            !prepared_exact_sum(frame->centre[axis], -half, frame->origin[axis]))
            slack += 0x1p-52 * fabs(frame->origin[axis]) + 0x1p-1074;
    }
    for (int i = 0; i < frame->count; i++)
        slack = fmax(slack, sum_of(frame->remainder[i]));
    return slack * (1 + 0x1p-50);
}

static double turn_error_of(const struct fmb_frame *frame)
{
    double lengths = sum_of(frame->origin);
    for (int i = 0; i < frame->count; i++)
        lengths += frame->in_range ? prepared_size(frame->summary, i) : sum_of(frame->component[i]);
    return ROTATION_ERROR * (1 + 0x1p-40) * lengths + 0x1p-1060; /* where products underflow */
}

static void complete(struct fmb_frame *frame)
{
    invert(frame);
    measure(frame);
    frame->summary = prepared_summary_of(frame);
    frame->radius = radius_of(frame);
    frame->slack = slack_of(frame);
    frame->turn_error = turn_error_of(frame);
}

void frame_set_plane_triangle(const double components[2][2], struct fmb_frame *out)
{
    memset(out, 0, sizeof *out);
    out->dim = 2;
    out->shape = FMB_TETRAHEDRON;
    out->count = 2;
    for (int i = 0; i < 2; i++)
        memcpy(out->component[i], components[i], sizeof components[i]);
    out->flat = are_equal(components[0][0], components[1][1], components[0][1], components[1][0]);
    measure(out);
    out->summary = prepared_summary_of(out);
}

/* ---- Frames from numbers ---- */

static enum fmb_status set_box(const double *centre, const double *size, struct fmb_frame *out)
{
    for (int axis = 0; axis < out->dim; axis++) {
        if (size[axis] < 0)
            return FMB_BAD_SIZE;
        out->component[axis][axis] = size[axis] + 0.0; /* never -0 */
        out->centre[axis] = centre ? centre[axis] : 0;
        out->origin[axis] = out->centre[axis] - 0.5 * size[axis];
    }
    return FMB_OK;
}

static void set_components(const double *origin, const double *components, struct fmb_frame *out)
{
    const size_t dim = (size_t) out->dim;
    if (origin)
        memcpy(out->origin, origin, dim * sizeof *origin);
    for (int i = 0; i < out->count; i++)
        memcpy(out->component[i], components + (size_t) i * dim, dim * sizeof *components);
}

enum fmb_status fmb_frame_make(int dim, int shape, const double *numbers, size_t count,
                               struct fmb_frame *out)
{
    if (!fmb_shape_name(shape))
        return FMB_UNKNOWN_SHAPE;
    const int components = fmb_component_count(dim, shape);
    if (components == 0)
        return FMB_WRONG_DIMENSION;
    const size_t without = (size_t) (shape == FMB_BOX ? dim : components * dim);
    if (count != without && count != without + (size_t) dim)
        return FMB_WRONG_COUNT;
    if (!all_finite(numbers, count))
        return FMB_NOT_FINITE;

    memset(out, 0, sizeof *out);
    out->dim = dim;
    out->shape = (enum fmb_shape) shape;
    out->count = components;
    const double *origin = count == without ? NULL : numbers, *rest = numbers + (count - without);
    if (shape != FMB_BOX)
        set_components(origin, rest, out);
    else if (set_box(origin, rest, out) != FMB_OK)
        return FMB_BAD_SIZE;
    complete(out);
    return FMB_OK;
}

/* The error of a difference of doubles is a double, and what is computed here is exact: the larger
 * of them and the difference are near each other, or the smaller one is what they differ by
 * (Dekker, A floating-point technique for extending the available precision, 1971). Nothing is
 * beyond the doubles where the difference is not, be they among the largest. */
static double difference_error(double x, double y, double difference)
{
    return fabs(x) >= fabs(y) ? (x - difference) - y : x - (difference + y);
}

enum fmb_status fmb_frame_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                        struct fmb_frame *out)
{
    const int components = fmb_component_count(dim, shape);
    if (shape != FMB_TETRAHEDRON && shape != FMB_FACE)
        return FMB_UNKNOWN_SHAPE;
    if (components == 0)
        return FMB_WRONG_DIMENSION;
    if (count != (size_t) ((components + 1) * dim))
        return FMB_WRONG_COUNT;
    memset(out, 0, sizeof *out);
    out->dim = dim;
    out->shape = (enum fmb_shape) shape;
    out->count = components;
    memcpy(out->origin, vertices, (size_t) dim * sizeof *vertices);
    for (int i = 0; i < components; i++)
        for (int axis = 0; axis < dim; axis++) {
            const double to = vertices[(i + 1) * dim + axis], from = vertices[axis];
            out->component[i][axis] = to - from;
            if (!isfinite(out->component[i][axis])) /* nor where a vertex is not */
                return FMB_NOT_FINITE;
            out->remainder[i][axis] = difference_error(to, from, out->component[i][axis]);
            out->rounded = out->rounded || out->remainder[i][axis] != 0;
        }
    complete(out);
    return FMB_OK;
}

/* ---- Bodies ---- */

/* As prepared_set() for a body at the origin that is not rotated: nothing rounds. */
INLINE struct aabb box_at_origin(const struct fmb_frame *frame, const int dim,
                                 const struct fmb_placement *placement)
{
    struct fmb_prepared prepared = {
        .summary = frame->summary, .frame = frame, .placement = placement};
    double *number = prepared.number;
    UNROLL(3)
    for (int axis = 0; axis < dim; axis++) {
        number[axis] = frame->origin[axis] + 0.0;
        for (int i = 0; i < dim; i++)
            number[(1 + i) * dim + axis] = frame->component[i][axis];
    }
    number[(1 + dim) * dim] = frame->slack * (1 + 0x1p-40);
    return aabb_of(&prepared, 0);
}

/* Sets the box of a body: that of its frames, at the origin and not rotated. */
static void set_body_box(struct fmb_body *out)
{
    const struct fmb_placement origin = {.body = out};
    struct aabb box;
    for (unsigned i = 0; i < out->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(out, i);
        const struct aabb one =
            frame->dim == 3 ? box_at_origin(frame, 3, &origin) : box_at_origin(frame, 2, &origin);
        box = i == 0 ? one : aabb_union(box, one);
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out->box[0][axis] = box.end[axis][0];
        out->box[1][axis] = 0 - box.end[axis][1];
    }
}

static void set_one(struct fmb_body *out)
{
    out->dim = out->one.dim;
    out->frame_count = 1;
    out->frames = NULL;
    out->radius = out->one.radius;
    set_body_box(out);
}

enum fmb_status fmb_body_make(int dim, int shape, const double *numbers, size_t count,
                              struct fmb_body *out)
{
    const enum fmb_status status = fmb_frame_make(dim, shape, numbers, count, &out->one);
    if (status == FMB_OK)
        set_one(out);
    return status;
}

enum fmb_status fmb_body_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                       struct fmb_body *out)
{
    const enum fmb_status status = fmb_frame_make_vertices(dim, shape, vertices, count, &out->one);
    if (status == FMB_OK)
        set_one(out);
    return status;
}

enum fmb_status fmb_body_make_frames(const struct fmb_frame *frames, size_t count,
                                     struct fmb_body *out)
{
    if (count == 0 || count > FMB_FRAMES_MAX)
        return count == 0 ? FMB_NO_FRAMES : FMB_OVER_LIMIT;
    memset(out, 0, sizeof *out);
    for (size_t i = 0; i < count; i++) {
        if (frames[i].dim != frames[0].dim)
            return FMB_DIMENSIONS_DIFFER;
        out->radius = fmax(out->radius, frames[i].radius);
    }
    out->dim = frames[0].dim;
    out->frame_count = (unsigned) count;
    if (count > 1)
        out->frames = frames;
    else
        out->one = frames[0];
    set_body_box(out);
    return FMB_OK;
}

/* ---- Placements ---- */

bool prepared_is_duration(double duration)
{
    return duration >= 0 && duration <= DBL_MAX;
}

enum fmb_status placements_check(const struct fmb_placement *a, const struct fmb_placement *b,
                                 double duration)
{
    enum fmb_status status = fmb_placement_check(a);
    if (status == FMB_OK)
        status = fmb_placement_check(b);
    if (status == FMB_OK && a->body->dim != b->body->dim)
        status = FMB_DIMENSIONS_DIFFER;
    if (status == FMB_OK && !prepared_is_duration(duration))
        status = FMB_BAD_DURATION;
    return status;
}
