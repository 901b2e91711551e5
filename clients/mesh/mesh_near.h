/* Two faces of one mesh that have vertices in common: whether they have more in common than that.
 */
#ifndef MESH_NEAR_H
#define MESH_NEAR_H

#include "mesh_meet.h"

/* Of one mesh: for each vertex the first one of the same coordinates. */
struct mesh_near {
    const struct mesh *mesh;
    unsigned *first; /* owned; [vertex] */
};

/* Memory is that of allocate.h. */
void mesh_near_open(const struct mesh *mesh, struct mesh_near *out);
void mesh_near_close(struct mesh_near *near);

enum mesh_nearness {
    MESH_APART,         /* no vertex in common */
    MESH_SHARE_VERTEX,  /* a vertex, and no other point */
    MESH_SHARE_EDGE,    /* two, with what is between them, and no other point */
    MESH_SHARE_AND_MEET /* more: *verdict says how they meet */
};

/* Exact. */
enum mesh_nearness mesh_near_of(const struct mesh_near *near, unsigned f, unsigned g,
                                enum fmb_verdict *verdict);

#endif
