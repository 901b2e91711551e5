/* The worker: opens the bus, and answers what comes on it until a signal ends it. Starts at once
 * whatever its options: it takes the place of one that died. */
#ifndef WORKER_H
#define WORKER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct worker_options {
    const char *lcm_url; /* NULL: see bus_open() */
    const char *prefix;  /* of the channels, "" for none */
    size_t bodies;       /* capacity of the cache */
    bool unfiltered;     /* LCM gets to see all that comes: filter.h */
};

/* A job for supervisor_run(). On input: options, a struct worker_options. On output: EXIT_SUCCESS
 * after SIGINT or SIGTERM; EXIT_FAILURE after a line on stderr that says why. */
int worker_run(const void *options, int64_t restarts, int ready);

#endif
