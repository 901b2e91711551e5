/* What poses cost: placing a frame, and pairs with orientations beside the same pairs given as
 * corners, the world coordinates of which are rounded. Then contacts at rest, which doubles rarely
 * decide. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "certified.h"
#include "family.h"
#include "posed.h"
#include "rung.h"
#include "trial.h"

/* ---- Random poses ---- */

/* Both are of the same pairs. */
struct sides {
    struct arena posed, corners;
};

enum { POSED, CORNERS };

static const struct {
    enum contender contender;
    int side;
    const char *key, *title;
} runs[] = {{CONTENDER_PLACING, POSED, "placing_ns", "placing"},
            {CONTENDER_BATCH, CORNERS, "batch_corners_ns", "corners"},
            {CONTENDER_BATCH, POSED, "batch_ns", "posed"},
            {CONTENDER_SINGLE, POSED, "single_prepared_ns", "prepared"},
            {CONTENDER_SINGLE_COMPUTED, POSED, "single_ns", "single"},
            {CONTENDER_SAT_PLACED, POSED, "sat_placed_ns", "sat"},
            {CONTENDER_QUERY, POSED, "query_ns", "query"},
            {CONTENDER_OBB, POSED, "obb_ns", "obb"},
            {CONTENDER_OBB_PLACED, POSED, "obb_placed_ns", "placed"}};

enum { RUNS = sizeof runs / sizeof *runs, BLOCKS_MAX = 64 };
enum { RUN_CORNERS = 1, RUN_BATCH = 2, RUN_SINGLE = 4, RUN_SAT = 5, RUN_QUERY = 6 };

static void sides_open(const struct bench *bench, const struct cell *cell, bool in_contact,
                       struct sides *out)
{
    struct scene scene = scene_draw_posed(cell, bench->bodies, bench->seed);
    struct pairs pairs = pairs_draw_of(&scene, in_contact, 5 * bench->pairs, bench->seed);
    arena_of(bench, scene_of_corners(&scene), pairs_copy(&pairs), &out->corners);
    arena_of(bench, scene, pairs, &out->posed);
}

/* Taken in turn in each block, each warmed up with other pairs of the same bodies. NAN where it
 * does not run. */
static void time_runs(const struct bench *bench, const struct cell *cell, struct sides *sides,
                      struct spread out[RUNS])
{
    double times[RUNS][BLOCKS_MAX];
    const int blocks = bench->race.blocks < BLOCKS_MAX ? bench->race.blocks : BLOCKS_MAX;
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int k = 0; k < RUNS; k++) {
            times[k][block] = NAN;
            if (!contender_runs(runs[k].contender, cell))
                continue;
            struct work work = runs[k].side == POSED ? sides->posed.work : sides->corners.work;
            const unsigned(*timed)[2] = work.pair;
            work.pair += work.count;
            contender_run(runs[k].contender, &work);
            work.pair = timed;
            const double start = stopwatch_now();
            contender_run(runs[k].contender, &work);
            times[k][block] = (stopwatch_now() - start) / (double) work.count;
        }
    }
    for (int k = 0; k < RUNS; k++)
        out[k] = spread_of(times[k], blocks);
}

static void cell_run(struct bench *bench, const struct cell *cell, bool in_contact)
{
    struct sides sides;
    struct spread times[RUNS];
    char text[CELL_TEXT_MAX];
    bench_progress(cell_text(cell, text));
    sides_open(bench, cell, in_contact, &sides);
    time_runs(bench, cell, &sides, times);
    bench_progress(NULL);
    const double batch = times[RUN_BATCH].median / times[RUN_CORNERS].median;
    const double single = times[RUN_SINGLE].median / times[RUN_SAT].median;
    const double query = times[RUN_QUERY].median / times[RUN_SAT].median;
    printf("%-13s %-10s", text, in_contact ? "in contact" : "separated");
    json_begin(&bench->json, NULL, '{');
    bench_put_cell(&bench->json, cell);
    json_bool(&bench->json, "contact", in_contact);
    for (int k = 0; k < RUNS; k++) {
        printf(isnan(times[k].median) ? "          " : " %9.1f", times[k].median);
        json_number(&bench->json, runs[k].key, times[k].median);
    }
    printf(" %9.2f %9.2f %9.2f\n", batch, single, query);
    json_end(&bench->json, '}');
    arena_close(&sides.posed);
    arena_close(&sides.corners);
}

static void random_run(struct bench *bench)
{
    struct cell cells[CELL_OF_ALL_SHAPES];
    const int count = cell_list_all(cells);
    printf(
        "\nRandom poses, nanoseconds a frame (placing) and a pair: the batch of the same pairs "
        "given\n"
        "as corners and posed; single pairs of prepared frames, and from pose to verdict; the\n"
        "yardstick with its placing; fmb_decide(); the test of oriented boxes, placed before and "
        "in\n"
        "the call. Ratios: batch to corners, single and query to the yardstick.\n\n%-24s",
        "");
    for (int k = 0; k < RUNS; k++)
        printf(" %9s", runs[k].title);
    printf(" %9s %9s %9s\n", "batch", "single", "query");
    json_begin(&bench->json, "poses", '[');
    for (int i = 0; i < count; i++)
        for (int contact = 1; contact >= 0; contact--)
            if (cells[i].shape[0] != FMB_FACE && cells[i].shape[1] != FMB_FACE)
                cell_run(bench, &cells[i], contact);
    json_end(&bench->json, ']');
}

/* ---- How many the filter leaves open ---- */

static void unsure_run(struct bench *bench)
{
    struct cell cells[CELL_OF_ALL_SHAPES];
    const int count = cell_list_all(cells);
    const size_t pairs = bench->quick ? 1000 : 200000;
    size_t unsure = 0, all = 0, contacts = 0;
    bench_progress("unsure");
    for (int i = 0; i < count; i++) {
        struct draw draw = cell_draw(bench->seed, "unsure", &cells[i], 0);
        for (size_t n = 0; n < pairs; n++, all++) {
            struct question question;
            struct trial trial;
            enum certified_path path;
            family_draw_posed(&draw, &cells[i], &question);
            trial_begin(&question, &trial);
            const struct frame_pair frames = pair_frames(&trial.pair[0]);
            contacts += verdict_by_rung(&frames, &path) != FMB_SEPARATED;
            unsure += path != CERTIFIED_FILTER;
        }
    }
    bench_progress(NULL);
    printf(
        "\nRandom posed pairs of all shapes, %zu, %zu in contact: the filter leaves %zu open "
        "(%.2g).\n",
        all, contacts, unsure, (double) unsure / (double) all);
    json_begin(&bench->json, "unsure", '{');
    json_number(&bench->json, "pairs", (double) all);
    json_number(&bench->json, "unsure", (double) unsure);
    json_end(&bench->json, '}');
}

/* ---- At rest ---- */

static struct scene scene_of_family(const struct bench *bench, const char *name, bool moving,
                                    size_t pairs)
{
    const struct cell cell = {3, moving, {FMB_BOX, FMB_BOX}};
    struct draw draw = cell_draw(bench->seed, name, &cell, 0);
    const struct family *family = NULL;
    for (size_t i = 0; !family; i++)
        family = strcmp(family_posed_at(i)->name, name) == 0 ? family_posed_at(i) : NULL;
    struct question *questions = scene_allocate(pairs, sizeof *questions);
    for (size_t i = 0; i < pairs; i++)
        family_draw(family, &cell, &draw, &questions[i]);
    struct scene scene = scene_of_questions(questions, pairs);
    free(questions);
    return scene;
}

static void rest_of_family(struct bench *bench, const char *name, const char *family, bool moving)
{
    static const enum contender raced[] = {CONTENDER_BATCH, CONTENDER_BATCH_BOX, CONTENDER_SINGLE,
                                           CONTENDER_QUERY, CONTENDER_QUERY_BOX, CONTENDER_EXACT};
    static const char *const keys[] = {"batch_ns", "batch_box_ns", "single_ns",
                                       "query_ns", "box_ns",       "exact_ns"};
    enum { RACED = sizeof raced / sizeof *raced };
    const size_t pairs = bench->quick ? 200 : 5000;
    struct race race = {bench->race.blocks < 9 ? bench->race.blocks : 9, 100 * bench->race.budget};
    struct spread times[RACED];
    struct scene scene = scene_of_family(bench, family, moving, pairs);
    struct pairs both = {pairs, scene_allocate(pairs, sizeof *both.at)};
    size_t touching = 0;
    for (unsigned i = 0; i < pairs; i++) {
        enum fmb_verdict verdict = FMB_SEPARATED;
        both.at[i][0] = i;
        both.at[i][1] = (unsigned) pairs + i;
        fmb_decide_prepared(&scene.prepared[i], &scene.prepared[pairs + i], 1, &verdict);
        touching += verdict == FMB_TOUCHING;
    }
    struct work work = work_of(&scene, &both);
    work.instructions = bench->instructions;
    bench_progress(name);
    race_run(&race, &work, raced, RACED, times);
    bench_progress(NULL);
    printf("%-44s %5.1f %%", name, 100 * (double) touching / (double) pairs);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", family);
    json_bool(&bench->json, "moving", moving);
    json_number(&bench->json, "touching", (double) touching / (double) pairs);
    for (int k = 0; k < RACED; k++) {
        printf(" %9.1f", times[k].median);
        json_number(&bench->json, keys[k], times[k].median);
    }
    json_end(&bench->json, '}');
    putchar('\n');
    work_free(&work);
    pairs_free(&both);
    scene_free(&scene);
}

static void rest_run(struct bench *bench)
{
    printf(
        "\nBoxes at rest and nearly so, nanoseconds a pair; the share that touches.\n\n%-44s %7s "
        "%9s %9s %9s %9s %9s %9s\n",
        "", "touch", "batch", "batch+box", "single", "query", "query+box", "exact");
    json_begin(&bench->json, "rest", '[');
    rest_of_family(bench, "cubes on a table, by yaw, rolled or not", "pose-yaw", false);
    rest_of_family(bench, "the same, sliding", "pose-yaw", true);
    rest_of_family(bench, "boxes sunk into a table, with a tilt", "pose-sunk", false);
    rest_of_family(bench, "the same, sliding", "pose-sunk", true);
    rest_of_family(bench, "quarter, half and third turns, touching", "pose-turns", false);
    rest_of_family(bench, "quarter turns of libm", "pose-turns-libm", false);
    rest_of_family(bench, "whole numbers up to 3, touching", "pose-whole-3", false);
    rest_of_family(bench, "whole numbers of 8 bits, touching", "pose-whole-255", false);
    rest_of_family(bench, "any pose for both, touching", "pose-shared", false);
    rest_of_family(bench, "equal orientations, touching or nearly", "pose-stacked", false);
    rest_of_family(bench, "any poses, touching or nearly", "pose-near", false);
    json_end(&bench->json, ']');
}

void poses_run(struct bench *bench)
{
    if (!bench_wants(bench, "poses"))
        return;
    random_run(bench);
    unsure_run(bench);
    rest_run(bench);
}
