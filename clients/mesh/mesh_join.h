/* Vertices of equal coordinates made one. */
#ifndef MESH_JOIN_H
#define MESH_JOIN_H

#include "mesh_build.h"

struct mesh_join {
    struct mesh_build *build; /* whose vertices all came from here */
    unsigned *slot;           /* owned; index of a vertex + 1; 0: none */
    uint64_t factor;          /* random and odd: no file knows which vertices share a slot */
    size_t slot_count;        /* 0 or a power of 2, at least twice as many as there are vertices */
};

/* On input: finite coordinates. On output: the index of the vertex that has them, a new one where
 * there was none; -0 becomes 0. Or false and the error. */
bool mesh_join_vertex(struct mesh_join *join, const double position[3], unsigned *index);

void mesh_join_free(struct mesh_join *join);

#endif
