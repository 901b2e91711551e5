/* Asks the service: many parts under way at once, none lost, answers in the order asked.
 *
 * LCM loses what a full buffer has no room for, and says nothing. So a query that gets no answer
 * within the time-out is sent again under the same sequence number, a service that is busy is
 * asked again after a pause, and a second answer to the same query is ignored. A part may take
 * several queries, one after the other: where the result had no room for all answers, and where
 * keys were not held. Each has a number of its own.
 *
 * What is under way is limited in number, and in bytes: no more than a usual receive buffer holds
 * at either end. */
#ifndef ASKING_H
#define ASKING_H

#include "part.h"

enum { ASKING_WINDOW = 64 };

/* A part under way. */
struct asking_slot {
    struct part part;
    struct part_answers answers;
    int64_t number;   /* sequence number of its query */
    int64_t first_at; /* when that was sent for the first time; clock_ns() */
    int64_t deadline; /* when to send it again, or to give it up; clock_ns() */
    int tries;        /* left */
    int refusals;     /* the service was busy */
    int unknown;      /* how often keys were not held */
    int by_key;       /* frames of the query that went by key */
    bool pausing;     /* the deadline ends a pause after a refusal */
    bool done;
    size_t charge; /* of a receive buffer; 0 where done */
    size_t size;
    unsigned char query[QUERY_BYTES_MAX];
};

/* All 0 at first. */
struct asking {
    const struct fmb_client_scene *scene;
    uint64_t oldest, next;                  /* parts: not delivered yet; not asked yet */
    bool cut;                               /* the part after those is in its slot already */
    struct asking_slot slot[ASKING_WINDOW]; /* [part % ASKING_WINDOW] */
    size_t charge;                          /* of all that is under way */
    int64_t next_number;                    /* sequence number of the next query */
    int64_t until;                          /* the end of the time for all; clock_ns() */
    int64_t heard_at;                       /* the last answer, or 0; clock_ns() */
    bool silent;                            /* nobody answers any more */
    int64_t probe_at; /* while silent: not before this is a query sent; clock_ns() */
    bool probing;     /* one was, and may still be answered */
    /* Pairs to be listed in a query, so that what is under way is decided within a time-out: as
     * the service told how long it took, for this method and want. */
    int32_t pairs_max;
    int method;
    unsigned want;
};

struct fmb_client;
struct cut;
struct order;

/* Asks all parts of the cut; returns when order has had an answer, or none, for each. */
void asking_run(struct fmb_client *client, const struct fmb_client_scene *scene, struct cut *cut,
                struct order *order);

/* Results that come in, also while nothing is asked. */
void asking_take_pair(struct fmb_client *client, const struct pair_result *result);
void asking_take_scene(struct fmb_client *client, const struct scene_result *result);

#endif
