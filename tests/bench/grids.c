/* Scenes full of contacts: cubes in a grid, each with its neighbours; and pairs that touch. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

#include "certified.h"
#include "family.h"
#include "trial.h"

/* ---- Grids ---- */

enum { TIMED = 6 };

static const enum contender timed[TIMED] = {CONTENDER_QUERY,     CONTENDER_BATCH,  CONTENDER_EXACT,
                                            CONTENDER_QUERY_BOX, CONTENDER_SINGLE, CONTENDER_SAT};
static const char *const keys[TIMED] = {"certified_ns", "batch_ns",  "exact_ns",
                                        "box_ns",       "single_ns", "sat_ns"};

static void grid_run(struct bench *bench, const char *name, double pitch, int side)
{
    struct race race = {bench->race.blocks < 5 ? bench->race.blocks : 5, 10 * bench->race.budget};
    struct spread times[TIMED];
    struct scene scene = scene_of_grid(pitch, side);
    struct pairs pairs = pairs_of_grid(side);
    struct work work = work_of(&scene, &pairs);
    work.instructions = bench->instructions;
    bench_progress(name);
    race_run(&race, &work, timed, TIMED, times);
    bench_progress(NULL);
    printf("%-28s %7zu", name, pairs.count);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", name);
    json_number(&bench->json, "pairs", (double) pairs.count);
    for (int i = 0; i < TIMED; i++) {
        printf(" %10.1f", times[i].median);
        json_number(&bench->json, keys[i], times[i].median);
    }
    json_end(&bench->json, '}');
    putchar('\n');
    work_free(&work);
    pairs_free(&pairs);
    scene_free(&scene);
}

/* ---- Pairs that touch ---- */

enum { TOUCHING = 4, KINDS = 2 };

static const enum contender touching_timed[TOUCHING] = {CONTENDER_BATCH, CONTENDER_SINGLE,
                                                        CONTENDER_QUERY, CONTENDER_SAT};
static const char *const touching_keys[TOUCHING] = {"batch_ns", "single_ns", "certified_ns",
                                                    "sat_ns"};
static const char *const kinds[KINDS] = {"doubles", "integers"};

/* 1: the verdict takes integers. */
static int kind_of(const struct question *question)
{
    struct trial trial;
    enum certified_path path;
    trial_begin(question, &trial);
    const struct frame_pair frames = pair_frames(&trial.pair[0]);
    certified_verdict(&frames, &path);
    return path == CERTIFIED_LIMBS || path == CERTIFIED_EXACT;
}

/* Pairs of the cell that touch exactly, vertices on edges and so on: of each kind so many. */
static void draw_touching(const struct bench *bench, const struct cell *cell, size_t count,
                          struct question *out[KINDS])
{
    struct draw draw = cell_draw(bench->seed, "touching", cell, 0);
    size_t drawn[KINDS] = {0};
    for (size_t i = 0; drawn[0] < count || drawn[1] < count; i = i < 64 ? i + 1 : 0) {
        const struct family *family = family_at(i);
        struct question question;
        if (!family || strncmp(family->name, "touch-", 6) != 0 || !family_has_cell(family, cell) ||
            (family->cells & FAMILY_3D && cell->dim == 2))
            continue;
        family_draw(family, cell, &draw, &question);
        const int kind = kind_of(&question);
        if (drawn[kind] < count)
            out[kind][drawn[kind]++] = question;
    }
}

static void touching_kind_run(struct bench *bench, const char *kind, size_t count,
                              const struct question *questions)
{
    struct race race = {bench->race.blocks < 9 ? bench->race.blocks : 9, 10 * bench->race.budget};
    struct spread times[TOUCHING];
    struct scene scene = scene_of_questions(questions, count);
    struct pairs pairs = {count, scene_allocate(count, sizeof *pairs.at)};
    for (unsigned i = 0; i < count; i++) {
        pairs.at[i][0] = i;
        pairs.at[i][1] = (unsigned) count + i;
    }
    struct work work = work_of(&scene, &pairs);
    work.instructions = bench->instructions;
    race_run(&race, &work, touching_timed, TOUCHING, times);
    json_begin(&bench->json, kind, '{');
    for (int i = 0; i < TOUCHING; i++) {
        printf(" %8.1f", times[i].median);
        json_number(&bench->json, touching_keys[i], times[i].median);
    }
    json_end(&bench->json, '}');
    work_free(&work);
    pairs_free(&pairs);
    scene_free(&scene);
}

static void touching_cell_run(struct bench *bench, const struct cell *cell)
{
    const size_t count = bench->quick ? 100 : 4000;
    struct question *questions[KINDS];
    char text[CELL_TEXT_MAX];
    for (int kind = 0; kind < KINDS; kind++)
        questions[kind] = scene_allocate(count, sizeof *questions[kind]);
    draw_touching(bench, cell, count, questions);
    bench_progress(cell_text(cell, text));
    printf("%-14s", cell_text(cell, text));
    json_begin(&bench->json, NULL, '{');
    bench_put_cell(&bench->json, cell);
    for (int kind = 0; kind < KINDS; kind++) {
        touching_kind_run(bench, kinds[kind], count, questions[kind]);
        free(questions[kind]);
    }
    json_end(&bench->json, '}');
    bench_progress(NULL);
    putchar('\n');
}

static void touching_run(struct bench *bench)
{
    struct cell cells[CELL_ORDINARY];
    const int count = cell_list(false, cells);
    printf("\nPairs that touch, where doubles do not round and where they do.\n\n%-14s", "");
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < TOUCHING; i++)
            printf(" %8s", contender_name(touching_timed[i]));
    putchar('\n');
    json_begin(&bench->json, "touching", '[');
    for (int i = 0; i < count; i++)
        touching_cell_run(bench, &cells[i]);
    json_end(&bench->json, ']');
}

void grids_run(struct bench *bench)
{
    const int side = bench->quick ? 8 : 22;
    if (!bench_wants(bench, "grids"))
        return;
    printf("\n%d cubes in a grid, every one with its neighbours, nanoseconds a pair.\n\n",
           side * side * side);
    printf("%-28s %7s %10s %10s %10s %10s %10s %10s\n", "", "pairs", "query", "batch", "exact",
           "query+box", "single", "sat");
    json_begin(&bench->json, "grids", '[');
    grid_run(bench, "pitch 1, all touch", 1, side);
    grid_run(bench, "pitch 0.1, an ulp either way", 0.1, side);
    json_end(&bench->json, ']');
    touching_run(bench);
}
