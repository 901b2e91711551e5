/* Shared by the answers to queries of all types. Private to answer_*.c. */
#ifndef ANSWERER_H
#define ANSWERER_H

#include "answer.h"

struct answerer {
    struct cache *cache; /* owned */
    int64_t server_id;
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the last pair result that has one */
};

/* The body at the position of the placement. On input: a checked placement. */
struct fmb_frame answerer_place(const struct placement *placement, const struct fmb_body *body);

/* The body of a placement that comes whole: in the cache or, if it is anonymous, in *anonymous.
 * Valid until another body is added. *handle: the handle of a body in the cache; otherwise
 * unchanged. */
const struct fmb_body *answerer_keep(struct answerer *answerer, const struct placement *placement,
                                     struct fmb_body *anonymous, struct handle *handle);

#endif
