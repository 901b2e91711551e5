/* fmb_decide_batch() with a limit on gaps, for scenes. */
#ifndef FMB_BATCH_H
#define FMB_BATCH_H

#include "fmb.h"

/* As fmb_decide_batch(), but gaps that are surely greater than farthest have bounds of NAN. */
enum fmb_status batch_decide(const struct fmb_batch *batch, double farthest);

#endif
