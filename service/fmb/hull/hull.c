/* Decides pairs with a hull. */
#include "hull.h"

enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer)
{
    (void) frames, (void) want, (void) effort, (void) answer;
    return FMB_CANNOT_DECIDE;
}

enum gap_outcome hull_gap_of(const struct hull_pair *pair, enum fmb_verdict verdict,
                             double farthest, struct fmb_gap *out)
{
    (void) pair, (void) verdict, (void) farthest, (void) out;
    return GAP_UNSURE;
}
