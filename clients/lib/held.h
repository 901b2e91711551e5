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
    bool held;               /* by the service */
    uint64_t serial;         /* another one whenever another body takes the slot */
    size_t size;             /* 0: unknown, there was no memory */
    unsigned char *geometry; /* owned, [size] */
    struct handle handle;    /* of these bytes */
};

struct held {
    struct hasher *hasher; /* not owned */
    uint64_t serial;       /* of the last body that entered */
    struct held_body body[HELD_MAX];
};

/* The entry of a body with this geometry; valid until the next call. */
struct held_body *held_find(struct held *held, const struct geometry *geometry);

void held_clear(struct held *held);

#endif
