/* Vertices of equal coordinates made one. */
#ifndef MESH_JOIN_H
#define MESH_JOIN_H

#include "mesh_build.h"

struct mesh_join {
    struct mesh_build *build;   /* not owned; all its vertices were added here */
    struct mesh_joined *vertex; /* owned: a table by coordinates; NULL: empty */
};

void mesh_join_open(struct mesh_join *join, struct mesh_build *build);
void mesh_join_close(struct mesh_join *join);

/* In: finite coordinates; -0 is taken as 0. On output: the index of the vertex that has them, which
 * is added if there was none. Returns false, with the error of the source, without memory. */
bool mesh_join_vertex(struct mesh_join *join, const double position[3], unsigned *index);

#endif
