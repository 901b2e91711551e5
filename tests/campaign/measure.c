#include "measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "gap_check.h"
#include "memory.h"
#include "rung.h"
#include "support_decision.h"

/* Pairs of a batch: the methods are timed over all of them, one after the other, each decided once,
 * so that no branch is predicted from having seen the pair before. */
enum { BATCH = 250 };

enum { IN_ORDER, SWAPPED, BOXLESS, GAP, ASKINGS };

enum { TIMES = 3 }; /* of verdicts, boxes and gaps */

struct batch {
    int count;
    struct trial trial[BATCH];
    struct reply reply[TRIAL_METHODS_MAX][ASKINGS][BATCH];
};

const char *measure_path_name(int path)
{
    static const char *const names[MEASURE_PATHS] = {[CERTIFIED_FILTER] = "filter",
                                                     [CERTIFIED_SECOND] = "second",
                                                     [CERTIFIED_LIMBS] = "limbs",
                                                     [CERTIFIED_ALL_SLABS] = "exact",
                                                     [CERTIFIED_PROGRAMS] = "programs"};
    return names[path];
}

/* Of the processor, spent by this thread: a machine that is busy otherwise does not count. */
static double ns_spent(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * (double) now.tv_sec + (double) now.tv_nsec;
}

/* Puts all pairs of the batch to a method. Returns nanoseconds a query. */
static double decide_all(struct batch *batch, int method, int mode)
{
    const struct fmb_method *chosen = fmb_method_at((size_t) method);
    const unsigned more = chosen->certain ? FMB_WANT_GAP | FMB_WANT_POINT : 0;
    const unsigned wants[ASKINGS] = {FMB_WANT_BOX, FMB_WANT_BOX | more, 0, more};
    struct reply *reply = batch->reply[method][mode];
    const double start = ns_spent();
    for (int i = 0; i < batch->count; i++)
        reply[i] = trial_decide(&batch->trial[i], chosen, mode == SWAPPED, wants[mode]);
    return (ns_spent() - start) / batch->count;
}

/* What a method that is never wrong must keep: it decides, its verdict is the true one in either
 * order, its interval and box contain the true ones and are as tight as is promised, the verdict
 * is the same without a box. */
static void check_promises(struct tally *tally, const struct fmb_method *method,
                           const struct oracle_answer *truth, const struct trial *trial,
                           const struct reply *reply[ASKINGS])
{
    const enum oracle_limit limit =
        strcmp(method->name, "exact") == 0 ? ORACLE_TIGHTEST : ORACLE_DESIGN;
    char why[TALLY_WHY_MAX];
    for (int order = 0; order < 2; order++)
        if (reply[order]->status != FMB_OK)
            tally_broken(tally, &trial->question, fmb_status_text(reply[order]->status));
        else if (!oracle_agrees(truth, &trial->pair[order], &reply[order]->answer, limit, why,
                                sizeof why))
            tally_broken(tally, &trial->question, why);
    if (!reply_same_verdict(reply[IN_ORDER], reply[BOXLESS]))
        tally_broken(tally, &trial->question, "another verdict without the box");
}

/* The same for gaps and points: the same bits in either order, with a box or without; and proven.
 */
static void check_gap_and_point(struct tally *tally, enum fmb_verdict verdict,
                                const struct trial *trial, const struct reply *reply[ASKINGS])
{
    const struct fmb_answer *answer = &reply[GAP]->answer, *swapped = &reply[SWAPPED]->answer;
    char why[TALLY_WHY_MAX];
    if (!reply_same_verdict(reply[IN_ORDER], reply[GAP]))
        tally_broken(tally, &trial->question, "another verdict with the gap");
    else if (!answer->has_gap || !swapped->has_gap)
        tally_broken(tally, &trial->question, "no gap");
    else if (answer->has_point != (verdict != FMB_SEPARATED) ||
             answer->has_point != swapped->has_point)
        tally_broken(tally, &trial->question, "a point of a separated pair, or none of a contact");
    else if (memcmp(answer->point, swapped->point, sizeof answer->point) != 0)
        tally_broken(tally, &trial->question, "another point in the other order");
    else if (!gap_check_swapped(question_is_symmetric(&trial->question), &answer->gap,
                                &swapped->gap))
        tally_broken(tally, &trial->question, "another gap in the other order");
    else if (!tally_gap(tally, verdict, &trial->pair[0], &answer->gap, why))
        tally_broken(tally, &trial->question, why);
}

/* Of bodies of several frames, the last step that any pair of them needs. */
static enum certified_path path_of(const struct pair *pair)
{
    enum certified_path most = CERTIFIED_FILTER;
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        for (unsigned j = 0; j < pair->b.body->frame_count; j++) {
            const struct frame_pair frames = {{fmb_body_frame(pair->a.body, i), &pair->a},
                                              {fmb_body_frame(pair->b.body, j), &pair->b},
                                              pair->duration};
            enum certified_path path;
            struct fmb_answer answer;
            if (!support_takes(frames.a.frame, frames.b.frame))
                verdict_by_rung(&frames, &path);
            else
                path = support_decide(&frames, 0, SUPPORT_QUICK, &answer) == FMB_OK
                           ? CERTIFIED_FILTER
                           : CERTIFIED_PROGRAMS;
            most = path > most ? path : most;
        }
    return most;
}

static void judge_pair(struct measure *measure, const struct batch *batch, int i,
                       struct oracle_answer *truth)
{
    const struct trial *trial = &batch->trial[i];
    oracle_decide(&trial->pair[0], FMB_WANT_BOX, truth);
    measure->pairs++;
    measure->truth[truth->verdict]++;
    measure->not_as_made +=
        measure->family->verdict != 0 && (int) truth->verdict != measure->family->verdict;
    measure->path[path_of(&trial->pair[0])]++;
    for (int m = 0; m < trial_methods(); m++) {
        const struct fmb_method *method = fmb_method_at((size_t) m);
        struct tally *tally = &measure->method[m].tally;
        const struct reply *reply[ASKINGS] = {
            &batch->reply[m][IN_ORDER][i], &batch->reply[m][SWAPPED][i],
            &batch->reply[m][BOXLESS][i], &batch->reply[m][GAP][i]};
        for (int order = 0; order < 2; order++)
            tally_reply(tally, truth, &trial->pair[order], reply[order]);
        tally_orders(tally, reply[IN_ORDER], reply[SWAPPED]);
        if (!trial_never_wrong(method))
            continue;
        check_promises(tally, method, truth, trial, reply);
        check_gap_and_point(tally, truth->verdict, trial, reply);
    }
}

static int compare_doubles(const void *p, const void *q)
{
    const double x = *(const double *) p, y = *(const double *) q;
    return (x > y) - (x < y);
}

static double median(double *value, size_t count)
{
    qsort(value, count, sizeof *value, compare_doubles);
    return count ? value[count / 2] : 0;
}

void measure_cell(struct measure *measure, long pairs, uint64_t seed)
{
    const size_t batches = (size_t) (pairs + BATCH - 1) / BATCH;
    const int methods = trial_methods();
    struct batch *batch = memory_get(sizeof *batch);
    double *ns = memory_get(TIMES * TRIAL_METHODS_MAX * batches * sizeof *ns);
    struct draw draw = cell_draw(seed, measure->family->name, &measure->cell, 0);
    struct oracle_answer truth;
    oracle_init(&truth);
    for (size_t n = 0; n < batches; n++, pairs -= BATCH) {
        batch->count = pairs < BATCH ? (int) pairs : BATCH;
        for (int i = 0; i < batch->count; i++) {
            struct question question;
            family_draw(measure->family, &measure->cell, &draw, &question);
            trial_begin(&question, &batch->trial[i]);
        }
        for (int m = 0; m < methods; m++) {
            double *at = ns + (size_t) (TIMES * m) * batches + n;
            at[0] = decide_all(batch, m, BOXLESS);
            at[batches] = decide_all(batch, m, IN_ORDER);
            decide_all(batch, m, SWAPPED);
            if (fmb_method_at((size_t) m)->certain)
                at[2 * batches] = decide_all(batch, m, GAP);
        }
        for (int i = 0; i < batch->count; i++)
            judge_pair(measure, batch, i, &truth);
        for (int i = 0; i < batch->count; i++)
            trial_end(&batch->trial[i]);
    }
    for (int m = 0; m < methods; m++) {
        double *at = ns + (size_t) (TIMES * m) * batches;
        measure->method[m].ns_verdict = median(at, batches);
        measure->method[m].ns_box = median(at + batches, batches);
        measure->method[m].ns_gap = median(at + 2 * batches, batches);
    }
    oracle_clear(&truth);
    free(ns);
    free(batch);
}
