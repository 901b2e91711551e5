/* fmb_decide_batch() with a limit on gaps, for scenes. */
#ifndef FMB_BATCH_H
#define FMB_BATCH_H

#include "fmb.h"

/* Whether the outcome of a pair, which may be FMB_REFUSED or FMB_LEFT_OPEN, is a contact. */
static inline bool batch_is_contact(unsigned char verdict)
{
    return verdict == FMB_TOUCHING || verdict == FMB_OVERLAPPING;
}

/* As fmb_decide_batch(), but gaps that are surely greater than farthest have bounds of NAN. */
enum fmb_status batch_decide(const struct fmb_batch *batch, double farthest);

#endif
