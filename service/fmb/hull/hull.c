/* Decides pairs with a hull: in doubles what they prove, the rest in integers. */
#include "hull.h"

#include "hull_exact.h"
#include "hull_search.h"

#include <math.h>

/* Sets contact and box of an overlap that doubles prove. Returns false if they are not tight
 * enough. */
static bool answer_in_doubles(const struct hull_pair *pair, unsigned want,
                              const struct hull_simplex *simplex, struct fmb_answer *answer)
{
    answer->has_contact = want & FMB_WANT_TIMES;
    answer->has_box = want & FMB_WANT_BOX;
    return (!answer->has_contact || hull_contact(pair, simplex, answer->contact)) &&
           (!answer->has_box || hull_box(pair, simplex, answer->box));
}

bool hull_decision_begin(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                         struct hull_decision *out, struct fmb_answer *answer)
{
    struct hull_simplex simplex = {.count = 0};
    struct hull_column first[FMB_DIM_MAX + 1];
    hull_order(frames, &out->frames);
    hull_pair_set(&out->frames, &out->pair);
    out->exact = NULL;
    answer->verdict =
        effort != HULL_EXACT && out->pair.usable ? hull_search(&out->pair, &simplex) : 0;
    if (answer->verdict == FMB_SEPARATED)
        return true;
    if (answer->verdict == FMB_OVERLAPPING) {
        if (answer_in_doubles(&out->pair, want, &simplex, answer))
            return true;
        simplex.count = 0; /* the centre is no column */
    }
    for (unsigned i = 0; i < simplex.count; i++)
        first[i] = simplex.vertex[i].column;
    if (effort != HULL_QUICK)
        out->exact = hull_exact_begin(&out->pair, want, first, simplex.count);
    return false;
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
    if (!hull_decision_begin(frames, want, effort, &decision, answer)) {
        if (effort == HULL_QUICK)
            return FMB_CANNOT_DECIDE;
        while (!hull_decision_step(&decision, answer))
            ;
    }
    answer->has_gap = want & FMB_WANT_GAP;
    return !answer->has_gap ||
                   hull_gap(frames, answer->verdict, INFINITY, &answer->gap) == GAP_KNOWN
               ? FMB_OK
               : FMB_CANNOT_DECIDE;
}
