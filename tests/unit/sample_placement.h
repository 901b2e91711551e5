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

static inline struct plain_frame sample_frame(int dim, int shape)
{
    struct plain_frame out = {.shape = shape};
    const int numbers = geometry_number_count(dim, shape, 0) - dim;
    for (int axis = 0; axis < dim; axis++)
        out.origin[axis] = axis ? axis + 0.5 : -0.0;
    for (int k = 0; k < numbers; k++)
        out.components[k] = k * 0.1 - 0x1p-1074;
    return out;
}

static inline void sample_pose(int i, struct query_placement *out)
{
    for (int axis = 0; axis < out->body.dim; axis++) {
        out->placed.position[axis] = axis ? -0.0 : 1.0 / (i + 1);
        out->placed.velocity[axis] = out->velocity_count ? (axis ? 1e308 : -i) : 0;
    }
    for (int k = 0; k < out->placed.orientation_count; k++)
        out->placed.orientation[k] = k ? 0x1p-600 * k : -i;
    for (int k = 0; k < out->placed.end_count; k++)
        *(k < out->body.dim ? &out->placed.end_position[k]
                            : &out->placed.end_orientation[k - out->body.dim]) = k ? i + k : -0.0;
}

/* Number i: 2D and 3D, all shapes, whole and by handle, of one frame (0, 6 and others) and of
 * several, by components and by vertices, with and without radius, at rest and moving, with and
 * without orientation, end, name and group. bytes: SAMPLE_BYTES_MAX, or GEOMETRY_FRAME_BYTES_MAX
 * for one frame; they must live as long as the placement. */
static inline struct query_placement sample_placement(int i, unsigned char *bytes)
{
    const int dim = 2 + i % 2;
    const int shape = i % 7 == 5 ? FMB_BOX : dim == 3 ? 1 + i / 2 % 3 : 1 + i / 2 % 2;
    struct query_placement out = {.placed.id = i,
                                  .body.dim = dim,
                                  .placed.orientation_count = i % 3 == 2 ? 2 * (dim - 1) : 0,
                                  .velocity_count = i % 5 ? 0 : dim};
    static const char *const names[] = {NULL, "arm", "", "gr\xc3\xbc\xc3\x9f", "\n\xff"};
    struct plain_frame frames[SAMPLE_FRAMES] = {
        sample_frame(dim, shape), sample_frame(dim, FMB_BOX), sample_frame(dim, FMB_TETRAHEDRON)};
    out.placed.name = names[i % 5];
    out.placed.end_count = i % 4 == 2 ? dim + out.placed.orientation_count : 0;
    out.placed.group = i % 4 == 3 ? INT64_MIN + i : 0;
    sample_pose(i, &out);
    for (int f = 0; f < SAMPLE_FRAMES; f++)
        frames[f].by_vertices =
            i % 5 < 2 && (frames[f].shape == FMB_TETRAHEDRON || frames[f].shape == FMB_FACE);
    frames[0].has_radius = i % 4 == 1;
    frames[0].radius = 1.0 / i;
    if (i % 3 == 1)
        memset(out.body.handle.bytes, i, sizeof out.body.handle.bytes);
    else
        out.body.frame_count = i % 7 == 3 ? SAMPLE_FRAMES : 1;
    for (int f = 0; f < out.body.frame_count; f++) {
        out.body.count_count += frames[f].by_vertices;
        out.body.number_count +=
            geometry_number_count(dim, frames[f].shape, 0) + frames[f].has_radius;
    }
    out.body = geometry_write_frames(dim, frames, out.body.frame_count, bytes);
    return out;
}

/* Whether two placements are the same to the bit. */
static inline bool same_placement(const struct query_placement *a, const struct query_placement *b)
{
    return a->placed.id == b->placed.id && handle_equal(&a->body.handle, &b->body.handle) &&
           a->body.dim == b->body.dim && a->body.frame_count == b->body.frame_count &&
           a->body.count_count == b->body.count_count &&
           a->body.number_count == b->body.number_count && a->placed.group == b->placed.group &&
           strcmp(a->placed.name ? a->placed.name : "", b->placed.name ? b->placed.name : "") ==
               0 &&
           a->placed.orientation_count == b->placed.orientation_count &&
           a->velocity_count == b->velocity_count && a->body.size == b->body.size &&
           memcmp(a->body.bytes, b->body.bytes, a->body.size) == 0 &&
           memcmp(a->placed.position, b->placed.position, sizeof a->placed.position) == 0 &&
           memcmp(a->placed.orientation, b->placed.orientation, sizeof a->placed.orientation) ==
               0 &&
           memcmp(a->placed.velocity, b->placed.velocity, sizeof a->placed.velocity) == 0 &&
           a->placed.end_count == b->placed.end_count &&
           memcmp(a->placed.end_position, b->placed.end_position, sizeof a->placed.end_position) ==
               0 &&
           memcmp(a->placed.end_orientation, b->placed.end_orientation,
                  sizeof a->placed.end_orientation) == 0;
}

#endif
