/* An instance of the service, in process: what it receives and what it answers goes onto a tape, as
 * a logger on its bus would have recorded both. It reads queries from the bytes that are on the
 * tape and answers them as answer.h does; only the time that this took is invented. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "answer.h"
#include "bus.h"
#include "draw.h"
#include "query.h"
#include "tape.h"
#include "wire.h"

#include <stdbool.h>

/* Its channels. */
enum instance_channel {
    INSTANCE_PAIR_QUERY,
    INSTANCE_PAIR_RESULT,
    INSTANCE_SCENE_QUERY,
    INSTANCE_SCENE_RESULT,
    INSTANCE_STATUS,
    INSTANCE_CHANNELS
};

struct instance {
    struct tape *tape; /* not owned */
    struct answerer *answerer;
    struct answer_job *job;
    struct wire_status status; /* what it counts for its heartbeat */
    struct draw draw;          /* for the times that answers are said to have taken */
    char channel[INSTANCE_CHANNELS][BUS_CHANNEL_MAX];
};

struct instance_options {
    const char *prefix; /* of the channels, "" for none */
    int64_t server_id;
    size_t frames; /* capacity of its cache */
};

/* On output: a service that holds no bodies, to be closed. False: out of memory, and nothing to be
 * closed. */
bool instance_open(struct instance *instance, struct tape *tape,
                   const struct instance_options *options);
void instance_close(struct instance *instance);

/* A query that comes now, and its result. The query's time is set, and the tape goes on a little.
 * Pointers in the result are valid until the next query. */
void instance_query_pair(struct instance *instance, struct pair_query *query,
                         struct pair_result *result);
void instance_query_scene(struct instance *instance, struct scene_query *query,
                          struct scene_result *result);

/* A heartbeat. */
void instance_beat(struct instance *instance);

#endif
