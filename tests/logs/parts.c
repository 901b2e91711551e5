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

struct solid part_box(int dim, const double origin[3], const double size[3])
{
    struct solid solid = {.dim = dim, .shape = FMB_CUBOID};
    for (int axis = 0; axis < dim; axis++) {
        solid.origin[axis] = origin[axis];
        solid.component[axis][axis] = size[axis];
    }
    return solid;
}

struct solid part_corner(int dim, const double origin[3], const double size[3])
{
    struct solid solid = part_box(dim, origin, size);
    solid.shape = FMB_TETRAHEDRON;
    return solid;
}

void part_middle(const struct solid *solid, double out[3])
{
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0;
        for (int i = 0; i < solid_count(solid); i++)
            sum += solid->component[i][axis];
        out[axis] = solid->origin[axis] + sum / 2;
    }
}

struct turn turn_by(double half_tangent)
{
    const double square = half_tangent * half_tangent;
    return (struct turn){(1 - square) / (1 + square), 2 * half_tangent / (1 + square)};
}

struct turn turn_and(struct turn one, struct turn other)
{
    return (struct turn){one.cosine * other.cosine - one.sine * other.sine,
                         one.sine * other.cosine + one.cosine * other.sine};
}
