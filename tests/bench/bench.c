/* The benchmark: the cost of a verdict, by kind of pair and by method; the cost of other answers;
 * and the worst pairs that were found. */
#include "bench.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "instruction_sets.h"
#include "machine.h"
#include "bench_options.h"

/* Of the loop that is always the same: more than this, and no time is to be believed to the last
 * few per cent. */
static const double much_noise = 0.05;

bool bench_wants(const struct bench *bench, const char *section)
{
    return !bench->section || strcmp(bench->section, section) == 0;
}

void bench_progress(const char *text)
{
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r%-40s\r", text ? text : "");
    fflush(stdout);
}

void bench_put_cell(struct json_writer *json, const struct cell *cell)
{
    char text[CELL_TEXT_MAX];
    json_number(json, "dim", cell->dim);
    json_bool(json, "moving", cell->moving);
    json_string(json, "shapes", cell_shapes_text(cell, text));
}

void arena_of(const struct bench *bench, struct scene scene, struct pairs pairs, struct arena *out)
{
    out->scene = scene;
    out->pairs = pairs;
    out->work = work_of(&out->scene, &out->pairs);
    out->work.count = bench->pairs;
    out->work.warm = out->work.pair + bench->pairs;
    out->work.warm_count = pairs.count - bench->pairs;
    out->work.instructions = bench->instructions;
}

/* So many pairs that the others, for warming up, touch nearly all bodies. */
void arena_open(const struct bench *bench, const struct cell *cell, bool in_contact,
                struct arena *out)
{
    const bool boxes = cell->shape[0] == FMB_BOX;
    const struct scene scene =
        (boxes ? scene_draw_posed : scene_draw)(cell, bench->bodies, bench->seed);
    arena_of(bench, scene, pairs_draw_of(&scene, in_contact, 5 * bench->pairs, bench->seed), out);
}

void arena_close(struct arena *arena)
{
    work_free(&arena->work);
    pairs_free(&arena->pairs);
    scene_free(&arena->scene);
}

static const char *instructions_of(const struct bench *bench)
{
    int best = bench->instructions;
    for (int set = INSTRUCTIONS_PLAIN;
         bench->instructions == INSTRUCTIONS_BEST && set <= INSTRUCTIONS_AVX512; set++)
        best = instructions_supported(set) ? set : best;
    return instructions_name(best);
}

static void put_machine(const struct bench *bench, struct json_writer *json, bool pinned)
{
    char cpu[MACHINE_TEXT_MAX];
    const double noise = stopwatch_noise();
    json_begin(json, "machine", '{');
    json_string(json, "cpu", machine_cpu(cpu));
    json_number(json, "cores", machine_cores());
    json_string(json, "compiler", machine_compiler());
    json_string(json, "instructions", instructions_of(bench));
    json_number(json, "last_level_cache_bytes", (double) machine_last_cache());
    json_bool(json, "pinned", pinned);
    json_number(json, "noise", noise);
    json_bool(json, "noisy", noise > much_noise);
    json_end(json, '}');
}

static void put_settings(const struct bench *bench, struct json_writer *json)
{
    json_begin(json, "settings", '{');
    json_number(json, "bodies", (double) bench->bodies);
    json_number(json, "pairs", (double) bench->pairs);
    json_number(json, "blocks", bench->race.blocks);
    json_number(json, "seed", (double) bench->seed);
    json_bool(json, "quick", bench->quick);
    json_end(json, '}');
}

/* The sections have been written to text; what is said of the machine comes before them, and is
 * known after. */
static bool write_json(const struct bench *bench, bool pinned, const char *text, const char *path)
{
    struct json_writer json = {.out = fopen(path, "w")};
    if (!json.out)
        return false;
    fputc('{', json.out);
    json_number(&json, "bench", 1);
    json_string(&json, "version", fmb_version());
    put_machine(bench, &json, pinned);
    put_settings(bench, &json);
    fputs(text, json.out);
    fputs("}\n", json.out);
    const bool failed = ferror(json.out);
    return fclose(json.out) == 0 && !failed;
}

static void print_head(const struct bench *bench)
{
    char cpu[MACHINE_TEXT_MAX];
    printf("%s, %s, batch: %s, last level cache %.3g MB\n", machine_cpu(cpu), machine_compiler(),
           instructions_of(bench), (double) machine_last_cache() / 0x1p20);
    printf("%zu bodies, %zu pairs a kind; medians of %d blocks.\n\n", bench->bodies, bench->pairs,
           bench->race.blocks);
    contender_help();
}

static void print_noise(bool pinned)
{
    printf("\nNoise: a loop that is always the same took times %.1f %% apart.\n",
           100 * stopwatch_noise());
    if (stopwatch_noise() > much_noise)
        printf(
            "That is much: something else was running, or the clock of the machine changes.\n"
            "Compare ratios, and do not believe small differences.\n");
    if (!pinned)
        printf("The program could not be tied to one CPU, which adds to it.\n");
}

int main(int argc, char **argv)
{
    struct bench bench;
    const char *path;
    char *text = NULL;
    size_t length = 0;
    const int outcome = bench_options(argc, argv, &bench, &path);
    if (outcome != OPTIONS_RUN)
        return outcome;
    const bool pinned = stopwatch_pin();
    bench.json = (struct json_writer){.out = open_memstream(&text, &length), .comma = true};
    if (!bench.json.out) {
        perror("bench");
        return EXIT_FAILURE;
    }
    print_head(&bench);
    cells_run(&bench);
    contacts_run(&bench);
    poses_run(&bench);
    gaps_run(&bench);
    hulls_run(&bench);
    radii_run(&bench);
    turns_run(&bench);
    worst_run(&bench);
    print_noise(pinned);
    const bool complete = fclose(bench.json.out) == 0;
    const bool written = complete && (!path || write_json(&bench, pinned, text, path));
    if (!written)
        fprintf(stderr, "bench: %s: %s\n", path ? path : "JSON", strerror(errno));
    free(text);
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}
