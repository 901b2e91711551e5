/* The state of a replay, and its parts. Private.
 *
 * The logs are read twice. The first time, replay_match.c finds for each query the place of its
 * result, and replay_pair.c for those of other clients; names and definitions are collected. The
 * second time, replay_answer.c answers the queries one after the other, and replay_compare.c
 * compares the new result with the one at that place. replay.c reads the logs. Each part calls only
 * those that follow it here. */
#ifndef REPLAY_PARTS_H
#define REPLAY_PARTS_H

#include "definitions.h"
#include "log_write.h"
#include "match.h"
#include "replay.h"

/* What the first reading finds of a query whose ids can be read. */
struct recorded_query {
    int64_t offset; /* of the query */
    bool skipped;   /* it cannot be decoded, or is outside the range of time */
    int32_t log;    /* of its result; -1: it has none */
    int64_t result; /* the offset of its result */
};

struct replay {
    const struct replay_options *options;
    const struct replay_sink *sink;
    struct tally *tally; /* [log_count] */
    struct log_channels channels;
    char **paths; /* owned: of the logs, and of the golden log if there is one */
    struct input input, rereader;
    struct output *golden_file;    /* NULL: none */
    struct log_writer *new_golden; /* of golden_file */
    struct definitions *definitions;
    struct hasher *hasher;
    int64_t first_utime;
    bool started, failed;
    int old_version; /* that recorded a message; 0: none did */

    /* The first reading. */
    struct match *match;
    struct recorded_query *recorded; /* owned, [recorded_count] */
    size_t recorded_count, recorded_capacity;
    /* With a golden log: */
    struct replay_pair *pairs;    /* table of clients, queries and their counterparts */
    int64_t paired_clients[2];    /* how many: of the replayed logs, of the golden log */
    struct match_item *unmatched; /* golden results without a query */
    bool golden_has_queries;

    /* The second reading. */
    size_t next;                  /* of recorded */
    struct local_answerer *local; /* NULL: the service on the bus answers */
    struct answer_bus *bus;       /* NULL: this process answers */
    struct match_item *again;     /* queries to be sent with the frames of their bodies */

    struct logged_query query;
    struct scene_query supply; /* without pairs */
    /* Buffers for messages read again: a query to be answered, and a result that a callback reads
     * meanwhile. */
    unsigned char query_bytes[LOG_DATA_MAX], result_bytes[LOG_DATA_MAX];
    unsigned char whole[QUERY_BYTES_MAX]; /* a query to be sent with the frames of its bodies */
    /* The comparison in progress: its query, as in the log and decoded, and both results. */
    const struct match_item *item;
    struct logged_query compared;
    struct logged_result then, now;
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

/* Answers the next query, in process or on the bus. */
void replay_answer_query(struct replay *replay, const struct message *query);

/* At the end: waits until all queries are answered, unless the replay has ended early. */
void replay_finish_answers(struct replay *replay);

/* Whether the replay has ended: no service answers, or a signal arrived. */
bool replay_has_ended(const struct replay *replay);

/* ---- replay_match.c ---- */

/* Registers a query. unreadable: only its ids can be read. */
void replay_take_query(struct replay *replay, const struct message *query, bool unreadable);
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

/* replay_fail_log() for a message that could be read before. */
void replay_fail_changed(struct replay *replay, int log);

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

/* Compares the new result of a query with the recorded one, if there is one, and counts the
 * outcome. */
void replay_compare(struct replay *replay, const struct match_item *query,
                    const struct new_result *answered);

/* Compares the decoded result, the second of its query, with the first one. */
void replay_compare_second(struct replay *replay, const struct match_note *note,
                           const struct message *second, const struct message *first);

#endif
