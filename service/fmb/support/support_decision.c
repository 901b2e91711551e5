/* Decides pairs by their vertices: in doubles if these prove the answer, otherwise by programs. */
#include "support_decision.h"

#include "programs.h"
#include "support_gap.h"

#include <math.h>
#include <string.h>

/* Sets contact and box of an overlap that doubles prove, each if it is wanted and tight enough.
 * Neither depends on whether the other is wanted. Returns the parts that are left to integers. */
static unsigned answer_in_doubles(const struct support_pair *pair, unsigned want,
                                  const struct support_simplex *simplex, struct fmb_answer *answer)
{
    answer->has_contact = want & FMB_WANT_TIMES && support_contact(pair, simplex, answer->contact);
    answer->has_box = want & FMB_WANT_BOX && support_box(pair, simplex, answer->box);
    return want &
           ~((answer->has_contact ? FMB_WANT_TIMES : 0u) | (answer->has_box ? FMB_WANT_BOX : 0u));
}

void support_decision_none(struct support_decision *out)
{
    out->programs = out->times.programs = NULL;
    out->gap = NULL;
}

static void set_pair(const struct frame_pair *frames, unsigned want, double farthest, bool bounded,
                     struct support_decision *out)
{
    support_decision_none(out);
    out->swapped = support_order(frames, &out->frames);
    out->searched = out->by_nearest = out->computes_point = false;
    out->cores = 0;
    out->ends = (struct support_round_ends){.time = {NAN, NAN}, .guess = {NAN, NAN}};
    out->bounded = bounded;
    out->want = want;
    out->farthest = farthest;
    support_pair_set(&out->frames, &out->pair);
}

static struct programs *begin_nearest(const struct support_decision *decision)
{
    struct support_column first[FMB_DIM_MAX + 1];
    const unsigned count =
        decision->searched ? support_columns(&decision->nearest.simplex, first) : 0;
    return programs_begin_nearest(&decision->pair, false, first, count);
}

/* Sets the point of a pair in contact, if it is wanted and doubles prove it. Otherwise begins the
 * programs that compute it, unless the decision is bounded. Returns whether the decision is
 * complete. */
static bool begin_point(struct support_decision *decision, struct fmb_answer *answer)
{
    if (!(decision->want & FMB_WANT_POINT) || answer->verdict == FMB_SEPARATED)
        return true;
    answer->has_point = true;
    if (decision->searched &&
        support_common_point(&decision->pair, &decision->nearest, answer->point))
        return true;
    decision->computes_point = true;
    if (!decision->bounded)
        decision->programs = begin_nearest(decision);
    return false;
}

/* Takes the outcome of a step of the gap. Returns whether it is complete. */
static bool take_gap(struct support_decision *decision, enum gap_outcome outcome,
                     struct fmb_answer *answer)
{
    if (outcome == GAP_UNSURE)
        return false;
    decision->gap = NULL;
    answer->has_gap = true;
    if (outcome == GAP_FAR)
        answer->gap = gap_none();
    return begin_point(decision, answer);
}

/* Begins the gap of a pair whose cores have this verdict. Returns whether the decision is complete.
 */
static bool begin_gap_of(struct support_decision *decision, enum fmb_verdict cores,
                         struct fmb_answer *answer)
{
    const bool all = decision->searched && decision->farthest == INFINITY;
    return take_gap(
        decision,
        support_gap_of_pair(&decision->pair, decision->swapped, all ? &decision->nearest : NULL,
                            cores, answer->verdict, decision->farthest + decision->pair.radius[1],
                            &answer->gap, decision->bounded ? NULL : &decision->gap),
        answer);
}

/* Begins the gap of a pair whose verdict is known, if it is wanted, then the point. The gap of
 * frames with radii follows from the gap of their cores, so the verdict of the cores may have to be
 * decided first. Returns whether the decision is complete. */
static bool begin_gap_and_point(struct support_decision *decision, struct fmb_answer *answer)
{
    if (!(decision->want & FMB_WANT_GAP))
        return begin_point(decision, answer);
    if (!decision->pair.rounded)
        return begin_gap_of(decision, answer->verdict, answer);
    if (decision->cores) /* if the cores touch, the direction has to prove the bound too */
        return begin_gap_of(
            decision, decision->cores == FMB_SEPARATED ? FMB_SEPARATED : FMB_OVERLAPPING, answer);
    if (!decision->bounded)
        decision->programs = programs_begin(&decision->pair, 0, NULL, 0);
    return false;
}

/* ---- Radii ---- */

/* Sets contact and box of a pair in contact, as far as they are wanted. */
static void set_contact(const struct support_decision *decision, const double contact[2],
                        struct fmb_answer *answer)
{
    answer->has_contact = decision->want & FMB_WANT_TIMES;
    answer->has_box = decision->want & FMB_WANT_BOX;
    if (answer->has_contact)
        memcpy(answer->contact, contact, sizeof answer->contact);
    if (answer->has_box)
        support_round_box(&decision->pair, contact, answer->box);
}

/* Completes the answer of a pair in contact as far as doubles do. Returns whether its contact is
 * known. */
static bool measure(struct support_decision *decision, struct fmb_answer *answer)
{
    const struct support_pair *pair = &decision->pair;
    double contact[2] = {0, pair->frames->duration + 0.0};
    if (answer->verdict == FMB_SEPARATED || !(decision->want & (FMB_WANT_TIMES | FMB_WANT_BOX)))
        return true;
    if (pair->drifts) {
        if (!decision->searched || !support_round_contact(pair, &decision->ends))
            return false;
        memcpy(contact, decision->ends.time, sizeof contact);
    }
    set_contact(decision, contact, answer);
    return true;
}

/* Begins a decision after the search for the cores. Returns whether it is complete. */
static bool round_begin(struct support_decision *decision, enum fmb_verdict cores,
                        struct fmb_answer *answer)
{
    decision->cores = cores;
    if (decision->searched)
        answer->verdict = support_round_verdict(&decision->pair, cores, &decision->nearest);
    if (answer->verdict && measure(decision, answer))
        return begin_gap_and_point(decision, answer);
    if (!decision->bounded) {
        decision->by_nearest = true;
        decision->programs = begin_nearest(decision);
    }
    return false;
}

/* Performs a step of the programs, and uses their result if that was the last. Returns whether the
 * decision is complete. */
static bool round_step(struct support_decision *decision, struct fmb_answer *answer)
{
    if (decision->times.programs) {
        if (!support_round_times_step(&decision->times))
            return false;
        set_contact(decision, decision->times.ends.time, answer);
        return begin_gap_and_point(decision, answer);
    }
    if (!programs_step(decision->programs))
        return false;
    struct programs *programs = decision->programs;
    decision->programs = NULL;
    if (!decision->by_nearest) {
        struct fmb_answer cores;
        programs_end(programs, &cores);
        decision->cores = cores.verdict;
        return begin_gap_and_point(decision, answer);
    }
    double inside[2];
    answer->verdict = programs_proof(programs)->verdict;
    programs_nearest_time(programs, inside);
    programs_end(programs, NULL);
    decision->by_nearest = false;
    if (measure(decision, answer))
        return begin_gap_and_point(decision, answer);
    support_round_times_begin(&decision->pair, inside, &decision->ends, &decision->times);
    return false;
}

bool support_decision_begin(const struct frame_pair *frames, unsigned want,
                            enum support_effort effort, double farthest,
                            struct support_decision *out, struct fmb_answer *answer)
{
    struct support_column first[FMB_DIM_MAX + 1];
    struct support_nearest *nearest = &out->nearest;
    const struct support_pair *pair = &out->pair;
    const bool all = want & FMB_WANT_GAP && farthest == INFINITY;
    unsigned left = want & (FMB_WANT_TIMES | FMB_WANT_BOX);
    enum fmb_verdict cores = 0;
    set_pair(frames, want, farthest, effort == SUPPORT_QUICK, out);
    out->searched = effort != SUPPORT_PROGRAMS && pair->usable;
    nearest->simplex.count = 0;
    const double far = pair->rounded ? support_round_far(pair) : support_separating_distance(pair);
    if (out->searched)
        cores = support_search(pair, all ? INFINITY : far, nearest);
    if (pair->rounded)
        return round_begin(out, cores, answer);
    answer->verdict = cores;
    if (answer->verdict == FMB_OVERLAPPING)
        left = answer_in_doubles(pair, left, &nearest->simplex, answer);
    if (answer->verdict == FMB_SEPARATED || (answer->verdict == FMB_OVERLAPPING && left == 0))
        return begin_gap_and_point(out, answer);
    if (effort != SUPPORT_QUICK) {
        /* The guess is a simplex that contains the origin after it was moved in a little. The
         * facet through which the ray leaves is close to it, so few steps are left. */
        struct support_guess guess;
        const bool guessed =
            answer->verdict == 0 && out->searched && support_guess_begin(pair, &guess);
        const struct support_simplex *simplex = guessed ? &guess.simplex : &nearest->simplex;
        const unsigned count = support_columns(simplex, first);
        out->programs = programs_begin(pair, left, first, count);
    }
    return false;
}

bool support_decision_begin_gap_and_point(const struct frame_pair *frames, unsigned want,
                                          enum fmb_verdict verdict, double farthest, bool bounded,
                                          struct support_decision *out, struct fmb_answer *answer)
{
    set_pair(frames, want, farthest, bounded, out);
    answer->verdict = verdict;
    out->searched = verdict != FMB_SEPARATED && out->pair.usable &&
                    (out->pair.rounded || want & FMB_WANT_POINT);
    if (out->pair.rounded && verdict == FMB_SEPARATED)
        out->cores = FMB_SEPARATED;
    else if (out->searched)
        out->cores = support_search(&out->pair, INFINITY, &out->nearest);
    return begin_gap_and_point(out, answer);
}

bool support_decision_step(struct support_decision *decision, struct fmb_answer *answer)
{
    if (decision->gap)
        return take_gap(decision, support_gap_step(decision->gap, &answer->gap), answer);
    if (decision->computes_point) {
        if (!programs_step(decision->programs))
            return false;
        programs_nearest_point(decision->programs, answer->point);
        programs_end(decision->programs, NULL);
        decision->programs = NULL;
        return true;
    }
    if (decision->pair.rounded)
        return round_step(decision, answer);
    if (!programs_step(decision->programs))
        return false;
    programs_end(decision->programs, answer);
    decision->programs = NULL;
    return begin_gap_and_point(decision, answer);
}

void support_decision_end(struct support_decision *decision)
{
    if (decision->programs)
        programs_end(decision->programs, NULL);
    if (decision->gap)
        support_gap_end(decision->gap);
    support_round_times_end(&decision->times);
    support_decision_none(decision);
}

enum fmb_status support_decide(const struct frame_pair *frames, unsigned want,
                               enum support_effort effort, struct fmb_answer *answer)
{
    struct support_decision decision;
    memset(answer, 0, sizeof *answer);
    bool done = support_decision_begin(frames, want, effort, INFINITY, &decision, answer);
    if (!done && effort == SUPPORT_QUICK)
        return FMB_CANNOT_DECIDE;
    while (!done)
        done = support_decision_step(&decision, answer);
    return FMB_OK;
}
