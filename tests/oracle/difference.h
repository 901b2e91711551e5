/* The swept difference of two solids, in rational numbers: the points
 *
 *     offset + b - a + x drift,   a of the first solid, b of the second, 0 <= x <= 1.
 *
 * Of the solids neither origin nor velocity is read. */
#ifndef DIFFERENCE_H
#define DIFFERENCE_H

#include "rational_solid.h"

struct difference {
    int dim;
    struct rational_solid *first, *second; /* first may be NULL: the origin */
    mpq_t *offset, *drift;                 /* [axis]; drift may be NULL: 0 */
};

/* end := the greatest (sign +1) or the least (-1) n . p over all its points p; point := a vertex
 * where that is attained. point may be NULL. */
void difference_end(const struct difference *difference, rational_vector n, int sign, mpq_t end,
                    mpq_t *point);

/* square := the square of the distance of its nearest point from the origin; point := that point,
 * may be NULL (nearest.c). */
void difference_nearest(const struct difference *difference, mpq_t square, mpq_t *point);

/* The sign of x - y |n|. */
int difference_compare(const mpq_t x, const mpq_t y, rational_vector n);

/* The sign of the greatest d - limit, where d is minus the distance of the plane of a facet from
 * the origin, over all facets that have the origin on their inner side or in their plane. Other
 * facets have d > 0. Without facets, as in a plane, d is 0. Slow: all pairs of edges, of a hull all
 * pairs of pairs of vertices (facets.c). */
int difference_compare_facets(const struct difference *difference, const mpq_t limit);

#endif
