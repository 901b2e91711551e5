/* Query in, result out: checks what a query says, finds or keeps its bodies, and decides.
 * Knows no LCM and no clock; given the same queries in the same order it gives the same
 * results. */
#ifndef ANSWER_H
#define ANSWER_H

#include "cache.h"
#include "query.h"

struct answerer {
    struct cache *cache; /* not owned */
    int64_t server_id;
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the last result that has one */
};

/* On output: the result, complete but for compute_ns (0). A query that cannot be decided gets
 * its status, and detail names the place: "b.components[4]: not a finite number". A query
 * with a wrong field or a dead key leaves the cache as it was. A certificate is there where it is
 * wanted and fits, and holds until the next call. */
void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result);

#endif
