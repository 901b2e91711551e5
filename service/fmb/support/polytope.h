/* A growing convex polytope: the hull of the points added so far, on a grid.
 *
 * Method. The boundary is a closed mesh of triangles (in 2D, of edges), each with its corners in
 * counterclockwise order seen from outside. A point outside is added by removing the facets that it
 * sees, which are connected, and joining it to the ridges around them. Which facets it sees is
 * exact: the numbers are integers, and determinants have 192 bits. So the mesh is that of a convex
 * polytope whatever the points are, coplanar and collinear ones included.
 *
 * Facets are kept in a heap by their height, that of their plane over the origin, which is negative
 * if the origin is outside.
 *
 * Memory: a mesh of up to POLYTOPE_FACETS facets, those that were removed included, needs no memory
 * of its own; a larger one is allocated through GMP. */
#ifndef FMB_POLYTOPE_H
#define FMB_POLYTOPE_H

#include "fmb.h"

#include <stdint.h>

enum {
    POLYTOPE_BITS = 52, /* coordinates are less than 2^POLYTOPE_BITS in magnitude */
    POLYTOPE_FACETS = 512,
    POLYTOPE_POINTS = POLYTOPE_FACETS / 2
};

/* The heights and normals of facets in doubles: bounds, in units of the grid (polytope.c). */
#define POLYTOPE_ERROR 18.0

struct polytope_facet {
    double normal[FMB_DIM_MAX]; /* of unit length, up to rounding */
    double height;              /* n . p of its points */
    int corner[FMB_DIM_MAX];    /* points */
    int next[FMB_DIM_MAX];      /* 3D: the facet across the edge from corner i to corner i + 1 */
    int link;                   /* scratch: a list of removed facets */
    bool gone;
};

struct polytope_point {
    int64_t at[FMB_DIM_MAX]; /* in 2D [2] is 0 */
    int facet;               /* scratch: a new facet that begins here */
};

struct polytope {
    int dim, facets, points, waiting; /* of the heap */
    int facet_capacity, point_capacity;
    struct polytope_facet *facet;
    struct polytope_point *point;
    int *heap;
    struct polytope_facet own_facet[POLYTOPE_FACETS];
    struct polytope_point own_point[POLYTOPE_POINTS];
    int own_heap[POLYTOPE_FACETS];
};

/* Begins an empty mesh; polytope_end() frees what it allocates, and leaves it empty. Points are
 * added to it by polytope_add_point() until there are dim + 1. */
void polytope_begin(struct polytope *mesh, int dim);
void polytope_end(struct polytope *mesh);

/* Returns the number of the point. */
int polytope_add_point(struct polytope *mesh, const int64_t at[FMB_DIM_MAX]);

/* Makes the first facets, of points 0 to dim; returns false if these lie in one plane (2D: line).
 */
bool polytope_close(struct polytope *mesh);

/* Removes the facet of least height from the heap, and returns its number; -1 if there is none. */
int polytope_lowest(struct polytope *mesh);

/* Returns the sign of the height of a point over the plane of a facet, exactly. */
int polytope_side(const struct polytope *mesh, int facet, const int64_t at[FMB_DIM_MAX]);

/* out := the normal of the plane of points 0 to 2 (2D: of the line of points 0 and 1), of unit
 * length up to rounding. In: they are not collinear (2D: not equal). */
void polytope_first_normal(const struct polytope *mesh, double out[FMB_DIM_MAX]);

/* Adds a point that lies above the given facet. */
void polytope_extend(struct polytope *mesh, int facet, const int64_t at[FMB_DIM_MAX]);

/* Returns the least height of all facets. In: a closed mesh. */
double polytope_least_height(const struct polytope *mesh);

#endif
