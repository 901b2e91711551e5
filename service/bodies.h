/* From the frames of a query, which have been checked (check.h), to frames of the engine: by key or
 * whole, kept or anonymous. */
#ifndef BODIES_H
#define BODIES_H

#include "cache.h"
#include "query.h"

/* The body of a frame that names it by key; NULL: it is not held. Good until the cache is asked
 * again. */
const struct fmb_body *bodies_find(struct cache *cache, const struct query_frame *frame);

/* The body of a frame that has its components: kept by id, or put into *room. Good until the cache
 * is asked again. *key: 0 for an anonymous one. */
const struct fmb_body *bodies_keep(struct cache *cache, const struct query_frame *frame,
                                   struct fmb_body *room, int64_t *key);

/* The body where the frame is. */
struct fmb_frame bodies_place(const struct query_frame *frame, const struct fmb_body *body);

#endif
