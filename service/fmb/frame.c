#include "fmb.h"

#include "exact.h"
#include "integer.h"
#include "prepared.h"

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

/* The components times 2^-*exponent, so that the largest number lies in [0.5, 1); a body in 2D
 * gets the unit vector along z as third. */
static void scale_components(const struct fmb_body *body, double scaled[3][3], int *exponent)
{
    double largest = 0;
    for (int i = 0; i < body->count; i++)
        for (int axis = 0; axis < body->dim; axis++)
            largest = fmax(largest, fabs(body->component[i][axis]));
    frexp(largest, exponent);
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            scaled[i][axis] = ldexp(body->component[i][axis], -*exponent);
    if (body->dim == 2)
        scaled[2][2] = 1;
}

/* Filter, with u = 2^-53: the determinant is a sum of six products of three numbers of size at
 * most 1. Each product passes through two multiplications and at most three additions or
 * subtractions, so that rounding changes it by a factor within (1 +- u)^5, and the sum by at
 * most 5.01 u times the sum of their magnitudes, the permanent; fused or reordered operations
 * only take factors away. Underflow, in scaling and in products, adds less than 2^-1000 in
 * all. A computed permanent is within the same factor of the exact one. So a determinant
 * beyond 2^-48 permanent + 2^-1000 has the right sign; 2^-48 = 32 u leaves room for the
 * rounding of this bound. Anything else is inverted exactly. */
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
 * x_i = k_i . p / (c_2 . k_2) 2^-e. False, and nothing done, unless the body is surely solid: a
 * determinant that rounding may have eaten is not to be divided by. */
static bool invert_in_doubles(struct fmb_body *body)
{
    double c[3][3], k[3][3];
    int exponent;
    scale_components(body, c, &exponent);
    for (int i = 0; i < 3; i++)
        cross(c[(i + 1) % 3], c[(i + 2) % 3], k[i]);
    double determinant = c[2][0] * k[2][0] + c[2][1] * k[2][1] + c[2][2] * k[2][2];
    if (!surely_solid((const double(*)[3]) c, determinant))
        return false;
    for (int axis = 0; axis < body->dim; axis++)
        for (int i = 0; i < body->dim; i++)
            body->inverse[axis][i] = ldexp(k[i][axis] / determinant, -exponent);
    return true;
}

static void invert(struct fmb_body *body)
{
    body->flat =
        body->count < body->dim ||
        (!invert_in_doubles(body) &&
         !exact_inverse(body->dim, (const double(*)[FMB_DIM_MAX]) body->component, body->inverse));
    body->inverted = !body->flat && all_finite(body->inverse[0], FMB_COMPONENTS_MAX);
    if (!body->inverted)
        memset(body->inverse, 0, sizeof body->inverse);
}

/* Sizes whose products of four, sums of a few dozen of them and 2^-53 of those neither overflow
 * nor lose bits to underflow; and no number so small that a product of two underflows. */
static const double least_size = 0x1p-200, largest_size = 0x1p200, least_number = 0x1p-400;

/* Of x y - z w, the products of numbers in range: whether it is surely not 0, the factors being off
 * by u each; and whether it is exactly 0, they being exact.
 *
 * Each product is rounded twice in its factors, once itself, and once in the difference: 4.01 u of
 * the sum of the magnitudes, and the bound is computed with fewer roundings than it has room for.
 * The error of a product is a double: products are above 2^-800, and errors above 2^-907. */
static bool surely_differ(double x, double y, double z, double w)
{
    return fabs(x * y - z * w) > 0x1p-50 * (fabs(x * y) + fabs(z * w));
}

static bool are_equal(double x, double y, double z, double w)
{
    return x * y == z * w && fma(x, y, -(x * y)) == fma(z, w, -(z * w));
}

/* Whether an edge c_1 - c_0 of doubles is 0 on an axis where the true one is not: the filter takes
 * a coordinate of 0 for what it is. */
static bool hides_difference(const struct fmb_body *body)
{
    const double *c = body->component[0], *d = body->component[1];
    for (int axis = 0; axis < 3; axis++)
        if (c[axis] == d[axis] && body->rest[0][axis] != body->rest[1][axis])
            return true;
    return false;
}

/* Whether a face has an area. Of one that is rounded only what is sure counts. */
static bool has_area(const struct fmb_body *body)
{
    const double *c = body->component[0], *d = body->component[1];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        if (surely_differ(c[i], d[j], c[j], d[i]) ||
            (!body->rounded && !are_equal(c[i], d[j], c[j], d[i])))
            return true;
    }
    return false;
}

static void measure_number(struct fmb_body *body, int i, double c, struct dyadic_span *span)
{
    const double magnitude = fabs(c);
    body->size[i] = magnitude > body->size[i] ? magnitude : body->size[i];
    body->in_range = body->in_range && (c == 0 || magnitude >= least_number);
    dyadic_span_add(span, dyadic_of(c));
}

void body_measure(struct fmb_body *body)
{
    struct dyadic_span span = dyadic_span_begin();
    body->in_range = body->shape == FMB_FACE || !body->flat;
    for (int i = 0; i < body->count; i++) {
        for (int axis = 0; axis < body->dim; axis++)
            measure_number(body, i, body->component[i][axis], &span);
        for (int axis = 0; axis < body->dim && body->rounded; axis++)
            dyadic_span_add(&span, dyadic_of(body->rest[i][axis]));
        body->in_range =
            body->in_range && body->size[i] >= least_size && body->size[i] <= largest_size;
    }
    if (body->shape == FMB_FACE && body->in_range)
        body->in_range = has_area(body) && !hides_difference(body);
    body->bits[0] = (int) span.unit;
    body->bits[1] = (int) span.top;
}

void body_set_plane_triangle(const double components[2][2], struct fmb_body *out)
{
    memset(out, 0, sizeof *out);
    out->dim = 2;
    out->shape = FMB_TETRAHEDRON;
    out->count = 2;
    for (int i = 0; i < 2; i++)
        memcpy(out->component[i], components[i], sizeof components[i]);
    out->flat = are_equal(components[0][0], components[1][1], components[0][1], components[1][0]);
    body_measure(out);
    out->head = prepared_head_of(out);
}

enum fmb_status fmb_body_make(int dim, int shape, const double *components, size_t count,
                              struct fmb_body *out)
{
    if (!fmb_shape_name(shape))
        return FMB_UNKNOWN_SHAPE;
    int vectors = fmb_component_count(dim, shape);
    if (vectors == 0)
        return FMB_WRONG_DIMENSION;
    if (count != (size_t) (vectors * dim))
        return FMB_WRONG_COUNT;
    if (!all_finite(components, count))
        return FMB_NOT_FINITE;

    memset(out, 0, sizeof *out);
    out->dim = dim;
    out->shape = (enum fmb_shape) shape;
    out->count = vectors;
    for (int i = 0; i < vectors; i++)
        memcpy(out->component[i], components + i * dim, (size_t) dim * sizeof *components);
    invert(out);
    body_measure(out);
    out->head = prepared_head_of(out);
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

enum fmb_status fmb_body_make_triangle(const double vertex[3][FMB_DIM_MAX], struct fmb_body *out)
{
    double component[2][FMB_DIM_MAX];
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            component[i][axis] = vertex[i + 1][axis] - vertex[0][axis];
    const enum fmb_status status = fmb_body_make(3, FMB_FACE, component[0], 6, out);
    if (status != FMB_OK)
        return status;
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            out->rest[i][axis] =
                difference_error(vertex[i + 1][axis], vertex[0][axis], component[i][axis]);
            out->rounded = out->rounded || out->rest[i][axis] != 0;
        }
    if (!out->rounded)
        return FMB_OK;
    memset(out->size, 0, sizeof out->size);
    body_measure(out);
    out->head = prepared_head_of(out);
    return FMB_OK;
}

/* 0 times a number that is not finite is not 0. */
static bool is_finite(const double v[FMB_DIM_MAX], int dim)
{
    const double none = 0 * v[0] + 0 * v[1];
    return (dim == 2 ? none : none + 0 * v[2]) == 0;
}

static bool frame_is_finite(const struct fmb_frame *frame)
{
    const int dim = frame->body->dim;
    return is_finite(frame->origin, dim) && (!frame->moving || is_finite(frame->velocity, dim));
}

bool prepared_is_duration(double duration)
{
    return duration >= 0 && duration <= DBL_MAX;
}

enum fmb_status fmb_pair_check(const struct fmb_pair *pair)
{
    if (pair->a.body->dim != pair->b.body->dim)
        return FMB_DIMENSIONS_DIFFER;
    if (!frame_is_finite(&pair->a) || !frame_is_finite(&pair->b))
        return FMB_NOT_FINITE;
    if (!prepared_is_duration(pair->duration))
        return FMB_BAD_DURATION;
    return FMB_OK;
}
