/* Decides a pair by its vertices, in steps: in doubles if these prove the answer, otherwise by the
 * programs: linear programs in exact numbers (hull_exact.h), and the search for the gap
 * (hull_gap.h). No shared state. */
#ifndef FMB_HULL_DECISION_H
#define FMB_HULL_DECISION_H

#include "hull_search.h"

/* What a decision may use: only doubles, in which case it is bounded (it takes no further steps and
 * allocates nothing); doubles, and programs for what they leave open; only programs. */
enum hull_effort { HULL_QUICK, HULL_CERTIFIED, HULL_EXACT };

struct hull_exact;
struct hull_gap_work;

/* A decision in progress. It points to itself: not to be copied. */
struct hull_decision {
    struct frame_pair frames; /* in the order of hull_order() */
    bool swapped, searched;   /* searched: nearest is the result of a search */
    bool bounded;
    unsigned want;
    double farthest;
    struct hull_pair pair;
    struct hull_nearest nearest;
    /* What the next step advances: at most one is not NULL; both NULL: complete. */
    struct hull_exact *exact;
    struct hull_gap_work *gap;
};

/* Sets a decision that is complete. */
void hull_decision_none(struct hull_decision *out);

/* Begins the decision of a checked pair.
 *
 * In:  want      as of fmb_decide(), but the contact only with FMB_WANT_TIMES
 *      farthest  a gap that is surely greater, by more than the width of an enclosure, has bounds
 *                of NAN
 *      *answer   all 0
 * Returns whether it is complete, with *answer set. If not, a bounded decision has ended; for any
 * other, call hull_decision_step() until it returns true, with the same *answer, which contains
 * what doubles gave. */
bool hull_decision_begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                         double farthest, struct hull_decision *out, struct fmb_answer *answer);

/* The same for the gap alone, of a pair with this verdict. bounded: as with HULL_QUICK. */
bool hull_decision_begin_gap(const struct frame_pair *frames, enum fmb_verdict verdict,
                             double farthest, bool bounded, struct hull_decision *out,
                             struct fmb_answer *answer);

/* Performs a step of a decision that is not complete. It takes some ten microseconds for numbers of
 * similar size, and less than a millisecond for any. Returns whether it is complete, with *answer
 * set; its memory is then freed. */
bool hull_decision_step(struct hull_decision *decision, struct fmb_answer *answer);

/* Frees the memory of a decision, complete or not. */
void hull_decision_end(struct hull_decision *decision);

/* Makes a decision with all its steps, without a limit on the gap. Returns FMB_CANNOT_DECIDE, with
 * *answer unspecified, if a bounded decision needs more. */
enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer);

#endif
