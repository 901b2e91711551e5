/* Frames and bodies: their construction, and the numbers that are derived from them once. Also the
 * checks of placements and durations. */
#include "fmb_batch.h"

#include "integer.h"
#include "interval.h"
#include "motion.h"
#include "prepared.h"
#include "rotation.h"
#include "vector.h"
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

/* Returns x 2^-exponent, rounded once. Faster than ldexp() for usual exponents. */
static double scaled_down(double x, int exponent)
{
    if (exponent < -1000 || exponent > 1000)
        return ldexp(x, -exponent);
    const uint64_t bits = (uint64_t) (1023 - exponent) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return x * scale;
}

/* scaled := the components times 2^-*exponent, with the largest number in [0.5, 1). The third
 * component of a frame in 2D is the unit vector along z. */
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

/* Returns whether the determinant is certainly not 0, and has the right sign.
 *
 * Derivation, with u = 2^-53. The determinant is a sum of six products of three numbers of
 * magnitude at most 1. Each product passes through two multiplications and at most three additions
 * or subtractions. Rounding therefore changes each product by a factor within (1 +- u)^5, and the
 * sum by at most 5.01 u times the sum of the magnitudes of the products, the permanent. Fused or
 * reordered operations only remove factors. Underflow, in scaling and in products, adds less than
 * 2^-1000 in all. The computed permanent is within the same factor of the exact one.
 *
 * So a determinant beyond 2^-48 permanent + 2^-1000 has the right sign. 2^-48 = 32 u also covers
 * the rounding of this bound, and components that are rounded themselves (3.01 u). All other frames
 * are inverted exactly. */
static bool certainly_solid(const double c[3][3], double determinant)
{
    double permanent = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        permanent +=
            fabs(c[2][i]) * (fabs(c[0][j]) * fabs(c[1][k]) + fabs(c[0][k]) * fabs(c[1][j]));
    }
    return fabs(determinant) > 0x1p-48 * permanent + 0x1p-1000;
}

/* Sets the inverse by Cramer's rule. With the components scaled by 2^-e, and k_0 = c_1 x c_2,
 * k_1 = c_2 x c_0, k_2 = c_0 x c_1: x_i = k_i . p / (c_2 . k_2) 2^-e. Returns false, and sets
 * nothing, unless the frame is certainly solid: otherwise the determinant may consist of rounding
 * errors only. */
static bool invert_in_doubles(struct fmb_frame *frame)
{
    double c[3][3], k[3][3];
    int exponent;
    scale_components(frame, c, &exponent);
    for (int i = 0; i < 3; i++)
        vec3_cross(c[(i + 1) % 3], c[(i + 2) % 3], k[i]);
    double determinant = vec3_dot(c[2], k[2]);
    if (!certainly_solid((const double(*)[3]) c, determinant))
        return false;
    for (int axis = 0; axis < frame->dim; axis++)
        for (int i = 0; i < frame->dim; i++)
            frame->inverse[axis][i] = scaled_down(k[i][axis] / determinant, exponent);
    return true;
}

/* The components in integers; a frame in 2D gets the unit vector along z as third. Returns the
 * unit. */
static long get_components(const struct fmb_frame *frame, mpz_t out[3][3])
{
    const int dim = frame->dim;
    struct dyadic_span span = dyadic_span_begin();
    for (int k = 0; k < dim * dim; k++) {
        dyadic_span_add(&span, dyadic_of(frame->component[k / dim][k % dim]));
        dyadic_span_add(&span, dyadic_of(frame->remainder[k / dim][k % dim]));
    }
    for (int i = 0; i < dim; i++)
        for (int axis = 0; axis < dim; axis++)
            integer_set_sum(out[i][axis], frame->component[i][axis], frame->remainder[i][axis],
                            span.unit);
    if (dim == 2)
        mpz_set_ui(out[2][2], 1);
    return span.unit;
}

/* Sets the inverse of the exact components, component + remainder. Every entry is the largest
 * double that is not above the exact one, infinite beyond the range of doubles. Returns false if
 * the frame is exactly flat and has no inverse.
 *
 * With k_0 = c_1 x c_2 and so on around: x_i = k_i . p / (c_2 . k_2). In integers, k is of one
 * degree less than the determinant, so that one unit is left below. */
static bool invert_exactly(struct fmb_frame *frame)
{
    const int dim = frame->dim;
    mpz_t c[3][3], k[3][3], determinant, scratch[2];
    mpz_inits(determinant, scratch[0], scratch[1], NULL);
    integer_each(c, sizeof c, mpz_init);
    integer_each(k, sizeof k, mpz_init);

    const long unit = get_components(frame, c);
    for (int i = 0; i < 3; i++)
        integer_cross(k[i], c[(i + 1) % 3], c[(i + 2) % 3], scratch[0]);
    integer_dot(determinant, c[2], k[2], scratch[0]);
    int sign = mpz_sgn(determinant);
    mpz_abs(determinant, determinant);
    for (int i = 0; sign && i < dim; i++)
        for (int axis = 0; axis < dim; axis++) {
            if (sign < 0)
                mpz_neg(k[i][axis], k[i][axis]);
            frame->inverse[axis][i] =
                integer_ratio_round(k[i][axis], determinant, -unit, ROUND_DOWN, scratch);
        }

    mpz_clears(determinant, scratch[0], scratch[1], NULL);
    integer_each(c, sizeof c, mpz_clear);
    integer_each(k, sizeof k, mpz_clear);
    return sign != 0;
}

static void invert(struct fmb_frame *frame)
{
    frame->flat =
        frame->count < frame->dim || (!invert_in_doubles(frame) && !invert_exactly(frame));
    frame->inverted = !frame->flat && all_finite(frame->inverse[0], FMB_COMPONENTS_MAX);
    if (!frame->inverted)
        memset(frame->inverse, 0, sizeof frame->inverse);
}

/* The least volume relative to the product of the lengths of the components. The rounding of a
 * rotation or of vertices might invert a thinner frame: each of three components is off by at most
 * ROTATION_ERROR and 2^-52 of itself, together less than 2^-48, and the volume by three times
 * that. */
static const double least_thickness = 0x1p-44;

/* Returns whether the volume of the parallelepiped of three components, or the area of the
 * parallelogram of two, is at least least_thickness times the product of their lengths. In: numbers
 * in range. The computed quotient is off by less than 2^-48. */
static bool is_thick(const struct fmb_frame *frame)
{
    const double(*c)[FMB_DIM_MAX] = frame->component;
    const double square = vec3_dot(c[0], c[0]) * vec3_dot(c[1], c[1]);
    double normal[3];
    vec3_cross(c[0], c[1], normal);
    if (frame->count < 3)
        return vec3_dot(normal, normal) >= least_thickness * least_thickness * square;
    return fabs(vec3_dot(normal, c[2])) >=
           least_thickness * sqrt(square) * sqrt(vec3_dot(c[2], c[2]));
}

/* Returns whether a face has an area, with its components as rounded. */
static bool has_area(const struct fmb_frame *frame)
{
    const double *c = frame->component[0], *d = frame->component[1];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        if (!interval_same_products(c[i], d[j], c[j], d[i]))
            return true;
    }
    return false;
}

/* Adds component i to size, in_range and span. */
static void measure_component(struct fmb_frame *frame, int i, struct dyadic_span *span)
{
    for (int axis = 0; axis < frame->dim; axis++) {
        const double c = frame->component[i][axis], magnitude = fabs(c);
        frame->size[i] = magnitude > frame->size[i] ? magnitude : frame->size[i];
        frame->in_range = frame->in_range && (c == 0 || magnitude >= PREPARED_LEAST_NUMBER);
        dyadic_span_add(span, dyadic_of(c));
        dyadic_span_add(span, dyadic_of(frame->remainder[i][axis]));
    }
    frame->in_range =
        frame->in_range && frame->size[i] >= PREPARED_LEAST && frame->size[i] <= PREPARED_LARGEST;
}

/* Sets size, in_range, sturdy and bits. in_range: the filter may use the doubles of the frame if it
 * is not rotated. They must describe the frame itself, or one close to it that is certainly not
 * flat. sturdy: the same for any rotation. */
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

/* Returns the largest magnitude of a coordinate of a vertex along an axis. Adds the magnitudes of
 * the numbers it is computed from to *sum. */
static double farthest_along(const struct fmb_frame *frame, int axis, double *sum)
{
    double low = 0, high = 0;
    *sum += fabs(frame->origin[axis]);
    for (int i = 0; i < frame->count; i++) {
        const double c = frame->component[i][axis];
        const double below = frame_is_simplex(frame) ? c : low + c;
        const double above = frame_is_simplex(frame) ? c : high + c;
        low = below < low ? below : low;
        high = above > high ? above : high;
        *sum += fabs(c);
    }
    low = fabs(frame->origin[axis] + low);
    high = fabs(frame->origin[axis] + high);
    return low > high ? low : high;
}

/* Returns the reach of a frame: the distance of the farthest corner of its bounding box from the
 * origin of the body. Where squares might overflow or underflow, it is the sum of the magnitudes of
 * all coordinates. The coordinate of a corner passes at most 4 roundings, and a remainder is at
 * most 2^-53 of its component: 2^-49 of the sum covers both. The factor covers the rounding of the
 * root, 2^-1000 underflow. */
static double reach_of(const struct fmb_frame *frame)
{
    double square = 0, sum = 0;
    for (int axis = 0; axis < frame->dim; axis++) {
        const double farthest = farthest_along(frame, axis, &sum);
        square += farthest * farthest;
    }
    const double reach = sum > 0x1p-400 && sum < 0x1p500 ? sqrt(square) + 0x1p-49 * sum : sum;
    return reach * PREPARED_MARGIN + 0x1p-1000;
}

/* Returns the slack of a frame. The origin of a box, centre - size / 2, is off by at most half a
 * unit in the last place on each axis; a whole unit is counted. A vertex of a simplex is off by at
 * most the remainder of its own component. The factor covers 4 roundings here and as many where it
 * is added to other errors. */
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
        slack = fmax(slack, vec3_sum(frame->remainder[i]));
    return slack * (1 + 0x1p-50);
}

/* Of a product of an entry of the matrix and one coordinate. */
#define SINGLE_PRODUCT_ERROR (1.1 * 0x1p-53)

/* Returns the turn_error of a frame: how far an inexact rotation moves a vertex v. The error of the
 * matrix moves it by MATRIX_ERROR |v|, |v| being at most the reach; the products of the matrix
 * with the origin and with the components are off by PRODUCT_ERROR of their lengths. The origin is
 * a vertex too. A component of a box has one coordinate, so that its product is rounded once only.
 */
static double turn_error_of(const struct fmb_frame *frame)
{
    double lengths = 0;
    for (int i = 0; i < frame->count; i++)
        lengths +=
            frame->in_range ? prepared_size(frame->summary, i) : vec3_sum(frame->component[i]);
    const double of_origin = (MATRIX_ERROR + PRODUCT_ERROR) * frame->reach;
    const double of_components =
        (frame_has_axes(frame) ? SINGLE_PRODUCT_ERROR : PRODUCT_ERROR) * lengths;
    return PREPARED_MARGIN * (of_origin + of_components) + 0x1p-1060; /* where products underflow */
}

/* Derives all other fields from shape, origin, centre, component and remainder. */
static void complete(struct fmb_frame *frame)
{
    invert(frame);
    measure(frame);
    frame->slack = frame->spread = slack_of(frame);
    frame->summary = prepared_summary_of(frame);
    frame->reach = frame->core_reach = reach_of(frame);
    frame->turn_error = turn_error_of(frame);
}

/* Sizes are rounded up: a difference that rounds is off by at most half a unit in its last place. A
 * point of the hull is therefore exactly the origin plus fractions in [0, 1] of the components, and
 * turn_error_of() holds for it. Its bound for the components also holds where tiny coordinates
 * become 0: a component has one coordinate before it is rotated. From 2^1000 on, sums might
 * overflow. */
void frame_set_bounds(const double bounds[2][FMB_DIM_MAX], struct fmb_frame *out)
{
    out->count = out->dim;
    for (int axis = 0; axis < out->dim; axis++) {
        const double low = bounds[0][axis], high = bounds[1][axis], size = high - low;
        const bool exact = prepared_exact_sum(high, -low, size);
        out->origin[axis] = low;
        out->component[axis][axis] = fmin(exact ? size : size * (1 + 0x1p-52), DBL_MAX);
        out->flat = out->flat || size == 0;
    }
    measure(out);
    out->reach = out->core_reach = reach_of(out);
    out->slack = out->spread = out->reach < 0x1p1000 ? 0 : INFINITY;
    out->summary = prepared_summary_of(out);
    out->turn_error = turn_error_of(out);
}

void frame_set_plane_triangle(const double components[2][2], struct fmb_frame *out)
{
    memset(out, 0, sizeof *out);
    out->dim = 2;
    out->shape = FMB_TETRAHEDRON;
    out->count = 2;
    for (int i = 0; i < 2; i++)
        memcpy(out->component[i], components[i], sizeof components[i]);
    out->flat = interval_same_products(components[0][0], components[1][1], components[0][1],
                                       components[1][0]);
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
        out->origin[axis] = out->centre[axis] - 0.5 * out->component[axis][axis];
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
    if (shape == FMB_HULL)
        return FMB_NOT_SUPPORTED;
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
    const double *origin = count == without ? NULL : numbers, *others = numbers + (count - without);
    if (shape != FMB_BOX)
        set_components(origin, others, out);
    else if (set_box(origin, others, out) != FMB_OK)
        return FMB_BAD_SIZE;
    complete(out);
    return FMB_OK;
}

/* Returns x - y - difference. In: difference is x - y, rounded, and finite.
 *
 * The error of a difference of doubles is a double, and every operation here is exact: of x and y,
 * the larger one in magnitude and the difference are close to each other, or they differ by the
 * smaller one (Dekker, A floating-point technique for extending the available precision, 1971).
 * No intermediate result overflows, even if x and y are among the largest doubles. */
static double difference_error(double x, double y, double difference)
{
    return fabs(x) >= fabs(y) ? (x - difference) - y : x - (difference + y);
}

/* Returns the double x = y + difference + error, given the rounded difference x - y and the error
 * of that rounding.
 *
 * Derivation. Let d be the difference and e its error, both of any sign; if y < 0, change all
 * signs. Sums of magnitude below 2^-1021 are exact; beyond, halves are doubles. Rounding is
 * monotonic. By Sterbenz's lemma u - v is exact if v / 2 <= u <= 2 v.
 *
 *   d and y of opposite signs, y > 0, so x < y.
 *     |d| <= 2 y. If |d| >= y / 2, y + d is exact by the lemma. Otherwise x >= y / 2, x - y is
 *     exact, e = 0, and y + d is x. In both cases (y + d) + e rounds x, a double.
 *     |d| > 2 y. Then x < -y, so |d| = |x| + y, rounded, is between |x| and 2 |x|. x - d, which is
 *     y + e, is exact by the lemma, and d + (y + e) rounds x.
 *   d and y of one sign, y > 0, so x > y.
 *     x <= 2 y. x - y is exact, e = 0, and d + y is x.
 *     x > 2 y. Then d is between x / 2 and x, x - d = y + e is exact, and d + (y + e) rounds x.
 *   d or y is 0. The other one is +-x, and e = 0.
 *
 * No intermediate result overflows: each is rounded from x, from x - d, or from a sum of opposite
 * signs. */
static double difference_undo(double y, double difference, double error)
{
    const bool opposite = (y < 0) != (difference < 0);
    return opposite && fabs(difference) <= 2 * fabs(y) ? (y + difference) + error
                                                       : difference + (y + error);
}

enum fmb_status fmb_frame_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                        struct fmb_frame *out)
{
    const int components = fmb_component_count(dim, shape);
    if (shape == FMB_HULL)
        return FMB_NOT_SUPPORTED;
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
            if (!isfinite(out->component[i][axis])) /* also if a vertex is not finite */
                return FMB_NOT_FINITE;
            out->remainder[i][axis] = difference_error(to, from, out->component[i][axis]);
            out->rounded = out->rounded || out->remainder[i][axis] != 0;
        }
    complete(out);
    return FMB_OK;
}

/* Returns number i of the list that fmb_frame_numbers() writes. */
static double number_of(const struct fmb_frame *frame, size_t i)
{
    const size_t dim = (size_t) frame->dim, axis = i % dim;
    const bool box = frame->shape == FMB_BOX;
    if (frame->shape == FMB_HULL)
        return frame->vertices[axis * frame->vertex_stride + i / dim];
    if (i < dim)
        return box ? frame->centre[i] : frame->origin[i];
    const size_t k = i / dim - 1;
    if (box)
        return frame->component[axis][axis];
    return frame->rounded ? difference_undo(frame->origin[axis], frame->component[k][axis],
                                            frame->remainder[k][axis])
                          : frame->component[k][axis];
}

size_t fmb_frame_numbers(const struct fmb_frame *frame, bool *by_vertices, double *numbers,
                         size_t capacity)
{
    const size_t dim = (size_t) frame->dim;
    size_t vectors = frame->shape == FMB_BOX ? 2 : 1 + (size_t) frame->count;
    if (frame->shape == FMB_HULL)
        vectors = frame->vertex_count;
    *by_vertices = frame->shape == FMB_HULL || frame->rounded;
    for (size_t i = 0; i < dim * vectors && i < capacity; i++)
        numbers[i] = number_of(frame, i);
    return dim * vectors;
}

/* ---- Bodies ---- */

/* Returns the box of a frame of a body at the origin, not rotated and at rest. The numbers are
 * those that prepared_set() would set; none is rounded. */
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
    number[(1 + dim) * dim] = frame->spread;
    return aabb_of(&prepared, 0);
}

void frame_box(const struct fmb_frame *frame, double box[2][FMB_DIM_MAX])
{
    const struct fmb_placement origin = {0};
    const struct aabb aabb =
        frame->dim == 3 ? box_at_origin(frame, 3, &origin) : box_at_origin(frame, 2, &origin);
    aabb_get_ends(&aabb, box);
}

/* Sets the box of a body: the union of those of its frames, in body coordinates. */
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
    aabb_get_ends(&box, out->box);
}

/* Completes a body whose only frame, out->one, was made with this status. Returns the status. */
static enum fmb_status complete_body(enum fmb_status status, struct fmb_body *out)
{
    if (status != FMB_OK)
        return status;
    out->dim = out->one.dim;
    out->frame_count = 1;
    out->frames = NULL;
    out->reach = out->one.reach;
    set_body_box(out);
    return FMB_OK;
}

/* The sums are rounded up. */
enum fmb_status fmb_frame_inflate(struct fmb_frame *frame, double radius)
{
    if (!(radius <= DBL_MAX && radius >= -DBL_MAX))
        return FMB_NOT_FINITE;
    if (radius < 0)
        return FMB_BAD_SIZE;
    frame->radius = radius + 0.0; /* never -0 */
    frame->reach = frame->core_reach;
    frame->spread = frame->slack;
    if (radius > 0) {
        frame->reach = (frame->core_reach + radius) * PREPARED_MARGIN;
        frame->spread = (frame->slack + radius) * (1 + 0x1p-50) + 0x1p-1074;
    }
    frame->summary = prepared_summary_of(frame);
    return FMB_OK;
}

enum fmb_status fmb_body_inflate(struct fmb_body *body, double radius)
{
    if (body->frames)
        return FMB_WRONG_COUNT;
    return complete_body(fmb_frame_inflate(&body->one, radius), body);
}

enum fmb_status fmb_body_make(int dim, int shape, const double *numbers, size_t count,
                              struct fmb_body *out)
{
    return complete_body(fmb_frame_make(dim, shape, numbers, count, &out->one), out);
}

enum fmb_status fmb_body_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                       struct fmb_body *out)
{
    return complete_body(fmb_frame_make_vertices(dim, shape, vertices, count, &out->one), out);
}

enum fmb_status fmb_body_make_hull(int dim, const double *vertices, size_t count, double *memory,
                                   struct fmb_body *out)
{
    return complete_body(fmb_frame_make_hull(dim, vertices, count, memory, &out->one), out);
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
        out->reach = fmax(out->reach, frames[i].reach);
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
    if (status == FMB_OK && (!prepared_is_duration(duration) ||
                             (duration == 0 && (a->end_count != 0 || b->end_count != 0))))
        status = FMB_BAD_DURATION;
    return status;
}
