#include "held.h"

#include "digest.h"

#include <assert.h>
#include <limits.h>
#include <string.h>

static_assert((int) GEOMETRY_FRAME_BYTES_MAX <= UCHAR_MAX, "held_body.size");

struct held_body *held_find(struct held *held, const struct geometry *geometry)
{
    const uint64_t hash = digest(0, geometry->bytes, geometry->size);
    struct held_body *body = &held->body[hash >> (64 - HELD_BITS)];
    if (body->size == geometry->size && memcmp(body->geometry, geometry->bytes, body->size) == 0)
        return body;
    body->held = false;
    body->size = (unsigned char) geometry->size;
    memcpy(body->geometry, geometry->bytes, geometry->size);
    body->handle = hasher_handle(held->hasher, geometry->bytes, geometry->size);
    return body;
}
