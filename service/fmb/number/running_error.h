/* Vectors with running error bounds.
 *
 * A coordinate is a sum of monomials. If each of them is rounded n times, the sum is off by at most
 * (n + 0.01) u times the sum of the magnitudes of the monomials, u = 2^-53. That sum is the weight
 * of the coordinate; the operations that compute the coordinate also compute the weight, on
 * magnitudes.
 *
 * Such a bound belongs to one value. It costs as much as the value itself, and is small if the
 * value is made of small numbers. */
#ifndef FMB_RUNNING_ERROR_H
#define FMB_RUNNING_ERROR_H

#include "fmb.h"

#include <math.h>

struct running_error {
    double at[FMB_DIM_MAX];     /* coordinates, rounded */
    double weight[FMB_DIM_MAX]; /* sum of the magnitudes of the monomials, for each coordinate */
    double length; /* bounds the length of every vector computed so from factors no longer */
};

/* Bounds the error of n . w. The normal n is a component rotated by a right angle (2D), the cross
 * product of two edges, or the sum of three cross products (the last face of a tetrahedron). The
 * vector w is a vertex of one frame seen from another, moving or not. In: weight is the weight of
 * n . w, less than 2^610.
 *
 * Number of roundings of one monomial:
 *
 *     3  before (offset once, drift twice)
 *     2  in edges that are differences: once in each of two
 *     2  in a cross product
 *     2  in the sum of three normals
 *     3  in a dot product
 *     4  in sums of components and motion
 *     2  where a bound is derived from it
 *
 * Together 18, if all of these applied to one monomial. 2^-48 = 32 u also covers the rounding of
 * the weight, and of the sum that the bound is added to.
 *
 * Underflow: there are at most 2^8 operations. Each is off by less than 2^-1074, and some results
 * are multiplied later by at most two lengths, each at most 2^204. The sum is less than 2^-660. */
static inline double running_error_bound(double weight)
{
    return 0x1p-48 * weight + 0x1p-660;
}

/* A vector of exact coordinates. */
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

/* x + sign y, sign +1 or -1. */
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

/* The cross product u x v. */
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

/* u in the plane z = 0, rotated by a right angle, counterclockwise. */
static inline struct running_error running_error_perpendicular(const struct running_error *u)
{
    return (struct running_error){
        {-u->at[1], u->at[0], 0}, {u->weight[1], u->weight[0], 0}, u->length};
}

/* u . v; of coordinates a value, of weights its weight. */
static inline double running_error_dot(const double u[FMB_DIM_MAX], const double v[FMB_DIM_MAX])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

#endif
