/* fmb_decide_batch() with a limit on gaps, for scenes, and with a chosen instruction set. */
#ifndef DECIDE_BATCH_H
#define DECIDE_BATCH_H

#include "fmb_batch.h"
#include "instructions.h"

/* Whether the outcome of a pair, which may be none, is a contact. */
static inline bool batch_is_contact(unsigned char verdict)
{
    return verdict == FMB_TOUCHING || verdict == FMB_OVERLAPPING;
}

/* As fmb_decide_batch(), but gaps that are surely greater than farthest have bounds of NAN. The
 * answers do not depend on the instructions, which must be supported. */
enum fmb_status batch_decide(const struct fmb_batch *batch, enum instructions instructions,
                             double farthest);

/* Stores the answer of pair i in the arrays of a batch. */
void batch_put(const struct fmb_batch *batch, size_t i, const struct fmb_answer *answer);

#endif
