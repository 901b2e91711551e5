/* Decides pairs by their vertices: in doubles if these prove the answer, otherwise by programs. */
#include "hull_decision.h"

#include "hull_exact.h"
#include "hull_gap.h"

#include <math.h>

/* Sets contact and box of an overlap that doubles prove, each if it is wanted and tight enough.
 * Neither depends on whether the other is wanted. Returns the parts that are left to integers. */
static unsigned answer_in_doubles(const struct hull_pair *pair, unsigned want,
                                  const struct hull_simplex *simplex, struct fmb_answer *answer)
{
    answer->has_contact = want & FMB_WANT_TIMES && hull_contact(pair, simplex, answer->contact);
    answer->has_box = want & FMB_WANT_BOX && hull_box(pair, simplex, answer->box);
    return want &
           ~((answer->has_contact ? FMB_WANT_TIMES : 0u) | (answer->has_box ? FMB_WANT_BOX : 0u));
}

void hull_decision_none(struct hull_decision *out)
{
    out->exact = NULL;
    out->gap = NULL;
}

static void set_pair(const struct frame_pair *frames, unsigned want, double farthest, bool bounded,
                     struct hull_decision *out)
{
    hull_decision_none(out);
    out->swapped = hull_order(frames, &out->frames);
    out->searched = false;
    out->bounded = bounded;
    out->want = want;
    out->farthest = farthest;
    hull_pair_set(&out->frames, &out->pair);
}

/* Takes the outcome of a step of the gap. Returns whether it is complete. */
static bool take_gap(struct hull_decision *decision, enum gap_outcome outcome,
                     struct fmb_answer *answer)
{
    if (outcome == GAP_UNSURE)
        return false;
    decision->gap = NULL;
    answer->has_gap = true;
    if (outcome == GAP_FAR)
        answer->gap = gap_none();
    return true;
}

/* Begins the gap, if it is wanted. Returns whether the decision is complete. */
static bool begin_gap(struct hull_decision *decision, struct fmb_answer *answer)
{
    if (!(decision->want & FMB_WANT_GAP))
        return true;
    const bool all = decision->searched && decision->farthest == INFINITY;
    return take_gap(
        decision,
        hull_gap_of_pair(&decision->pair, decision->swapped, all ? &decision->nearest : NULL,
                         answer->verdict, decision->farthest, &answer->gap,
                         decision->bounded ? NULL : &decision->gap),
        answer);
}

bool hull_decision_begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                         double farthest, struct hull_decision *out, struct fmb_answer *answer)
{
    struct hull_column first[FMB_DIM_MAX + 1];
    struct hull_nearest *nearest = &out->nearest;
    const struct hull_pair *pair = &out->pair;
    const bool all = want & FMB_WANT_GAP && farthest == INFINITY;
    unsigned left = want & (FMB_WANT_TIMES | FMB_WANT_BOX);
    set_pair(frames, want, farthest, effort == HULL_QUICK, out);
    out->searched = effort != HULL_EXACT && pair->usable;
    nearest->simplex.count = 0;
    if (out->searched)
        answer->verdict =
            hull_search(pair, all ? INFINITY : hull_separating_distance(pair), nearest);
    if (answer->verdict == FMB_OVERLAPPING)
        left = answer_in_doubles(pair, left, &nearest->simplex, answer);
    if (answer->verdict == FMB_SEPARATED || (answer->verdict == FMB_OVERLAPPING && left == 0))
        return begin_gap(out, answer);
    if (effort != HULL_QUICK) {
        /* The guess is a simplex that contains the origin after it was moved in a little. The
         * facet through which the ray leaves is close to it, so few steps are left. */
        struct hull_guess guess;
        const bool guessed =
            answer->verdict == 0 && out->searched && hull_guess_begin(pair, &guess);
        const struct hull_simplex *simplex = guessed ? &guess.simplex : &nearest->simplex;
        for (unsigned i = 0; i < simplex->count; i++)
            first[i] = simplex->vertex[i].column;
        out->exact = hull_exact_begin(pair, left, first, simplex->count);
    }
    return false;
}

bool hull_decision_begin_gap(const struct frame_pair *frames, enum fmb_verdict verdict,
                             double farthest, bool bounded, struct hull_decision *out,
                             struct fmb_answer *answer)
{
    set_pair(frames, FMB_WANT_GAP, farthest, bounded, out);
    answer->verdict = verdict;
    return begin_gap(out, answer);
}

bool hull_decision_step(struct hull_decision *decision, struct fmb_answer *answer)
{
    if (decision->gap)
        return take_gap(decision, hull_gap_step(decision->gap, &answer->gap), answer);
    if (!hull_exact_step(decision->exact))
        return false;
    hull_exact_end(decision->exact, answer);
    decision->exact = NULL;
    return begin_gap(decision, answer);
}

void hull_decision_end(struct hull_decision *decision)
{
    if (decision->exact)
        hull_exact_end(decision->exact, NULL);
    if (decision->gap)
        hull_gap_end(decision->gap);
    hull_decision_none(decision);
}

enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer)
{
    static const struct fmb_answer none;
    struct hull_decision decision;
    *answer = none;
    bool done = hull_decision_begin(frames, want, effort, INFINITY, &decision, answer);
    if (!done && effort == HULL_QUICK)
        return FMB_CANNOT_DECIDE;
    while (!done)
        done = hull_decision_step(&decision, answer);
    return FMB_OK;
}
