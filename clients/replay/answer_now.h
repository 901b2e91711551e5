/* Answers the queries of a log in this process with the code of the service: encoded query in,
 * encoded result out. Deterministic: the same query gets the same bytes, except compute_ns. */
#ifndef ANSWER_NOW_H
#define ANSWER_NOW_H

#include "any_query.h"
#include "definitions.h"

struct answer_now;

/* On input: frames: capacity of the cache, as fmbd --frames; definitions: the bodies of handles,
 * not owned. Exits with status 1 if memory is exhausted. */
struct answer_now *answer_now_open(size_t frames, struct definitions *definitions);
void answer_now_close(struct answer_now *now); /* may be NULL */

struct answered {
    const unsigned char *bytes; /* the result, as a service sends it; valid until the next call */
    size_t size;
    int64_t compute_ns, pairs; /* time taken, pairs decided */
    int32_t status;
    /* If the status is UNKNOWN_BODY: the first handle not defined so far; else none. */
    struct handle undefined;
    const struct placement *placement; /* [placement_count] of the query; valid as bytes is */
    int32_t placement_count;
    bool all_held; /* all whole bodies with an id were in the cache, so they are defined */
};

/* Answers a query. On input: its bytes in the log, at most the first LOG_DATA_MAX. Returns NULL; or
 * a static text: why it cannot be decoded. */
const char *answer_now(struct answer_now *now, enum log_kind kind, const unsigned char *bytes,
                       uint32_t size, struct answered *out);

#endif
