/* Which results did not come by. A service says in each heartbeat how many results it has
 * published, and publishes them and its heartbeats in one order: so what it published between two
 * heartbeats, and did not come, is missing. What comes before the first heartbeat of a service and
 * after its last one is not known to be complete. */
#ifndef RECORD_ANSWERED_H
#define RECORD_ANSWERED_H

#include <stdint.h>

/* Services that are remembered, by server_id; the one least recently heard of is forgotten. */
enum { ANSWERED_SERVERS = 16 };

struct answered_server {
    int64_t server_id;
    int64_t first;    /* published by its first heartbeat that came, as it said; -1: none came */
    int64_t came;     /* results since then */
    int64_t missing;  /* at its last heartbeat */
    uint64_t used_at; /* 0: free */
};

/* All 0 at the start. */
struct answered {
    struct answered_server server[ANSWERED_SERVERS];
    uint64_t now;
    int64_t forgotten; /* missing of services that are forgotten */
};

/* A result has come. */
void answered_result(struct answered *answered, int64_t server_id);

/* A heartbeat has come, which says how many results were published. */
void answered_heartbeat(struct answered *answered, int64_t server_id, int64_t published);

/* Results of all services that did not come. */
int64_t answered_missing(const struct answered *answered);

#endif
