/* The sections of the benchmark. Each prints a table for people and writes its part of the JSON. */
#ifndef BENCH_H
#define BENCH_H

#include "contender.h"
#include "json_write.h"

struct bench {
    size_t bodies; /* of a scene */
    size_t pairs;  /* of a cell, in contact and separated each */
    struct race race;
    uint64_t seed;
    bool quick;
    enum instructions instructions;
    const char *section; /* NULL: all */
    struct json_writer json;
};

bool bench_wants(const struct bench *bench, const char *section);

/* A line on stderr that says how far it is, if that is a terminal; NULL takes it away. */
void bench_progress(const char *text);

/* "dim", "moving", "shapes" of an open object. */
void bench_put_cell(struct json_writer *json, const struct cell *cell);

/* A scene, and pairs of it. Not to be copied: the work points to the scene. */
struct arena {
    struct scene scene;
    struct pairs pairs;
    struct work work;
};
/* Takes the scene and the pairs: the first bench->pairs of them are timed, the others for warming
 * up. */
void arena_of(const struct bench *bench, struct scene scene, struct pairs pairs, struct arena *out);
/* A random scene of the cell, boxes in any pose, with pairs that are in contact, or such that are
 * not. */
void arena_open(const struct bench *bench, const struct cell *cell, bool in_contact,
                struct arena *out);
void arena_close(struct arena *arena);

void cells_run(struct bench *bench);    /* cells, box */
void contacts_run(struct bench *bench); /* contacts */
void poses_run(struct bench *bench);    /* poses */
void gaps_run(struct bench *bench);     /* gaps */
void hulls_run(struct bench *bench);    /* hulls */
void radii_run(struct bench *bench);    /* radii; in hulls.c */
void turns_run(struct bench *bench);    /* turns */
void worst_run(struct bench *bench);    /* worst */

#endif
