/* The sections of the benchmark of the bus. Each prints a table for people and writes its part of
 * the JSON. */
#ifndef BUS_BENCH_H
#define BUS_BENCH_H

#include "json_write.h"
#include "line.h"
#include "parties.h"
#include "stopwatch.h"

struct bus_bench {
    int blocks;      /* of each side of a comparison */
    int trips;       /* of pairs, a block */
    int scene_trips; /* of scenes, a block */
    uint64_t seed;
    bool quick;
    const char *section; /* NULL: all */
    struct json_writer json;
    int lost; /* round trips that did not come back, in all */
    /* Meanwhile: */
    struct cpus cpus;
    struct parties parties;
    struct line service, echo;
};

bool bus_bench_wants(const struct bus_bench *bench, const char *section);

/* Starts both programs, and waits until they answer. False: they do not, and stderr has the reason.
 * bus_bench_end() ends what was started, and may be called twice. */
bool bus_bench_begin(struct bus_bench *bench, int cores);
void bus_bench_end(struct bus_bench *bench);

/* Reports an error on stderr, and exits. */
void bus_bench_fail(const char *what);

/* Sections. On input: both programs run, on one core or two. */
void trips_pairs(struct bus_bench *bench);
void trips_scenes(struct bus_bench *bench);

/* "key": {median, low, high}. */
void bus_bench_put(struct json_writer *json, const char *key, struct spread spread);

#endif
