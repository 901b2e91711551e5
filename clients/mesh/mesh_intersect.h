/* Intersects the faces of two meshes. Bounding volume trees (fmb.h) yield the candidate pairs, and
 * each candidate is decided. */
#ifndef MESH_INTERSECT_H
#define MESH_INTERSECT_H

#include "fmb.h"
#include "mesh.h"

struct mesh_query {
    const struct mesh *a, *b;
    const double *velocity[2]; /* [3] of a and of b, finite; NULL: at rest */
    double duration;           /* of the window, seconds; finite, from 0 */
};

struct mesh_pair {
    unsigned a, b; /* indices of faces */
    enum fmb_verdict verdict;
    double contact[2]; /* seconds; set if a mesh has a velocity */
};

struct mesh_intersection {
    struct mesh_pair *pair; /* owned; sorted by a, then by b */
    size_t count, capacity;
    size_t overlapping, touching; /* of the pairs, by verdict */
    size_t faces[2];              /* faces of a and of b in at least one pair */
    bool moving;
};

/* Makes the body of a face: the triangle of its vertices, exactly. In: a mesh on which
 * mesh_transform() succeeded. */
void mesh_face_body(const struct mesh *mesh, unsigned face, struct fmb_body *out);

/* In: meshes on which mesh_transform() succeeded. Returns FMB_OK and an intersection, which the
 * caller frees with mesh_intersection_free(). Progress is an approximate number of faces of a. On
 * error nothing needs to be freed. Exits with status 1 if memory is exhausted. No shared state. */
enum fmb_status mesh_intersect(const struct mesh_query *query, struct mesh_intersection *out);
void mesh_intersection_free(struct mesh_intersection *intersection);

#endif
