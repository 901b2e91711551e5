/* The method certified, for one pair of frames.
 *
 *   In     two prepared frames, the window, what is wanted; quick: no integers wider than
 *          LIMBS_NARROW
 *   Out    the answer; with quick, FMB_CANNOT_DECIDE if it needs wider integers
 *
 * The verdict is found on a ladder. climb() takes its rungs in turn, each for pairs that the one
 * before leaves unsure:
 *
 *   1. first_pass()     the filter in doubles (kernel.h)
 *   2. second_pass()    its second pass (slabs_exact.h)
 *   3. open_slabs()     each slab that doubles leave open, in integers (limbs.h)
 *   4. all_slabs()      all slabs, in integers: of flat frames, and where doubles do not reach
 *
 * Two faces that no slab separates touch if their planes cross. If they stay in one plane, the
 * verdict is that of their projections, two triangles in 2D: these take the place of the pair, and
 * the ladder is climbed again.
 *
 * Then set_contact(), certified_box() and gap_of() compute what else is wanted: in doubles, and
 * what these do not give within the limits of fmb.h in integers. Each step depends on the numbers
 * of the pair only, so that every caller gets the same bits. The error bounds are derived in
 * slabs.c, slabs_lanes.h, box_clip.h and contact.c. */
#include "certified.h"

#include "exact.h"
#include "faces.h"
#include "gap.h"
#include "hull.h"
#include "limbs.h"
#include "kernel.h"

#include <math.h>
#include <string.h>

/* The state of one decision. */
struct certified {
    struct frame_pair pair;
    const struct fmb_prepared *frame[2];
    enum kernel_kind kind;
    bool swapped;            /* kernels of this kind take b as their first frame */
    bool quick;              /* integers of LIMBS_NARROW are the widest allowed */
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

/* a, b: the frames of the pair, prepared. */
static void set_pair(struct certified *certified, const struct frame_pair *pair,
                     const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    certified->pair = *pair;
    certified->frame[0] = a;
    certified->frame[1] = b;
    certified->kind = kernel_kind_of(a, b, pair->duration, &certified->swapped);
    certified->state = SLABS_UNKNOWN;
    certified->contact[0] = NAN;
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
    return certified->kind < KERNEL_KINDS ? call_kernel(certified, kernel_set_best()->exact, &one)
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
    if (certified->quick && question.limbs > LIMBS_NARROW)
        return SLABS_UNSURE;
    const int count = slabs_list(&certified->slabs, true, slab);
    for (int i = 0; i < count; i++)
        if (slab[i].error == 0 ? certified->slabs.inexact : slab_gap(&slab[i]) >= -slab[i].error)
            normal[open++] = slab[i].normal;
    const int sign = limbs_functions_of(&question)->slabs(&question, normal, NULL, open, NULL);
    return sign > 0 ? SLABS_SEPARATED : sign == 0 ? SLABS_TOUCHING : SLABS_OVERLAPPING;
}

static enum hull_effort effort_of(bool quick)
{
    return quick ? HULL_QUICK : HULL_CERTIFIED;
}

/* The exact method; of a pair with a hull, that of hull.h. */
static enum slabs_outcome all_slabs(struct certified *certified)
{
    struct fmb_answer answer = {0};
    const bool times = certified->times && !certified->quick && drifts(certified);
    if (hull_takes(certified->frame[0]->frame, certified->frame[1]->frame))
        return hull_decide(&certified->pair, 0, effort_of(certified->quick), &answer) == FMB_OK
                   ? (enum slabs_outcome) answer.verdict
                   : SLABS_UNSURE;
    return (enum slabs_outcome) exact_verdict(&certified->pair, certified->quick,
                                              times ? certified->exact_contact : NULL);
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
                                 certified->quick, &certified->projection);
    if (planes == FACES_SHARED) {
        const struct frame_pair *plane = &certified->projection.pair;
        prepared_set(plane->a, &certified->projected[0]);
        prepared_set(plane->b, &certified->projected[1]);
        set_pair(certified, plane, &certified->projected[0], &certified->projected[1]);
        return CERTIFIED_FILTER;
    }
    certified->flat = planes == FACES_UNDECIDED;
    return certified->flat ? CERTIFIED_EXACT : CERTIFIED_PATHS;
}

/* The verdict of a pair that the rungs below next leave unsure; 0 if it needs integers that a quick
 * decision must not use. */
static enum fmb_verdict climb(struct certified *certified, enum certified_path next)
{
    enum slabs_outcome outcome = SLABS_UNSURE;
    while (next < CERTIFIED_PATHS) {
        certified->path = next++;
        outcome = take_rung(certified);
        if (outcome == SLABS_TOUCHING && are_faces(certified) && next < CERTIFIED_PATHS)
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
 * window. Returns false if the decision is quick and needs wider integers. Which step gives the
 * times depends on the numbers of the pair only, so that they are the same bits for every caller.
 */
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
                   !certified->quick, contact))
        return true;
    if (certified->quick)
        return false;
    if (certified->path != CERTIFIED_EXACT)
        all_slabs(certified);
    memcpy(contact, certified->exact_contact, sizeof certified->exact_contact);
    return true;
}

bool certified_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   double box[2][FMB_DIM_MAX])
{
    struct kernel_one one;
    bool swapped;
    const enum kernel_kind kind = kernel_box_kind(a, b, duration, &swapped);
    kernel_set_one(swapped ? b : a, swapped ? a : b, duration, &one);
    kernel_set_best()->boxes(&one.call, kind);
    memcpy(box, one.box[0], sizeof one.box[0]);
    return !isnan(box[0][0]);
}

bool certified_box_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                          double duration, bool quick, double box[2][FMB_DIM_MAX])
{
    bool swapped;
    const enum kernel_kind kind = kernel_box_kind(a, b, duration, &swapped);
    const struct fmb_prepared *const frame[2] = {swapped ? b : a, swapped ? a : b};
    const struct frame_pair pair = {
        {frame[0]->frame, frame[0]->placement}, {frame[1]->frame, frame[1]->placement}, duration};
    struct limbs_question question;
    limbs_question_set(&pair, limbs_span_of(&pair), LIMBS_FLAT, &question);
    if (quick && question.limbs > LIMBS_NARROW)
        return false;
    if (kind < KERNEL_KINDS && limbs_functions_of(&question)->box(&question, frame, box))
        return true;
    if (!quick)
        exact_box(&pair, box);
    return !quick;
}

/* ---- Decisions ---- */

/* Begins the decision of a pair. times: contact is wanted. */
static void begin(struct certified *certified, const struct frame_pair *pair,
                  const struct fmb_prepared *a, const struct fmb_prepared *b, bool times,
                  bool quick)
{
    certified->times = times;
    certified->quick = quick;
    certified->flat = false;
    set_pair(certified, pair, a, b);
}

static struct frame_pair pair_of(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                 double duration)
{
    return (struct frame_pair){{a->frame, a->placement}, {b->frame, b->placement}, duration};
}

/* Decides a pair without a hull, whose prepared frames are a and b. */
INLINE enum fmb_status decide(const struct frame_pair *pair, const struct fmb_prepared *a,
                              const struct fmb_prepared *b, unsigned want, bool quick,
                              struct fmb_answer *answer)
{
    const double duration = pair->duration;
    struct certified certified;
    begin(&certified, pair, a, b, true, quick);
    answer->verdict = climb(&certified, CERTIFIED_FILTER);
    if (!answer->verdict)
        return FMB_CANNOT_DECIDE;
    answer->has_contact = answer->verdict != FMB_SEPARATED;
    answer->has_box = answer->has_contact && want & FMB_WANT_BOX;
    answer->has_gap = want & FMB_WANT_GAP;
    if (answer->has_contact && !set_contact(&certified, answer->contact))
        return FMB_CANNOT_DECIDE;
    if (answer->has_box &&
        !(certified.kind < KERNEL_KINDS && certified_box(a, b, duration, answer->box)) &&
        !certified_box_unsure(a, b, duration, quick, answer->box))
        return FMB_CANNOT_DECIDE;
    if (answer->has_gap &&
        gap_of(a, b, duration, answer->verdict, INFINITY, &answer->gap) == GAP_UNSURE) {
        if (quick)
            return FMB_CANNOT_DECIDE;
        hull_gap(pair, answer->verdict, INFINITY, &answer->gap);
    }
    return FMB_OK;
}

enum fmb_status certified_decide_prepared(const struct fmb_prepared *a,
                                          const struct fmb_prepared *b, double duration,
                                          unsigned want, bool quick, struct fmb_answer *answer)
{
    const struct frame_pair pair = pair_of(a, b, duration);
    return hull_takes(a->frame, b->frame) ? hull_decide(&pair, want, effort_of(quick), answer)
                                          : decide(&pair, a, b, want, quick, answer);
}

enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer)
{
    struct fmb_prepared a, b;
    if (hull_takes(pair->a.frame, pair->b.frame))
        return hull_decide(pair, want | FMB_WANT_TIMES, HULL_CERTIFIED, answer);
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    return decide(pair, &a, &b, want | FMB_WANT_TIMES, false, answer);
}

enum fmb_verdict certified_verdict(const struct frame_pair *pair, enum certified_path *path)
{
    struct certified certified;
    struct fmb_prepared a, b;
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    begin(&certified, pair, &a, &b, false, false);
    const enum fmb_verdict verdict = climb(&certified, CERTIFIED_FILTER);
    *path = certified.path;
    return verdict;
}

enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes, bool quick)
{
    const struct frame_pair pair = pair_of(a, b, duration);
    struct certified certified;
    begin(&certified, &pair, a, b, false, quick);
    return climb(&certified,
                 passes == 2 && !are_faces(&certified) ? CERTIFIED_LIMBS : CERTIFIED_SECOND);
}
