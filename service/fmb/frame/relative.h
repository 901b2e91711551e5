/* The motion of one frame of a pair relative to the other, in doubles. */
#ifndef FMB_RELATIVE_H
#define FMB_RELATIVE_H

#include "prepared.h"

/* Frame b relative to a. Axes beyond the dimension hold 0.
 *
 * Accuracy: each coordinate of offset is rounded once, each of drift twice. If the product
 * underflows, drift may be off by another 2^-1075. Equal velocities give a drift of exactly 0, but
 * a drift of 0 along an axis does not imply equal velocities along it (slabs.c, underflow). */
struct relative_motion {
    bool drifts;                /* the velocities differ, and the window is not empty */
    double offset[FMB_DIM_MAX]; /* origin of b - origin of a, at t = 0 */
    double drift[FMB_DIM_MAX];  /* (velocity of b - velocity of a) T, over the whole window */
};

/* Sets *out. duration: T, seconds. Returns false if a number overflowed. No shared state. */
bool relative_motion_of(const struct world_frame *a, const struct world_frame *b, double duration,
                        struct relative_motion *out);

#endif
