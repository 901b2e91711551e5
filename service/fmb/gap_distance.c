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
 * Accuracy, with u = 2^-53. Along a direction with |n| = 1 +- 4 u, f(n) is a sum of products of
 * coordinates: of the offset, rounded once, of the drift, rounded twice, and of components; a
 * product is rounded 3 times with its sum over the axes, and at most 8 times in sums of these. So
 * its error is below 13.01 u sum |n_k| |x_k| <= 13.1 u R, R the sum of the lengths of all these
 * vectors; f(n) is at most R, and dividing it by |n| moves it by 5 u R more. gap_error() has 32 u
 * R, and the errors of both frames.
 *
 * A witness point is o + sum x_i c_i + t v for parameters x_i and a time t of the window that are
 * doubles. Each monomial is rounded at most 7 times. Sums of weights are off by 4 u; those of a
 * cuboid are cut off at 1, those of a simplex may be 4 u too large in all. So the point is within
 * 7.01 u |..|_1 + 4 u sum |c_i|, which is below 16 u far, from a point of the rounded frame at this
 * time, and that within the error of the frame from the true one. */
#include "gap.h"

#include "range.h"

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
};

static void subtract(const double x[3], const double y[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = x[axis] - y[axis];
}

/* ---- Vertices ---- */

/* Of a simplex of vectors first to first + 2 the mask keeps the one with the least n . x alone. */
static void keep_least(int first, const lanes at[GAP_LANES], lanes_mask mask[GAP_LANES])
{
    int least = first;
    for (int k = first + 1; k < first + 3; k++)
        if (at[k / 2][k % 2] < at[least / 2][least % 2])
            least = k;
    for (int k = first; k < first + 3; k++)
        if (k != least)
            mask[k / 2][k % 2] = 0;
}

INLINE lanes masked(lanes_mask mask, lanes x)
{
    return (lanes) (mask & (lanes_mask) x);
}

INLINE double sum_of(const lanes x[GAP_LANES])
{
    const lanes sum = (x[0] + x[1]) + (x[2] + x[3]);
    return sum[0] + sum[1];
}

/* The vertex with the least n . p; returns that. */
static double support(const struct gap_pair *pair, const double n[3], struct corner *out)
{
    lanes at[GAP_LANES], part[GAP_LANES];
    lanes_mask mask[GAP_LANES];
    gap_dots(pair, n, at);
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        mask[i] = at[i] < 0;
    if (pair->simplex[0])
        keep_least(0, at, mask);
    if (pair->simplex[1])
        keep_least(GAP_OF_B, at, mask);
    out->bits = 0;
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++) {
        out->bits |= lanes_mask_bits(mask[i]) << 2 * i;
        at[i] = masked(mask[i], at[i]);
    }
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        UNROLL(4)
        for (int i = 0; i < GAP_LANES; i++)
            part[i] = masked(mask[i], pair->vector[axis][i]);
        out->at[axis] = pair->offset[axis] + sum_of(part);
    }
    return gap_dot(n, pair->offset) + sum_of(at);
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
static void reject(const double x[3], const double e[3], double out[3])
{
    const double inverse = 1 / gap_dot(e, e);
    memcpy(out, x, 3 * sizeof *out);
    for (int step = 0; step < 2; step++) {
        const double share = gap_dot(out, e) * inverse;
        for (int axis = 0; axis < 3; axis++)
            out[axis] -= share * e[axis];
    }
}

/* The direction of the point, of unit length; false if there is none. */
static bool direction_of(const struct simplex *simplex, bool plane, double n[3])
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
        reject(w, simplex->edge[0], n);
    }
    const double square = gap_dot(n, n);
    if (!(square >= 0x1p-950)) /* it may have underflowed */
        return false;
    const double scale = (gap_dot(n, w) < 0 ? -1 : 1) / sqrt(square);
    for (int axis = 0; axis < 3; axis++)
        n[axis] *= scale;
    return true;
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

/* The share of vector k in the point. */
static double share_of(const struct simplex *simplex, int k)
{
    double sum = 0;
    for (int c = 0; c < simplex->count; c++)
        sum += simplex->corner[c].bits >> k & 1 ? simplex->weight[c] : 0;
    return range_least(sum, 1);
}

static void set_witness(const struct gap_pair *pair, const struct simplex *simplex,
                        struct fmb_gap *out)
{
    double apart[3] = {0}, error = pair->error;
    out->time = share_of(simplex, GAP_DRIFT) * pair->duration + 0.0;
    for (int f = 0; f < 2; f++) {
        const double *number = pair->frame[f]->number;
        const double *velocity = prepared_velocity(pair->frame[f]);
        double share[3];
        for (int i = 0; i < pair->count[f]; i++)
            share[i] = share_of(simplex, f * GAP_OF_B + i);
        for (int axis = 0; axis < pair->dim; axis++) {
            double at = out->time * velocity[axis];
            for (int i = 0; i < pair->count[f]; i++)
                at += share[i] * number[(1 + i) * pair->dim + axis];
            out->witness[f][axis] = number[axis] + at + 0.0;
        }
        error += 0x1p-49 * pair->far[f];
    }
    subtract(out->witness[1], out->witness[0], apart);
    out->has_witness = true;
    out->bounds[1] = (sqrt(gap_dot(apart, apart)) + error) * (1 + 0x1p-49);
}

enum gap_outcome gap_distance(const struct gap_pair *pair, double farthest, struct fmb_gap *out)
{
    const double error = gap_error(pair), close = 0x1p-47 * pair->reach;
    const double far = farthest + 0x1p-38 * (pair->far[0] + pair->far[1]) + error;
    struct simplex simplex;
    struct corner next;
    double n[3], best = -INFINITY;
    set_first(pair, &simplex);
    for (int step = 0; step < STEPS_MAX; step++) {
        if (!direction_of(&simplex, pair->dim == 2, n))
            break;
        const double f = support(pair, n, &next);
        if (f > far)
            return GAP_FAR;
        if (f > best) {
            best = f;
            memcpy(out->direction, n, sizeof n);
        }
        if (gap_dot(n, simplex.corner[0].at) - f <= close || has_corner(&simplex, next.bits))
            break;
        simplex.corner[simplex.count] = next;
        simplex.weight[simplex.count++] = 0;
        if (!move(&simplex))
            return GAP_UNSURE;
    }
    out->bounds[0] = best - error;
    set_witness(pair, &simplex, out);
    return gap_is_tight(pair, out->bounds) ? GAP_KNOWN : GAP_UNSURE;
}
