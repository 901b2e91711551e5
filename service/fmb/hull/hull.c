/* Decides pairs with a hull: in doubles what they prove, the rest in integers. */
#include "hull.h"

#include "hull_exact.h"
#include "hull_gap.h"
#include "hull_search.h"

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

/* hull_decision_begin(). *nearest := the result of the search in doubles; *searched: whether there
 * was one. */
static bool begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                  struct hull_decision *out, struct hull_nearest *nearest, bool *searched,
                  struct fmb_answer *answer)
{
    struct hull_column first[FMB_DIM_MAX + 1];
    const struct hull_pair *pair = &out->pair;
    unsigned left = want & (FMB_WANT_TIMES | FMB_WANT_BOX);
    out->swapped = hull_order(frames, &out->frames);
    hull_pair_set(&out->frames, &out->pair);
    out->exact = NULL;
    *searched = effort != HULL_EXACT && pair->usable;
    nearest->simplex.count = 0;
    answer->has_contact = answer->has_box = false;
    answer->verdict =
        *searched
            ? hull_search(pair, want & FMB_WANT_GAP ? INFINITY : hull_separating_distance(pair),
                          nearest)
            : 0;
    if (answer->verdict == FMB_OVERLAPPING)
        left = answer_in_doubles(pair, left, &nearest->simplex, answer);
    if (answer->verdict == FMB_SEPARATED || (answer->verdict == FMB_OVERLAPPING && left == 0))
        return true;
    if (effort != HULL_QUICK) {
        for (unsigned i = 0; i < nearest->simplex.count; i++)
            first[i] = nearest->simplex.vertex[i].column;
        out->exact = hull_exact_begin(pair, left, first, nearest->simplex.count);
    }
    return false;
}

bool hull_decision_begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                         struct hull_decision *out, struct fmb_answer *answer)
{
    struct hull_nearest nearest;
    bool searched;
    return begin(frames, want & ~(unsigned) FMB_WANT_GAP, effort, out, &nearest, &searched, answer);
}

bool hull_decision_step(struct hull_decision *decision, struct fmb_answer *answer)
{
    if (!hull_exact_step(decision->exact))
        return false;
    hull_exact_end(decision->exact, answer);
    decision->exact = NULL;
    return true;
}

void hull_decision_end(struct hull_decision *decision)
{
    if (decision->exact)
        hull_exact_end(decision->exact, NULL);
    decision->exact = NULL;
}

enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer)
{
    struct hull_decision decision;
    struct hull_nearest nearest;
    struct hull_gap_work *work;
    bool searched;
    if (!begin(frames, want, effort, &decision, &nearest, &searched, answer)) {
        if (effort == HULL_QUICK)
            return FMB_CANNOT_DECIDE;
        while (!hull_decision_step(&decision, answer))
            ;
    }
    answer->has_gap = want & FMB_WANT_GAP;
    if (!answer->has_gap)
        return FMB_OK;
    enum gap_outcome outcome =
        hull_gap_of_pair(&decision.pair, decision.swapped, searched ? &nearest : NULL,
                         answer->verdict, INFINITY, &answer->gap, &work);
    while (outcome == GAP_UNSURE)
        outcome = hull_gap_step(work, &answer->gap);
    return FMB_OK;
}
