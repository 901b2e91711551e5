/* The benchmark of the bus: pairs and scenes beside a bare LCM echo of as many bytes, with the time
 * to decide and the time on the bus listed separately. */
#include "bus_bench.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "duel.h"
#include "fmb.h"
#include "machine.h"
#include "bus_options.h"

bool bus_bench_wants(const struct bus_bench *bench, const char *section)
{
    return !bench->section || strcmp(bench->section, section) == 0;
}

/* The programs that were started end with this one. */
void bus_bench_fail(const char *what)
{
    fprintf(stderr, "bench-bus: %s\n", what);
    exit(EXIT_FAILURE);
}

bool bus_bench_begin(struct bus_bench *bench, int cores)
{
    bench->service = bench->echo = (struct line){0};
    bench->parties.service = bench->parties.echo = -1;
    if (!parties_cpus(cores, &bench->cpus)) {
        fprintf(stderr, "bench-bus: %d cores are not available\n", cores);
        return false;
    }
    if (parties_start(&bench->cpus, &bench->parties) &&
        line_open(bench->parties.service_url, false, &bench->service) &&
        line_open(bench->parties.echo_url, true, &bench->echo))
        return true;
    fprintf(stderr, "bench-bus: fmbd or the echo does not answer. %s", parties_log());
    return false;
}

void bus_bench_end(struct bus_bench *bench)
{
    line_close(&bench->service);
    line_close(&bench->echo);
    parties_stop(&bench->parties);
}

void bus_bench_put(struct json_writer *json, const char *key, struct spread spread)
{
    json_begin(json, key, '{');
    json_number(json, "median", spread.median);
    json_number(json, "low", spread.low);
    json_number(json, "high", spread.high);
    json_end(json, '}');
}

/* ---- Sections ---- */

/* Runs a section on so many cores, with the programs started anew. False: they do not run. */
static bool run_on(struct bus_bench *bench, int cores, void (*run)(struct bus_bench *))
{
    const bool begun = bus_bench_begin(bench, cores);
    if (begun)
        run(bench);
    bus_bench_end(bench);
    return begun;
}

static int most_cores(void)
{
    struct cpus cpus;
    return parties_cpus(2, &cpus) ? 2 : 1;
}

static bool run_trips(struct bus_bench *bench, const char *section, void (*run)(struct bus_bench *))
{
    bool good = true;
    if (!bus_bench_wants(bench, section))
        return true;
    json_begin(&bench->json, section, '[');
    for (int cores = 1; cores <= most_cores() && good; cores++) {
        printf("\nRound trips of %s, client and service on %s; microseconds.\n\n", section,
               cores == 1 ? "one core" : "two cores");
        duel_print_head();
        good = run_on(bench, cores, run);
    }
    json_end(&bench->json, ']');
    return good;
}

/* ---- Around them ---- */

static const char *network(void)
{
    const char *netns = getenv("FMB_NETNS");
    return netns && strcmp(netns, "own") == 0 ? "a network namespace of its own"
                                              : "this host's network, a random port, ttl=0";
}

/* The receive buffer is that of a client of fmbd, which is granted as much as fmbd itself. */
static void put_head(const struct bus_bench *bench, struct json_writer *json)
{
    char cpu[MACHINE_TEXT_MAX];
    json_number(json, "bus", 1);
    json_string(json, "version", fmb_version());
    json_begin(json, "machine", '{');
    json_string(json, "cpu", machine_cpu(cpu));
    json_number(json, "cores", machine_cores());
    json_string(json, "compiler", machine_compiler());
    json_string(json, "network", network());
    json_number(json, "receive_buffer", (double) bench->service.receive_buffer);
    json_end(json, '}');
    json_begin(json, "settings", '{');
    json_number(json, "blocks", bench->blocks);
    json_number(json, "trips", bench->trips);
    json_number(json, "scene_trips", bench->scene_trips);
    json_number(json, "seed", (double) bench->seed);
    json_bool(json, "quick", bench->quick);
    json_end(json, '}');
    json_number(json, "lost", bench->lost);
}

static bool write_json(const struct bus_bench *bench, const char *text, const char *path)
{
    struct json_writer json = {.out = fopen(path, "w")};
    if (!json.out)
        return false;
    fputc('{', json.out);
    put_head(bench, &json);
    fputs(text, json.out);
    fputs("}\n", json.out);
    const bool failed = ferror(json.out);
    return fclose(json.out) == 0 && !failed;
}

static void print_head(const struct bus_bench *bench)
{
    char cpu[MACHINE_TEXT_MAX];
    printf("%s, %d cores, %s; on %s.\n", machine_cpu(cpu), machine_cores(), machine_compiler(),
           network());
    printf(
        "Medians of %d blocks of %d round trips (scenes: fewer), quartiles in brackets; fmbd and "
        "the\necho in turns, with datagrams of the same sizes.\n",
        bench->blocks, bench->trips);
}

static void print_tail(const struct bus_bench *bench)
{
    printf(
        "\nReceive buffers of fmbd and its clients: %ld bytes granted. Blocks that lost something "
        "and were left out: "
        "%d.\n",
        bench->service.receive_buffer, bench->lost);
}

int main(int argc, char **argv)
{
    static struct bus_bench bench;
    const char *path;
    char *text = NULL;
    size_t length = 0;
    const int outcome = bus_options(argc, argv, &bench, &path);
    if (outcome != OPTIONS_RUN)
        return outcome;
    bench.json = (struct json_writer){.out = open_memstream(&text, &length), .comma = true};
    if (!bench.json.out) {
        perror("bench-bus");
        return EXIT_FAILURE;
    }
    print_head(&bench);
    const bool run =
        run_trips(&bench, "pairs", trips_pairs) && run_trips(&bench, "scenes", trips_scenes);
    print_tail(&bench);
    const bool complete = fclose(bench.json.out) == 0 && run;
    const bool written = complete && (!path || write_json(&bench, text, path));
    if (run && !written)
        fprintf(stderr, "bench-bus: %s: %s\n", path ? path : "JSON", strerror(errno));
    free(text);
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}
