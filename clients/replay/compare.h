/* Two results of one query: then, as it was recorded, and now.
 *
 * They are the same if their statuses are, and the verdicts, intervals, boxes and certificates of
 * all pairs that both have answered: bit for bit, or with a tolerance. Who answered, when, how long
 * it took, which keys it told and what it had lost are not compared. A result of a scene may have
 * fewer pairs than were asked (end_pair): those that one of the two lacks are not compared. */
#ifndef COMPARE_H
#define COMPARE_H

#include "log_kind.h"
#include "query.h"
#include "replayed.h"

/* In what a pair differs first: each of these includes that those before it are the same. */
enum difference_kind {
    DIFFERENT_STATUS,
    DIFFERENT_VERDICT,
    DIFFERENT_INTERVAL,
    DIFFERENT_BOX,
    DIFFERENT_CERTIFICATE,
    DIFFERENT_KINDS
};

/* "verdict"; static. */
const char *difference_name(enum difference_kind kind);

/* What one of the two says of a pair. */
struct difference_side {
    int32_t status;           /* as in the result */
    struct fmb_answer answer; /* all 0 where the status is not OK, or the method cannot decide */
    const char *certificate;  /* NULL: none */
};

struct difference {
    enum difference_kind kind;
    bool whole; /* of a scene: its status, not a pair's answer */
    int64_t body_id[2];
    unsigned frame[2]; /* indices of the frames in the query */
    int dim;
    struct difference_side then, now;
};

struct compare_options {
    /* 0: bit for bit. Else ends of intervals may differ by so much times the duration, ends of
     * boxes by so much times the largest number of both boxes, and certificates are not compared.
     */
    double tolerance;
};

typedef void difference_sink(void *user, const struct difference *difference);

/* Calls the sink for each difference. Returns SAME, DIFFERENT, BUSY or UNKNOWN. */
enum replay_outcome compare_pairs(const struct compare_options *options,
                                  const struct pair_query *query, const struct pair_result *then,
                                  const struct pair_result *now, difference_sink *sink, void *user);
enum replay_outcome compare_scenes(const struct compare_options *options,
                                   const struct scene_query *query, const struct scene_result *then,
                                   const struct scene_result *now, difference_sink *sink,
                                   void *user);

/* Whether two encoded results, the second of them as wire_write_*() writes it, are the same in all
 * that is compared, seen from their bytes alone. False: perhaps. kind: of the query. */
bool compare_bytes_same(enum log_kind kind, const unsigned char *then, size_t then_size,
                        const unsigned char *now, size_t now_size);

#endif
