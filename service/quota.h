/* Quotas of one client: how old its waiting queries become, how much compute time they may take,
 * and how often it gets a refusal.
 *
 * The compute time is an estimate: the number of waiting queries times the mean time of the last
 * 64 to 128 that were answered, separately for each FIFO of the queue. A mean, because the sum of
 * many queries is what counts: a client that mixes cheap and expensive ones is limited by what they
 * take together, and one expensive query among a hundred does not stand for all. So many, because
 * fewer would let the mean of such a mixture jump. The means are those of one client, so that no
 * client is limited by what others query. A new client begins as one that had 16 queries of
 * QUOTA_FLOOR_NS answered, so that many cheap queries may wait before the first has been answered,
 * and the first alone does not decide. As soon as the mean is higher, the newest queries that
 * exceed the quota are refused. While the mean follows a client that changes to expensive queries,
 * it can have more work waiting than the quota, of QUOTA_AGE_NS at most.
 *
 * No function allocates; there is no shared state. */
#ifndef QUOTA_H
#define QUOTA_H

#include "queue.h"

#include <stdbool.h>
#include <stdint.h>

/* A query that has waited longer since it arrived is dropped. A repeat is a query that arrives. */
#define QUOTA_AGE_NS INT64_C(5000000000)

/* The most compute time that the waiting queries of one client may take, and of all clients
 * together if each takes its equal part. With one query a second, which is the least that a client
 * with one waiting query gets beside many, 4 s are answered before they are QUOTA_AGE_NS old. */
#define QUOTA_CLIENT_NS INT64_C(1000000000)
#define QUOTA_ALL_NS INT64_C(4000000000)

/* The least time a query is taken to need: about what receiving it and sending its result take. A
 * full queue of 8192 such queries is within QUOTA_CLIENT_NS. */
#define QUOTA_FLOOR_NS INT64_C(10000)

/* A client gets QUOTA_REFUSALS refusals at once, and one more after each QUOTA_REFUSAL_NS: 100 a
 * second. A client whose window is QUOTA_REFUSALS queries gets all of them. */
#define QUOTA_REFUSAL_NS INT64_C(10000000)
enum { QUOTA_REFUSALS = 64 };

/* All 0 at the start. */
struct quota {
    int64_t client_id;
    int64_t sum_ns[QUEUE_FIFOS], count[QUEUE_FIFOS]; /* of the last queries that were answered */
    int64_t refused_until_ns; /* when the last refusal would have been sent at one per interval */
};

/* Records that a query took ns. */
void quota_note(struct quota *quota, enum queue_fifo fifo, int64_t ns);

/* Estimated time of a query. */
int64_t quota_estimate(const struct quota *quota, enum queue_fifo fifo);

/* Whether the client has more waiting than it may. One query is always within the quota. On input:
 * its number of waiting queries in each FIFO, and the number of clients with waiting queries, from
 * 1. */
bool quota_exceeded(const struct quota *quota, const int64_t waiting[QUEUE_FIFOS], int64_t clients);

/* Whether a refusal may be sent now. If so, it counts as sent. */
bool quota_take_refusal(struct quota *quota, int64_t now_ns);

#endif
