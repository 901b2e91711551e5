/* Cache of bodies by handle: for each its encoded form, and the struct fmb_body with its frames and
 * their inverses.
 *
 * The capacity is a fixed number of frames. A body takes as many as it has, and of each hull one
 * more for each CACHE_VERTICES of its vertices, or part of them. The least recently used
 * body is evicted first, and for a body of several frames its neighbours in memory too. A body in
 * use by a query is pinned: it is not evicted until the query has released it. All memory is
 * allocated by cache_create(). Each body has one entry, whatever its ids: two clients that use
 * the same id for different bodies do not evict each other's. A second table maps an id to its
 * latest entry, so that a body sent again with its frames under the same id is found by comparing
 * bytes, without SHA-256. Both tables are hashed with a secret, so that no client can choose bodies
 * or ids that collide. One cache may be used by one thread at a time; caches share no state. */
#ifndef CACHE_H
#define CACHE_H

#include "query.h"

#include <stdint.h>

enum { CACHE_FRAMES_MAX = 10000000, CACHE_VERTICES = 8 };

struct cache;

struct cache_counts {
    int64_t bodies;                  /* held now */
    int64_t frames, frame_capacity;  /* that these bodies take; of the cache */
    int64_t ids;                     /* ids whose latest body is held */
    int64_t hits, misses, evictions; /* since cache_create() */
};

/* On input: frames from 1 to CACHE_FRAMES_MAX; secret: random. Returns NULL if out of memory. The
 * caller destroys it; cache_destroy() accepts NULL. */
struct cache *cache_create(size_t frames, const uint64_t secret[2]);
void cache_destroy(struct cache *cache);

/* Touches all pages of a cache of up to 64 MB, so that the memory of the process does not grow
 * after start. Larger caches are left to grow. Takes milliseconds. */
void cache_prefault(struct cache *cache);

/* A body in the cache. */
struct cached {
    struct body_view view; /* owned by the cache */
    struct fmb_body body;  /* last: all frames follow each other in memory from body.one on */
};

/* Looks up a handle. Returns the body, pinned: it is valid until the caller releases it, once for
 * each call of cache_find(), cache_lookup(), cache_add() or cache_intern() that returned it, and is
 * then the most recently used. Counts a hit. Returns NULL, and counts nothing, if it is not held.
 */
const struct cached *cache_find(struct cache *cache, const struct handle *handle);

/* The same without counting or pinning; valid until a body is added. */
const struct cached *cache_peek(const struct cache *cache, const struct handle *handle);

/* Looks up an encoded body, in time proportional to its bytes. On input: id, or 0 for none; a body
 * whose frames the engine accepts. On output: view->handle. Returns the body, pinned as by
 * cache_find(), and counts a hit; or NULL, and counts a miss, if it is not held. */
const struct cached *cache_lookup(struct cache *cache, int64_t id, struct body_view *view);

/* Adds a body that cache_lookup() did not find, which may evict others. On input: its id, its
 * encoded form with the handle, and the body, which are copied; body NULL: it is made here, in one
 * step. Returns the body, pinned as by cache_find(); if it has been added since, the one that is
 * held; NULL if it cannot be added: it takes more frames than the capacity, or pinned bodies leave
 * no free memory of that length. */
const struct cached *cache_add(struct cache *cache, int64_t id, const struct body_view *view,
                               const struct fmb_body *body);

/* Finds a body, or makes it in one step and adds it: cache_lookup(), then cache_add(). */
const struct cached *cache_intern(struct cache *cache, int64_t id, struct body_view *view);

/* Evicts all bodies that are not pinned. */
void cache_clear(struct cache *cache);

/* Unpins a body. On input: a body that one of the functions above returned pinned, not released
 * since. */
void cache_release(struct cache *cache, const struct cached *cached);

/* Prefetches the memory that the look-up of a placement's body will touch. On input: any placement,
 * checked or not. */
void cache_prefetch(const struct cache *cache, const struct query_placement *placement);

/* Iterates over all bodies in the order of memory. On input: *position: 0 at the start; any value
 * is safe. Returns the first body at or after *position, and sets *position to the next one; NULL:
 * there are no more. Look-ups do not change the order. A body added during the iteration may be
 * missed if it takes the memory of an evicted one. Valid until a body is added. */
const struct cached *cache_next(const struct cache *cache, int64_t *position);

struct cache_counts cache_counts(const struct cache *cache);

/* The most bodies in one bucket of the table by handle, which bounds the comparisons of a look-up.
 * For tests; takes time proportional to the capacity. */
int64_t cache_longest_chain(const struct cache *cache);

#endif
