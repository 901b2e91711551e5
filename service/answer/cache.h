/* The bodies that the service holds, by handle: geometry and struct fmb_body with its frames and
 * their inverses.
 *
 * The capacity is a fixed number of frames; a body takes as many as it has. The least recently used
 * body is evicted first, and for a body of several frames its neighbours in memory too. A body that
 * a query uses is not evicted until the query has released it. All memory is allocated by
 * cache_create(). Each geometry has one entry, whatever its ids: two clients that use the same id
 * for different bodies do not disturb each other. A second table maps an id to its latest entry, so
 * that a body that comes whole again under its id is found by comparing bytes, without SHA-256.
 * Both tables are hashed with a secret, so that no client can choose bodies or ids that collide.
 * For one thread at a time. */
#ifndef CACHE_H
#define CACHE_H

#include "query.h"

#include <stdint.h>

enum { CACHE_FRAMES_MAX = 10000000 };

struct cache;

struct cache_counts {
    int64_t bodies;
    int64_t frames, frame_capacity;
    int64_t ids; /* ids whose latest entry is known */
    int64_t hits, misses, evictions;
};

/* On input: frames from 1 to CACHE_FRAMES_MAX; secret: random. NULL: out of memory. cache_destroy()
 * accepts NULL. */
struct cache *cache_create(size_t frames, const uint64_t secret[2]);
void cache_destroy(struct cache *cache);

/* Touches the memory of a cache of up to 64 MB, so that the service's memory does not grow after it
 * is ready. Takes milliseconds. */
void cache_take_memory(struct cache *cache);

/* A body in the cache. */
struct cached {
    struct handle handle;
    struct geometry geometry; /* owned by the cache */
    struct fmb_body body;     /* last: the frames of a body of several begin where body.one is */
};

/* The body with this handle, which becomes the most recently used; counts a hit. It is valid until
 * the caller releases it, once for each time it was found or kept. NULL: not held; counts nothing.
 */
const struct cached *cache_find(struct cache *cache, const struct handle *handle);

/* The same, without counting or marking it as used; valid until the next cache_keep(). */
const struct cached *cache_peek(const struct cache *cache, const struct handle *handle);

/* The body with this geometry, as cache_find() returns it; it is added if it was not held. On
 * input: id, or 0 for none; a geometry whose frames fmb_frame_make() accepts. *handle: its handle.
 * NULL: it is not held and has more frames than the capacity, or than there is memory for among
 * bodies in use. */
const struct cached *cache_keep(struct cache *cache, int64_t id, const struct geometry *geometry,
                                struct handle *handle);

/* On input: a body that was found or kept, and not released since. */
void cache_release(struct cache *cache, const struct cached *cached);

/* Prefetches the memory that a look-up will touch. On input: any placement. */
void cache_prefetch(const struct cache *cache, const struct placement *placement);

/* Iterates over all bodies: returns the first at *position (0 at first) or after it, and sets
 * *position to the next one; NULL: there are no more. Look-ups do not change the order. A body
 * added during the iteration may be missed if it takes the position of an evicted one. */
const struct cached *cache_next(const struct cache *cache, int64_t *position);

struct cache_counts cache_counts(const struct cache *cache);

/* The most bodies in one bucket of the table by handle: the most that a look-up compares. For
 * tests; takes time proportional to the capacity. */
int64_t cache_longest_chain(const struct cache *cache);

#endif
