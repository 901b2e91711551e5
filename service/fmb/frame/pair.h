/* A pair of placed frames, the input of every method. A pair of bodies of several frames is decided
 * as the pairs of their frames (decide.c). */
#ifndef FMB_PAIR_H
#define FMB_PAIR_H

#include "fmb.h"

struct placed_frame {
    const struct fmb_frame *frame;
    const struct fmb_placement *placement;
};

struct frame_pair {
    struct placed_frame a, b;
    double duration; /* seconds, finite, not negative */
};

/* Returns FMB_OK, or the status of fmb_decide() for two placements that cannot be compared. */
enum fmb_status placements_check(const struct fmb_placement *a, const struct fmb_placement *b,
                                 double duration);

/* Returns whether component i is parallel to axis i of the body, for every i. */
static inline bool frame_has_axes(const struct fmb_frame *frame)
{
    return frame->shape == FMB_BOX || frame->shape == FMB_HULL;
}

/* Returns whether the frame is a simplex: a tetrahedron or a face. */
static inline bool frame_is_simplex(const struct fmb_frame *frame)
{
    return frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
}

/* Returns the number of vertices of a frame that is not a hull. */
static inline unsigned frame_vertex_count(const struct fmb_frame *frame)
{
    return frame_is_simplex(frame) ? (unsigned) frame->count + 1 : 1U << frame->count;
}

/* Vertex k of such a frame is its origin plus some components. Returns whether component i is among
 * these. */
static inline bool frame_vertex_has(const struct fmb_frame *frame, unsigned k, int i)
{
    return frame_is_simplex(frame) ? k == (unsigned) i + 1 : k >> i & 1;
}

/* Returns whether a frame is decided by its vertices (support_pair.h). Its slabs belong to a cuboid
 * that contains it, and only reject pairs. */
static inline bool frame_by_vertices(const struct fmb_frame *frame)
{
    return frame->shape == FMB_HULL || frame->radius != 0;
}

/* Returns whether the vertices of both frames decide the pair. */
static inline bool support_takes(const struct fmb_frame *a, const struct fmb_frame *b)
{
    return frame_by_vertices(a) || frame_by_vertices(b);
}

/* Returns whether the velocity is not 0. */
static inline bool placement_moves(const struct fmb_placement *placement, int dim)
{
    const double *v = placement->velocity;
    return v[0] != 0 || v[1] != 0 || (dim == 3 && v[2] != 0);
}

/* Returns whether a frame of the pair has a velocity that is not 0. */
static inline bool pair_moves(const struct frame_pair *pair)
{
    const int dim = pair->a.frame->dim;
    return placement_moves(pair->a.placement, dim) || placement_moves(pair->b.placement, dim);
}

/* Returns whether a placement of the pair has an end, and the window is not empty. */
static inline bool pair_turns(const struct frame_pair *pair)
{
    return (pair->a.placement->end_count | pair->b.placement->end_count) != 0 && pair->duration > 0;
}

#endif
