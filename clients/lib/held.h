/* A table of bodies that the service may hold. A body that it holds can be sent by handle.
 *
 * The key is the geometry. Each slot has one body: a new body replaces the one in its slot, which
 * is from then on sent whole again. The handle of a body is computed when it enters the table. */
#ifndef HELD_H
#define HELD_H

#include "query.h"

enum { HELD_BITS = 14, HELD_MAX = 1 << HELD_BITS };

/* All 0: an empty slot. */
struct held_body {
    bool held;               /* a result has shown that the service holds it */
    uint64_t serial;         /* changes when another body takes the slot */
    size_t size;             /* 0: not stored, for lack of memory */
    unsigned char *geometry; /* owned, [size] */
    struct handle handle;    /* of these bytes */
};

struct held {
    struct hasher *hasher; /* not owned */
    uint64_t serial;       /* of the newest body */
    struct held_body body[HELD_MAX];
};

/* Returns the entry of a body with this geometry, which enters the table if it is not there. Valid
 * until the next call. */
struct held_body *held_find(struct held *held, const struct geometry *geometry);

/* Frees the bodies. */
void held_clear(struct held *held);

#endif
