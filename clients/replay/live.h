/* A query of a log as a live service is asked it, and the result as the log would have it. Knows no
 * bus and no clock.
 *
 * What is asked are the recorded bytes, but for what says whose they are: client id and sequence
 * number are the asker's own. (Where one of them is what the service refuses, both stay, and utime,
 * which nobody looks at, tells the results apart.)
 *
 * Keys of the log mean nothing to another service. A frame that came by key goes by the key that
 * the live service has told for the same components, once it has; until then, and when that key has
 * died, the components go in its place. Where the query is too long for a datagram with them, the
 * service is first taught them: by queries of no pairs, as many as it takes, which bring components
 * and learn keys. A key whose components nobody knows goes as it is: a service that did not tell it
 * does not hold it.
 *
 * A result of a scene may end before all pairs: since the scene took long while others waited, or
 * since keys, which are told for what came whole, took its room. Then the rest is asked, and the
 * parts are joined: the result is what this process would say, whatever the service had to do. */
#ifndef LIVE_H
#define LIVE_H

#include "answer_now.h"
#include "match.h"

struct live;

/* known: the keys of the log, not owned; key_now is used for those of the service. client_id: the
 * asker's own. Never NULL: ends the program where there is no memory. */
struct live *live_open(struct known_bodies *known, int64_t client_id);
void live_close(struct live *live); /* may be NULL */

/* A query on its way; to be kept in one place meanwhile. */
struct live_query {
    struct match_item recorded;   /* its bytes are in in_log */
    struct answered_now answered; /* once done; its bytes are in result */

    /* What is asked now, in asked. */
    enum log_kind kind; /* PAIR_QUERY or SCENE_QUERY: where it goes, and its result comes from */
    struct query_header ids; /* that the result has too */
    size_t size;

    bool keyed;        /* it has frames by key, and the service will look at them */
    size_t bytes;      /* that the query or its result takes at most, as a rule: the larger */
    int deaths;        /* how often keys of the service had died */
    int lessons;       /* queries that taught */
    int64_t server_id; /* who answered last */

    /* For itself. */
    int asks, failures;    /* since it last came further; failures: deaths of keys */
    int by_key, completed; /* of the frames that came by key: with a key of the service; whole */
    bool teaches, hopeless, listed;
    bool told_keys;              /* some bodies came whole once, so that the result told keys */
    int32_t frames_once, frames; /* of the query; of what is asked now */
    int32_t first_pair, total;   /* of pairs; total is -1 where the query cannot be OK */
    int32_t next_pair; /* result has the answers before this one, if it is not first_pair */

    unsigned char in_log[LOG_DATA_MAX], asked[LOG_DATA_MAX], result[LOG_DATA_MAX];
};

/* Begins with a query of the log, whose bytes are copied. WITHOUT_BODY: of some keys the components
 * are not known; it can be asked all the same. UNREADABLE: no such message; *error says why. */
enum answer_now_outcome live_begin(struct live *live, const struct match_item *recorded,
                                   struct live_query *out, const char **error);

/* Writes what is to be asked next, with a number of its own. */
void live_next(struct live *live, struct live_query *query);

/* Takes a result that has the ids of what was asked. patient: busy is no answer. */
enum live_taken {
    LIVE_NONSENSE, /* no result, or none to this query: nothing was taken */
    LIVE_BUSY,     /* to be asked again, as it is */
    LIVE_MORE,     /* live_next() is to be asked */
    LIVE_DONE      /* answered is there */
};
enum live_taken live_take(struct live *live, struct live_query *query, const void *bytes,
                          uint32_t size, bool patient);

/* For a query that the bus does not carry to a service: done, refused as over a limit, which is
 * what a service says of every query longer than QUERY_BYTES_MAX that it hears. */
void live_refuse(struct live *live, struct live_query *query);

#endif
