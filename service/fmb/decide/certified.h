/* The method certified: doubles with bounds on their errors, and exact arithmetic for what these
 * leave open.
 *
 * verdict: the filter, axes and slabs in doubles (kernel.h, slabs.c); if it is unsure, its second
 *   pass (slabs_second.h), the open slabs in integers (limbs.h), or all slabs; of two faces in one
 *   plane, the verdict of two triangles in 2D (faces.c).
 * contact: the filter bounds the times in the same pass (slabs_lanes.h); if a bound is not tight
 *   enough, or nothing rounds, the slabs one by one (contact.c).
 * box: from what is left of the edges and where they cross, in doubles (box_clip.h) or in integers
 *   (limbs_box.h).
 * gap: given the verdict, in steps of its own (gap.h).
 * What needs more than 512 bits, and pairs with a hull or a radius: support_decision.h.
 *
 * Contact and box are computed as two enclosures: the outer one surely contains the exact value,
 * the inner one is surely contained in it. The answer is the outer one. It is given only if the two
 * are so close that it is within the limits of fmb.h; otherwise integers or the programs decide. */
#ifndef FMB_CERTIFIED_H
#define FMB_CERTIFIED_H

#include "faces.h"
#include "kernel.h"
#include "limbs.h"
#include "support_decision.h"
#include "turn_decision.h"

/* The rungs: what may decide a verdict, in the order in which it is tried. The filter; its second
 * pass; the slabs that these leave open, in integers; all slabs, in integers; the programs. */
enum certified_path {
    CERTIFIED_FILTER,
    CERTIFIED_SECOND,
    CERTIFIED_LIMBS,
    CERTIFIED_ALL_SLABS,
    CERTIFIED_PROGRAMS
};

/* A decision in progress. It points into itself: not to be copied. */
struct certified {
    /* Set at the beginning. */
    const struct fmb_prepared *given[2]; /* the caller's frames, or own */
    struct fmb_prepared own[2];
    double duration, farthest;
    unsigned want;
    /* What the programs compute: the whole answer; what is missing of contact and box; gap and
     * point. */
    enum { CERTIFIED_ALL, CERTIFIED_MISSING, CERTIFIED_GAP_AND_POINT, CERTIFIED_TURNING } stage;
    struct turn_decision *turning; /* allocated for the decision of a pair that turns, or NULL */
    struct fmb_placement begin[2]; /* in a window of 0 s: the placements without their ends */
    struct support_decision program;
    struct fmb_answer proven; /* by programs: verdict, contact and box */
    /* The pair that the rungs decide: the given one, or its projection. */
    struct frame_pair pair;
    const struct fmb_prepared *frame[2];
    enum kernel_kind kind;
    bool swapped;            /* kernels of this kind take b as their first frame */
    bool bounded;            /* nothing is allocated, and no program is begun */
    bool times;              /* contact is wanted if the pair drifts */
    double contact[2];       /* as in struct kernel_call */
    double exact_contact[2]; /* set by all_slabs() */
    enum certified_path path;
    /* Set by find_slabs(). */
    enum { SLABS_UNKNOWN, SLABS_GOOD, SLABS_BAD } state; /* good: doubles can bound the slabs */
    struct slabs_pair slabs;
    struct dyadic_span span;
    bool rounds;                        /* operations on these numbers may round */
    bool flat;                          /* two faces in parallel planes: slabs do not decide them */
    struct faces_projection projection; /* the pair, of faces that share a plane */
    struct fmb_prepared projected[2];
};

/* Begins the decision of a prepared pair. The frames must outlive it.
 *
 * In:  want      bits of FMB_WANT_; the contact only with FMB_WANT_TIMES
 *      farthest  a gap that is surely greater may have bounds of NAN
 *      effort    SUPPORT_QUICK: bounded, takes tens of microseconds at most and allocates nothing:
 *                a slab takes at most 1,000 products of limbs (most take 100 to 300), and a pair
 *                has at most SLABS_MAX slabs. SUPPORT_PROGRAMS: the method exact
 *      *answer   all 0
 *
 * Returns whether it is complete, with *answer set. If not, a bounded decision would need more than
 * it is allowed, and has ended. For any other decision, call certified_step() with the same answer
 * until it returns true, or certified_end() to abandon it. */
bool certified_begin(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                     unsigned want, double farthest, enum support_effort effort,
                     struct certified *out, struct fmb_answer *answer);

/* Performs a step of less than a millisecond. Returns whether the decision is complete; its memory
 * is then freed. */
bool certified_step(struct certified *certified, struct fmb_answer *answer);

/* Frees the memory of a decision, complete or not. */
void certified_end(struct certified *certified);

/* Makes a decision that is not bounded, with all its steps. */
void certified_decide_prepared(const struct fmb_prepared *a, const struct fmb_prepared *b,
                               double duration, unsigned want, double farthest,
                               struct fmb_answer *answer);

/* Decides a checked pair: the function of the method certified. */
enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* Returns the verdict of a prepared pair that the filter leaves unsure, or 0 if it needs the
 * programs. In: passes: how many passes of the filter were tried, 1 or 2. Bounded. */
enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes);

/* Sets the gap and the point, as far as they are wanted, of a prepared pair with answer->verdict. A
 * gap that is surely greater than farthest has bounds of NAN. Returns false if the first search in
 * doubles does not give both. In: want, bits of FMB_WANT_GAP and FMB_WANT_POINT. */
bool certified_gap_and_point(const struct fmb_prepared *a, const struct fmb_prepared *b,
                             double duration, unsigned want, double farthest,
                             struct fmb_answer *answer);

/* Computes the contact of a pair in contact that drifts. rounds: operations on these numbers may
 * round. span: of the pair. exact: integers may be used for an end that doubles do not give within
 * its limit. Returns false if the permitted methods do not give the contact. */
bool contact_of(const struct frame_pair *pair, const struct slabs_pair *slabs, bool rounds,
                struct dyadic_span span, bool exact, double contact[2]);

/* Sets the box and the point of a prepared pair in contact, as far as they are wanted and doubles
 * give them within their limits. In: want, bits of FMB_WANT_BOX and FMB_WANT_POINT. Returns the
 * bits of what doubles do not give. */
unsigned certified_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                       unsigned want, struct fmb_answer *answer);

#endif
