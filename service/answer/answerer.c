#include "answerer.h"

#include <stdlib.h>
#include <string.h>

struct answerer *answerer_create(const struct answerer_options *options)
{
    struct answerer *answerer = malloc(sizeof *answerer);
    if (!answerer)
        return NULL;
    answerer->server_id = options->server_id;
    answerer->cache = cache_create(options->frames, options->secret);
    if (!answerer->cache) {
        free(answerer);
        return NULL;
    }
    return answerer;
}

void answerer_destroy(struct answerer *answerer)
{
    if (!answerer)
        return;
    cache_destroy(answerer->cache);
    free(answerer);
}

struct cache *answerer_cache(struct answerer *answerer)
{
    return answerer->cache;
}

struct fmb_placement answerer_place(const struct placement *placement, const struct fmb_body *body)
{
    struct fmb_placement out = {.body = body, .orientation_count = placement->orientation_count};
    memcpy(out.position, placement->position, sizeof out.position);
    memcpy(out.velocity, placement->velocity, sizeof out.velocity);
    memcpy(out.orientation, placement->orientation, sizeof out.orientation);
    return out;
}

struct used_body answerer_intern(struct answerer *answerer, const struct placement *placement,
                                 struct query_bodies *own, int32_t *frames, struct handle *handle)
{
    struct cache *cache = answerer->cache;
    const struct geometry *geometry = &placement->geometry;
    const int64_t id = placement->body_id;
    const struct cached *cached = NULL;
    if (!own->maker.memory) {
        cached = id ? cache_lookup(cache, id, geometry, handle) : NULL;
        if (cached)
            return (struct used_body){&cached->body, cached};
        body_begin(&own->maker, geometry, own->memory + own->used);
    }
    const struct fmb_body *body = body_continue(&own->maker, frames);
    if (!body)
        return (struct used_body){.body = NULL};
    own->used += BODY_BYTES(body->frame_count);
    own->maker.memory = NULL;
    if (id)
        cached = cache_add(cache, id, handle, geometry, body);
    return (struct used_body){cached ? &cached->body : body, cached};
}

void answerer_release(struct answerer *answerer, const struct used_body *used)
{
    if (used->cached)
        cache_release(answerer->cache, used->cached);
}
