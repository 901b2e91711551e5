/* Answers the queries of a log in this process: what fmbd would say to them, from bytes to bytes,
 * by the code that it says it with. No clock but to measure, no bus, nothing random: the same
 * queries in the same order get the same bytes. */
#ifndef ANSWER_NOW_H
#define ANSWER_NOW_H

#include "known_bodies.h"
#include "log_kind.h"

struct answer_now;

/* bodies: capacity of the cache, as fmbd --bodies. known: not owned; the keys of the log. Never
 * NULL: ends the program where there is no memory. */
struct answer_now *answer_now_open(size_t bodies, struct known_bodies *known);
void answer_now_close(struct answer_now *now); /* may be NULL */

enum answer_now_outcome {
    ANSWER_NOW_DONE,
    ANSWER_NOW_WITHOUT_BODY, /* done, with UNKNOWN_BODY: of some keys the components are not known
                              */
    ANSWER_NOW_UNREADABLE    /* no such message; error says why */
};

struct answered_now {
    /* Of the result, as the service would send it; good until the next call. */
    const unsigned char *bytes;
    size_t size;
    int64_t compute_ns, pairs; /* taken, and decided */
    int32_t status;
    const char *error;
};

/* On input: a query's bytes as they stand in the log, of more than LOG_DATA_MAX the first so many;
 * kind PAIR_QUERY or SCENE_QUERY. */
enum answer_now_outcome answer_now(struct answer_now *now, enum log_kind kind,
                                   const unsigned char *bytes, size_t size,
                                   struct answered_now *out);

#endif
