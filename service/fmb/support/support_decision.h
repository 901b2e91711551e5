/* Decides a pair by its vertices, in steps: in doubles if these prove the answer, otherwise by the
 * programs: linear programs and the nearest point in integers (programs.h), and the search for the
 * gap (support_gap.h). No shared state. */
#ifndef FMB_SUPPORT_DECISION_H
#define FMB_SUPPORT_DECISION_H

#include "support_round.h"

/* What a decision may use:
 *
 *   SUPPORT_QUICK      doubles only. The decision is bounded: it has no further steps and allocates
 *                      nothing
 *   SUPPORT_CERTIFIED  doubles, and the programs for what doubles leave open
 *   SUPPORT_PROGRAMS   the programs only */
enum support_effort { SUPPORT_QUICK, SUPPORT_CERTIFIED, SUPPORT_PROGRAMS };

struct programs;
struct support_gap_work;

/* A decision in progress. It points to itself: not to be copied. */
struct support_decision {
    struct frame_pair frames; /* in the order of support_order() */
    bool swapped, searched;   /* searched: nearest is the result of a search */
    bool bounded;
    bool computes_point; /* programs computes the point */
    unsigned want;
    double farthest;
    struct support_pair pair;
    struct support_nearest nearest;
    /* What the next step advances: at most one is not NULL; all NULL: complete. */
    struct programs *programs;
    struct support_gap_work *gap;
    /* Of frames with radii. */
    bool by_nearest; /* programs decides by the nearest point, else the verdict of the cores */
    enum fmb_verdict cores; /* the verdict of the cores, which the gap needs; 0: not known */
    struct support_round_ends ends;
    struct support_round_times times;
};

/* Sets a decision that is complete. */
void support_decision_none(struct support_decision *out);

/* Begins the decision of a checked pair.
 *
 * In:  want      as of fmb_decide(), but the contact only with FMB_WANT_TIMES
 *      farthest  a gap that is surely greater, by more than the width of an enclosure, has bounds
 *                of NAN
 *      *answer   all 0
 * Returns whether it is complete, with *answer set. If not, a bounded decision has ended; for any
 * other, call support_decision_step() until it returns true, with the same *answer, which contains
 * what doubles gave. */
bool support_decision_begin(const struct frame_pair *frames, unsigned want,
                            enum support_effort effort, double farthest,
                            struct support_decision *out, struct fmb_answer *answer);

/* The same for the gap and the point alone. In: want, bits of FMB_WANT_GAP and FMB_WANT_POINT;
 * verdict, of the pair; bounded: as with SUPPORT_QUICK. */
bool support_decision_begin_gap_and_point(const struct frame_pair *frames, unsigned want,
                                          enum fmb_verdict verdict, double farthest, bool bounded,
                                          struct support_decision *out, struct fmb_answer *answer);

/* Performs a step of a decision that is not complete. It takes some ten microseconds for numbers of
 * similar size, and less than a millisecond for any. Returns whether it is complete, with *answer
 * set; its memory is then freed. */
bool support_decision_step(struct support_decision *decision, struct fmb_answer *answer);

/* Frees the memory of a decision, complete or not. */
void support_decision_end(struct support_decision *decision);

/* Makes a decision with all its steps, without a limit on the gap. Returns FMB_CANNOT_DECIDE, with
 * *answer unspecified, if a bounded decision needs more. */
enum fmb_status support_decide(const struct frame_pair *frames, unsigned want,
                               enum support_effort effort, struct fmb_answer *answer);

#endif
