#include "batch.h"
#include "contender.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static volatile unsigned sink; /* so that nothing is left out */

struct work work_of(const struct scene *scene, const struct pairs *pairs)
{
    return (struct work){.scene = scene,
                         .pair = (const unsigned(*)[2]) pairs->at,
                         .count = pairs->count,
                         .verdicts = scene_allocate(pairs->count, 1),
                         .contacts = scene_allocate(pairs->count, 2 * sizeof(double)),
                         .boxes = scene_allocate(pairs->count, 6 * sizeof(double)),
                         .gaps = scene_allocate(pairs->count, sizeof(double))};
}

void work_free(struct work *work)
{
    free(work->verdicts);
    free(work->contacts);
    free(work->boxes);
    free(work->gaps);
}

/* ---- The contenders ---- */

static void run_batch(const struct work *work, bool contacts, bool boxes)
{
    const struct fmb_batch batch = {.frames = work->scene->prepared,
                                    .frame_count = work->scene->count,
                                    .pairs = work->pair,
                                    .pair_count = work->count,
                                    .duration = 1,
                                    .verdicts = work->verdicts,
                                    .contacts = contacts ? work->contacts : NULL,
                                    .boxes = boxes ? work->boxes : NULL};
    sink += batch_decide(&batch, work->instructions, INFINITY);
}

static void batch(const struct work *work)
{
    run_batch(work, false, false);
}

static void batch_interval(const struct work *work)
{
    run_batch(work, true, false);
}

static void batch_box(const struct work *work)
{
    run_batch(work, false, true);
}

static unsigned char meets(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    enum fmb_verdict verdict;
    return fmb_decide_prepared(a, b, 1, &verdict) == FMB_OK ? (unsigned char) verdict : 0;
}

static void single(const struct work *work)
{
    const struct fmb_prepared *prepared = work->scene->prepared;
    for (size_t i = 0; i < work->count; i++)
        work->verdicts[i] = meets(&prepared[work->pair[i][0]], &prepared[work->pair[i][1]]);
}

static void single_computed(const struct work *work)
{
    const struct fmb_placement *placement = work->scene->placement;
    for (size_t i = 0; i < work->count; i++) {
        struct fmb_prepared a, b;
        fmb_prepare(&placement[work->pair[i][0]], 0, 1, &a);
        fmb_prepare(&placement[work->pair[i][1]], 0, 1, &b);
        work->verdicts[i] = meets(&a, &b);
    }
}

/* The verdict of a method that takes touching for contact and does not report it. */
static unsigned char verdict_of(bool meets)
{
    return meets ? FMB_OVERLAPPING : FMB_SEPARATED;
}

static void sat(const struct work *work)
{
    const struct lean_frame *lean = work->scene->lean;
    for (size_t i = 0; i < work->count; i++)
        work->verdicts[i] =
            verdict_of(lean_meets(&lean[work->pair[i][0]], &lean[work->pair[i][1]], 1));
}

static void sat_placed(const struct work *work)
{
    const struct fmb_placement *placement = work->scene->placement;
    for (size_t i = 0; i < work->count; i++) {
        const struct fmb_placement *a = &placement[work->pair[i][0]],
                                   *b = &placement[work->pair[i][1]];
        struct lean_frame lean[2];
        lean_place(fmb_body_frame(a->body, 0), a, &lean[0]);
        lean_place(fmb_body_frame(b->body, 0), b, &lean[1]);
        work->verdicts[i] = verdict_of(lean_meets(&lean[0], &lean[1], 1));
    }
}

static void obb(const struct work *work)
{
    const struct oriented *oriented = work->scene->oriented;
    for (size_t i = 0; i < work->count; i++)
        work->verdicts[i] =
            verdict_of(oriented_meet(&oriented[work->pair[i][0]], &oriented[work->pair[i][1]]));
}

static void obb_placed(const struct work *work)
{
    const struct fmb_placement *placement = work->scene->placement;
    for (size_t i = 0; i < work->count; i++) {
        const struct fmb_placement *a = &placement[work->pair[i][0]],
                                   *b = &placement[work->pair[i][1]];
        struct oriented oriented[2];
        oriented_place(fmb_body_frame(a->body, 0), a, &oriented[0]);
        oriented_place(fmb_body_frame(b->body, 0), b, &oriented[1]);
        work->verdicts[i] = verdict_of(oriented_meet(&oriented[0], &oriented[1]));
    }
}

/* A frame for a pair: those of the scene, one after the other. */
static void placing(const struct work *work)
{
    const struct scene *scene = work->scene;
    struct fmb_prepared out;
    for (size_t i = 0, at = 0; i < work->count; i++, at = at + 1 < scene->count ? at + 1 : 0)
        sink += fmb_prepare(&scene->placement[at], 0, 1, &out);
}

static void run_method(const struct work *work, const char *name, unsigned want)
{
    const struct fmb_method *method = fmb_method_by_name(name);
    const struct fmb_placement *placement = work->scene->placement;
    for (size_t i = 0; i < work->count; i++) {
        struct fmb_answer answer;
        fmb_decide(method, &placement[work->pair[i][0]], &placement[work->pair[i][1]], 1, want,
                   &answer);
        work->verdicts[i] = (unsigned char) answer.verdict;
    }
}

static void query(const struct work *work)
{
    run_method(work, "certified", 0);
}

static void query_box(const struct work *work)
{
    run_method(work, "certified", FMB_WANT_BOX);
}

static void fmb(const struct work *work)
{
    run_method(work, "fmb", 0);
}

static void exact(const struct work *work)
{
    run_method(work, "exact", 0);
}

static void run_peer(const struct work *work, int peer)
{
    peer_run(work->peers, peer, work->pair, work->count, work->gaps);
    for (size_t i = 0; i < work->count; i++)
        work->verdicts[i] = isnan(work->gaps[i]) ? 0 : verdict_of(work->gaps[i] <= 0);
}

/* ---- The table ---- */

static const struct {
    const char *name;
    void (*run)(const struct work *work);
    int where;
} table[] = {
#define X(id, name, run, where) {name, run, where},
    CONTENDER_MAP(X)
#undef X
};

const char *contender_name(enum contender contender)
{
    return contender < CONTENDERS ? table[contender].name
                                  : peer_name((int) (contender - CONTENDERS));
}

static bool peer_runs(int peer, const struct cell *cell)
{
    return cell->dim == 3 && peer_name(peer) && peer_answers(peer) & PEER_VERDICT &&
           peer_takes(peer, cell->moving ? PEER_MOVING : 0);
}

bool contender_runs(enum contender contender, const struct cell *cell)
{
    if (contender >= CONTENDERS)
        return peer_runs((int) (contender - CONTENDERS), cell);
    switch (table[contender].where) {
    case ONLY_MOVING: return cell->moving;
    case ONLY_BOXES_AT_REST:
        return cell->dim == 3 && !cell->moving && cell->shape[0] == FMB_BOX &&
               cell->shape[1] == FMB_BOX;
    default: return true;
    }
}

void contender_run(enum contender contender, const struct work *work)
{
    if (contender < CONTENDERS)
        table[contender].run(work);
    else
        run_peer(work, (int) (contender - CONTENDERS));
}

double contender_wrong(enum contender contender, const struct work *work,
                       const unsigned char *certified)
{
    size_t wrong = 0;
    contender_run(contender, work);
    for (size_t i = 0; i < work->count; i++)
        wrong += certified[i] != 0 &&
                 (work->verdicts[i] == 0 ||
                  (work->verdicts[i] == FMB_SEPARATED) != (certified[i] == FMB_SEPARATED));
    return (double) wrong / (double) work->count;
}

void contender_help(void)
{
    printf(
        "batch: fmb_decide_batch(), verdicts only; +interval, +box: with these. single: "
        "fmb_decide_prepared()\n"
        "of prepared frames; computed: prepared in the call. query: fmb_decide(), certified, with\n"
        "the interval of moving pairs. fmb, exact: the same by these methods; fmb with the "
        "inverse\n"
        "kept in the body. sat: separating axes in plain doubles, verdict only, of placed frames:\n"
        "the yardstick; placed: in the call. obb: oriented boxes, the same way.\n");
}

/* ---- Races ---- */

enum { BLOCKS_MAX = 64, LEAST_PAIRS = 64 };

static double time_of(enum contender contender, const struct work *work)
{
    const double start = stopwatch_now();
    contender_run(contender, work);
    return (stopwatch_now() - start) / (double) work->count;
}

/* some: what will be timed, of all. Slow ones, that decide but some of the pairs, need no more
 * here.
 */
static void warm_up(enum contender contender, const struct work *some, const struct work *all)
{
    struct work other = *some;
    other.pair = all->warm;
    other.count =
        some->count < all->count && some->count < all->warm_count ? some->count : all->warm_count;
    contender_run(contender, &other);
}

/* As many of the pairs as the budget covers. */
static struct work cut(const struct race *race, const struct work *work, enum contender contender)
{
    struct work some = *work;
    some.count = some.count < LEAST_PAIRS ? some.count : LEAST_PAIRS;
    const double most = race->budget / time_of(contender, &some);
    if (most > (double) some.count)
        some.count = most < (double) work->count ? (size_t) most : work->count;
    return some;
}

void race_run(const struct race *race, const struct work *work, const enum contender *contenders,
              int count, struct spread *out)
{
    struct work some[CONTENDERS_AND_PEERS];
    double times[CONTENDERS_AND_PEERS][BLOCKS_MAX];
    const int blocks = race->blocks < BLOCKS_MAX ? race->blocks : BLOCKS_MAX;
    for (int i = 0; i < count; i++)
        some[i] = cut(race, work, contenders[i]);
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int i = 0; i < count; i++) {
            warm_up(contenders[i], &some[i], work);
            times[i][block] = time_of(contenders[i], &some[i]);
        }
    }
    for (int i = 0; i < count; i++)
        out[i] = spread_of(times[i], blocks);
}
