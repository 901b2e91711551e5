/* How fast logs are gone through, beside what they cannot be faster than:
 *
 *   scenes  fmb replay of a log of scenes, in pairs a second, beside fmb_decide_batch() by itself
 *           on the same pairs, whose frames have been prepared before
 *   pairs   fmb replay of a log of pair queries, in queries a second
 *   info    fmb log info, in bytes a second, beside cat of the same file to /dev/null
 *
 * In turns, on one core; CPU time of the thread or, of programs, of the child, reading included
 * (from memory: the logs have been read once before). Medians. */
#include "allocate.h"
#include "definitions.h"
#include "geometry_write.h"
#include "child.h"
#include "input.h"
#include "machine.h"
#include "replay.h"
#include "stopwatch.h"
#include "wire.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROUNDS = 15, SCENES_MAX = 400, FRAMES = 65536 };

static _Noreturn void fail(const char *what)
{
    fprintf(stderr, "bench-replay: %s\n", what);
    exit(1);
}

/* ---- The batch by itself ---- */

/* A scene of the log, ready for the batch. */
struct scene {
    struct placed {
        struct fmb_body body;
        struct fmb_placement placement;
    } * placed;                 /* owned: the prepared frames refer to them */
    struct fmb_prepared *frame; /* owned */
    unsigned (*pair)[2];        /* owned */
    size_t frame_count, pair_count;
    double duration;
};

struct scenes {
    struct scene scene[SCENES_MAX];
    int count;
    int64_t pairs;
    unsigned char verdict[QUERY_PAIRS_MAX];
};

/* A body of one frame. A placement by handle has the geometry that the log defines. */
static void prepare(const struct query_placement *placement, struct definitions *definitions,
                    struct placed *placed, struct fmb_prepared *out)
{
    const struct body_view *geometry = &placement->body;
    struct plain_frame frame;
    double numbers[FMB_FRAME_NUMBERS_MAX];
    if (query_by_handle(placement) &&
        !(geometry = definitions_find(definitions, &placement->body.handle)))
        fail("a handle that the log does not define");
    struct geometry_reader reader = geometry_begin(geometry);
    const int dim = reader.dim;
    if (!geometry_read(&reader, &frame))
        fail("a frame of the log is none");
    const int count = geometry_number_count(dim, frame.shape, 0);
    memcpy(numbers, frame.origin, (size_t) dim * sizeof *numbers);
    memcpy(numbers + dim, frame.components, (size_t) (count - dim) * sizeof *numbers);
    placed->placement = placement->placed;
    placed->placement.body = &placed->body;
    if (fmb_body_make(dim, frame.shape, numbers, (size_t) count, &placed->body) != FMB_OK ||
        fmb_prepare(&placed->placement, 0, 1, out) != FMB_OK)
        fail("a frame of the log is none");
}

static void keep_scene(struct scenes *scenes, struct definitions *definitions,
                       const struct scene_query *query)
{
    struct scene *scene = &scenes->scene[scenes->count++];
    scene->frame_count = (size_t) query->placement_count;
    scene->pair_count = (size_t) query->index_count / 2;
    scene->duration = query->duration;
    scene->frame = aligned_alloc(64, scene->frame_count * sizeof *scene->frame);
    scene->placed = calloc(scene->frame_count, sizeof *scene->placed);
    scene->pair = malloc(scene->pair_count * sizeof *scene->pair);
    if (!scene->frame || !scene->placed || !scene->pair)
        fail("no memory");
    memcpy(scene->pair, query->pair, scene->pair_count * sizeof *scene->pair);
    for (size_t i = 0; i < scene->frame_count; i++)
        prepare(&query->placement[i], definitions, &scene->placed[i], &scene->frame[i]);
    scenes->pairs += (int64_t) scene->pair_count;
}

static void read_scenes(char *path, struct scenes *scenes)
{
    static struct scene_query query;
    const struct log_channels channels = log_channels("");
    struct definitions *definitions = definitions_open();
    struct input input;
    struct log_event event;
    struct log_damage damage;
    if (!input_open(&input, &path, 1))
        fail(path);
    while (scenes->count < SCENES_MAX && input_next(&input, &event, &damage) == LOG_EVENT) {
        if (log_kind_of(&channels, &event) != LOG_SCENE_QUERY ||
            wire_read_scene_query(event.data, (uint32_t) event.kept, &query))
            continue;
        definitions_add_message(definitions, NULL, LOG_SCENE_QUERY, event.data,
                                (uint32_t) event.kept);
        if (query.index_count > 0)
            keep_scene(scenes, definitions, &query);
    }
    input_close(&input);
    definitions_close(definitions);
}

static double batch_ns(struct scenes *scenes)
{
    const double begin = stopwatch_now();
    for (int i = 0; i < scenes->count; i++) {
        const struct scene *scene = &scenes->scene[i];
        const struct fmb_batch batch = {.frames = scene->frame,
                                        .frame_count = scene->frame_count,
                                        .pairs = (const unsigned(*)[2]) scene->pair,
                                        .pair_count = scene->pair_count,
                                        .duration = scene->duration,
                                        .verdicts = scenes->verdict};
        if (fmb_decide_batch(&batch) != FMB_OK)
            fail("the batch refused");
    }
    return stopwatch_now() - begin;
}

/* ---- Replay ---- */

static void no_found(void *user, const struct difference *found)
{
    (void) user;
    (void) found;
    fail("a difference");
}

static void no_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    (void) user;
    (void) place;
    (void) channel;
    fail(what);
}

static void no_damage(void *user, int log, const struct log_damage *damage)
{
    (void) user;
    (void) log;
    fail(damage->what);
}

static void no_progress(void *user, int64_t bytes, int64_t of)
{
    (void) of;
    (void) user;
    (void) bytes;
}

static double replay_ns(char *path, struct tally *tally)
{
    const struct replay_sink sink = {no_found, no_unreadable, no_damage, no_progress, NULL};
    const struct replay_options options = {
        .log = &path, .log_count = 1, .prefix = "", .to = INFINITY, .frames = FRAMES};
    memset(tally, 0, sizeof *tally);
    const double begin = stopwatch_now();
    if (!replay_run(&options, &sink, tally))
        fail("the replay failed");
    const double took = stopwatch_now() - begin;
    const struct tally_channel both = tally_both(tally);
    if (tally_compared(&both) != both.queries)
        fail("not all was compared");
    return took;
}

/* ---- The benchmark ---- */

static void bench_scenes(char *path)
{
    static struct scenes scenes;
    static struct tally tally;
    double batch[ROUNDS], replay[ROUNDS], ratio[ROUNDS];
    read_scenes(path, &scenes);
    for (int round = 0; round < ROUNDS; round++) {
        batch[round] = batch_ns(&scenes) / (double) scenes.pairs;
        replay[round] = replay_ns(path, &tally);
        replay[round] /= (double) (tally.channel[TALLY_SCENES].pairs);
        ratio[round] = batch[round] / replay[round];
    }
    printf("scenes  %8.1f million pairs a second   batch alone %8.1f   ratio %.2f\n",
           1e3 / spread_of(replay, ROUNDS).median, 1e3 / spread_of(batch, ROUNDS).median,
           spread_of(ratio, ROUNDS).median);
}

static void bench_pairs(char *path)
{
    static struct tally tally;
    double replay[ROUNDS];
    for (int round = 0; round < ROUNDS; round++)
        replay[round] = replay_ns(path, &tally) / (double) tally_both(&tally).queries;
    const struct spread spread = spread_of(replay, ROUNDS);
    printf("pairs   %8.3f million queries a second (%.0f ns; quartiles %.0f, %.0f)   %s\n",
           1e3 / spread.median, spread.median, spread.low, spread.high, path);
}

static void bench_info(const char *fmb, const char *path)
{
    const char *info[] = {fmb, "log", "info", path, NULL}, *cat[] = {"cat", path, NULL};
    double of_info[ROUNDS], of_cat[ROUNDS], ratio[ROUNDS];
    const int fd = open(path, O_RDONLY);
    const double size = (double) lseek(fd, 0, SEEK_END);
    close(fd);
    for (int round = 0; round < ROUNDS; round++) {
        of_info[round] = child_run(info).cpu_ns / size;
        of_cat[round] = child_run(cat).cpu_ns / size;
        ratio[round] = of_cat[round] / of_info[round];
    }
    printf("info    %8.2f GB a second   cat %8.2f   ratio %.2f   %s\n",
           1 / spread_of(of_info, ROUNDS).median, 1 / spread_of(of_cat, ROUNDS).median,
           spread_of(ratio, ROUNDS).median, path);
}

int main(int argc, char **argv)
{
    char cpu[MACHINE_TEXT_MAX];
    if (argc < 4) {
        fprintf(stderr, "usage: bench-replay FMB SCENES.LOG PAIRS.LOG...\n");
        return 2;
    }
    stopwatch_pin();
    printf("%s, %s\n", machine_cpu(cpu), machine_compiler());
    bench_scenes(argv[2]);
    for (int i = 3; i < argc; i++)
        bench_pairs(argv[i]);
    for (int i = 2; i < argc; i++)
        bench_info(argv[1], argv[i]);
    return 0;
}
