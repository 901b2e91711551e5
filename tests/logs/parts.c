#include "parts.h"

#include <string.h>

static void set_vector(const double *vector, int dim, struct query_numbers *out)
{
    out->count = dim;
    memcpy(out->number, vector, (size_t) dim * sizeof *vector);
}

void part_frame(const struct solid *solid, int64_t body_id, struct query_frame *out)
{
    *out = (struct query_frame){
        .body_id = body_id, .shape = (int32_t) solid->shape, .dim = solid->dim};
    set_vector(solid->origin, solid->dim, &out->origin);
    if (solid->moving)
        set_vector(solid->velocity, solid->dim, &out->velocity);
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < solid->dim; axis++)
            out->components.number[out->components.count++] = solid->component[i][axis];
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
