/* Two placed bodies of one frame each, and their window: what tests pass about and change. The
 * library takes the parts as arguments. */
#ifndef PLACED_PAIR_H
#define PLACED_PAIR_H

#include <gmp.h>

#include "fmb.h"
#include "pair.h"

struct pair {
    struct fmb_placement a, b;
    double duration; /* seconds */
    /* Read by the oracle only. Not NULL: both bodies rest in their poses at this time, a share of
     * the window. NULL: the whole window; no body has an end. */
    mpq_srcptr at;
};

/* FMB_OK, or the status with which fmb_decide() refuses the pair. */
enum fmb_status pair_check(const struct pair *pair);

/* fmb_decide(), fmb_certificate() and fmb_certificate_holds() of a pair. */
enum fmb_status pair_decide(const struct fmb_method *method, const struct pair *pair, unsigned want,
                            struct fmb_answer *answer);
enum fmb_status pair_certificate(const struct pair *pair, char *text, size_t size, size_t *length);
bool pair_certificate_holds(const struct pair *pair, enum fmb_verdict verdict, const char *text,
                            char *why, size_t size);

/* For functions inside the engine. Refers to the placements of the pair and to their bodies. */
struct frame_pair pair_frames(const struct pair *pair);

#endif
