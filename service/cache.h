/* The bodies that the service has met, by id: components, inverse and all that fmb_body holds.
 *
 * A fixed number of bodies; the least recently used goes first. All memory is asked for at the
 * start, and touched as bodies come. Each set of components that is kept gets a key, a number
 * that no other set gets in the life of the cache: a frame may name its components by id and
 * key. A key dies when its body is replaced (same id, other components, shape or dimension) or
 * evicted. */
#ifndef CACHE_H
#define CACHE_H

#include "fmb/fmb.h"

#include <stdint.h>

enum { CACHE_BODIES_MAX = 10000000 };

struct cache;

struct cache_counts {
    int64_t bodies, capacity;
    int64_t hits;
    int64_t misses;
    int64_t replacements; /* of the misses: the id was held with other components */
    int64_t evictions;
};

/* On input: capacity from 1 to CACHE_BODIES_MAX; first_key, from 1 to 2^52: where the keys
 * start to count. With a random start, a key from another life of the service names nothing
 * here: a wrong hit would need the same id at the same place in two sequences that start
 * anywhere among 2^52 numbers.
 * On output: a cache, to be freed with cache_destroy(); NULL: out of memory. */
struct cache *cache_create(size_t capacity, int64_t first_key);

/* For a service, that takes no more memory later than it had when it was ready. Takes milliseconds.
 * A very large cache is left alone: it takes memory as bodies come. */
void cache_take_memory(struct cache *cache);
void cache_destroy(struct cache *cache);

/* Both return a body that is good until the cache is asked again. */

size_t cache_capacity(const struct cache *cache);

/* Hints: this id will be asked for soon, and, later, sooner. Bodies are anywhere in memory, and the
 * next two of them can be on their way at once. */
void cache_expect_soon(const struct cache *cache, int64_t id);
void cache_expect(const struct cache *cache, int64_t id);

/* Finds the body with these components (bitwise), or keeps it. On input: id > 0, the rest as
 * fmb_body_make() accepts it. On output: never NULL; *key. */
const struct fmb_body *cache_keep(struct cache *cache, int64_t id, int dim, int shape,
                                  const double *components, int64_t *key);

/* Finds the body that the key was given for, if it has this dimension and shape. NULL: it is not
 * held (any more); that counts neither as hit nor as miss. */
const struct fmb_body *cache_find(struct cache *cache, int64_t id, int64_t key, int dim, int shape);

struct cache_counts cache_counts(const struct cache *cache);

#endif
