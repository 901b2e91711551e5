/* Shared by the answers to queries of all types. Private to answer_*.c. */
#ifndef ANSWERER_H
#define ANSWERER_H

#include "answer.h"
#include "body.h"

struct answerer {
    struct cache *cache; /* owned */
    int64_t server_id;
    struct query_bodies bodies;              /* of the pair query under way */
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the last pair result that has one */
};

/* The body of a placement of a query under way. */
struct used_body {
    const struct fmb_body *body;
    const struct cached *cached; /* to be released; NULL: it was made for this query alone */
};

/* The body where the placement puts it. On input: a checked placement. */
struct fmb_placement answerer_place(const struct placement *placement, const struct fmb_body *body);

/* The body of a placement that comes whole: in the cache; or in *own, if it is anonymous or the
 * cache has no memory for it. *handle: the handle of a body with an id; otherwise unchanged. */
struct used_body answerer_keep(struct answerer *answerer, const struct placement *placement,
                               struct query_bodies *own, struct handle *handle);

/* Must be called once for each body of a query that was found or kept in the cache. On input: may
 * be all 0. */
void answerer_release(struct answerer *answerer, const struct used_body *used);

#endif
