/* The point of a polytope P next to the origin, in doubles, for a P that is given by its vertex
 * with the least n . p for any n.
 *
 * Method. Wolfe's algorithm. It holds a simplex of vertices of P and the weights of its point next
 * to the origin. The direction of that point comes from the simplex: the vertex, what is left of it
 * across an edge, or the normal of a triangle; not from the point itself, which is a small
 * difference of large numbers where frames are close. The vertex of P with the least n . p gives
 * f(n), a lower bound; it is added to the simplex until that bound and the distance agree. Where
 * the new simplex has its point next to the origin outside, the old point moves toward it as far as
 * the weights stay positive, and vertices that are left without weight are dropped.
 *
 * Nothing is believed of this but the direction and the weights: the caller proves its bounds from
 * them. */
#ifndef FMB_GAP_SIMPLEX_H
#define FMB_GAP_SIMPLEX_H

#include "gap.h"

#include <math.h>
#include <string.h>

enum { GAP_CORNERS = 4, GAP_STEPS_MAX = 32 };

/* A vertex of P. */
struct gap_corner {
    double at[3];
    unsigned bits; /* which one: defined by the caller */
};

struct gap_simplex {
    int count;
    struct gap_corner corner[GAP_CORNERS];
    double weight[GAP_CORNERS];
    double edge[GAP_CORNERS - 1][3], normal[3]; /* from the first corner; of a triangle */
    double inverse;                             /* of two corners: 1 / the square of the edge */
};

INLINE void gap_subtract(const double x[3], const double y[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = x[axis] - y[axis];
}

INLINE bool gap_has_corner(const struct gap_simplex *simplex, unsigned bits)
{
    for (int i = 0; i < simplex->count; i++)
        if (simplex->corner[i].bits == bits)
            return true;
    return false;
}

/* x less its part along e: twice, the second time for what the first one rounds. */
INLINE void gap_reject(const double x[3], const double e[3], double inverse, double out[3])
{
    memcpy(out, x, 3 * sizeof *out);
    for (int step = 0; step < 2; step++) {
        const double share = vec3_dot(out, e) * inverse;
        for (int axis = 0; axis < 3; axis++)
            out[axis] -= share * e[axis];
    }
}

/* The direction of the point, of any length; *square is that of its length. False if there is
 * none. */
INLINE bool gap_direction_of(const struct gap_simplex *simplex, bool plane, double n[3],
                             double *square)
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
        gap_reject(w, simplex->edge[0], simplex->inverse, n);
    }
    const double sign = copysign(1, vec3_dot(n, w));
    for (int axis = 0; axis < 3; axis++)
        n[axis] *= sign;
    *square = vec3_dot(n, n);
    return *square >= GAP_LEAST_SQUARE;
}

/* Weights of the point of the affine hull next to the origin; false if the corners are not affinely
 * independent. */
INLINE bool gap_affine_weights(struct gap_simplex *simplex, double out[GAP_CORNERS])
{
    const double *w = simplex->corner[0].at;
    double(*e)[3] = simplex->edge, *n = simplex->normal, other[3], total;
    for (int i = 1; i < simplex->count; i++)
        gap_subtract(simplex->corner[i].at, w, e[i - 1]);
    if (simplex->count == 2) {
        total = vec3_dot(e[0], e[0]);
        out[1] = -vec3_dot(w, e[0]);
    } else if (simplex->count == 3) {
        vec3_cross(e[0], e[1], n);
        total = vec3_dot(n, n);
        vec3_cross(e[1], w, other);
        out[1] = vec3_dot(other, n);
        vec3_cross(w, e[0], other);
        out[2] = vec3_dot(other, n);
    } else {
        for (int i = 0; i < 3; i++) {
            vec3_cross(e[(i + 1) % 3], e[(i + 2) % 3], other);
            out[1 + i] = -vec3_dot(other, w);
            total = vec3_dot(other, e[i]);
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

INLINE void gap_drop(struct gap_simplex *simplex, int i)
{
    simplex->count--;
    for (; i < simplex->count; i++) {
        simplex->corner[i] = simplex->corner[i + 1];
        simplex->weight[i] = simplex->weight[i + 1];
    }
}

/* Moves the point to the one next to the origin, and drops corners without weight. False where
 * rounding keeps it from moving: the corners are dependent, or hold the origin. */
INLINE bool gap_move(struct gap_simplex *simplex)
{
    for (;;) {
        double aim[GAP_CORNERS], step = 1;
        int first = -1;
        if (simplex->count == 1) {
            simplex->weight[0] = 1;
            return true;
        }
        if (!gap_affine_weights(simplex, aim))
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
            return simplex->count < GAP_CORNERS;
        }
        if (!(step >= 0)) /* none of both is positive */
            step = 0;
        for (int i = 0; i < simplex->count; i++)
            simplex->weight[i] += step * (aim[i] - simplex->weight[i]);
        gap_drop(simplex, first);
    }
}

/* A P, and its vertex with the least n . p. */
typedef void gap_support(const void *context, const double n[3], struct gap_corner *out);

/* Returns whether f(n) is certainly greater than far |n|. square: of |n|. */
INLINE bool gap_is_beyond(double far, double f, double square)
{
    const bool known = square >= GAP_LEAST_SQUARE; /* else it may have underflowed */
    return far < INFINITY && f > 0 && known && f > far * sqrt(square);
}

/* Finds the point of P nearest to the origin.
 *
 * In:  toward     any direction: the vertex in it is the first one
 *      close      vertices that are nearer by no more than this are not added
 *      far        a distance; INFINITY
 * Out: *simplex   its weights give the point
 *      direction  of unit length up to rounding
 *      *f         f(direction)
 * Returns GAP_FAR if f is greater than far, GAP_UNSURE if the simplex has four corners, and
 * contains the origin up to rounding, or if rounding keeps the point from moving. */
INLINE enum gap_outcome gap_nearest(const void *context, gap_support *const support, int dim,
                                    const double toward[3], double close, double far,
                                    struct gap_simplex *simplex, double direction[3], double *f)
{
    double n[3], square, of_direction = 1;
    support(context, toward, &simplex->corner[0]);
    simplex->weight[0] = 1;
    simplex->count = 1;
    *f = -INFINITY;
    if (gap_is_beyond(far, vec3_dot(toward, simplex->corner[0].at), vec3_dot(toward, toward)))
        return GAP_FAR;
    for (int step = 0; step < GAP_STEPS_MAX; step++) {
        if (!gap_direction_of(simplex, dim == 2, n, &square))
            break;
        CHECK_GIVEN_NORMAL(n, square);
        struct gap_corner *next = &simplex->corner[simplex->count];
        support(context, n, next);
        *f = vec3_dot(n, next->at);
        if (gap_is_beyond(far, *f, square))
            return GAP_FAR;
        for (int axis = 0; axis < 3; axis++)
            direction[axis] = n[axis];
        of_direction = square;
        const double above = vec3_dot(n, simplex->corner[0].at) - *f;
        if (above <= 0 || above * above <= close * close * square ||
            gap_has_corner(simplex, next->bits))
            break;
        simplex->weight[simplex->count++] = 0;
        if (!gap_move(simplex))
            return GAP_UNSURE;
    }
    const double inverse = 1 / sqrt(of_direction);
    for (int axis = 0; axis < 3; axis++)
        direction[axis] *= inverse;
    *f *= inverse;
    return GAP_KNOWN;
}

#endif
