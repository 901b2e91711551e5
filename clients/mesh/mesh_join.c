#include "mesh_join.h"

#include "keyed_hash.h"

#include <stdlib.h>

struct mesh_joined {
    double position[3];
    unsigned index;
    UT_hash_handle hh;
};

void mesh_join_open(struct mesh_join *join, struct mesh_build *build)
{
    *join = (struct mesh_join){.build = build};
}

void mesh_join_close(struct mesh_join *join)
{
    struct mesh_joined *at = join->vertex, *next;
    HASH_CLEAR(hh, join->vertex);
    for (; at; at = next) {
        next = at->hh.next;
        free(at);
    }
}

bool mesh_join_vertex(struct mesh_join *join, const double position[3], unsigned *index)
{
    /* -0 + 0 is 0; all else plus 0 is what it was. */
    const double clean[3] = {position[0] + 0.0, position[1] + 0.0, position[2] + 0.0};
    struct mesh_joined *joined;
    HASH_FIND(hh, join->vertex, clean, sizeof clean, joined);
    if (!joined) {
        if (!mesh_add_vertex(join->build, clean))
            return false;
        joined = allocate(1, sizeof *joined);
        memcpy(joined->position, clean, sizeof clean);
        joined->index = (unsigned) join->build->mesh->vertex_count - 1;
        HASH_ADD(hh, join->vertex, position, sizeof clean, joined);
    }
    *index = joined->index;
    return true;
}
