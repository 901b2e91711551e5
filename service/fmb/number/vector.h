/* Vectors of three doubles. Every operation rounds; terms are added in the order of the axes. */
#ifndef FMB_VECTOR_H
#define FMB_VECTOR_H

#include "inlined.h"

#include <math.h>

INLINE double vec3_dot(const double x[3], const double y[3])
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

INLINE void vec3_cross(const double x[3], const double y[3], double out[3])
{
    out[0] = x[1] * y[2] - x[2] * y[1];
    out[1] = x[2] * y[0] - x[0] * y[2];
    out[2] = x[0] * y[1] - x[1] * y[0];
}

/* Returns the sum of the magnitudes of the coordinates. It bounds the length of v, except for
 * rounding. */
INLINE double vec3_sum(const double v[3])
{
    return (fabs(v[0]) + fabs(v[1])) + fabs(v[2]);
}

/* Returns the largest magnitude of a coordinate. */
INLINE double vec3_largest(const double v[3])
{
    const double x = fabs(v[0]), y = fabs(v[1]), z = fabs(v[2]), yz = y > z ? y : z;
    return x > yz ? x : yz;
}

#endif
