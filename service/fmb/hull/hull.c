/* Decides pairs with a hull: in doubles what they prove, the rest in integers. */
#include "hull.h"

#include "hull_exact.h"
#include "hull_search.h"

static void decide_exactly(const struct hull_pair *pair, unsigned want,
                           const struct hull_simplex *start, struct fmb_answer *answer)
{
    struct hull_column first[FMB_DIM_MAX + 1];
    for (unsigned i = 0; i < start->count; i++)
        first[i] = start->vertex[i].column;
    struct hull_exact *exact = hull_exact_begin(pair, want, first, start->count);
    while (!hull_exact_step(exact))
        ;
    hull_exact_end(exact, answer);
}

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

enum fmb_status hull_decide(const struct frame_pair *frames, unsigned want, enum hull_effort effort,
                            struct fmb_answer *answer)
{
    struct frame_pair ordered;
    struct hull_pair pair;
    struct hull_simplex simplex = {.count = 0};
    if (want & FMB_WANT_GAP)
        return FMB_CANNOT_DECIDE;
    hull_order(frames, &ordered);
    hull_pair_set(&ordered, &pair);
    answer->verdict = effort != HULL_EXACT && pair.usable ? hull_search(&pair, &simplex) : 0;
    if (answer->verdict == FMB_SEPARATED ||
        (answer->verdict == FMB_OVERLAPPING && answer_in_doubles(&pair, want, &simplex, answer)))
        return FMB_OK;
    if (effort == HULL_QUICK)
        return FMB_CANNOT_DECIDE;
    if (answer->verdict == FMB_OVERLAPPING)
        simplex.count = 0;
    decide_exactly(&pair, want, &simplex, answer);
    return FMB_OK;
}

enum gap_outcome hull_gap_of(const struct hull_pair *pair, enum fmb_verdict verdict,
                             double farthest, struct fmb_gap *out)
{
    (void) pair, (void) verdict, (void) farthest, (void) out;
    return GAP_UNSURE;
}
