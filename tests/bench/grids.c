/* Scenes full of contacts: cubes in a grid, each with its neighbours. */
#include "bench.h"

enum { ASKED = 4 };

static const enum contender asked[ASKED] = {CONTENDER_QUERY, CONTENDER_BATCH, CONTENDER_EXACT,
                                            CONTENDER_QUERY_BOX};
static const char *const keys[ASKED] = {"certified_ns", "batch_ns", "exact_ns", "box_ns"};

static void grid_run(struct bench *bench, const char *name, double pitch, int side)
{
    struct race race = {bench->race.blocks < 5 ? bench->race.blocks : 5, 10 * bench->race.budget};
    struct spread times[ASKED];
    struct scene scene = scene_of_grid(pitch, side);
    struct pairs pairs = pairs_of_grid(side);
    struct work work = work_of(&scene, &pairs);
    work.instructions = bench->instructions;
    bench_progress(name);
    race_run(&race, &work, asked, ASKED, times);
    bench_progress(NULL);
    printf("%-28s %7zu", name, pairs.count);
    json_open(&bench->json, NULL, '{');
    json_text(&bench->json, "name", name);
    json_number(&bench->json, "pairs", (double) pairs.count);
    for (int i = 0; i < ASKED; i++) {
        printf(" %10.1f", times[i].median);
        json_number(&bench->json, keys[i], times[i].median);
    }
    json_close(&bench->json, '}');
    putchar('\n');
    work_free(&work);
    pairs_free(&pairs);
    scene_free(&scene);
}

void grids_run(struct bench *bench)
{
    const int side = bench->quick ? 8 : 22;
    if (!bench_wants(bench, "grids"))
        return;
    printf("\n%d cubes in a grid, every one with its neighbours, nanoseconds a pair.\n\n",
           side * side * side);
    printf("%-28s %7s %10s %10s %10s %10s\n", "", "pairs", "query", "batch", "exact", "query+box");
    json_open(&bench->json, "grids", '[');
    grid_run(bench, "pitch 1, all touch", 1, side);
    grid_run(bench, "pitch 0.1, an ulp either way", 0.1, side);
    json_close(&bench->json, ']');
}
