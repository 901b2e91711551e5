/* A placed frame in rational numbers, as fmb.h defines it. */
#ifndef RATIONAL_SOLID_H
#define RATIONAL_SOLID_H

#include <gmp.h>
#include <stdbool.h>

#include "fmb.h"

/* In the world, at the start of the window; axes and components that are not there are 0. */
struct rational_solid {
    int count;    /* of components */
    bool simplex; /* a tetrahedron or a face */
    mpq_t origin[FMB_DIM_MAX];
    mpq_t component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis] */
    mpq_t velocity[FMB_DIM_MAX];
};

void rational_solid_init(const struct fmb_frame *frame, const struct fmb_placement *placement,
                         struct rational_solid *out);
void rational_solid_clear(struct rational_solid *solid);

/* The greatest of sign * (coordinate of a vertex over the window): a cuboid's sums all components
 * that add, a simplex takes the one that adds most. */
void rational_solid_farthest(const struct rational_solid *solid, const mpq_t duration, int axis,
                             int sign, mpq_t out);

/* Three coordinates. */
typedef mpq_t rational_vector[FMB_DIM_MAX];
void rational_vector_init(rational_vector v);
void rational_vector_clear(rational_vector v);
void rational_dot(mpq_t out, rational_vector x, rational_vector y);

/* sum += sign * x * y. */
void rational_add_product(mpq_t sum, int sign, const mpq_t x, const mpq_t y);

#endif
