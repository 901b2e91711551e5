/* Compares a recorded exchange (then) with a new one (now).
 *
 * They are the same if their statuses are, and the verdicts, intervals, boxes, points, gaps and
 * certificates of all pairs that both answer: bit for bit, or within a tolerance. The service,
 * times and handles are not compared. The result of a scene may answer fewer pairs than requested
 * (end_pair): pairs that only one of the two answers are not compared. If the recorded result is to
 * a query of another scene (scene_change.h), that is the only difference. No shared state. */
#ifndef COMPARE_H
#define COMPARE_H

#include "match.h"
#include "scene_change.h"

/* How two exchanges compare. */
enum replay_outcome {
    REPLAY_SAME,
    REPLAY_DIFFERENT,
    /* Nothing to compare: */
    REPLAY_BUSY,       /* the service was busy */
    REPLAY_UNKNOWN,    /* the service did not hold a body then */
    REPLAY_UNDEFINED,  /* a handle that the log does not define */
    REPLAY_NOT_HELD,   /* not answered: the cache has no memory for the bodies */
    REPLAY_UNRECORDED, /* no result was recorded */
    REPLAY_OUTCOMES
};

/* The first difference of a pair: everything listed before it is the same. */
enum difference_kind {
    DIFFERENT_STATUS,
    DIFFERENT_VERDICT,
    DIFFERENT_INTERVAL,
    DIFFERENT_BOX,
    DIFFERENT_POINT,
    DIFFERENT_GAP,
    DIFFERENT_CERTIFICATE,
    DIFFERENT_SCENE, /* the two sides have other bodies or pairs, which are not compared */
    DIFFERENT_KINDS
};

extern const char *const difference_name[DIFFERENT_KINDS]; /* for example "verdict" */

/* Most bytes of the detail of a difference, final 0 included. */
enum { COMPARE_DETAIL_MAX = SCENE_CHANGE_MAX };

struct difference {
    /* Of the query; the caller's sink sets these. */
    struct match_place place;
    enum log_kind query_kind;
    int64_t client_id, sequence_number;
    char label[QUERY_NAME_MAX + 1]; /* of a scene, truncated; "": none */
    enum difference_kind kind;
    bool whole;         /* of the scene as a whole (its status, bodies or pairs), not of a pair */
    const char *detail; /* DIFFERENT_SCENE: what differs, for people; otherwise NULL */
    int64_t body_id[2];
    unsigned placement[2]; /* indices in the query */
    int dim;
    bool names_frames[2]; /* of the gap of then and of now: a body has several frames */
    /* In a scene the status is OK, and the verdict 0 if the method cannot decide. */
    struct fmb_client_answer then, now;
};

struct compare_options {
    /* 0: bit for bit. Otherwise times of intervals and points may differ by tolerance * duration,
     * and ends of boxes and gaps, and points, by tolerance * (largest coordinate of the query): of
     * the position of a body, at the beginning or the end, plus its reach, which is 0 if its
     * geometry is not in the query. Directions, witness points and certificates are then not
     * compared. */
    double tolerance;
};

typedef void difference_sink(void *user, const struct difference *difference);

/* Calls the sink for each difference. In: two exchanges that have a result. Does not return
 * REPLAY_UNRECORDED. */
enum replay_outcome compare_exchanges(const struct compare_options *options, struct exchange *then,
                                      struct exchange *now, difference_sink *sink, void *user);

/* Quick check: returns true if the compared bytes of two encoded results are the same; false if not
 * known. In: kind: of the query; now: encoded by wire_write_*(). */
bool compare_bytes_same(enum log_kind kind, const unsigned char *then, size_t then_size,
                        const unsigned char *now, size_t now_size);

#endif
