/* Triangles with vertices in common, seen along an axis: in a plane, where it costs little to know
 * exactly on which side of a line a point lies. What is known of the pictures is known of the
 * triangles too: where those of F and G have no more than one point or edge in common, and that of
 * F has an area, so that no two points of F are one in it, F and G have no more in common. */
#ifndef MESH_FLAT_H
#define MESH_FLAT_H

#include <stdbool.h>

/* Whether F = conv(a, b, c) and G = conv(a, d, e) surely have no point but a in common, [axis]. */
bool mesh_flat_share_vertex(const double *a, const double *b, const double *c, const double *d,
                            const double *e);

/* Whether conv(p, q, r) and conv(p, q, s) surely have no point in common but those between p and q.
 */
bool mesh_flat_share_edge(const double *p, const double *q, const double *r, const double *s);

#endif
