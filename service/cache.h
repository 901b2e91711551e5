/* The bodies that the service holds, by handle: geometry and struct fmb_body with its inverse.
 *
 * The capacity is a fixed number of frames; the least recently used body is evicted first. All
 * memory is allocated by cache_create(). Each geometry has one entry, whatever its ids: two clients
 * that use the same id for different bodies do not disturb each other. A second table maps an id to
 * its latest entry, so that a body that comes whole again under its id is found by comparing bytes,
 * without SHA-256. Both tables are hashed with a secret, so that no client can choose bodies or ids
 * that collide. For one thread at a time. */
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

/* A body in the cache. Valid until the next cache_keep(). */
struct cached {
    struct fmb_body body;
    struct handle handle;
    struct geometry geometry; /* owned by the cache */
};

/* The body with this handle, which becomes the most recently used; counts a hit. NULL: not held;
 * counts nothing. */
const struct cached *cache_find(struct cache *cache, const struct handle *handle);

/* The same, without counting or marking it as used. */
const struct cached *cache_peek(const struct cache *cache, const struct handle *handle);

/* The body with this geometry, which becomes the most recently used; it is added if it was not
 * held. On input: id, or 0 for none; a geometry of one frame that fmb_body_make() accepts. Never
 * NULL. */
const struct cached *cache_keep(struct cache *cache, int64_t id, const struct geometry *geometry);

/* Prepares a body without adding it. On input: a geometry as for cache_keep(). */
void cache_make_body(const struct geometry *geometry, struct fmb_body *out);

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
