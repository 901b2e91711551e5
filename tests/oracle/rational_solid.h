/* A placed frame in rational numbers, as fmb.h defines it. */
#ifndef RATIONAL_SOLID_H
#define RATIONAL_SOLID_H

#include <gmp.h>
#include <stdbool.h>

#include "fmb.h"

/* Three coordinates. */
typedef mpq_t rational_vector[FMB_DIM_MAX];

/* In the world, at the start of the window; in 2D the third coordinate is 0. A point is
 *
 *     origin + sum_i x_i column_i,   0 <= x_i <= 1,
 *
 * and of a hull (a tetrahedron, a face) also sum_i x_i = 1: its columns are its vertices. These are
 * the points of the core: the frame has all points within its radius of them. */
struct rational_solid {
    int count; /* of columns */
    bool hull;
    mpq_t radius;
    rational_vector origin, velocity;
    rational_vector *column; /* [count] */
};

void rational_solid_init(const struct fmb_frame *frame, const struct fmb_placement *placement,
                         struct rational_solid *out);

/* The same, at rest in the pose at a time, a share of the window. If at is NULL: as above. */
void rational_solid_init_at(const struct fmb_frame *frame, const struct fmb_placement *placement,
                            mpq_srcptr at, double duration, struct rational_solid *out);
void rational_solid_clear(struct rational_solid *solid);

/* The orientations at the start and at the end of the window, (w, x, y, z) also in 2D. If there is
 * no end, both are the same. The sign of the end makes the turn less than 180 degrees. */
void rational_orientation(const struct fmb_placement *placement, mpq_t start[4], mpq_t end[4]);

/* The greatest of sign * (coordinate of a vertex over the window), plus the radius. */
void rational_solid_farthest(struct rational_solid *solid, const mpq_t duration, int axis, int sign,
                             mpq_t out);

/* extent := the greatest of n . (a point of the core - the origin). Where point is not NULL, adds
 * such a point minus the origin, a vertex, to it. */
void rational_solid_support(struct rational_solid *solid, rational_vector n, mpq_t extent,
                            mpq_t *point);

void rational_vector_init(rational_vector v);
void rational_vector_clear(rational_vector v);
void rational_dot(mpq_t out, rational_vector x, rational_vector y);

/* sum += sign * x * y. */
void rational_add_product(mpq_t sum, int sign, const mpq_t x, const mpq_t y);

#endif
