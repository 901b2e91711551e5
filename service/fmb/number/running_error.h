/* Vectors that carry, for each axis, the sum of the magnitudes of what they were made of: a sum of
 * monomials, each of them rounded n times, is off by at most (n + 0.01) u times the sum of their
 * magnitudes, u = 2^-53; and that is found by the same operations on magnitudes ("weight"). Such a
 * bound is made for one value alone: it costs as much as the value, and is small where that is
 * made of small numbers. */
#ifndef FMB_RUNNING_ERROR_H
#define FMB_RUNNING_ERROR_H

#include "fmb.h"

#include <math.h>

struct running_error {
    double at[FMB_DIM_MAX], weight[FMB_DIM_MAX];
    double length; /* no vector of lengths up to those of its factors is longer */
};

/* Bounds the error of n . w, where n is a component turned by a right angle (2D), the cross product
 * of two edges, or the sum of three such (the last face of a tetrahedron), and w a vertex of one
 * frame seen from another, moving or not; weight is that of n . w, less than 2^610.
 *
 * A monomial is rounded at most 3 times before (offset once, drift twice), once in each edge that
 * is a difference, 2 times in a cross product, 2 in the sum of three normals, 3 in a dot product,
 * 4 in sums of components and motion, 2 where a bound is taken from it: 18 times, if all of these
 * applied to one. 2^-48 = 32 u leaves room for the rounding of the weight and of what the
 * bound is added to. Underflow: at most 2^8 operations, each off by less than 2^-1074, some of them
 * multiplied later by at most two lengths, of 2^204 each at most: less than 2^-660. */
static inline double running_error_bound(double weight)
{
    return 0x1p-48 * weight + 0x1p-660;
}

static inline struct running_error running_error_of(const double v[FMB_DIM_MAX])
{
    struct running_error out;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.at[axis] = v[axis];
        out.weight[axis] = fabs(v[axis]);
    }
    out.length = (out.weight[0] + out.weight[1]) + out.weight[2];
    return out;
}

/* x + sign y */
static inline struct running_error running_error_sum(const struct running_error *x, double sign,
                                                     const struct running_error *y)
{
    struct running_error out;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.at[axis] = x->at[axis] + sign * y->at[axis];
        out.weight[axis] = x->weight[axis] + y->weight[axis];
    }
    out.length = x->length + y->length;
    return out;
}

static inline struct running_error running_error_cross(const struct running_error *u,
                                                       const struct running_error *v)
{
    struct running_error out;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out.at[i] = u->at[j] * v->at[k] - u->at[k] * v->at[j];
        out.weight[i] = u->weight[j] * v->weight[k] + u->weight[k] * v->weight[j];
    }
    out.length = u->length * v->length;
    return out;
}

/* In the plane z = 0: turned by a right angle, counterclockwise. */
static inline struct running_error running_error_perpendicular(const struct running_error *u)
{
    return (struct running_error){
        {-u->at[1], u->at[0], 0}, {u->weight[1], u->weight[0], 0}, u->length};
}

static inline double running_error_dot(const double u[FMB_DIM_MAX], const double v[FMB_DIM_MAX])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

#endif
