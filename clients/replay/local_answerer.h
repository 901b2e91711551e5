/* Answers the queries of a log in this process with the code of the service: encoded query in,
 * encoded result out. Deterministic: the same query gets the same bytes, except compute_ns. */
#ifndef LOCAL_ANSWERER_H
#define LOCAL_ANSWERER_H

#include "logged_query.h"
#include "definitions.h"

struct local_answerer;

/* In: frames: capacity of the cache, as fmbd --frames; definitions: the bodies of handles, not
 * owned. Exits with status 1 if memory is exhausted. */
struct local_answerer *local_answerer_open(size_t frames, struct definitions *definitions);
void local_answerer_close(struct local_answerer *now); /* may be NULL */

struct new_result {
    const unsigned char *bytes; /* the result, as a service sends it; valid until the next call */
    size_t size;
    int64_t compute_ns, pairs; /* time taken, pairs decided */
    int32_t status;
    bool not_held; /* not answered: the cache has no memory for bodies that are defined */
};

/* Answers a query. In: its bytes in the log, at most the first LOG_DATA_MAX. Returns NULL; or a
 * static text: why it cannot be decoded. */
const char *local_answer(struct local_answerer *now, enum log_kind kind, const unsigned char *bytes,
                         uint32_t size, struct new_result *out);

#endif
