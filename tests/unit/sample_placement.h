/* Placements of every kind, for round trips. */
#ifndef SAMPLE_PLACEMENT_H
#define SAMPLE_PLACEMENT_H

#include "geometry_write.h"
#include "query.h"

enum {
    SAMPLE_FRAMES = 3,
    SAMPLE_BYTES_MAX =
        GEOMETRY_NONE_BYTES + SAMPLE_FRAMES * (GEOMETRY_FRAME_BYTES_MAX - GEOMETRY_NONE_BYTES)
};

static inline struct geometry_frame sample_frame(int dim, int shape)
{
    struct geometry_frame out = {.shape = shape};
    const int numbers = geometry_number_count(dim, shape, 0) - dim;
    for (int axis = 0; axis < dim; axis++)
        out.origin[axis] = axis ? axis + 0.5 : -0.0;
    for (int k = 0; k < numbers; k++)
        out.components[k] = k * 0.1 - 0x1p-1074;
    return out;
}

static inline void sample_pose(int i, struct placement *out)
{
    for (int axis = 0; axis < out->dim; axis++) {
        out->position[axis] = axis ? -0.0 : 1.0 / (i + 1);
        out->velocity[axis] = out->velocity_count ? (axis ? 1e308 : -i) : 0;
    }
    for (int k = 0; k < out->orientation_count; k++)
        out->orientation[k] = k ? 0x1p-600 * k : -i;
}

/* Number i: 2D and 3D, all shapes, whole and by handle, of one frame (0, 6 and others) and of
 * several, by components and by vertices, at rest and moving, with and without orientation, name
 * and group. bytes: SAMPLE_BYTES_MAX, or
 * GEOMETRY_FRAME_BYTES_MAX for one frame; they must live as long as the placement. */
static inline struct placement sample_placement(int i, unsigned char *bytes)
{
    const int dim = 2 + i % 2;
    const int shape = i % 7 == 5 ? FMB_BOX : dim == 3 ? 1 + i / 2 % 3 : 1 + i / 2 % 2;
    struct placement out = {.body_id = i,
                            .dim = dim,
                            .orientation_count = i % 3 == 2 ? 2 * (dim - 1) : 0,
                            .velocity_count = i % 5 ? 0 : dim};
    static const char *const names[] = {NULL, "arm", "", "gr\xc3\xbc\xc3\x9f", "\n\xff"};
    struct geometry_frame frames[SAMPLE_FRAMES] = {
        sample_frame(dim, shape), sample_frame(dim, FMB_BOX), sample_frame(dim, FMB_TETRAHEDRON)};
    out.name = names[i % 5];
    out.group = i % 4 == 3 ? INT64_MIN + i : 0;
    sample_pose(i, &out);
    for (int f = 0; f < SAMPLE_FRAMES; f++)
        frames[f].by_vertices =
            i % 5 < 2 && (frames[f].shape == FMB_TETRAHEDRON || frames[f].shape == FMB_FACE);
    if (i % 3 == 1)
        memset(out.handle.bytes, i, sizeof out.handle.bytes);
    else
        out.frame_count = i % 7 == 3 ? SAMPLE_FRAMES : 1;
    for (int f = 0; f < out.frame_count; f++) {
        out.count_count += frames[f].by_vertices;
        out.number_count += geometry_number_count(dim, frames[f].shape, 0);
    }
    out.geometry =
        (struct geometry){bytes, geometry_write_frames(dim, frames, out.frame_count, bytes)};
    return out;
}

/* Whether two placements are the same to the bit. */
static inline bool same_placement(const struct placement *a, const struct placement *b)
{
    return a->body_id == b->body_id && handle_equal(&a->handle, &b->handle) && a->dim == b->dim &&
           a->frame_count == b->frame_count && a->count_count == b->count_count &&
           a->number_count == b->number_count && a->group == b->group &&
           strcmp(a->name ? a->name : "", b->name ? b->name : "") == 0 &&
           a->orientation_count == b->orientation_count && a->velocity_count == b->velocity_count &&
           a->geometry.size == b->geometry.size &&
           memcmp(a->geometry.bytes, b->geometry.bytes, a->geometry.size) == 0 &&
           memcmp(a->position, b->position, sizeof a->position) == 0 &&
           memcmp(a->orientation, b->orientation, sizeof a->orientation) == 0 &&
           memcmp(a->velocity, b->velocity, sizeof a->velocity) == 0;
}

#endif
