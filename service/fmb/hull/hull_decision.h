/* The decision of a pair by its vertices, in steps: what doubles prove, the rest by programs in
 * exact numbers (hull_exact.h), and the gap (hull_gap.h). No shared state. */
#ifndef FMB_HULL_DECISION_H
#define FMB_HULL_DECISION_H

#include "hull_search.h"

/* How much a decision may do: doubles alone; doubles, and programs for what they leave open;
 * programs alone. */
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
    /* What comes next, at most one of them; NULL both: complete. */
    struct hull_exact *exact;
    struct hull_gap_work *gap;
};

/* Sets a decision that is complete. */
void hull_decision_none(struct hull_decision *out);

/* Begins the decision of a checked pair.
 *
 * In:  want      as of fmb_decide(); the contact too only with FMB_WANT_TIMES
 *      farthest  a gap that is surely greater, by more than the width of an enclosure, has bounds
 *                of NAN
 *      *answer   all 0
 * Returns whether it is complete, with *answer set. Otherwise a quick one ends here; of any other
 * hull_decision_step() is called until it returns true, with the same *answer, which has what
 * doubles gave. */
bool hull_decision_begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                         double farthest, struct hull_decision *out, struct fmb_answer *answer);

/* The same for the gap alone, of a pair with this verdict. bounded: as a quick one. */
bool hull_decision_begin_gap(const struct frame_pair *frames, enum fmb_verdict verdict,
                             double farthest, bool bounded, struct hull_decision *out,
                             struct fmb_answer *answer);

/* Performs a step of a decision that is not complete: some ten microseconds for numbers of similar
 * size, and less than a millisecond for any. Returns whether it is complete, with *answer set; its
 * memory is then freed. */
bool hull_decision_step(struct hull_decision *decision, struct fmb_answer *answer);

/* Frees the memory of a decision, complete or not. */
void hull_decision_end(struct hull_decision *decision);

/* All steps, without a limit on the gap. Returns FMB_CANNOT_DECIDE, with *answer unspecified, if
 * the decision is quick and needs more. */
enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer);

#endif
