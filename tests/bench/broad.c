/* Which pairs may meet: a tree of boxes, beside what it stands for: sorting along one axis, and
 * deciding every pair. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "aabb.h"

enum { BLOCKS_MAX = 5, PAIRS_MAX = 1024 };

/* What a block of a scene is: frames, a tree of them, and memory for what is found. */
struct broad {
    const struct scene *scene;
    void *memory;
    struct fmb_tree tree;
    struct end *end;            /* [count] */
    unsigned (*pairs)[2];       /* [PAIRS_MAX] */
    unsigned char *verdicts;    /* [PAIRS_MAX] */
    size_t candidates, meeting; /* of the last that was run */
};

/* ---- Sorted along one axis ---- */

struct end {
    double low;
    unsigned index;
    struct aabb box, against;
};

static int compare_ends(const void *one, const void *other)
{
    const double x = ((const struct end *) one)->low, y = ((const struct end *) other)->low;
    return (x > y) - (x < y);
}

/* Frames in the order in which they begin along x; each with those that begin before it ends. */
static void run_sweep(struct broad *broad)
{
    const size_t count = broad->scene->count;
    struct end *end = broad->end;
    for (size_t i = 0; i < count; i++) {
        end[i].box = aabb_of(&broad->scene->prepared[i], 1);
        end[i].against = aabb_probe(&end[i].box);
        end[i].low = end[i].box.end[0][0];
        end[i].index = (unsigned) i;
    }
    qsort(end, count, sizeof *end, compare_ends);
    broad->candidates = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count && end[j].low <= end[i].against.end[0][0]; j++)
            if (aabb_overlaps(&end[j].box, &end[i].against)) {
                unsigned *pair = broad->pairs[broad->candidates++ % PAIRS_MAX];
                pair[0] = end[i].index;
                pair[1] = end[j].index;
            }
}

/* ---- The tree ---- */

static void put_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct scene *scene = context;
    fmb_box_of(&scene->prepared[index], 1, box);
}

static void run_build(struct broad *broad)
{
    const struct fmb_boxes boxes = {prepared_kind(broad->scene->prepared) & PREPARED_3D ? 3 : 2,
                                    put_box, broad->scene, NULL};
    fmb_tree_build(&boxes, broad->scene->count, 1, broad->memory, &broad->tree);
}

static void run_pairs(struct broad *broad)
{
    struct fmb_tree_cursor cursor = {0};
    broad->candidates = 0;
    for (size_t count = 1; count > 0; broad->candidates += count)
        fmb_tree_pairs(&broad->tree, &broad->tree, &cursor, broad->pairs, PAIRS_MAX, &count);
}

/* ---- Verdicts ---- */

static void decide(struct broad *broad, size_t count)
{
    const struct fmb_batch batch = {.frames = broad->scene->prepared,
                                    .frame_count = broad->scene->count,
                                    .pairs = (const unsigned(*)[2]) broad->pairs,
                                    .pair_count = count,
                                    .duration = 1,
                                    .verdicts = broad->verdicts};
    fmb_decide_batch(&batch);
    for (size_t k = 0; k < count; k++)
        broad->meeting += broad->verdicts[k] != FMB_SEPARATED;
}

/* From frames to verdicts. */
static void run_whole(struct broad *broad)
{
    struct fmb_tree_cursor cursor = {0};
    broad->meeting = 0;
    run_build(broad);
    for (size_t count = 1; count > 0;) {
        fmb_tree_pairs(&broad->tree, &broad->tree, &cursor, broad->pairs, PAIRS_MAX, &count);
        decide(broad, count);
    }
}

static void run_every(struct broad *broad)
{
    size_t count = 0;
    broad->meeting = 0;
    for (unsigned i = 0; i < broad->scene->count; i++)
        for (unsigned j = i + 1; j < broad->scene->count; j++) {
            broad->pairs[count][0] = i;
            broad->pairs[count][1] = j;
            if (++count == PAIRS_MAX) {
                decide(broad, count);
                count = 0;
            }
        }
    decide(broad, count);
}

/* ---- The section ---- */

static const struct {
    const char *name, *key;
    void (*run)(struct broad *broad);
    size_t most; /* frames */
} runs[] = {{"build", "build_ns", run_build, SIZE_MAX},
            {"pairs", "pairs_ns", run_pairs, SIZE_MAX},
            {"sweep", "sweep_ns", run_sweep, SIZE_MAX},
            {"whole", "whole_ns", run_whole, SIZE_MAX},
            {"every", "every_ns", run_every, 3000}};

enum { RUNS = sizeof runs / sizeof *runs };

static bool is_run(const struct broad *broad, int k)
{
    return broad->scene->count <= runs[k].most;
}

/* Nanoseconds a frame of each, taken in turn; NAN where there are too many. What was counted has to
 * be the same for all. */
static void time_runs(const struct bench *bench, struct broad *broad, struct spread out[RUNS])
{
    double times[RUNS][BLOCKS_MAX];
    const size_t count = broad->scene->count;
    const int blocks = bench->quick ? 2 : BLOCKS_MAX;
    const size_t rounds = count < 10000 && !bench->quick ? 10000 / count : 1;
    size_t candidates = 0, meeting = 0;
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int k = 0; k < RUNS; k++) {
            const size_t times_run = runs[k].run == run_every ? 1 : rounds;
            const double start = stopwatch_now();
            for (size_t round = 0; round < times_run && is_run(broad, k); round++)
                runs[k].run(broad);
            times[k][block] = (stopwatch_now() - start) / ((double) count * (double) times_run);
            candidates = runs[k].run == run_pairs ? broad->candidates : candidates;
            meeting = runs[k].run == run_whole ? broad->meeting : meeting;
        }
        if (broad->candidates != candidates || broad->meeting != meeting) {
            fputs("bench: a pair is lost\n", stderr);
            exit(EXIT_FAILURE);
        }
    }
    for (int k = 0; k < RUNS; k++)
        out[k] = is_run(broad, k) ? spread_of(times[k], blocks) : (struct spread){NAN, NAN, NAN};
}

static void put(struct bench *bench, const char *name, const struct broad *broad,
                const struct spread times[RUNS])
{
    const double count = (double) broad->scene->count;
    bench_progress(NULL);
    printf("%-16s %7.0f %8.2f", name, count, (double) broad->candidates / count);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", name);
    json_number(&bench->json, "frames", count);
    json_number(&bench->json, "bytes", (double) fmb_tree_bytes(broad->scene->count));
    json_number(&bench->json, "candidates", (double) broad->candidates);
    json_number(&bench->json, "meeting", (double) broad->meeting);
    for (int k = 0; k < RUNS; k++) {
        if (isnan(times[k].median))
            printf(" %9s", "");
        else
            printf(" %9.1f", times[k].median);
        json_number(&bench->json, runs[k].key, times[k].median);
    }
    json_end(&bench->json, '}');
    putchar('\n');
}

static void broad_of(struct bench *bench, const char *name, enum fmb_shape shape, bool moving,
                     size_t count)
{
    const double neighbours = 8;
    struct spread times[RUNS];
    bench_progress(name);
    struct scene scene = scene_of_cloud(shape, moving, neighbours, count, bench->seed);
    struct broad broad = {.scene = &scene,
                          .memory = scene_allocate(1, fmb_tree_bytes(count)),
                          .end = scene_allocate(count, sizeof *broad.end),
                          .pairs = scene_allocate(PAIRS_MAX, sizeof *broad.pairs),
                          .verdicts = scene_allocate(PAIRS_MAX, 1)};
    time_runs(bench, &broad, times);
    put(bench, name, &broad, times);
    free(broad.memory);
    free(broad.end);
    free(broad.pairs);
    free(broad.verdicts);
    scene_free(&scene);
}

void broad_run(struct bench *bench)
{
    const size_t most = bench->quick ? 1000 : 100000;
    if (!bench_wants(bench, "broad"))
        return;
    printf(
        "\nWhich pairs may meet, frames in a cloud; candidates, and nanoseconds, of a frame. "
        "Tree:\n"
        "build, pairs. sweep: sorted along one axis.\n"
        "whole: tree, pairs and their verdicts; every: the verdicts of all pairs there are.\n\n");
    printf("%-16s %7s %8s", "", "frames", "pairs");
    for (int k = 0; k < RUNS; k++)
        printf(" %9s", runs[k].name);
    putchar('\n');
    json_begin(&bench->json, "broad", '[');
    for (size_t count = 100; count <= most; count *= 10) {
        broad_of(bench, "cuboids", FMB_CUBOID, false, count);
        broad_of(bench, "moving cuboids", FMB_CUBOID, true, count);
        broad_of(bench, "faces", FMB_FACE, false, count);
        broad_of(bench, "moving faces", FMB_FACE, true, count);
    }
    json_end(&bench->json, ']');
}
