/* The method certified, for one pair of frames.
 *
 *   In     two prepared frames, the window, what is wanted; quick: no integers wider than
 *          CERTIFIED_QUICK_LIMBS
 *   Out    the answer; with quick, FMB_CANNOT_DECIDE if it needs wider integers
 *
 * Steps for the verdict, each for pairs that the one before leaves unsure:
 *
 *   1. verdict_of()           the filter in doubles (kernel.h)
 *   2. verdict_of_unsure()    its second pass (slabs_exact.h)
 *   3. verdict_of_slabs()     each open slab in fixed-width integers (limbs.h)
 *   4. verdict_exact()        the exact method (exact.h)
 *
 * Two faces that no slab separates go through verdict_of_planes(): if they stay in one plane, the
 * verdict is that of their projections, two triangles in 2D.
 *
 * Then answer_contact(), answer_box() and gap_of() compute what else is wanted: in doubles, what
 * these do not give within the limits of fmb.h in fixed-width integers, and the rest by the exact
 * method. Each step depends on the numbers of the pair only, so that every caller gets the same
 * bits. The error bounds are derived in slabs.c, slabs_lanes.h, box_clip.h and contact.c. */
#include "certified.h"

#include "exact.h"
#include "faces.h"
#include "gap.h"
#include "limbs.h"
#include "limbs_box.h"
#include "kernel.h"

#include <math.h>
#include <string.h>

/* The state of one decision. Parts are computed when they are needed. */
struct certified {
    const struct frame_pair *pair;
    bool quick;                          /* CERTIFIED_QUICK_LIMBS is the widest integer allowed */
    bool open;                           /* only with quick: the verdict needs wider ones */
    const struct fmb_prepared *frame[2]; /* of a and b */
    bool swapped;                        /* kernels of this kind take b as their first frame */
    enum kernel_kind kind;
    bool slabs_known, slabs_good; /* slabs_good: doubles can bound the slabs of the pair */
    struct slabs_pair slabs;
    bool span_known, rounds; /* rounds: operations on these numbers may round */
    struct dyadic_span span;
    enum certified_path path;
    enum faces_planes planes;           /* other than CROSSING only of two faces that are close */
    struct faces_projection projection; /* where they are SHARED */
};

static void begin(struct certified *certified, const struct frame_pair *pair, bool quick)
{
    certified->pair = pair;
    certified->quick = quick;
    certified->open = false;
    certified->slabs_known = certified->span_known = false;
    certified->planes = FACES_CROSSING;
}

static bool find_slabs(struct certified *certified)
{
    if (!certified->slabs_known)
        certified->slabs_good = slabs_prepare(certified->frame[0], certified->frame[1],
                                              certified->pair->duration, &certified->slabs);
    certified->slabs_known = true;
    return certified->slabs_good;
}

/* On input: good slabs. */
static void find_span(struct certified *certified)
{
    if (certified->span_known)
        return;
    certified->span_known = true;
    certified->span = limbs_span_of(certified->pair);
    certified->rounds = !limbs_never_round(&certified->slabs, certified->span);
}

/* The verdict by the exact method; 0 if the decision is quick. */
static enum fmb_verdict verdict_exact(struct certified *certified)
{
    struct fmb_answer answer = {0};
    certified->path = CERTIFIED_EXACT;
    certified->open = certified->quick;
    if (!certified->quick)
        exact_decide(certified->pair, 0, &answer);
    return answer.verdict;
}

/* In: good slabs. Each slab that doubles leave open is decided in integers; so are edges that are
 * parallel as rounded, which need not be so as given. */
static enum fmb_verdict verdict_of_slabs(struct certified *certified)
{
    const struct slabs_pair *pair = &certified->slabs;
    struct slab_value slab[SLABS_MAX];
    struct limbs_pair limbs;
    find_span(certified);
    if (!limbs_prepare(certified->pair, certified->span, &limbs) ||
        (certified->quick && limbs.limbs > CERTIFIED_QUICK_LIMBS))
        return verdict_exact(certified);
    certified->path = CERTIFIED_LIMBS;
    const int count = slabs_list(pair, true, slab);
    int sign = -1;
    for (int i = 0; i < count && sign <= 0; i++) {
        if (slab[i].error == 0 ? !pair->inexact : slab_gap(&slab[i]) < -slab[i].error)
            continue;
        const int one = limbs_gap_sign(&limbs, slab[i].normal);
        sign = one > sign ? one : sign;
    }
    return sign > 0 ? FMB_SEPARATED : sign == 0 ? FMB_TOUCHING : FMB_OVERLAPPING;
}

static enum fmb_verdict projection_verdict(struct certified *certified);

/* The verdict of two faces that no slab separates, and that do not lie strictly inside all slabs.
 * They touch unless their planes are parallel. */
static enum fmb_verdict verdict_of_planes(struct certified *certified)
{
    certified->planes = faces_planes_of(certified->pair, &certified->slabs, certified->span,
                                        &certified->projection);
    if (certified->planes == FACES_CROSSING)
        return FMB_TOUCHING;
    return certified->planes == FACES_SHARED ? projection_verdict(certified)
                                             : verdict_exact(certified);
}

/* Sets the kind of a pair from its prepared frames. Returns false if doubles cannot decide it. */
static bool set_kind(struct certified *certified, const struct fmb_prepared *a,
                     const struct fmb_prepared *b)
{
    certified->frame[0] = a;
    certified->frame[1] = b;
    certified->kind = kernel_kind_of(a, b, certified->pair->duration, &certified->swapped);
    return certified->kind < KERNEL_KINDS;
}

/* Runs a kernel of many pairs on this one. */
static enum slabs_outcome call_kernel(const struct certified *certified,
                                      kernel_function *const *kernels, struct kernel_one *out)
{
    kernel_set_one(certified->frame[certified->swapped], certified->frame[!certified->swapped],
                   certified->pair->duration, out);
    kernels[certified->kind](&out->call);
    return (enum slabs_outcome) out->outcome[0];
}

static bool are_faces(const struct certified *certified)
{
    return certified->kind & KERNEL_FACE && certified->kind & KERNEL_SAME_SHAPE;
}

/* In: a pair that the second pass leaves unsure; or two faces, if it finds them touching. */
static enum fmb_verdict verdict_in_integers(struct certified *certified, bool touching)
{
    if (!find_slabs(certified))
        return verdict_exact(certified);
    const enum fmb_verdict verdict = touching ? FMB_TOUCHING : verdict_of_slabs(certified);
    if (!are_faces(certified) || certified->path == CERTIFIED_EXACT)
        return verdict; /* contact_of() needs no planes of faces that do not fit integers */
    find_span(certified);
    return verdict == FMB_TOUCHING ? verdict_of_planes(certified) : verdict;
}

/* In: a pair that the first pass leaves unsure. */
static enum fmb_verdict verdict_of_unsure(struct certified *certified)
{
    if (certified->kind >= KERNEL_KINDS)
        return verdict_exact(certified);
    struct kernel_one out;
    const enum slabs_outcome outcome = call_kernel(certified, kernel_set_best()->exact, &out);
    const bool touching = outcome == SLABS_TOUCHING;
    certified->path = CERTIFIED_SECOND;
    if (outcome == SLABS_UNSURE || (touching && are_faces(certified)))
        return verdict_in_integers(certified, touching);
    return (enum fmb_verdict) outcome;
}

/* In: a pair whose kind is set. contact: NULL, or the output of the contact of a pair that drifts,
 * as in struct kernel_call. */
static enum fmb_verdict verdict_of(struct certified *certified, double contact[2])
{
    const struct kernel_set *kernels = kernel_set_best();
    enum slabs_outcome outcome;
    certified->path = CERTIFIED_FILTER;
    if (contact) {
        struct kernel_one one;
        outcome = call_kernel(certified, kernels->times, &one);
        memcpy(contact, one.contact[0], sizeof one.contact[0]);
    } else {
        outcome = kernels->single[certified->kind](certified->frame[certified->swapped],
                                                   certified->frame[!certified->swapped],
                                                   certified->pair->duration);
    }
    return outcome == SLABS_UNSURE ? verdict_of_unsure(certified) : (enum fmb_verdict) outcome;
}

/* In: a pair after begin(). */
static enum fmb_verdict verdict_of_any(struct certified *certified)
{
    struct fmb_prepared a, b;
    prepared_set(certified->pair->a, &a);
    prepared_set(certified->pair->b, &b);
    return set_kind(certified, &a, &b) ? verdict_of(certified, NULL) : verdict_exact(certified);
}

static enum fmb_verdict projection_verdict(struct certified *certified)
{
    struct certified projection;
    begin(&projection, &certified->projection.pair, certified->quick);
    const enum fmb_verdict verdict = verdict_of_any(&projection);
    certified->path = projection.path;
    certified->open = projection.open;
    return verdict;
}

/* Whether the components have few bits, as hand-written numbers do: then probably no operation
 * rounds, and the times are exact. */
static bool is_plain(const struct certified *certified)
{
    return prepared_both_plain(certified->frame[0], certified->frame[1]);
}

/* Whether no operation rounds, so that the times are exact in doubles. Not tested for numbers that
 * probably round. */
static bool never_rounds(struct certified *certified)
{
    if (!is_plain(certified) || !find_slabs(certified))
        return false;
    find_span(certified);
    return !certified->rounds;
}

static enum fmb_status decide_pair(const struct frame_pair *pair, unsigned want, bool quick,
                                   struct fmb_answer *answer);

/* Completes the contact. In: for a pair that drifts, answer->contact is that of the filter. A pair
 * that does not drift is in contact over the whole window. Returns false if the exact method is
 * needed. Which step gives the times depends on the numbers of the pair only, so that they are the
 * same bits for every caller. */
static bool answer_contact(struct certified *certified, struct fmb_answer *answer)
{
    answer->has_contact = true;
    if (!(certified->kind & KERNEL_DRIFTS)) {
        answer->contact[0] = 0;
        answer->contact[1] = certified->pair->duration + 0.0; /* never -0 */
        return true;
    }
    if (certified->planes == FACES_SHARED) {
        struct fmb_answer projection = {0};
        const enum fmb_status status =
            decide_pair(&certified->projection.pair, 0, certified->quick, &projection);
        memcpy(answer->contact, projection.contact, sizeof projection.contact);
        return status == FMB_OK;
    }
    if (!never_rounds(certified) && !isnan(answer->contact[0]))
        return true;
    if (certified->planes == FACES_UNDECIDED || !find_slabs(certified))
        return false;
    find_span(certified);
    return contact_of(certified->pair, &certified->slabs, certified->rounds, certified->span,
                      !certified->quick, answer->contact);
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
    const struct frame_pair pair = {{a->frame, a->placement}, {b->frame, b->placement}, duration};
    if (limbs_box(a, b, duration, quick ? CERTIFIED_QUICK_LIMBS : LIMBS_MAX, box))
        return true;
    if (!quick)
        exact_box(&pair, box);
    return !quick;
}

/* Sets the box. Returns false if the decision is quick and needs wider integers. */
static bool answer_box(const struct certified *certified, struct fmb_answer *answer)
{
    const struct fmb_prepared *a = certified->frame[0], *b = certified->frame[1];
    const double duration = certified->pair->duration;
    answer->has_box = true;
    return certified_box(a, b, duration, answer->box) ||
           certified_box_unsure(a, b, duration, certified->quick, answer->box);
}

static enum fmb_status decide(const struct frame_pair *pair, const struct fmb_prepared *a,
                              const struct fmb_prepared *b, unsigned want, bool quick,
                              struct fmb_answer *answer)
{
    struct certified certified;
    begin(&certified, pair, quick);
    if (!set_kind(&certified, a, b))
        return quick ? FMB_CANNOT_DECIDE : exact_decide(pair, want & FMB_WANT_BOX, answer);
    answer->verdict =
        verdict_of(&certified, certified.kind & KERNEL_DRIFTS ? answer->contact : NULL);
    if (certified.open)
        return FMB_CANNOT_DECIDE;
    if (answer->verdict == FMB_SEPARATED) {
        answer->contact[0] = answer->contact[1] = 0;
        return FMB_OK;
    }
    if (!answer_contact(&certified, answer)) {
        struct fmb_answer exact = {0};
        if (quick)
            return FMB_CANNOT_DECIDE;
        exact_decide(pair, 0, &exact);
        memcpy(answer->contact, exact.contact, sizeof exact.contact);
    }
    if (want & FMB_WANT_BOX && !answer_box(&certified, answer))
        return FMB_CANNOT_DECIDE;
    return FMB_OK;
}

/* decide(), and the gap if it is wanted. */
static enum fmb_status decide_all(const struct frame_pair *pair, const struct fmb_prepared *a,
                                  const struct fmb_prepared *b, unsigned want, bool quick,
                                  struct fmb_answer *answer)
{
    const enum fmb_status status = decide(pair, a, b, want, quick, answer);
    answer->has_gap = want & FMB_WANT_GAP;
    if (status == FMB_OK && answer->has_gap &&
        gap_of(a, b, pair->duration, answer->verdict, INFINITY, quick, &answer->gap) == GAP_UNSURE)
        return FMB_CANNOT_DECIDE;
    return status;
}

static enum fmb_status decide_pair(const struct frame_pair *pair, unsigned want, bool quick,
                                   struct fmb_answer *answer)
{
    struct fmb_prepared a, b;
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    return decide_all(pair, &a, &b, want, quick, answer);
}

enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer)
{
    return decide_pair(pair, want, false, answer);
}

enum fmb_status certified_decide_prepared(const struct fmb_prepared *a,
                                          const struct fmb_prepared *b, double duration,
                                          unsigned want, bool quick, struct fmb_answer *answer)
{
    const struct frame_pair pair = {{a->frame, a->placement}, {b->frame, b->placement}, duration};
    return decide_all(&pair, a, b, want, quick, answer);
}

enum fmb_verdict certified_verdict(const struct frame_pair *pair, enum certified_path *path)
{
    struct certified certified;
    begin(&certified, pair, false);
    const enum fmb_verdict verdict = verdict_of_any(&certified);
    *path = certified.path;
    return verdict;
}

enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes, bool quick)
{
    const struct frame_pair pair = {{a->frame, a->placement}, {b->frame, b->placement}, duration};
    struct certified certified;
    begin(&certified, &pair, quick);
    set_kind(&certified, a, b);
    return passes == 2 && !are_faces(&certified) ? verdict_in_integers(&certified, false)
                                                 : verdict_of_unsure(&certified);
}
