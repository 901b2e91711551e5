/* A face of a mesh, as the engine takes it. */
#ifndef MESH_FACE_H
#define MESH_FACE_H

#include "mesh_meet.h"

/* The vertices, [corner][axis]. */
void mesh_face_vertices(const struct mesh *mesh, unsigned face, double vertex[3][3]);

/* The box of the article's tetrahedron of a face, [lower, upper][axis]: it holds all of it, and is
 * a few units in the last place larger. */
void mesh_face_tetrahedron_box(const struct mesh *mesh, unsigned face, double box[2][3]);

/* A face as a body at a place. Not to be copied or moved: the placement refers to the body. */
struct mesh_placed_face {
    struct fmb_body body;
    struct fmb_placement placement;
};

/* velocity: NULL or [3]. Returns false if an edge is longer than the largest double. */
bool mesh_face_place(const struct mesh *mesh, enum mesh_as as, unsigned face,
                     const double *velocity, struct mesh_placed_face *out);

#endif
