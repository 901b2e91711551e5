/* What the keys in a log stand for. A result tells a key for each body of its query that came
 * whole; later frames carry the key in place of the components. Here the components are kept, by
 * body and key, so that a query of a log can be asked of anybody.
 *
 * A fixed number of bodies; the least recently used goes first. All memory is asked for at the
 * start. Two services may have told the same key for different components: then the later one
 * counts, as it did on the bus. */
#ifndef KNOWN_BODIES_H
#define KNOWN_BODIES_H

#include "query.h"

/* All but the components in one line of the cache. */
struct known_body {
    _Alignas(64) int64_t body_id;
    int64_t key;
    int64_t server_id; /* who told the key; 0: nobody */
    int64_t key_now;   /* for the user of this: 0 where it was just learned */
    bool mine;         /* likewise, false; learn.h sets it */
    bool used;         /* this and next: of known_bodies.c */
    uint32_t next;
    int32_t dim, shape; /* as the frame said, which may be anything */
    struct query_numbers components;
};

struct known_bodies;

/* Four times as many as a service keeps by default, some 40 MB. */
enum { KNOWN_BODIES_USUAL = 1 << 18 };

/* capacity from 1. Never NULL: ends the program where there is no memory. */
struct known_bodies *known_bodies_create(size_t capacity);
void known_bodies_destroy(struct known_bodies *known); /* may be NULL */

/* Hints, as those of cache.h. */
void known_bodies_expect_soon(const struct known_bodies *known, int64_t body_id, int64_t key);
void known_bodies_expect(const struct known_bodies *known, int64_t body_id, int64_t key);

/* NULL: it is not known. Good until something is learned. */
struct known_body *known_bodies_find(struct known_bodies *known, int64_t body_id, int64_t key);

/* Whether all that a result of this service could tell of the body is known; mine: and that the
 * user's own have told it. */
bool known_bodies_has(struct known_bodies *known, int64_t body_id, int64_t key, int64_t server_id,
                      bool mine);

/* Whether more than half of the capacity is used. Until then nothing has gone for others. */
bool known_bodies_half_full(const struct known_bodies *known);

/* On input: a frame with a body id and components; what its key is, and who said so. Returns what
 * is known of it now. */
struct known_body *known_bodies_learn(struct known_bodies *known, const struct query_frame *frame,
                                      int64_t key, int64_t server_id);

/* Whether a frame with components has those that are known, bit for bit. */
bool known_bodies_same(const struct known_body *body, const struct query_frame *frame);

/* Puts the components into a frame that has its key alone, and leaves the key. False: they are not
 * known, and the frame is as it was. */
bool known_bodies_complete(struct known_bodies *known, struct query_frame *frame);

#endif
