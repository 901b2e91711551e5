#include "held.h"

#include "digest.h"

#include <stdlib.h>
#include <string.h>

static struct held_body *enter(struct held *held, const struct body_view *view,
                               struct held_body **at)
{
    struct held_body *body = malloc(sizeof *body + view->size);
    if (!body)
        return NULL;
    *body = (struct held_body){
        .next = *at, .handle = handle_of(view->bytes, view->size), .size = view->size};
    memcpy(body->bytes, view->bytes, view->size);
    held->count++;
    return *at = body;
}

struct held_body *held_find(struct held *held, const struct body_view *view)
{
    const uint64_t hash = digest(0, view->bytes, view->size);
    struct held_body **at = &held->body[hash >> (64 - HELD_BITS)], *body = *at;
    while (body && (body->size != view->size || memcmp(body->bytes, view->bytes, body->size) != 0))
        body = body->next;
    return body ? body : enter(held, view, at);
}

void held_clear(struct held *held)
{
    for (int i = 0; i < HELD_MAX; i++)
        for (struct held_body *body; (body = held->body[i]); free(body))
            held->body[i] = body->next;
    held->count = 0;
}
