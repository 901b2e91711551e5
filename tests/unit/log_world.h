/* Logs of a small world: clients that send pairs and scenes of bodies, whole and by handle, and
 * services that answer them, by the service's own code. What happens, and where it stands in the
 * log, is drawn: results come late, before their queries, again, or not at all; services start anew
 * and hold no bodies; a recorder requests definitions; queries are repeated or refused. */
#ifndef LOG_WORLD_H
#define LOG_WORLD_H

#include "query.h"

#include <stdbool.h>
#include <stddef.h>

/* No two events have the same log time: from LOG_WORLD_BEGIN on, one each millisecond. */
#define LOG_WORLD_BEGIN INT64_C(1700000000000000)
enum { LOG_WORLD_STEP = 1000 };

struct world_event {
    double at; /* its place among the others, until the world is put in order */
    int64_t utime;
    const char *channel;  /* static */
    unsigned char *bytes; /* owned */
    size_t size;
};

struct log_world {
    struct world_event *event; /* owned; [count], in the order of the log */
    size_t count, capacity;
    uint64_t seed, state; /* of what is drawn */
};

struct world_options {
    uint64_t seed;
    int steps;
    bool once; /* no client repeats a query */
};

/* To be cleared with log_world_clear(). */
void world_make(const struct world_options *options, struct log_world *out);

/* A world in which so many bodies come whole, in scenes of 300, of which the first has those that
 * are over, and then by handle in scenes of all of them, so many; each result after its query. */
void world_make_large(int bodies, int scenes, struct log_world *out);

/* Pairs of whole bodies: first all queries, then all results. */
void world_make_apart(int pairs, struct log_world *out);

void log_world_clear(struct log_world *world);

/* Adds an event after the last one. */
void world_add(struct log_world *world, const char *channel, const void *bytes, size_t size);

/* The world's log, by LCM's own writer. */
void world_write(const struct log_world *world, const char *path);

/* From 0 to below n. */
int world_draw(struct log_world *world, int n);

#endif
