/* A face of a mesh, as the engine wants it. */
#ifndef MESH_FACE_H
#define MESH_FACE_H

#include "mesh_meet.h"

/* The vertices, [corner][axis]. */
void mesh_face_vertices(const struct mesh *mesh, unsigned face, double vertex[3][3]);

/* The box of the article's tetrahedron of a face, [lower, upper][axis]: it holds all of it, and is
 * a few units in the last place larger. */
void mesh_face_tetrahedron_box(const struct mesh *mesh, unsigned face, double box[2][3]);

/* A frame on a body, which is set too. velocity: NULL or [3]. False where an edge is longer than
 * the doubles go. */
bool mesh_face_frame(const struct mesh *mesh, enum mesh_as as, unsigned face,
                     const double *velocity, struct fmb_body *body, struct fmb_frame *out);

#endif
