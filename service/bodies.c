#include "bodies.h"

#include <assert.h>
#include <string.h>

const struct fmb_body *bodies_find(struct cache *cache, const struct query_frame *frame)
{
    return cache_find(cache, frame->body_id, frame->key, frame->dim, frame->shape);
}

const struct fmb_body *bodies_keep(struct cache *cache, const struct query_frame *frame,
                                   struct fmb_body *room, int64_t *key)
{
    const double *components = frame->components.number;
    if (frame->body_id)
        return cache_keep(cache, frame->body_id, frame->dim, frame->shape, components, key);
    const enum fmb_status status =
        fmb_body_make(frame->dim, frame->shape, components, (size_t) frame->components.count, room);
    assert(status == FMB_OK);
    (void) status;
    *key = 0;
    return room;
}

struct fmb_frame bodies_place(const struct query_frame *frame, const struct fmb_body *body)
{
    struct fmb_frame out = {.body = body, .moving = frame->velocity.count > 0};
    memcpy(out.origin, frame->origin.number, sizeof out.origin);
    memcpy(out.velocity, frame->velocity.number, sizeof out.velocity);
    return out;
}
