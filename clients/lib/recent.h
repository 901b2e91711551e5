/* The results of recent queries, to detect second results that contradict them. */
#ifndef RECENT_H
#define RECENT_H

#include <stdbool.h>
#include <stdint.h>

enum { RECENT_MAX = 256 };

struct request_result;

/* All 0: none. */
struct recent {
    struct recent_result {
        bool used;
        int kind;
        int64_t number;
        int32_t end_pair; /* of a scene */
        uint64_t digest;  /* of the bytes that are compared */
    } result[RECENT_MAX]; /* [number % RECENT_MAX] */
};

/* Records the result of the query with this number. */
void recent_note(struct recent *recent, const struct request_result *result, int64_t number);

/* Whether a second result contradicts the first. Service, handles and compute time are not
 * compared. Refusals that depend on the moment (BUSY, UNKNOWN_BODY), scene results with different
 * end_pair, and definitions contradict nothing. */
bool recent_contradicts(const struct recent *recent, const struct request_result *result);

#endif
