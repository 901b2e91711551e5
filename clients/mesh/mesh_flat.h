/* Adjacent triangles, projected along a coordinate axis: in a plane, the exact side of a line on
 * which a point lies is cheap to compute. If the projections of F and G intersect in nothing but
 * one point or edge, and the projection of F has an area, so that no two points of F project to
 * one, then F and G intersect in nothing else either. */
#ifndef MESH_FLAT_H
#define MESH_FLAT_H

#include <stdbool.h>

/* Whether F = conv(a, b, c) and G = conv(a, d, e) certainly have no common point but a. False: not
 * known. Points are [axis]. */
bool mesh_flat_share_vertex(const double *a, const double *b, const double *c, const double *d,
                            const double *e);

/* Whether conv(p, q, r) and conv(p, q, s) certainly have no common point outside the segment pq.
 * False: not known. Points are [axis]. */
bool mesh_flat_share_edge(const double *p, const double *q, const double *r, const double *s);

#endif
