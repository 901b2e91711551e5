/* Quotas of one client: the age of its waiting queries, their compute time, and the rate of its
 * refusals.
 *
 * The compute time is an estimate: the number of waiting queries times the mean time of the last
 * 64 to 128 that were answered, separately for each FIFO of the queue. A mean is used because the
 * sum counts: a client that mixes cheap and expensive queries is limited by their total time. With
 * fewer samples the mean of such a mixture would jump. Each client has its own means, so that no
 * client is limited by the queries of others.
 *
 * A new client begins with 16 samples of QUOTA_FLOOR_NS, so that many cheap queries may wait before
 * one has been answered, and the first answer does not dominate the mean. When the mean rises, the
 * newest queries that exceed the quota are refused. If a client changes to expensive queries, the
 * mean lags behind: more work than the quota may then wait, but none of it longer than
 * QUOTA_AGE_NS.
 *
 * No function allocates; there is no shared state. */
#ifndef QUOTA_H
#define QUOTA_H

#include "queue.h"

#include <stdbool.h>
#include <stdint.h>

/* A query that has waited for longer since its arrival is dropped. A repeat has its own arrival. */
#define QUOTA_AGE_NS INT64_C(5000000000)

/* The most compute time that the waiting queries of one client may take; and those of all clients
 * together, in equal parts. 4 s of work are answered before any of it is QUOTA_AGE_NS old. */
#define QUOTA_CLIENT_NS INT64_C(1000000000)
#define QUOTA_ALL_NS INT64_C(4000000000)

/* The least estimate for one query: about the time to receive it and to send its result. A full
 * queue of 8192 such queries is within QUOTA_CLIENT_NS. */
#define QUOTA_FLOOR_NS INT64_C(10000)

/* A client gets QUOTA_REFUSALS refusals at once, and one more after each QUOTA_REFUSAL_NS: 100 a
 * second. A client whose window is QUOTA_REFUSALS queries gets all of them. */
#define QUOTA_REFUSAL_NS INT64_C(10000000)
enum { QUOTA_REFUSALS = 64 };

/* All 0 at the start. */
struct quota {
    int64_t client_id;
    int64_t sum_ns[QUEUE_FIFOS], count[QUEUE_FIFOS]; /* of the last queries that were answered */
    /* Theoretical arrival time of the next refusal (generic cell rate algorithm). */
    int64_t next_refusal_ns;
};

/* Adds the time of an answered query to the samples. */
void quota_add_sample(struct quota *quota, enum queue_fifo fifo, int64_t ns);

/* Estimated time of the client's next query in a FIFO, nanoseconds. */
int64_t quota_estimate(const struct quota *quota, enum queue_fifo fifo);

/* Whether the waiting queries of the client exceed its quota of compute time. One query is always
 * within the quota. On input: waiting: their number in each FIFO; clients: the number of clients
 * with waiting queries, at least 1. */
bool quota_exceeded(const struct quota *quota, const int64_t waiting[QUEUE_FIFOS], int64_t clients);

/* Returns whether a refusal may be sent now. If so, it is counted as sent. */
bool quota_take_refusal(struct quota *quota, int64_t now_ns);

#endif
