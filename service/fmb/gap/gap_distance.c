/* The gap of a separated pair, in doubles.
 *
 * Method. The point of P nearest to the origin (gap_simplex.h). Both bounds are derived from its
 * direction and weights: the lower one is f(n) less its error, the upper one the distance of the
 * witness points.
 *
 * Accuracy, with u = 2^-53. The direction n has any length. f(n) is n . p for a vertex p: a sum of
 * products of a coordinate of n with one of the offset, rounded once, of the drift, rounded twice,
 * or of a component, each rounded at most 4 times in p and 3 times in the product with n. So its
 * error is below 9.01 u sum |n_k| |x_k| <= 9.1 u |n| R, R the sum of the lengths of all these
 * vectors; f(n) is at most R |n|. Dividing it by |n| moves it by 5 u R, and rounding the direction
 * of unit length by 2 u R more. gap_error() has 32 u R, and the errors of both frames.
 *
 * A witness point is o + sum x_i c_i + t v for parameters x_i and a time t of the window that are
 * doubles. Each monomial is rounded at most 6 times. Sums of weights are off by 4 u; those of a
 * cuboid are cut off at 1, those of a simplex may be 4 u too large in all. So the point is within
 * 7.01 u |..|_1 + 4 u sum |c_i|, which is below 16 u far, from a point of the rounded frame at this
 * time, and that within the error of the frame from the true one. */
#include "gap_simplex.h"

#include "interval.h"

#include <math.h>
#include <string.h>

/* The error of a witness point, relative to a bound on the coordinates of its frame. */
#define GAP_WITNESS_ROUNDING 0x1p-49

/* ---- Vertices ---- */

/* The lanes of two bits. */
static const lanes_mask mask_of[4] = {{0, 0}, {-1, 0}, {0, -1}, {-1, -1}};

/* x in the lanes of the vectors in bits, i the position of the lanes; else 0. */
INLINE lanes masked(unsigned bits, int i, lanes x)
{
    return lanes_select(mask_of[bits >> 2 * i & 3], x, lanes_of(0));
}

INLINE double sum_of(const lanes x[GAP_LANES])
{
    const lanes sum = (x[0] + x[1]) + (x[2] + x[3]);
    return sum[0] + sum[1];
}

/* Of the vectors of a simplex, first to first + 2, the one with the least n . x, if that is
 * negative: the first of several. */
INLINE unsigned least_of(int first, const lanes at[GAP_LANES])
{
    const double x = at[first / 2][first % 2], y = at[(first + 1) / 2][(first + 1) % 2];
    const double z = at[(first + 2) / 2][(first + 2) % 2];
    const double least = interval_min(interval_min(x, y), z);
    const unsigned equal =
        (unsigned) (x == least) | (unsigned) (y == least) << 1 | (unsigned) (z == least) << 2;
    return least < 0 ? (equal & -equal) << first : 0;
}

/* The vertex with the least n . p. */
static void support(const void *context, const double n[3], struct gap_corner *out)
{
    const struct gap_pair *pair = (const struct gap_pair *) context;
    const unsigned of_a = 7, of_b = 7 << GAP_OF_B;
    lanes at[GAP_LANES], part[GAP_LANES];
    unsigned bits = 0;
    gap_dots(pair, n, at);
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        bits |= lanes_mask_bits(at[i] < 0) << 2 * i;
    if (pair->simplex[0])
        bits = (bits & ~of_a) | least_of(0, at);
    if (pair->simplex[1])
        bits = (bits & ~of_b) | least_of(GAP_OF_B, at);
    out->bits = bits;
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        UNROLL(4)
        for (int i = 0; i < GAP_LANES; i++)
            part[i] = masked(bits, i, pair->vector[axis][i]);
        out->at[axis] = pair->offset[axis] + sum_of(part);
    }
}

/* ---- Bounds ---- */

static double witness_error(const struct gap_pair *pair)
{
    return pair->error + GAP_WITNESS_ROUNDING * (pair->far[0] + pair->far[1]);
}

static void set_witness(const struct gap_pair *pair, const struct gap_simplex *simplex,
                        struct fmb_gap *out)
{
    lanes share[GAP_LANES] = {{0}}, part[GAP_LANES];
    double apart[3] = {0};
    for (int c = 0; c < simplex->count; c++)
        UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        share[i] += masked(simplex->corner[c].bits, i, lanes_of(simplex->weight[c]));
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        share[i] = CHECK_GIVEN(lanes_min(share[i], lanes_of(1)));
    out->time = CHECK_GIVEN(share[GAP_DRIFT / 2][GAP_DRIFT % 2] * pair->duration + 0.0);
    const double *a = pair->frame[0]->number, *b = pair->frame[1]->number;
    const double *of_a = prepared_velocity(pair->frame[0]);
    const double *of_b = prepared_velocity(pair->frame[1]);
    for (int axis = 0; axis < pair->dim; axis++) {
        UNROLL(3)
        for (int i = 0; i < GAP_LANES - 1; i++)
            part[i] = share[i] * pair->vector[axis][i];
        const double at_a = (part[0][0] + part[0][1]) + part[1][0];
        const double at_b = (part[1][1] + part[2][0]) + part[2][1];
        out->witness[0][axis] = a[axis] + (out->time * of_a[axis] - at_a) + 0.0;
        out->witness[1][axis] = b[axis] + (out->time * of_b[axis] + at_b) + 0.0;
    }
    for (int f = 0; f < 2; f++)
        CHECK_BOUND(GAP_WITNESS_ROUNDING, false,
                    (out->witness[f][0] + out->witness[f][1]) + out->witness[f][2],
                    GAP_WITNESS_ROUNDING * pair->far[f]);
    gap_subtract(out->witness[1], out->witness[0], apart);
    out->has_witness = true;
    out->bounds[1] = (sqrt(vec3_dot(apart, apart)) + witness_error(pair)) * (1 + 0x1p-49);
}

FLATTEN enum gap_outcome gap_distance(const struct gap_pair *pair, double farthest,
                                      struct fmb_gap *out)
{
    const double error = gap_error(pair), close = 0x1p-47 * pair->reach;
    const double far = farthest + GAP_FAR_MARGIN * (pair->far[0] + pair->far[1]) + error;
    struct gap_simplex simplex;
    double toward[3], f;
    /* The origin from the middle of the vectors. */
    for (int axis = 0; axis < 3; axis++)
        toward[axis] = pair->offset[axis] + 0.5 * sum_of(pair->vector[axis]);
    const enum gap_outcome outcome =
        gap_nearest(pair, support, pair->dim, toward, close, far, &simplex, out->direction, &f);
    if (outcome != GAP_KNOWN)
        return outcome;
    CHECK_BOUND(GAP_ROUNDING, false, f, GAP_ROUNDING * pair->reach);
    out->bounds[0] = f - error;
    set_witness(pair, &simplex, out);
    return gap_is_tight(pair, out->bounds) ? GAP_KNOWN : GAP_UNSURE;
}

/* A translation of b by the depth along the direction moves P so that the origin is on its
 * boundary. The nearest point of P is then 0 up to rounding, and its weights give the deepest pair.
 */
FLATTEN enum gap_outcome gap_deepest(const struct gap_pair *pair, struct fmb_gap *out)
{
    const double upper = out->bounds[1], close = 0x1p-47 * pair->reach;
    struct gap_pair moved = *pair;
    struct gap_simplex simplex;
    double direction[3], f;
    for (int axis = 0; axis < 3; axis++)
        moved.offset[axis] -= upper * out->direction[axis];
    gap_nearest(&moved, support, pair->dim, out->direction, close, INFINITY, &simplex, direction,
                &f);
    set_witness(pair, &simplex, out);
    out->bounds[1] = upper;
    return gap_stray(out) + witness_error(pair) <= GAP_LIMIT * pair->least ? GAP_KNOWN : GAP_UNSURE;
}
