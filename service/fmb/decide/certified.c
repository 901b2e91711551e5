/* The method certified, for one pair of frames.
 *
 *   In     two prepared frames, the window, what is wanted
 *   Out    the answer, in steps
 *
 * The verdict is decided by the first of several rungs that is sure of it. climb() tries them in
 * this order:
 *
 *   1. first_pass()     the filter in doubles (kernel.h)
 *   2. second_pass()    its second pass (slabs_second.h)
 *   3. open_slabs()     each slab that doubles leave open, in integers (limbs.h)
 *   4. all_slabs()      all slabs, in integers: flat frames, and numbers out of doubles' range
 *
 * Two faces that no slab separates touch if their planes cross. If they stay in one plane, the
 * verdict is that of their projections, two triangles in 2D: these take the place of the pair, and
 * the rungs are tried again from the first.
 *
 * Then set_contact(), set_box() and gap_of() compute what else is wanted: in doubles, and what
 * these do not give within the limits of fmb.h in integers.
 *
 * What needs more than 512 bits is left to the programs (support_decision.h), which work in steps:
 * the verdict, ends of contact and box, and the gap. Pairs with a hull or a radius are decided
 * there from the beginning. Which of these gives a result depends on the numbers of the pair only,
 * so that every caller gets the same bits. The error bounds are derived in slabs.c, slabs_lanes.h,
 * BOXES.md and contact.c. */
#include "certified.h"

#include "gap.h"
#include "kernel.h"
#include "memory.h"

#include <math.h>
#include <string.h>

/* a, b: the frames of the pair, prepared. */
static void set_pair(struct certified *certified, const struct frame_pair *pair,
                     const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    certified->pair = *pair;
    certified->frame[0] = a;
    certified->frame[1] = b;
    certified->kind = kernel_kind_of(a, b, pair->duration, &certified->swapped);
    certified->state = SLABS_UNKNOWN;
    certified->contact[0] = certified->exact_contact[0] = NAN;
}

/* Returns whether doubles can bound the slabs of the pair, and sets them. */
static bool find_slabs(struct certified *certified)
{
    struct slabs_pair *slabs = &certified->slabs;
    if (certified->state == SLABS_UNKNOWN) {
        const bool good = certified->kind < KERNEL_KINDS &&
                          slabs_prepare(certified->frame[0], certified->frame[1],
                                        certified->pair.duration, slabs);
        certified->state = good ? SLABS_GOOD : SLABS_BAD;
        if (good) {
            certified->span = limbs_span_of(&certified->pair);
            certified->rounds = !limbs_never_round(slabs, certified->span);
        }
    }
    return certified->state == SLABS_GOOD;
}

static bool are_faces(const struct certified *certified)
{
    return certified->kind & KERNEL_FACE && certified->kind & KERNEL_SAME_SHAPE;
}

static bool drifts(const struct certified *certified)
{
    if (certified->kind < KERNEL_KINDS)
        return certified->kind & KERNEL_DRIFTS;
    return certified->pair.duration > 0 &&
           kernel_pair_drifts(certified->frame[0], certified->frame[1]);
}

/* ---- Rungs ---- */

/* Runs a kernel of many pairs on this one. */
static enum slabs_outcome call_kernel(const struct certified *certified,
                                      kernel_function *const *kernels, struct kernel_one *out)
{
    kernel_set_one(certified->frame[certified->swapped], certified->frame[!certified->swapped],
                   certified->pair.duration, out);
    kernels[certified->kind](&out->call);
    return (enum slabs_outcome) out->outcome[0];
}

INLINE enum slabs_outcome first_pass(struct certified *certified)
{
    const struct kernel_set *kernels = kernel_set_best();
    struct kernel_one one;
    if (certified->kind >= KERNEL_KINDS)
        return SLABS_UNSURE;
    if (!certified->times || !drifts(certified))
        return kernels->single[certified->kind](certified->frame[certified->swapped],
                                                certified->frame[!certified->swapped],
                                                certified->pair.duration);
    const enum slabs_outcome outcome = call_kernel(certified, kernels->times, &one);
    memcpy(certified->contact, one.contact[0], sizeof certified->contact);
    return outcome;
}

static enum slabs_outcome second_pass(struct certified *certified)
{
    struct kernel_one one;
    return certified->kind < KERNEL_KINDS ? call_kernel(certified, kernel_set_best()->second, &one)
                                          : SLABS_UNSURE;
}

/* Decides in integers each slab that doubles leave open; so are edges that are parallel as rounded,
 * which need not be so as given. */
static enum slabs_outcome open_slabs(struct certified *certified)
{
    struct slab_value slab[SLABS_MAX];
    struct slab_normal normal[SLABS_MAX];
    struct limbs_question question;
    int open = 0;
    if (!find_slabs(certified))
        return SLABS_UNSURE;
    limbs_question_set(&certified->pair, certified->span, LIMBS_SLABS, &question);
    if (!limbs_suffice(&question))
        return SLABS_UNSURE;
    const int count = slabs_list(&certified->slabs, true, slab);
    for (int i = 0; i < count; i++)
        if (slab[i].error == 0 ? certified->slabs.inexact : slab_gap(&slab[i]) >= -slab[i].error)
            normal[open++] = slab[i].normal;
    const int sign = limbs_slabs(&question, normal, NULL, open, NULL);
    return sign > 0 ? SLABS_SEPARATED : sign == 0 ? SLABS_TOUCHING : SLABS_OVERLAPPING;
}

static enum slabs_outcome all_slabs(struct certified *certified)
{
    const bool times = certified->times && !certified->bounded && drifts(certified);
    struct limbs_question question;
    limbs_question_set(&certified->pair, limbs_span_of(&certified->pair), LIMBS_FLAT, &question);
    if (!limbs_suffice(&question))
        return SLABS_UNSURE;
    return (enum slabs_outcome) limbs_verdict(&question, times ? certified->exact_contact : NULL);
}

/* Inlined, and with no pointers to functions: nearly every pair takes the first rung only. */
INLINE enum slabs_outcome take_rung(struct certified *certified)
{
    switch (certified->path) {
    case CERTIFIED_FILTER: return first_pass(certified);
    case CERTIFIED_SECOND: return second_pass(certified);
    case CERTIFIED_LIMBS: return open_slabs(certified);
    default: return all_slabs(certified);
    }
}

/* Sets the planes of two faces that no slab separates, and that do not lie strictly inside all
 * slabs. Faces that share a plane are replaced by their projections. Returns the next rung; the
 * last one plus 1 if the planes cross, so that the faces touch. */
static enum certified_path rung_of_faces(struct certified *certified)
{
    enum faces_planes planes = FACES_UNDECIDED;
    if (find_slabs(certified))
        planes = faces_planes_of(&certified->pair, &certified->slabs, certified->span,
                                 &certified->projection);
    if (planes == FACES_SHARED) {
        const struct frame_pair *plane = &certified->projection.pair;
        prepared_set(plane->a, &certified->projected[0]);
        prepared_set(plane->b, &certified->projected[1]);
        set_pair(certified, plane, &certified->projected[0], &certified->projected[1]);
        return CERTIFIED_FILTER;
    }
    certified->flat = planes == FACES_UNDECIDED;
    return certified->flat ? CERTIFIED_ALL_SLABS : CERTIFIED_PROGRAMS;
}

/* Tries the rungs from next on. Returns the verdict, or 0 if it needs the programs. */
static enum fmb_verdict climb(struct certified *certified, enum certified_path next)
{
    enum slabs_outcome outcome = SLABS_UNSURE;
    while (next < CERTIFIED_PROGRAMS) {
        certified->path = next++;
        outcome = take_rung(certified);
        if (outcome == SLABS_TOUCHING && are_faces(certified) && next < CERTIFIED_PROGRAMS)
            next = rung_of_faces(certified);
        else if (outcome != SLABS_UNSURE)
            break;
    }
    return (enum fmb_verdict) outcome;
}

/* ---- Contact and box ---- */

/* Whether no operation rounds, so that the times are exact in doubles. Not tested for numbers that
 * probably round: components have few bits where they are hand-written. */
static bool never_rounds(struct certified *certified)
{
    return prepared_both_plain(certified->frame[0], certified->frame[1]) && find_slabs(certified) &&
           !certified->rounds;
}

/* Sets the contact of a pair in contact. A pair that does not drift is in contact over the whole
 * window. Returns false if it needs integers of more than 512 bits, or of any width although the
 * decision is bounded: GMP, which allocates, rounds their ratios. */
static bool set_contact(struct certified *certified, double contact[2])
{
    contact[0] = 0;
    contact[1] = certified->pair.duration + 0.0; /* never -0 */
    if (!drifts(certified))
        return true;
    memcpy(contact, certified->contact, sizeof certified->contact);
    if (!isnan(contact[0]) && !never_rounds(certified))
        return true;
    if (!certified->flat && find_slabs(certified) &&
        contact_of(&certified->pair, &certified->slabs, certified->rounds, certified->span,
                   !certified->bounded, contact))
        return true;
    if (certified->bounded ||
        (isnan(certified->exact_contact[0]) && all_slabs(certified) == SLABS_UNSURE))
        return false;
    memcpy(contact, certified->exact_contact, sizeof certified->exact_contact);
    return true;
}

unsigned certified_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                       unsigned want, struct fmb_answer *answer)
{
    struct kernel_one one;
    bool swapped;
    const enum kernel_kind kind = kernel_box_kind(a, b, duration, &swapped);
    if (kind >= KERNEL_KINDS)
        return want;
    kernel_set_one(swapped ? b : a, swapped ? a : b, duration, &one);
    one.call.points = want & FMB_WANT_POINT ? one.point : NULL;
    kernel_set_best()->boxes(&one.call, kind);
    if (want & FMB_WANT_BOX && !isnan(one.box[0][0][0])) {
        memcpy(answer->box, one.box[0], sizeof answer->box);
        want &= ~(unsigned) FMB_WANT_BOX;
    }
    if (want & FMB_WANT_POINT && !isnan(one.point[0][0])) {
        memcpy(answer->point, one.point[0], sizeof answer->point);
        want &= ~(unsigned) FMB_WANT_POINT;
    }
    return want;
}

/* Computes the box of a pair in contact for which certified_box() does not give it, in integers of
 * at most 512 bits. Returns false if it needs more. */
static bool box_in_limbs(const struct fmb_prepared *a, const struct fmb_prepared *b,
                         double duration, double box[2][FMB_DIM_MAX])
{
    bool swapped;
    const enum kernel_kind kind = kernel_box_kind(a, b, duration, &swapped);
    const struct fmb_prepared *const frame[2] = {swapped ? b : a, swapped ? a : b};
    const struct frame_pair pair = {
        {frame[0]->frame, frame[0]->placement}, {frame[1]->frame, frame[1]->placement}, duration};
    struct limbs_question question;
    limbs_question_set(&pair, limbs_span_of(&pair), LIMBS_FLAT, &question);
    return kind < KERNEL_KINDS && limbs_suffice(&question) && limbs_box(&question, frame, box);
}

/* ---- Decisions ---- */

/* Sets up the rungs for a pair. */
static void begin(struct certified *certified, const struct frame_pair *pair,
                  const struct fmb_prepared *a, const struct fmb_prepared *b, bool times,
                  bool bounded)
{
    certified->times = times;
    certified->bounded = bounded;
    certified->flat = false;
    set_pair(certified, pair, a, b);
}

static struct frame_pair pair_of(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                 double duration)
{
    return (struct frame_pair){{a->frame, a->placement}, {b->frame, b->placement}, duration};
}

/* Begins the programs for the parts of an answer that are missing. Neither frame is a hull or has a
 * radius, so the programs give the tightest ends. Returns whether these parts are complete. */
static bool begin_program(struct certified *certified, unsigned missing)
{
    const struct frame_pair pair =
        pair_of(certified->given[0], certified->given[1], certified->duration);
    memset(&certified->proven, 0, sizeof certified->proven);
    certified->stage = CERTIFIED_MISSING;
    return !certified->bounded && support_decision_begin(&pair, missing, SUPPORT_PROGRAMS, INFINITY,
                                                         &certified->program, &certified->proven);
}

/* Sets the gap and the point, as far as they are wanted, of a pair whose verdict is known. Returns
 * false if that takes steps of the programs, which have then begun unless the decision is bounded.
 */
static bool begin_gap_and_point(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                double duration, unsigned want, double farthest, bool bounded,
                                struct support_decision *program, struct fmb_answer *answer)
{
    if (want & FMB_WANT_GAP) {
        const enum gap_outcome outcome =
            gap_of(a, b, duration, answer->verdict, farthest, &answer->gap);
        answer->has_gap = true;
        if (outcome == GAP_FAR)
            answer->gap = gap_none();
        if (outcome != GAP_UNSURE)
            want &= ~(unsigned) FMB_WANT_GAP;
    }
    if (!want)
        return true;
    const struct frame_pair pair = pair_of(a, b, duration);
    return support_decision_begin_gap_and_point(&pair, want, answer->verdict, farthest, bounded,
                                                program, answer);
}

/* Sets what is wanted besides the verdict, which is known. Ends that the programs gave are used
 * only if nothing else gives them. Returns whether the answer is complete. */
static bool measure(struct certified *certified, struct fmb_answer *answer)
{
    const struct fmb_prepared *a = certified->given[0], *b = certified->given[1];
    const struct fmb_answer *proven = &certified->proven;
    const bool meets = answer->verdict != FMB_SEPARATED;
    unsigned missing = 0, left = certified->want & FMB_WANT_GAP;
    answer->has_contact = meets && certified->want & FMB_WANT_TIMES;
    answer->has_box = meets && certified->want & FMB_WANT_BOX;
    answer->has_point = meets && certified->want & FMB_WANT_POINT;
    if (answer->has_contact && !set_contact(certified, answer->contact)) {
        if (proven->has_contact)
            memcpy(answer->contact, proven->contact, sizeof answer->contact);
        else
            missing |= FMB_WANT_TIMES;
    }
    if (meets && certified->want & (FMB_WANT_BOX | FMB_WANT_POINT))
        left |= certified_box(a, b, certified->duration,
                              certified->want & (FMB_WANT_BOX | FMB_WANT_POINT), answer);
    if (left & FMB_WANT_BOX && !box_in_limbs(a, b, certified->duration, answer->box)) {
        if (proven->has_box)
            memcpy(answer->box, proven->box, sizeof answer->box);
        else
            missing |= FMB_WANT_BOX;
    }
    if (missing)
        return begin_program(certified, missing);
    left &= ~(unsigned) FMB_WANT_BOX;
    certified->stage = CERTIFIED_GAP_AND_POINT;
    return begin_gap_and_point(a, b, certified->duration, left, certified->farthest,
                               certified->bounded, &certified->program, answer);
}

bool certified_gap_and_point(const struct fmb_prepared *a, const struct fmb_prepared *b,
                             double duration, unsigned want, double farthest,
                             struct fmb_answer *answer)
{
    struct support_decision program;
    if (prepared_has_end(a) || prepared_has_end(b))
        return false;
    return begin_gap_and_point(a, b, duration, want, farthest, true, &program, answer);
}

static bool begin_with_end(const struct frame_pair *pair, unsigned want, double farthest,
                           enum support_effort effort, struct certified *out,
                           struct fmb_answer *answer);

/* a, b: the frames of the pair, prepared, or NULL. */
INLINE bool begin_pair(const struct frame_pair *pair, const struct fmb_prepared *a,
                       const struct fmb_prepared *b, unsigned want, double farthest,
                       enum support_effort effort, struct certified *out, struct fmb_answer *answer)
{
    support_decision_none(&out->program);
    out->turning = NULL;
    if ((pair->a.placement->end_count | pair->b.placement->end_count) != 0)
        return begin_with_end(pair, want, farthest, effort, out, answer);
    if (effort == SUPPORT_PROGRAMS || support_takes(pair->a.frame, pair->b.frame)) {
        out->stage = CERTIFIED_ALL;
        return support_decision_begin(pair, want, effort, farthest, &out->program, answer);
    }
    if (!a) {
        prepared_set(pair->a, &out->own[0]);
        prepared_set(pair->b, &out->own[1]);
    }
    out->given[0] = a ? a : &out->own[0];
    out->given[1] = b ? b : &out->own[1];
    out->duration = pair->duration;
    out->want = want;
    out->farthest = farthest;
    out->proven.has_contact = out->proven.has_box = false;
    begin(out, pair, out->given[0], out->given[1], want & FMB_WANT_TIMES, effort == SUPPORT_QUICK);
    answer->verdict = climb(out, CERTIFIED_FILTER);
    return answer->verdict ? measure(out, answer)
                           : begin_program(out, want & (FMB_WANT_BOX | FMB_WANT_TIMES));
}

static void end_turning(struct certified *certified)
{
    if (!certified->turning)
        return;
    turn_end(certified->turning);
    memory_release(certified->turning, sizeof *certified->turning);
    certified->turning = NULL;
}

/* Begins the decision of a pair in which a placement has an end. */
static bool begin_with_end(const struct frame_pair *pair, unsigned want, double farthest,
                           enum support_effort effort, struct certified *out,
                           struct fmb_answer *answer)
{
    if (pair->duration > 0) {
        struct turn_decision bounded;
        const bool quick = effort == SUPPORT_QUICK;
        out->stage = CERTIFIED_TURNING;
        if (!quick)
            out->turning = memory_allocate(sizeof *out->turning);
        const bool done =
            turn_begin(pair, want, farthest, quick, quick ? &bounded : out->turning, NULL, answer);
        if (done)
            end_turning(out);
        return done;
    }
    const struct placed_frame *const given[2] = {&pair->a, &pair->b};
    struct frame_pair still = *pair;
    for (int f = 0; f < 2; f++) {
        out->begin[f] = *given[f]->placement;
        out->begin[f].end_count = 0;
    }
    still.a.placement = &out->begin[0];
    still.b.placement = &out->begin[1];
    return begin_pair(&still, NULL, NULL, want, farthest, effort, out, answer);
}

bool certified_begin(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                     unsigned want, double farthest, enum support_effort effort,
                     struct certified *out, struct fmb_answer *answer)
{
    const struct frame_pair pair = pair_of(a, b, duration);
    return begin_pair(&pair, a, b, want, farthest, effort, out, answer);
}

bool certified_step(struct certified *certified, struct fmb_answer *answer)
{
    if (certified->stage == CERTIFIED_TURNING) {
        const bool done = turn_step(certified->turning, answer);
        if (done)
            end_turning(certified);
        return done;
    }
    if (certified->stage != CERTIFIED_MISSING)
        return support_decision_step(&certified->program, answer);
    if (!support_decision_step(&certified->program, &certified->proven))
        return false;
    answer->verdict = certified->proven.verdict;
    return measure(certified, answer);
}

void certified_end(struct certified *certified)
{
    support_decision_end(&certified->program);
    end_turning(certified);
}

void certified_decide_prepared(const struct fmb_prepared *a, const struct fmb_prepared *b,
                               double duration, unsigned want, double farthest,
                               struct fmb_answer *answer)
{
    struct certified certified;
    bool done =
        certified_begin(a, b, duration, want, farthest, SUPPORT_CERTIFIED, &certified, answer);
    while (!done)
        done = certified_step(&certified, answer);
}

enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer)
{
    struct certified certified;
    bool done = begin_pair(pair, NULL, NULL, want | FMB_WANT_TIMES, INFINITY, SUPPORT_CERTIFIED,
                           &certified, answer);
    while (!done)
        done = certified_step(&certified, answer);
    return answer->verdict ? FMB_OK : FMB_CANNOT_DECIDE;
}

bool fmb_decide_at_once(const struct fmb_placement *a, const struct fmb_placement *b,
                        double duration, unsigned want, struct fmb_answer *answer)
{
    const struct frame_pair pair = {
        {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
    struct certified certified;
    memset(answer, 0, sizeof *answer);
    return begin_pair(&pair, NULL, NULL, want | FMB_WANT_TIMES, INFINITY, SUPPORT_QUICK, &certified,
                      answer);
}

enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes)
{
    const struct frame_pair pair = pair_of(a, b, duration);
    struct certified certified;
    begin(&certified, &pair, a, b, false, true);
    return climb(&certified,
                 passes == 2 && !are_faces(&certified) ? CERTIFIED_LIMBS : CERTIFIED_SECOND);
}
