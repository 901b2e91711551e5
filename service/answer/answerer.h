/* State and functions shared by the answers to queries of all types. Private to answer*.c. */
#ifndef ANSWERER_H
#define ANSWERER_H

#include "answer.h"
#include "body.h"

struct answerer {
    struct cache *cache; /* owned */
    int64_t server_id;
    struct query_bodies bodies;            /* of the pair query being answered */
    char certificate[FMB_CERTIFICATE_MAX]; /* of the last pair result that has one */
};

/* The body of a placement of a query in progress. */
struct used_body {
    const struct fmb_body *body;
    const struct cached *cached; /* pinned, to be released; NULL: made for this query only */
};

/* Returns the engine's placement of a body: its pose and velocity. On input: a checked placement,
 * and its body, which must outlive the result. */
struct fmb_placement answerer_place(const struct placement *placement, const struct fmb_body *body);

/* Returns the body of a checked placement that has frames. It is found in the cache; or it is made
 * in *own, at most *frames frames a call (body_continue()), and added to the cache unless it is
 * anonymous or the cache has no memory for it. Returns .body NULL while it is not complete: the
 * next call for this query must be for the same placement. On output: *handle: the handle of a body
 * with an id, which the caller keeps there until the body is complete; unchanged for an anonymous
 * body.
 */
struct used_body answerer_intern(struct answerer *answerer, const struct placement *placement,
                                 struct query_bodies *own, int32_t *frames, struct handle *handle);

/* Releases the body, if it is in the cache. To be called once for each body of a query. On input:
 * *used may be all 0. */
void answerer_release(struct answerer *answerer, const struct used_body *used);

#endif
