/* Results, and a record of recent ones that detects a second result which contradicts the first. */
#ifndef RECENT_H
#define RECENT_H

#include "fmb_client_raw.h"

#include <stdbool.h>
#include <stdint.h>

enum { RECENT_MAX = 256 };

/* A well-formed result; or the end of a request without one: status is negative (enum
 * fmb_client_status). */
struct request_result {
    enum fmb_client_kind kind;
    int status;
    const char *detail; /* "" if OK, or if there is no result */
    /* The result, decoded. The one of another kind may be NULL, or is not to be read. */
    const struct pair_result *pair;
    const struct scene_result *scene;
    const unsigned char *bytes; /* of the message; NULL: there is no result */
    size_t size;
    int64_t number; /* sequence number of the query */
};

/* All 0: none. */
struct recent {
    struct recent_result {
        bool used;
        bool comparable; /* end_pair and digest are set */
        bool repeated;   /* the query was sent more than once */
        int kind;
        int64_t number;
        int32_t end_pair; /* of a scene */
        uint64_t digest;  /* of the bytes that are compared */
    } result[RECENT_MAX]; /* [number % RECENT_MAX] */
};

/* Records the result of the query with this number. repeated: the query was sent more than once. */
void recent_note(struct recent *recent, const struct request_result *result, int64_t number,
                 bool repeated);

/* Whether a result is a second one of a repeated query. With one service on the bus, that repeat
 * was spurious. */
bool recent_was_repeated(const struct recent *recent, const struct request_result *result);

/* Whether a result contradicts the recorded one of the same query. Service, handles and compute
 * time are not compared. Refusals that depend on the state of the service (BUSY, UNKNOWN_BODY),
 * results of scenes with different end_pair, and definitions contradict nothing. */
bool recent_contradicts(const struct recent *recent, const struct request_result *result);

#endif
