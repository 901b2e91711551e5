/* What a margin adds to a scene query. */
#include "bench.h"

#include <stdlib.h>

enum { RUNS = 3, BLOCKS_MAX = 64 };

/* meet and near: of the last run. */
struct margins {
    struct fmb_scene scene;
    struct fmb_scene_limits limits;
    void *memory;
    size_t meet, near;
};

enum { PLAIN, GAPS, MARGIN };

static const char *const keys[RUNS] = {"plain_ns", "gaps_ns", "margin_ns"};

static void run(struct margins *margins, int k, double margin)
{
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    margins->scene.want = k == GAPS ? FMB_WANT_GAP : 0;
    margins->scene.margin = k == MARGIN ? margin : 0;
    margins->meet = margins->near = 0;
    bool done = fmb_scene_begin(&margins->scene, &margins->limits, margins->memory, &state);
    while (!done) {
        done = fmb_scene_step(state, &answers);
        for (size_t i = 0; i < answers.count; i++)
            *(answers.verdicts[i] == FMB_SEPARATED ? &margins->near : &margins->meet) += 1;
    }
}

static void time_runs(const struct bench *bench, struct margins *margins, double margin,
                      double out[RUNS])
{
    double times[RUNS][BLOCKS_MAX];
    const int blocks = bench->race.blocks < BLOCKS_MAX ? bench->race.blocks : BLOCKS_MAX;
    const int rounds = bench->quick ? 1 : 10;
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int k = 0; k < RUNS; k++) {
            run(margins, k, margin);
            const double start = stopwatch_now();
            for (int round = 0; round < rounds; round++)
                run(margins, k, margin);
            times[k][block] = (stopwatch_now() - start) /
                              ((double) rounds * (double) margins->scene.placement_count);
        }
    }
    for (int k = 0; k < RUNS; k++)
        out[k] = spread_of(times[k], blocks).median;
}

/* neighbours: how many other bodies the box of each meets. */
static void row(struct bench *bench, const char *name, enum fmb_shape shape, bool moving,
                double neighbours, double margin)
{
    const size_t count = bench->quick ? 200 : 2000;
    struct scene scene = scene_of_cloud(shape, moving, neighbours, count, bench->seed);
    struct margins margins = {.scene = {.placements = scene.placement,
                                        .placement_count = count,
                                        .duration = moving,
                                        .which = FMB_PAIRS_ALL}};
    double times[RUNS];
    margins.limits = fmb_scene_limits_of(&margins.scene);
    margins.memory = scene_allocate(1, fmb_scene_bytes(&margins.limits));
    bench_progress("margins");
    time_runs(bench, &margins, margin, times);
    bench_progress(NULL);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", name);
    json_number(&bench->json, "bodies", (double) count);
    json_number(&bench->json, "neighbours", neighbours);
    json_number(&bench->json, "margin", margin);
    json_number(&bench->json, "meet", (double) margins.meet);
    json_number(&bench->json, "near", (double) margins.near);
    printf("%-18s %6g %6zu %8g %6zu", name, neighbours, margins.meet, margin, margins.near);
    for (int k = 0; k < RUNS; k++) {
        json_number(&bench->json, keys[k], times[k]);
        printf(" %8.0f", times[k]);
    }
    printf(" %8.2f %8.2f\n", times[GAPS] / times[PLAIN], times[MARGIN] / times[PLAIN]);
    json_end(&bench->json, '}');
    free(margins.memory);
    scene_free(&scene);
}

void margins_run(struct bench *bench)
{
    static const double neighbours[] = {0.1, 1, 8}, margins[] = {1e-3, 1e-2};
    printf(
        "\nScenes of bodies of about size 1 in a cloud, nanoseconds a body: verdicts; verdicts\n"
        "and gaps of pairs that meet; verdicts with a margin, and gaps of near pairs. boxes: how\n"
        "many others the box of a body meets; meet, near: pairs. Ratios to verdicts only.\n\n"
        "%-18s %6s %6s %8s %6s %8s %8s %8s %8s %8s\n",
        "", "boxes", "meet", "margin", "near", "verdicts", "gaps", "margin", "gaps", "margin");
    json_begin(&bench->json, "margins", '[');
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            row(bench, "cuboids", FMB_CUBOID, false, neighbours[i], margins[k]);
            row(bench, "tetrahedra", FMB_TETRAHEDRON, false, neighbours[i], margins[k]);
            row(bench, "moving cuboids", FMB_CUBOID, true, neighbours[i], margins[k]);
        }
    json_end(&bench->json, ']');
}
