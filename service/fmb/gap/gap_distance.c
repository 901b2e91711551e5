/* The gap of a separated pair, in doubles.
 *
 * Method. Wolfe's algorithm for the point of a polytope next to the origin. It holds a simplex of
 * vertices of P and the weights of its point next to the origin. The direction of that point comes
 * from the simplex: the vertex, what is left of it across an edge, or the normal of a triangle; not
 * from the point itself, which is a small difference of large numbers where frames are close. The
 * vertex of P with the least n . p gives f(n), a lower bound; it is added to the simplex until that
 * bound and the distance agree. Where the new simplex has its point next to the origin outside, the
 * old point moves toward it as far as the weights stay positive, and vertices that are left without
 * weight are dropped.
 *
 * Nothing is believed of this but the direction and the weights. Both bounds are derived from them:
 * the lower one is f(n) less its error, the upper one the distance of the witness points.
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
#include "gap.h"

#include "interval.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 4, STEPS_MAX = 32 };

/* A vertex of P. */
struct corner {
    double at[3];
    unsigned bits; /* bit k: vector k is added to the offset */
};

struct simplex {
    int count;
    struct corner corner[CORNERS];
    double weight[CORNERS];
    double edge[CORNERS - 1][3], normal[3]; /* from the first corner; of a triangle */
    double inverse;                         /* of two corners: 1 / the square of the edge */
};

static void subtract(const double x[3], const double y[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = x[axis] - y[axis];
}

/* ---- Vertices ---- */

/* The lanes of two bits. */
static const lanes_mask mask_of[4] = {{0, 0}, {-1, 0}, {0, -1}, {-1, -1}};

/* x in the lanes of the vectors in bits, i the position of the lanes; else 0. */
INLINE lanes masked(unsigned bits, int i, lanes x)
{
    return (lanes) (mask_of[bits >> 2 * i & 3] & (lanes_mask) x);
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
INLINE void support(const struct gap_pair *pair, const double n[3], struct corner *out)
{
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

static bool has_corner(const struct simplex *simplex, unsigned bits)
{
    for (int i = 0; i < simplex->count; i++)
        if (simplex->corner[i].bits == bits)
            return true;
    return false;
}

/* The vertex in the direction of the origin from the middle of the vectors. */
static void set_first(const struct gap_pair *pair, struct simplex *out)
{
    double n[3];
    for (int axis = 0; axis < 3; axis++)
        n[axis] = pair->offset[axis] + 0.5 * sum_of(pair->vector[axis]);
    support(pair, n, &out->corner[0]);
    out->weight[0] = 1;
    out->count = 1;
}

/* ---- The point of a simplex next to the origin ---- */

/* x less its part along e: twice, the second time for what the first one rounds. */
static void reject(const double x[3], const double e[3], double inverse, double out[3])
{
    memcpy(out, x, 3 * sizeof *out);
    for (int step = 0; step < 2; step++) {
        const double share = gap_dot(out, e) * inverse;
        for (int axis = 0; axis < 3; axis++)
            out[axis] -= share * e[axis];
    }
}

/* The direction of the point, of any length; *square is that of its length. False if there is
 * none. */
static bool direction_of(const struct simplex *simplex, bool plane, double n[3], double *square)
{
    const double *w = simplex->corner[0].at;
    if (simplex->count == 1) {
        memcpy(n, w, 3 * sizeof *n);
    } else if (simplex->count == 3) {
        if (plane) /* it holds the origin, but for rounding */
            return false;
        memcpy(n, simplex->normal, 3 * sizeof *n);
    } else if (plane) {
        n[0] = -simplex->edge[0][1];
        n[1] = simplex->edge[0][0];
        n[2] = 0;
    } else {
        reject(w, simplex->edge[0], simplex->inverse, n);
    }
    const double sign = copysign(1, gap_dot(n, w));
    for (int axis = 0; axis < 3; axis++)
        n[axis] *= sign;
    *square = gap_dot(n, n);
    return *square >= 0x1p-950; /* else it may have underflowed */
}

/* Weights of the point of the affine hull next to the origin; false if the corners are not affinely
 * independent. */
static bool affine_weights(struct simplex *simplex, double out[CORNERS])
{
    const double *w = simplex->corner[0].at;
    double(*e)[3] = simplex->edge, *n = simplex->normal, other[3], total;
    for (int i = 1; i < simplex->count; i++)
        subtract(simplex->corner[i].at, w, e[i - 1]);
    if (simplex->count == 2) {
        total = gap_dot(e[0], e[0]);
        out[1] = -gap_dot(w, e[0]);
    } else if (simplex->count == 3) {
        gap_cross(e[0], e[1], n);
        total = gap_dot(n, n);
        gap_cross(e[1], w, other);
        out[1] = gap_dot(other, n);
        gap_cross(w, e[0], other);
        out[2] = gap_dot(other, n);
    } else {
        for (int i = 0; i < 3; i++) {
            gap_cross(e[(i + 1) % 3], e[(i + 2) % 3], other);
            out[1 + i] = -gap_dot(other, w);
            total = gap_dot(other, e[i]);
        }
    }
    const double inverse = 1 / total;
    simplex->inverse = inverse;
    out[0] = 1;
    for (int i = 1; i < simplex->count; i++) {
        out[i] *= inverse;
        out[0] -= out[i];
    }
    return fabs(inverse) <= 0x1p1000;
}

static void drop(struct simplex *simplex, int i)
{
    simplex->count--;
    for (; i < simplex->count; i++) {
        simplex->corner[i] = simplex->corner[i + 1];
        simplex->weight[i] = simplex->weight[i + 1];
    }
}

/* Moves the point to the one next to the origin, and drops corners without weight. False where
 * rounding keeps it from moving: the corners are dependent, or hold the origin. */
static bool move(struct simplex *simplex)
{
    for (;;) {
        double aim[CORNERS], step = 1;
        int first = -1;
        if (simplex->count == 1) {
            simplex->weight[0] = 1;
            return true;
        }
        if (!affine_weights(simplex, aim))
            return false;
        for (int i = 0; i < simplex->count; i++) {
            if (aim[i] > 0)
                continue;
            const double part = simplex->weight[i] / (simplex->weight[i] - aim[i]);
            if (first < 0 || part < step) {
                step = part;
                first = i;
            }
        }
        if (first < 0) {
            memcpy(simplex->weight, aim, sizeof aim);
            return simplex->count < CORNERS;
        }
        if (!(step >= 0)) /* none of both is positive */
            step = 0;
        for (int i = 0; i < simplex->count; i++)
            simplex->weight[i] += step * (aim[i] - simplex->weight[i]);
        drop(simplex, first);
    }
}

/* ---- Bounds ---- */

static void set_witness(const struct gap_pair *pair, const struct simplex *simplex,
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
        share[i] = lanes_min(share[i], lanes_of(1));
    out->time = share[GAP_DRIFT / 2][GAP_DRIFT % 2] * pair->duration + 0.0;
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
    const double error = pair->error + 0x1p-49 * (pair->far[0] + pair->far[1]);
    subtract(out->witness[1], out->witness[0], apart);
    out->has_witness = true;
    out->bounds[1] = (sqrt(gap_dot(apart, apart)) + error) * (1 + 0x1p-49);
}

enum gap_outcome gap_distance(const struct gap_pair *pair, double farthest, struct fmb_gap *out)
{
    const double error = gap_error(pair), close = 0x1p-47 * pair->reach;
    const double far = farthest + 0x1p-38 * (pair->far[0] + pair->far[1]) + error;
    struct simplex simplex;
    double n[3], square, of_direction = 1, f = -INFINITY;
    set_first(pair, &simplex);
    for (int step = 0; step < STEPS_MAX; step++) {
        if (!direction_of(&simplex, pair->dim == 2, n, &square))
            break;
        struct corner *next = &simplex.corner[simplex.count];
        support(pair, n, next);
        f = gap_dot(n, next->at);
        if (farthest < INFINITY && f > far * sqrt(square))
            return GAP_FAR;
        for (int axis = 0; axis < 3; axis++)
            out->direction[axis] = n[axis];
        of_direction = square;
        const double above = gap_dot(n, simplex.corner[0].at) - f;
        if (above <= 0 || above * above <= close * close * square ||
            has_corner(&simplex, next->bits))
            break;
        simplex.weight[simplex.count++] = 0;
        if (!move(&simplex))
            return GAP_UNSURE;
    }
    const double inverse = 1 / sqrt(of_direction);
    for (int axis = 0; axis < 3; axis++)
        out->direction[axis] *= inverse;
    out->bounds[0] = f * inverse - error;
    set_witness(pair, &simplex, out);
    return gap_is_tight(pair, out->bounds) ? GAP_KNOWN : GAP_UNSURE;
}
