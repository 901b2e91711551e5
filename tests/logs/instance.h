/* An instance of the service, in process: what it is asked and what it answers goes onto a tape, as
 * a logger on its bus would have seen both. It reads queries from the bytes that are on the tape,
 * and answers with answer_pair() and answer_scene(); only the time that this took is made up. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "answer.h"
#include "bus.h"
#include "draw.h"
#include "query.h"
#include "senders.h"
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
    struct answerer answerer;
    struct senders senders;
    struct wire_status status; /* what it counts for its heartbeat */
    struct draw draw;          /* for the times that answers are said to have taken */
    struct scene_query *heard; /* owned: the scene that is being answered */
    char channel[INSTANCE_CHANNELS][BUS_CHANNEL_MAX];
    /* On the tape a result stands so long after its query; or before it, as where two threads of a
     * logger took them in turns. */
    int64_t result_after_us;
};

struct instance_options {
    const char *prefix; /* of the channels, "" for none */
    int64_t server_id, first_key;
    size_t bodies; /* capacity of its cache */
};

/* On output: a service that knows nobody, to be closed. False: out of memory, and nothing to be
 * closed. It stays where it is in memory. */
bool instance_open(struct instance *instance, struct tape *tape,
                   const struct instance_options *options);
void instance_close(struct instance *instance);

/* A query that comes now, and its result. The query's time is set, and the tape goes on a little.
 * A certificate of the result holds until the next query. */
void instance_ask_pair(struct instance *instance, struct pair_query *query,
                       struct pair_result *result);
void instance_ask_scene(struct instance *instance, struct scene_query *query,
                        struct scene_result *result);

/* The same for a service that has no room for it: nobody looks at the query. */
void instance_turn_away_pair(struct instance *instance, struct pair_query *query);
void instance_turn_away_scene(struct instance *instance, struct scene_query *query);

/* Bytes that come on the channel of queries of scenes, of pairs; they need not be any. The service
 * answers what can be read of them, and refuses what is too long. On output: false, there is no
 * result. */
bool instance_hear_pair(struct instance *instance, const unsigned char *bytes, size_t size,
                        struct pair_result *result);
bool instance_hear_scene(struct instance *instance, const unsigned char *bytes, size_t size,
                         struct scene_result *result);

/* A query that nobody hears: it stands on the tape, and has no result. */
void instance_miss_pair(struct instance *instance, struct pair_query *query);

/* A heartbeat. */
void instance_beat(struct instance *instance);

#endif
