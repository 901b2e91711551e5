/* Classifies pairs of adjacent faces: whether they have more in common than the vertices they
 * share. */
#ifndef MESH_ADJACENCY_H
#define MESH_ADJACENCY_H

#include "fmb.h"
#include "mesh.h"

/* Identifies vertices with equal coordinates. */
struct mesh_adjacency {
    const struct mesh *mesh;
    unsigned *first; /* owned; [vertex]: the first vertex with the same coordinates */
};

/* mesh: not owned. Close it with mesh_adjacency_close(). Exits with status 1 if memory is
 * exhausted. */
void mesh_adjacency_open(const struct mesh *mesh, struct mesh_adjacency *out);
void mesh_adjacency_close(struct mesh_adjacency *adjacency);

enum mesh_relation {
    MESH_NOT_ADJACENT, /* no shared vertex */
    MESH_SHARE_VERTEX, /* one shared vertex, and no other common point */
    MESH_SHARE_EDGE,   /* two shared vertices, and no common point outside the edge between them */
    MESH_SHARE_AND_INTERSECT /* adjacent, and with further common points: see *verdict */
};

/* Classifies the faces f and g, exactly. On output: *verdict only if the result is
 * MESH_SHARE_AND_INTERSECT. No shared state. */
enum mesh_relation mesh_adjacency_of(const struct mesh_adjacency *adjacency, unsigned f, unsigned g,
                                     enum fmb_verdict *verdict);

#endif
