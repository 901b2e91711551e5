/* The work of the steps into which the engine divides a pair. */
#ifndef WORK_STEPS_H
#define WORK_STEPS_H

#include "fmb.h"

/* Returns the work done so far, in any unit. */
typedef double work_so_far(void);

/* Decides two placements as a scene of one listed pair with interval, box and gap, or makes their
 * certificate. In: duration 0: an instant. Out: *steps: increased by the number of steps; *made:
 * whether there is a certificate. Returns the greatest work of a step. */
double work_of_scene_step(const struct fmb_placement placements[2], double duration,
                          work_so_far *work, int *steps);
double work_of_certificate_step(const struct fmb_placement placements[2], double duration,
                                work_so_far *work, int *steps, bool *made);

#endif
