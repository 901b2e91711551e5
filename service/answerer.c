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

struct fmb_frame answerer_place(const struct placement *placement, const struct fmb_body *body)
{
    struct fmb_frame out = {.body = body, .moving = placement->velocity_count > 0};
    memcpy(out.origin, placement->position, sizeof out.origin);
    memcpy(out.velocity, placement->velocity, sizeof out.velocity);
    return out;
}

const struct fmb_body *answerer_keep(struct answerer *answerer, const struct placement *placement,
                                     struct fmb_body *anonymous, struct handle *handle)
{
    if (!placement->body_id) {
        cache_make_body(&placement->geometry, anonymous);
        return anonymous;
    }
    const struct cached *cached =
        cache_keep(answerer->cache, placement->body_id, &placement->geometry);
    *handle = cached->handle;
    return &cached->body;
}
