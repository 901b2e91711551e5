/* Which faces of two meshes a picture of limited size shows: those that it cannot do without; and
 * of the others, those first that matter least, every one, every second, every third, ... */
#ifndef MESH_THIN_H
#define MESH_THIN_H

#include "mesh.h"

/* What a face is to the picture: what is there to be recognised, what lies beside faces that meet,
 * what meets; and what is never left out. */
enum { MESH_THIN_REST, MESH_THIN_BESIDE, MESH_THIN_MET, MESH_THIN_NEEDED };

/* What is kept of a mesh: its faces in their order, and the vertices of these alone. */
struct mesh_thinned {
    unsigned *face, *vertex; /* owned; numbers in the mesh, both counted as below */
    unsigned *place;         /* owned; [vertex of the mesh]: where it is in vertex[], if it is */
    size_t face_count, vertex_count;
};

/* How many bytes a kept face and a kept vertex take, and a face more of a mesh that is thinned. */
struct mesh_thin_cost {
    size_t face, vertex, number;
};

/* On input: count meshes, 1 or 2; role: [mesh][face]; limit: bytes of all that is kept.
 * On output: kept, for mesh_thinned_free(). All needed faces are in it, whatever they take. */
void mesh_thin(const struct mesh *const mesh[2], int count, unsigned char *const role[2],
               const struct mesh_thin_cost *cost, size_t limit, struct mesh_thinned kept[2]);
void mesh_thinned_free(struct mesh_thinned *kept);

#endif
