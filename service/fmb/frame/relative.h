/* How one frame of a pair moves against the other, in doubles. */
#ifndef FMB_RELATIVE_H
#define FMB_RELATIVE_H

#include "prepared.h"

/* Frame b as a sees it. Axes beyond the dimension hold 0. Accuracy: each number of offset is
 * rounded once, each of drift twice; where the product underflows, drift may be off by another
 * 2^-1075. Equal velocities give a drift of exactly 0, but a coordinate of 0 does not mean that
 * they are equal along that axis (slabs.c, underflow). */
struct relative_motion {
    bool drifts;                /* the velocities differ, and the window is not empty */
    double offset[FMB_DIM_MAX]; /* of b's origin from a's, at t = 0 */
    double drift[FMB_DIM_MAX];  /* of b against a, over the whole window */
};

/* False if a number overflowed. */
bool relative_motion_of(const struct world_frame *a, const struct world_frame *b, double duration,
                        struct relative_motion *out);

#endif
