/* The bodies that the service is known to hold, so that they can be sent by handle.
 *
 * A table by content, one body per slot: a new body replaces another in its slot, which is then
 * sent whole again. The handle of a body is computed when it enters the table. */
#ifndef HELD_H
#define HELD_H

#include "query.h"

enum { HELD_BITS = 14, HELD_MAX = 1 << HELD_BITS };

/* All 0: an empty slot. */
struct held_body {
    bool held; /* by the service */
    unsigned char size;
    unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX]; /* [size] */
    struct handle handle;                             /* of these bytes */
};

struct held {
    struct hasher *hasher; /* not owned */
    struct held_body body[HELD_MAX];
};

/* The entry of a body with this geometry, of at most GEOMETRY_FRAME_BYTES_MAX bytes; valid until
 * the next call. */
struct held_body *held_find(struct held *held, const struct geometry *geometry);

#endif
