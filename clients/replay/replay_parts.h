/* The state of a replay, and its parts. Private. Each part calls only those below it: replay.c
 * reads the logs, replay_answer.c answers queries, replay_match.c matches queries with their
 * results,
 * replay_pair.c those of different clients, and replay_compare.c compares results. */
#ifndef REPLAY_PARTS_H
#define REPLAY_PARTS_H

#include "definitions.h"
#include "log_write.h"
#include "match.h"
#include "replay.h"

union decoded_result {
    struct pair_result pair;
    struct scene_result scene;
};

struct replay {
    const struct replay_options *options;
    const struct replay_sink *sink;
    struct tally *tally; /* [log_count] */
    struct log_channels channels;
    struct input input;
    struct event_reader *rereader;
    struct log_reader *golden;     /* NULL: none */
    struct output *golden_file;    /* NULL: none */
    struct log_writer *new_golden; /* of golden_file */
    struct definitions *definitions;
    struct hasher *hasher;
    struct local_answerer *local; /* NULL: the service on the bus answers */
    struct answer_bus *bus;       /* NULL: this process answers */
    struct match *match;
    /* Queries to answer again: soon, since the service lacked a body; at the end, since they name a
     * handle that was not defined before them. */
    struct match_list again, undefined;
    /* With a golden log: the clients that have a result in it by their ids; its results without a
     * query, at the end; whether it contains queries. */
    struct replay_pair *matched_clients;
    struct match_list unmatched;
    bool golden_has_queries;
    int64_t first_utime;
    bool started, at_end, failed;
    int old_version; /* that recorded a message; 0: none did */
    struct logged_query query;
    struct scene_query supply; /* without pairs */
    /* Buffers for messages read again: a query to be answered, and a result that a callback reads
     * meanwhile. */
    unsigned char query_bytes[LOG_DATA_MAX], result_bytes[LOG_DATA_MAX];
    unsigned char whole[QUERY_BYTES_MAX]; /* a query to be sent with the frames of its bodies */
    /* The comparison in progress: its query, as in the table and decoded, and both results. */
    const struct match_item *item;
    struct logged_query compared;
    union decoded_result then, now;
    unsigned char compared_bytes[LOG_DATA_MAX]; /* contain the geometries of compared */
};

/* A query or a result, in the buffer of its reader. */
struct message {
    struct match_key key;
    struct match_place place;
    const unsigned char *bytes;
    uint32_t size;
};

/* ---- replay_answer.c ---- */

/* The sink of the service's answers. */
bool replay_on_answered(void *user, struct match_item *query, const struct new_result *answered);

/* Answers the query, in process or on the bus, unless it is outside the range of time. */
void replay_take_query(struct replay *replay, struct message *query);
void replay_take_definition(struct replay *replay, const struct log_event *event,
                            const struct match_place *place);

/* At the end: waits until all queries are answered; then answers those with handles that are not
 * defined, unless the replay has ended early. */
void replay_finish_answers(struct replay *replay);

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

/* ---- replay_pair.c ---- */

/* match_note(), for clients whose results are found by their ids. */
void replay_note_match(struct replay *replay, const struct match_item *query,
                       const struct match_place *result);
void replay_close_pairs(struct replay *replay);

/* At the end, with a golden log: matches its unmatched results, which this frees, with the queries
 * in the table by their order, and sets left_over of these. */
void replay_pair_results(struct replay *replay);

/* Counts and reports a query that only one recording has. key: of the query. */
void replay_count_left_over(struct replay *replay, const struct match_key *key,
                            const struct match_place *place);

/* ---- replay_compare.c ---- */

/* Reports errno and what cannot be read or written, once; the replay continues. */
void replay_fail(struct replay *replay, const char *what);
void replay_fail_log(struct replay *replay, int log);

/* The counts of the channel of a query or result. */
struct tally_channel *replay_channel(struct replay *replay, const struct match_key *key,
                                     const struct match_place *place);

/* Counts and reports a message that cannot be decoded. */
void replay_refuse(struct replay *replay, enum log_kind kind, const struct message *message,
                   const char *error);

/* Reads a message again into bytes. Returns false after replay_fail_log(). */
bool replay_read_again(struct replay *replay, const struct match_key *key,
                       const struct match_place *place, unsigned char bytes[LOG_DATA_MAX],
                       struct message *out);

/* Decodes a result, for the functions below. Returns NULL; or a static text: why it cannot be
 * decoded. */
const char *replay_read_result(struct replay *replay, const struct message *result);

/* compare_status_is_transient() of the status of the decoded result. kind: of its query. */
bool replay_is_transient(const struct replay *replay, enum log_kind kind);

/* Quick check of a query with its new result against the bytes of the recorded result. Returns true
 * if they are the same, which was counted; false: not known, or there is a page. */
bool replay_same_bytes(struct replay *replay, const struct match_item *query,
                       const struct message *result);

/* The next three functions read the query from its log again; if that fails, they call
 * replay_fail_log(). */

/* Compares the new result of a query with the decoded result, and counts the outcome. Does nothing
 * if the query is not in the replayed range. */
void replay_compare(struct replay *replay, const struct match_item *query);

/* Counts a query with a new result, but without a recorded one. Does nothing if the query is not in
 * the replayed range. */
void replay_unrecorded(struct replay *replay, const struct match_item *query);

/* Compares the decoded result, the second of its query, with the first one. */
void replay_compare_second(struct replay *replay, const struct match_note *note,
                           const struct message *second, const struct message *first);

#endif
