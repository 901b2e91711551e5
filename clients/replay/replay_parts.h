/* The state of a replay, and its parts. Private.
 *
 * replay.c reads the logs from the first event to the last, collects names and definitions, and
 * matches queries with results (match.h); replay_pair.c matches results of other clients. Then
 * replay_answer.c reads each query again and answers it, and replay_compare.c compares the new
 * result with the recorded one. Each part calls only those that follow it here. */
#ifndef REPLAY_PARTS_H
#define REPLAY_PARTS_H

#include "definitions.h"
#include "fmb_client_raw.h"
#include "local_answerer.h"
#include "log_write.h"
#include "match.h"
#include "replay.h"

#include <glib.h>

/* A query under way on the bus. */
struct replay_slot {
    struct replay *replay; /* NULL: the slot is free */
    struct match_item *query;
    bool supplies; /* the message only carries bodies of the query */
};

struct replay {
    const struct replay_options *options;
    const struct replay_sink *sink;
    struct tally *tally; /* [log_count] */
    struct log_channels channels;
    char **paths; /* owned: of the logs, and of the golden log if there is one */
    /* The first reads the logs, then the queries again; the second results, and in callbacks. The
     * third reads the golden log again, so that neither changes from one file to another. */
    struct input input, rereader, golden_rereader;
    struct output *golden_file;    /* NULL: none */
    struct log_writer *new_golden; /* of golden_file */
    struct definitions *definitions;
    bool started, failed;

    struct match match;  /* queries, and the results to compare with */
    struct match golden; /* the queries and results of a golden log */
    struct body_names *golden_names;

    struct local_answerer *local;
    /* Used only with a service on the bus: */
    struct fmb_client *client; /* NULL: this process answers */
    int signals;               /* readable after SIGINT and SIGTERM; -1: not opened */
    struct replay_slot slot[FMB_CLIENT_RAW_WINDOW];
    int under_way; /* queries */
    unsigned polls;
    int64_t begun_at, server_id;
    GQueue again; /* items of queries to be sent with the frames of their bodies */

    struct logged_query query;
    struct scene_query supply; /* without pairs */
    /* Buffers for messages read again: a query to be answered, and a result that a callback reads
     * meanwhile. */
    unsigned char query_bytes[LOG_DATA_MAX], result_bytes[LOG_DATA_MAX];
    unsigned char whole[QUERY_BYTES_MAX]; /* a query to be sent with the frames of its bodies */
    /* The comparison in progress: its query, as in the log and decoded, and both results. */
    const struct match_item *item;
    struct logged_query compared; /* also scratch memory for queries to and results from the bus */
    struct logged_query golden_query; /* of the golden result, if it has its own */
    struct logged_result then, now;
    struct tally_channel others;    /* queries whose labels are not counted */
    char label[QUERY_NAME_MAX + 1]; /* of the query, truncated; "": none, or not read */
    char note[COMPARE_DETAIL_MAX];  /* how the scenes of both differ; "": they do not */
    /* Contain the geometries of compared and golden_query. */
    unsigned char compared_bytes[LOG_DATA_MAX], golden_bytes[LOG_DATA_MAX];
    unsigned char answered_bytes[QUERY_BYTES_MAX]; /* the result of a service */
};

/* ---- replay_answer.c ---- */

/* Opens the bus. Returns false after an error, which was reported. From then on SIGINT and SIGTERM
 * are blocked and end the replay. */
bool replay_open_bus(struct replay *replay);
void replay_close_bus(struct replay *replay); /* if it was opened */

/* Answers all queries, in process or on the bus, unless the replay ends early. */
void replay_answer_queries(struct replay *replay);

/* Whether the replay has ended: no service answers, or a signal arrived. */
bool replay_has_ended(struct replay *replay);

/* ---- replay_pair.c ---- */

/* Matches the results of a golden log that have no query with queries of other clients. Counts and
 * reports queries that only one recording has. */
void replay_pair_clients(struct replay *replay);

/* ---- replay_compare.c ---- */

/* Reports what cannot be read or written, once; the replay continues. error: a value of errno; EIO
 * for a message that could be read before. */
void replay_fail(struct replay *replay, const char *what, int error);

/* The counts of the channel of a query or result. */
struct tally_channel *replay_channel(struct replay *replay, const struct match_item *item);

/* Reports a message that cannot be decoded, or is not used for another reason. */
void replay_report(struct replay *replay, const struct match_item *item, const char *what);

/* Reads a query again and decodes it; *size: its bytes. Returns false if it cannot be read, or has
 * changed, which was reported. */
bool replay_read_query(struct replay *replay, struct input *input, const struct match_item *query,
                       unsigned char bytes[LOG_DATA_MAX], uint32_t *size, struct logged_query *out);

/* Compares the new result of a query with the recorded one, if there is one, and counts the
 * outcome. */
void replay_compare(struct replay *replay, const struct match_item *query,
                    const struct new_result *answered);

/* Compares second results with the result of their query, and counts results without a query. */
void replay_compare_results(struct replay *replay);

#endif
