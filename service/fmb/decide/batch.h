/* The batch, as scenes use it. */
#ifndef FMB_BATCH_H
#define FMB_BATCH_H

#include "fmb.h"

/* As fmb_decide_batch(). Gaps that are surely greater than farthest have bounds of NAN. */
enum fmb_status batch_decide(const struct fmb_batch *batch, double farthest);

#endif
