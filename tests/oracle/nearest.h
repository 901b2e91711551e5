/* The point of a polytope that is next to the origin, in rational numbers. */
#ifndef NEAREST_H
#define NEAREST_H

#include <gmp.h>

#include "rational_solid.h"

enum { NEAREST_MAX = 2 * FMB_DIM_MAX + 1 };

/* A set of parameters, each 0, 1 or free within [0, 1]; those of a simplex sum up to at most 1. */
struct nearest {
    int count;
    mpq_t *column[NEAREST_MAX]; /* [axis] */
    int simplex[2], simplex_end[2];
};

/* square := the least |w + sum x_i column_i|^2 over all faces, of whatever dimension: of each the
 * foot of the perpendicular on its plane, by normal equations, where it lies in the face. */
void nearest_square(const struct nearest *box, rational_vector w, mpq_t square);

#endif
