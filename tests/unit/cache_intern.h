/* Bodies made in one step, and added to a cache as the service adds them. */
#ifndef CACHE_INTERN_H
#define CACHE_INTERN_H

#include "body.h"
#include "cache.h"

#include <stdlib.h>

/* In: memory  of body_bytes() */
static inline const struct fmb_body *body_make(const struct body_view *view, void *memory)
{
    struct body_maker maker;
    int32_t frames = INT32_MAX;
    body_begin(&maker, view, memory);
    return body_continue(&maker, &frames);
}

/* Finds a body, or makes it and adds it: what cache_lookup() or cache_add() returns. */
static inline const struct cached *cache_intern(struct cache *cache, int64_t id,
                                                struct body_view *view)
{
    const struct cached *cached = cache_lookup(cache, id, view);
    if (cached)
        return cached;
    void *memory = malloc(body_bytes(view));
    cached = cache_add(cache, id, view, body_make(view, memory));
    free(memory);
    return cached;
}

#endif
