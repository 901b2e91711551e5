#include "held.h"

#include "digest.h"

#include <stdlib.h>
#include <string.h>

/* Without memory the geometry is not stored: the body is then not found again, and sent whole. */
static void enter(struct held *held, const struct geometry *geometry, struct held_body *out)
{
    unsigned char *copy = realloc(out->geometry, geometry->size);
    out->geometry = copy ? copy : out->geometry;
    out->size = copy ? geometry->size : 0;
    out->held = false;
    out->serial = ++held->serial;
    out->handle = hasher_handle(held->hasher, geometry->bytes, geometry->size);
    if (copy)
        memcpy(copy, geometry->bytes, geometry->size);
}

struct held_body *held_find(struct held *held, const struct geometry *geometry)
{
    const uint64_t hash = digest(0, geometry->bytes, geometry->size);
    struct held_body *body = &held->body[hash >> (64 - HELD_BITS)];
    if (body->size != geometry->size || memcmp(body->geometry, geometry->bytes, body->size) != 0)
        enter(held, geometry, body);
    return body;
}

void held_clear(struct held *held)
{
    for (int i = 0; i < HELD_MAX; i++)
        free(held->body[i].geometry);
}
