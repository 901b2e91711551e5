/* A closed mesh of as many triangles as one likes: an octahedron whose faces are divided, pushed
 * out to a sphere with bumps. */
#ifndef BUMPY_H
#define BUMPY_H

#include "mesh.h"

enum { BUMPY_FACES_MIN = 8, BUMPY_FACES_MAX = 100000000 };

/* On input: about how many faces, from MIN to MAX; which bumps. On output: a mesh to be given to
 * mesh_free(), of 8 n^2 faces, that is nearest to them, and 4 n^2 + 2 vertices. Each edge is one of
 * two faces, in opposite directions; seen from outside corners go round against the clock.
 * Coordinates are multiples of 1e-6 as near as doubles have them, from -1.3 to 1.3: "%.6f" writes
 * what reads back as the same double. They are the same on every machine: of additions, products,
 * quotients and square roots only, which are rounded the same everywhere. Ends the program where
 * there is no memory. */
void bumpy_make(unsigned faces, uint64_t seed, struct mesh *out);

#endif
