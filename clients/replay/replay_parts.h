/* The state of a replay. Private: replay.c reads the logs, replay_answer.c answers queries,
 * replay_match.c matches queries with their results. */
#ifndef REPLAY_PARTS_H
#define REPLAY_PARTS_H

#include "input.h"
#include "log_write.h"
#include "pending.h"
#include "replay.h"

struct replay {
    const struct replay_options *options;
    const struct replay_sink *sink;
    struct tally *tally; /* [log_count] */
    struct log_channels channels;
    struct input input;
    struct event_reader *rereader;
    struct log_reader *golden;     /* NULL: none */
    struct log_writer *new_golden; /* NULL: none */
    struct definitions *definitions;
    struct hasher *hasher;
    struct local_answerer *local; /* NULL: the service on the bus answers */
    struct answer_bus *bus;       /* NULL: this process answers */
    struct comparison *comparison;
    struct match *match;
    struct pending_queries *pending;
    /* Queries to answer again, since their handles are now defined; linked by ->pending. */
    struct match_item *defined, **defined_end;
    int64_t first_utime;
    bool started, failed, version_1;
    struct logged_query query;
    struct definition definition;
    struct scene_query supply; /* without pairs */
    /* Buffers for messages read again: a query to be answered, and a result that a callback reads
     * meanwhile. */
    unsigned char query_bytes[LOG_DATA_MAX], result_bytes[LOG_DATA_MAX];
    unsigned char whole[QUERY_BYTES_MAX];
};

/* A query or a result, in the buffer of its reader. */
struct message {
    struct match_key key;
    struct match_place place;
    const unsigned char *bytes;
    uint32_t size;
};

/* ---- replay.c ---- */

/* Reports errno and what cannot be read or written, once; the replay continues. */
void replay_fail(struct replay *replay, const char *what);
void replay_fail_log(struct replay *replay, int log);

struct tally_channel *replay_channel(struct replay *replay, const struct match_key *key,
                                     const struct match_place *place);

/* Counts and reports a message that cannot be decoded. */
void replay_refuse(struct replay *replay, enum log_kind kind, const struct message *message,
                   const char *error);

/* Reads a message again into bytes. Returns false after replay_fail_log(). */
bool replay_read_again(struct replay *replay, const struct match_key *key,
                       const struct match_place *place, unsigned char bytes[LOG_DATA_MAX],
                       struct message *out);

/* ---- replay_answer.c ---- */

/* The sink of the service's answers. */
bool replay_on_answered(void *user, struct match_item *query, const struct new_result *answered);

/* Answers the query, in process or on the bus, unless it is outside the range of time. */
void replay_take_query(struct replay *replay, struct message *query);
void replay_take_definition(struct replay *replay, const struct log_event *event,
                            const struct match_place *place);

/* At the end: the first waits until all queries are answered, except those with handles that are
 * not defined; the second answers these. */
void replay_finish_answers(struct replay *replay);
void replay_finish_pending(struct replay *replay);

/* Whether the replay has ended: no service answers, or a signal arrived. */
bool replay_has_ended(const struct replay *replay);

/* ---- replay_match.c ---- */

/* Adds an item for a query. Its result may be known already; otherwise the item is in the table. */
struct match_item *replay_begin_query(struct replay *replay, const struct message *query,
                                      bool unreadable);

/* Compares a query that was removed from the table with its recorded result, and frees it. */
void replay_compare_recorded(struct replay *replay, struct match_item *query);

void replay_take_result(struct replay *replay, const struct message *result);

/* At the end: processes results that do not echo the time of their query, and unmatched items. */
void replay_finish_matches(struct replay *replay);

#endif
