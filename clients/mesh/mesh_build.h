/* A mesh that grows, of a file that does not say how large it is. */
#ifndef MESH_BUILD_H
#define MESH_BUILD_H

#include "mesh_source.h"

struct mesh_build {
    struct mesh_source *source;
    struct mesh *mesh;
    size_t vertex_room, face_room;
};

/* On output: true, or false and the error: there is no memory, or too many of them. */
bool mesh_add_vertex(struct mesh_build *build, const double position[3]);
bool mesh_add_face(struct mesh_build *build, const unsigned corner[3]);

/* At the end: gives back the memory that nothing lies in. */
void mesh_fit(struct mesh_build *build);

#endif
