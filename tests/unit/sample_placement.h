/* Placements of every kind, for round trips. */
#ifndef SAMPLE_PLACEMENT_H
#define SAMPLE_PLACEMENT_H

#include "query.h"

/* Number i: 2D and 3D, all shapes, whole and by handle, at rest and moving. bytes must live as long
 * as the placement. */
static inline struct placement sample_placement(int i,
                                                unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX])
{
    const int dim = 2 + i % 2, shape = dim == 3 ? 1 + i / 2 % 3 : 1 + i / 2 % 2;
    struct placement out = {.body_id = i, .dim = dim, .velocity_count = i % 5 ? 0 : dim};
    struct geometry_frame frame = {.shape = shape};
    for (int k = 0; k < FMB_COMPONENTS_MAX; k++)
        frame.components[k] = k * 0.1 - 0x1p-1074;
    for (int axis = 0; axis < dim; axis++) {
        frame.origin[axis] = axis + 0.5;
        out.position[axis] = axis ? -0.0 : 1.0 / (i + 1);
        out.velocity[axis] = out.velocity_count ? (axis ? 1e308 : -i) : 0;
    }
    if (i % 3 == 1) {
        memset(out.handle.bytes, i, sizeof out.handle.bytes);
        geometry_write_none(dim, bytes);
        out.geometry = (struct geometry){bytes, GEOMETRY_NONE_BYTES};
    } else {
        out.frame_count = 1;
        out.number_count = dim * (1 + fmb_component_count(dim, shape));
        out.geometry = (struct geometry){bytes, geometry_write(dim, &frame, bytes)};
    }
    return out;
}

/* Whether two placements are the same to the bit. */
static inline bool same_placement(const struct placement *a, const struct placement *b)
{
    return a->body_id == b->body_id && handle_equal(&a->handle, &b->handle) && a->dim == b->dim &&
           a->frame_count == b->frame_count && a->number_count == b->number_count &&
           a->orientation_count == b->orientation_count && a->velocity_count == b->velocity_count &&
           a->geometry.size == b->geometry.size &&
           memcmp(a->geometry.bytes, b->geometry.bytes, a->geometry.size) == 0 &&
           memcmp(a->position, b->position, sizeof a->position) == 0 &&
           memcmp(a->orientation, b->orientation, sizeof a->orientation) == 0 &&
           memcmp(a->velocity, b->velocity, sizeof a->velocity) == 0;
}

#endif
