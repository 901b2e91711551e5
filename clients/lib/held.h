/* The bodies of a client, and whether the service holds them: those are sent by handle.
 *
 * The key is the encoded body. The handle of a body is computed when it enters the table. */
#ifndef HELD_H
#define HELD_H

#include "query.h"

/* HELD_MAX: the size of the table. If it has as many bodies, and more than twice those of a scene,
 * it is cleared before the scene. */
enum { HELD_BITS = 14, HELD_MAX = 1 << HELD_BITS };

struct held_body {
    struct held_body *next; /* of the same digest */
    bool held;              /* a result has shown that the service holds it */
    struct handle handle;
    size_t size;
    unsigned char bytes[]; /* [size], encoded */
};

/* All 0: empty. */
struct held {
    size_t count;
    struct held_body *body[HELD_MAX]; /* owned, by their digests */
};

/* Returns the entry of a body, which enters the table if it is not there; NULL if out of memory.
 * Valid until held_clear(). */
struct held_body *held_find(struct held *held, const struct body_view *view);

/* Removes all bodies. */
void held_clear(struct held *held);

#endif
