#include "parts.h"

#include "geometry_write.h"

static struct body_view write_body(const struct solid *solid, unsigned char *to)
{
    const int dim = solid->dim;
    struct plain_frame frame = {.shape = (int) solid->shape};
    double number[SOLID_NUMBERS_MAX];
    const int count = solid_numbers(solid, number);
    if (solid->shape == FMB_HULL)
        return geometry_write_hull(dim, number, count / dim, to);
    for (int i = 0; i < count; i++)
        *(i < dim ? &frame.origin[i] : &frame.components[i - dim]) = number[i];
    return geometry_write(dim, &frame, to);
}

void part_place(const struct solid *solid, int64_t body_id, struct query_placement *out)
{
    enum { BYTES = 512 };
    static unsigned char bytes[PART_BODIES_MAX][BYTES];
    static int next;
    unsigned char *to = bytes[next];
    next = (next + 1) % PART_BODIES_MAX;
    *out = (struct query_placement){.placed = solid_placement(solid, NULL),
                                    .velocity_count = solid->moving ? solid->dim : 0,
                                    .body = write_body(solid, to)};
    out->placed.id = body_id;
}

void part_by_handle(struct query_placement *placement, const struct handle *handle)
{
    placement->body = geometry_named(placement->body.dim, handle);
}
