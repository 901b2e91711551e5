/* How the batch does: with each set of instructions; and as scenes and calls grow, from what the
 * nearest cache holds to what none does. */
#include "bench.h"

#include <stdlib.h>
#include <unistd.h>

/* ---- Instructions ---- */

static void instructions_of_cell(struct bench *bench, const struct cell *cell)
{
    char text[CELL_TEXT_MAX];
    struct arena arena;
    arena_open(bench, cell, true, &arena);
    printf("%-13s in contact", cell_text(cell, text));
    for (int set = INSTRUCTIONS_PLAIN; set <= INSTRUCTIONS_AVX512; set++) {
        if (!instructions_supported(set))
            continue;
        const enum contender batch = CONTENDER_BATCH;
        struct spread times;
        arena.work.instructions = (enum instructions) set;
        race_run(&bench->race, &arena.work, &batch, 1, &times);
        printf("   %s %.1f", instructions_name(set), times.median);
        json_begin(&bench->json, NULL, '{');
        json_string(&bench->json, "name", instructions_name(set));
        json_string(&bench->json, "cell", text);
        json_bool(&bench->json, "contact", true);
        json_number(&bench->json, "ns", times.median);
        json_number(&bench->json, "low", times.low);
        json_number(&bench->json, "high", times.high);
        json_end(&bench->json, '}');
    }
    putchar('\n');
    arena_close(&arena);
}

void instructions_run(struct bench *bench)
{
    static const struct cell cells[] = {{3, false, {FMB_CUBOID, FMB_CUBOID}},
                                        {3, false, {FMB_TETRAHEDRON, FMB_TETRAHEDRON}},
                                        {3, true, {FMB_CUBOID, FMB_CUBOID}},
                                        {2, false, {FMB_CUBOID, FMB_CUBOID}}};
    if (!bench_wants(bench, "instructions"))
        return;
    printf(
        "\nThe batch with each set of instructions that this machine and this build have,\n"
        "nanoseconds a pair.\n\n");
    json_begin(&bench->json, "instructions", '[');
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
        instructions_of_cell(bench, &cells[i]);
    json_end(&bench->json, ']');
}

/* ---- Growth ---- */

/* Memory for a scene and its answers. */
static const double most_bytes = 2e9;

static double bytes_of(double bodies, double pairs)
{
    return bodies * (sizeof(struct fmb_prepared) + sizeof(struct fmb_body) +
                     sizeof(struct fmb_placement)) +
           pairs * (2 * sizeof(unsigned) + 1 + 8 * 8);
}

/* Nanoseconds a pair: all pairs, in calls of so many. */
static struct spread time_in_calls(const struct bench *bench, const struct work *work, size_t call)
{
    double times[8];
    const int blocks = bench->quick ? 2 : work->count > 1000000 ? 3 : 5;
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        const double start = stopwatch_now();
        for (size_t at = 0; at < work->count; at += call) {
            struct work some = *work;
            some.pair += at;
            some.verdicts += at;
            some.count = work->count - at < call ? work->count - at : call;
            contender_run(CONTENDER_BATCH, &some);
        }
        times[block] = (stopwatch_now() - start) / (double) work->count;
    }
    return spread_of(times, blocks);
}

static const struct cell growing = {3, false, {FMB_CUBOID, FMB_CUBOID}};

static void put(struct bench *bench, size_t bodies, size_t pairs, struct spread times)
{
    json_begin(&bench->json, NULL, '{');
    json_number(&bench->json, "bodies", (double) bodies);
    json_number(&bench->json, "pairs", (double) pairs);
    json_number(&bench->json, "bytes", (double) (bodies * sizeof(struct fmb_prepared)));
    json_number(&bench->json, "ns", times.median);
    json_number(&bench->json, "low", times.low);
    json_number(&bench->json, "high", times.high);
    json_end(&bench->json, '}');
    bench_progress(NULL);
    printf("%10zu bodies (%.3g MB), %9zu pairs: %8.1f ns a pair\n", bodies,
           (double) (bodies * sizeof(struct fmb_prepared)) / 1e6, pairs, times.median);
}

static void grow_bodies(struct bench *bench)
{
    const size_t most = bench->quick ? 10000 : 1000000, count = bench->quick ? 10000 : 1000000;
    for (size_t bodies = 10; bodies <= most; bodies *= 10) {
        if (bytes_of((double) bodies, (double) count) > most_bytes)
            continue;
        bench_progress("growth, bodies");
        struct scene scene = scene_draw(&growing, bodies, bench->seed);
        struct pairs pairs = pairs_draw(&scene, count, bench->seed);
        struct work work = work_of(&scene, &pairs);
        work.instructions = bench->instructions;
        put(bench, bodies, count, time_in_calls(bench, &work, count));
        work_free(&work);
        pairs_free(&pairs);
        scene_free(&scene);
    }
}

/* Small calls go on through the pairs, so that each is decided once in turn. */
static void grow_pairs(struct bench *bench)
{
    const size_t most = bench->quick ? 10000 : 10000000;
    struct scene scene = scene_draw(&growing, bench->bodies, bench->seed);
    for (size_t call = 10; call <= most; call *= 10) {
        const size_t all = call < 100000 ? 100000 : call, count = bench->quick ? 10000 : all;
        if (bytes_of((double) scene.count, (double) count) > most_bytes)
            continue;
        bench_progress("growth, pairs");
        struct pairs pairs = pairs_draw(&scene, count, bench->seed);
        struct work work = work_of(&scene, &pairs);
        work.instructions = bench->instructions;
        put(bench, scene.count, call, time_in_calls(bench, &work, call));
        work_free(&work);
        pairs_free(&pairs);
    }
    scene_free(&scene);
}

void growth_run(struct bench *bench)
{
    if (!bench_wants(bench, "growth"))
        return;
    printf("\nThe batch as scenes grow, and as calls do: 3D static cuboids, random pairs.\n\n");
    json_begin(&bench->json, "growth", '{');
    json_begin(&bench->json, "bodies", '[');
    grow_bodies(bench);
    json_end(&bench->json, ']');
    json_begin(&bench->json, "pairs", '[');
    grow_pairs(bench);
    json_end(&bench->json, ']');
    json_end(&bench->json, '}');
}
