#include "parts.h"

#include "geometry_write.h"

void part_place(const struct solid *solid, int64_t body_id, struct query_placement *out)
{
    static unsigned char bytes[PART_BODIES_MAX][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    struct plain_frame frame = {.shape = (int) solid->shape};
    const int dim = solid->dim, components = solid_count(solid);
    for (int i = 0; i < components; i++)
        for (int axis = 0; axis < dim; axis++)
            frame.components[dim * i + axis] = solid->component[i][axis];
    unsigned char *to = bytes[next];
    next = (next + 1) % PART_BODIES_MAX;
    *out = (struct query_placement){.placed.id = body_id,
                                    .velocity_count = solid->moving ? dim : 0,
                                    .body = geometry_write(dim, &frame, to)};
    for (int axis = 0; axis < dim; axis++) {
        out->placed.position[axis] = solid->origin[axis];
        out->placed.velocity[axis] = solid->moving ? solid->velocity[axis] : 0;
    }
}

void part_by_handle(struct query_placement *placement, const struct handle *handle)
{
    placement->body = geometry_named(placement->body.dim, handle);
}
