/* A pair of frames at their places: what every method decides. Bodies of several frames are pairs
 * of their frames (decide.c). */
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

/* FMB_OK, or why two placements cannot be compared: fmb_decide(). */
enum fmb_status placements_check(const struct fmb_placement *a, const struct fmb_placement *b,
                                 double duration);

/* Whether the frame is a simplex: a tetrahedron or a face. */
static inline bool frame_is_simplex(const struct fmb_frame *frame)
{
    return frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
}

/* Whether a velocity is not 0. */
static inline bool placement_moves(const struct fmb_placement *placement, int dim)
{
    const double *v = placement->velocity;
    return v[0] != 0 || v[1] != 0 || (dim == 3 && v[2] != 0);
}

static inline bool pair_moves(const struct frame_pair *pair)
{
    const int dim = pair->a.frame->dim;
    return placement_moves(pair->a.placement, dim) || placement_moves(pair->b.placement, dim);
}

#endif
