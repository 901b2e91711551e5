/* Converts a face of a mesh to a body of the engine. */
#ifndef MESH_FACE_H
#define MESH_FACE_H

#include "fmb.h"
#include "mesh.h"

/* How a face is represented as a body. */
enum mesh_as {
    /* The triangle of its vertices, exactly: no edge is rounded. */
    MESH_FACES,
    /* The article's tetrahedron with its origin in the first vertex: the edges c0 and c1 to the
     * other two, rounded, and c2 = c1 x c0 divided by its length, or 0 if that length is 0. */
    MESH_TETRAHEDRA
};

/* On output: the coordinates of the vertices, [corner][axis]. */
void mesh_face_vertices(const struct mesh *mesh, unsigned face, double vertex[3][3]);

/* On output: the AABB of the article's tetrahedron of a face, [lower, upper][axis]. It contains the
 * tetrahedron, and is larger by a few units in the last place. */
void mesh_face_tetrahedron_box(const struct mesh *mesh, unsigned face, double box[2][3]);

/* A face as a placed body. Must not be copied or moved: the placement points to the body. */
struct mesh_placed_face {
    struct fmb_body body;
    struct fmb_placement placement;
};

/* velocity: [3], or NULL for a face at rest. Returns false if an edge is longer than the largest
 * double. */
bool mesh_face_place(const struct mesh *mesh, enum mesh_as as, unsigned face,
                     const double *velocity, struct mesh_placed_face *out);

#endif
