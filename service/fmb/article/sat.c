/* The separating axis theorem, the article's comparator. Two convex bodies are separated if and
 * only if they are separated along a normal of one of their faces, or of the plane of an edge of
 * each (Eberly and Schneider, the article's reference 1). A moving body sweeps a convex body too:
 * its drift over the window is one more edge. These axes are the normals of the slabs of the pair
 * (slabs.h). The kernels of the filter decide what they are sure of; of other pairs the slabs are
 * listed, and their numbers are taken as they are, as if they had no errors.
 *
 * Accuracy: none is guaranteed. Rounding decides near contact, but only there. */
#include "inexact.h"
#include "kernel.h"

#include <math.h>
#include <string.h>

/* Whether the slab is wider than the error of its numbers. That of edges that are parallel, or
 * nearly so, is not: its normal consists of rounding errors, and it says nothing. */
static bool has_width(const struct slab_value *slab)
{
    return slab->high - slab->low > slab->error;
}

static enum fmb_verdict verdict_of(const struct slab_value *slab, int count)
{
    enum fmb_verdict verdict = FMB_OVERLAPPING;
    for (int i = 0; i < count; i++) {
        const double gap = slab_gap(&slab[i]);
        if (!has_width(&slab[i]))
            continue;
        if (gap > 0)
            return FMB_SEPARATED;
        if (gap == 0)
            verdict = FMB_TOUCHING;
    }
    return verdict;
}

/* Sets the contact of a pair that meets, in seconds: the time in which the offset is within all
 * slabs. Rounding may leave nothing: then it is the middle of what is left. */
static void set_contact(const struct slab_value *slab, int count, double duration,
                        struct fmb_answer *answer)
{
    struct bounds bounds = {.strict = {0, 1}, .closed = {0, 1}};
    for (int i = 0; i < count; i++) {
        struct inequality side[2];
        slab_inequalities(&slab[i], side);
        for (int k = 0; k < 2 && has_width(&slab[i]); k++) {
            const double at = -side[k].c / side[k].g;
            if (side[k].g > 0)
                bounds.strict[0] = fmax(at, bounds.strict[0]);
            else if (side[k].g < 0)
                bounds.strict[1] = fmin(at, bounds.strict[1]);
        }
    }
    if (bounds.strict[0] > bounds.strict[1])
        bounds.strict[0] = bounds.strict[1] =
            fmin(fmax((bounds.strict[0] + bounds.strict[1]) / 2, 0), 1);
    bounds_answer_contact(&bounds, duration, answer);
}

/* Decides a pair of which a kernel is not sure, or does not give the contact. */
static enum fmb_status decide_by_list(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                      double duration, struct fmb_answer *answer)
{
    struct slabs_pair pair;
    struct slab_value slab[SLABS_MAX];
    if (!slabs_prepare(a, b, duration, &pair))
        return FMB_CANNOT_DECIDE;
    const int count = slabs_list(&pair, true, slab);
    answer->verdict = verdict_of(slab, count);
    if (answer->verdict != FMB_SEPARATED)
        set_contact(slab, count, duration, answer);
    return FMB_OK;
}

enum fmb_status sat_decide(const struct frame_pair *frames, unsigned want,
                           struct fmb_answer *answer)
{
    const double duration = frames->duration;
    struct fmb_prepared frame[2];
    bool swapped;
    (void) want;
    prepared_set(frames->a, &frame[0]);
    prepared_set(frames->b, &frame[1]);
    const enum kernel_kind kind = kernel_kind_of(&frame[0], &frame[1], duration, &swapped);
    if (frames->a.frame->flat || frames->b.frame->flat || kind >= KERNEL_KINDS)
        return FMB_CANNOT_DECIDE;
    double contact[2] = {0, duration + 0.0}; /* never -0 */
    const struct kernel_set *kernels = kernel_set_best();
    const struct fmb_prepared *first = &frame[swapped], *second = &frame[!swapped];
    enum slabs_outcome outcome;
    if (kind & KERNEL_DRIFTS) {
        struct kernel_one one;
        kernel_set_one(first, second, duration, &one);
        kernels->times[kind](&one.call);
        outcome = (enum slabs_outcome) one.outcome[0];
        memcpy(contact, one.contact[0], sizeof contact);
    } else {
        outcome = kernels->single[kind](first, second, duration);
    }
    if (outcome == SLABS_UNSURE || (outcome == SLABS_OVERLAPPING && isnan(contact[0])))
        return decide_by_list(&frame[0], &frame[1], duration, answer);
    answer->verdict = (enum fmb_verdict) outcome;
    answer->has_contact = outcome != SLABS_SEPARATED;
    if (answer->has_contact)
        memcpy(answer->contact, contact, sizeof contact);
    return FMB_OK;
}
