#include "cache.h"

#include "query.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Entries are linked by index: each into the chain of its bucket, and all that are used into a
 * ring in the order of use. Entry 0 holds no body: it closes the ring, with the newest beyond it
 * on one side and the oldest on the other; and it ends the chains, so that buckets start as the
 * zeros that calloc() has without touching them. */
enum { NONE = 0, ENDS = 0 };

/* Apart from its body: each use of a body changes its neighbours in the order of use, and these are
 * anywhere; entries are small and lie together. */
struct entry {
    int64_t id, key;
    int32_t next;         /* in the bucket */
    int32_t newer, older; /* in the order of use */
};

/* What most pairs need of a body is in its first two lines. */
enum { LINE = 64 };

struct held {
    _Alignas(LINE) struct fmb_body body;
};

struct cache {
    int64_t next_key;
    uint64_t multiplier; /* odd, random */
    int bucket_shift;
    int32_t *bucket;     /* [2^(64 - bucket_shift)]: first entry of each */
    struct entry *entry; /* [capacity + 1] */
    struct held *held;   /* [capacity + 1] */
    struct cache_counts counts;
};

/* So that no entry lies in two lines, nor a body in more than it has to. */
static void *in_lines(size_t size)
{
    return aligned_alloc(LINE, (size + LINE - 1) / LINE * LINE);
}

struct cache *cache_create(size_t capacity, int64_t first_key)
{
    assert(capacity >= 1 && capacity <= CACHE_BODIES_MAX);
    int bucket_bits = 1;
    while (((size_t) 1 << bucket_bits) < capacity)
        bucket_bits++;
    const size_t entries = capacity + 1, buckets = (size_t) 1 << bucket_bits;
    struct cache *cache = malloc(sizeof *cache);
    struct entry *entry = in_lines(entries * sizeof *entry);
    struct held *held = in_lines(entries * sizeof *held);
    int32_t *bucket = calloc(buckets, sizeof *bucket);
    if (!cache || !entry || !held || !bucket) {
        free(cache);
        free(entry);
        free(held);
        free(bucket);
        return NULL;
    }
    *cache = (struct cache){.next_key = first_key,
                            .multiplier = query_id_mix(first_key) | 1,
                            .bucket_shift = 64 - bucket_bits,
                            .bucket = bucket,
                            .entry = entry,
                            .held = held,
                            .counts = {.capacity = (int64_t) capacity}};
    entry[ENDS].newer = entry[ENDS].older = ENDS;
    return cache;
}

/* Memory is there when it has been written to. */
static void touch_pages(void *memory, size_t size)
{
    enum { PAGE = 4096 };
    volatile char *page = memory;
    for (size_t at = 0; at < size; at += PAGE)
        page[at] = page[at];
}

void cache_take_memory(struct cache *cache)
{
    enum { TAKEN_MAX = 64 << 20 };
    const size_t entries = (size_t) cache->counts.capacity + 1;
    const size_t of_entries = entries * sizeof *cache->entry,
                 of_held = entries * sizeof *cache->held;
    const size_t of_buckets = sizeof *cache->bucket << (64 - cache->bucket_shift);
    if (of_entries + of_held + of_buckets > TAKEN_MAX)
        return;
    touch_pages(cache->entry, of_entries);
    touch_pages(cache->held, of_held);
    touch_pages(cache->bucket, of_buckets);
}

void cache_destroy(struct cache *cache)
{
    if (!cache)
        return;
    free(cache->bucket);
    free(cache->entry);
    free(cache->held);
    free(cache);
}

/* Multiplicative hashing: the upper bits of the product. The multiplier is random, lest somebody
 * chooses ids that all fall into one bucket. */
static int32_t *bucket_of(const struct cache *cache, int64_t id)
{
    return &cache->bucket[(uint64_t) id * cache->multiplier >> cache->bucket_shift];
}

static int32_t find(struct cache *cache, int64_t id)
{
    int32_t e = *bucket_of(cache, id);
    while (e != NONE && cache->entry[e].id != id)
        e = cache->entry[e].next;
    return e;
}

void cache_expect_soon(const struct cache *cache, int64_t id)
{
    __builtin_prefetch(bucket_of(cache, id));
}

void cache_expect(const struct cache *cache, int64_t id)
{
    const int32_t e = *bucket_of(cache, id);
    const char *body = (const char *) &cache->held[e];
    __builtin_prefetch(&cache->entry[e]);
    __builtin_prefetch(body);
    __builtin_prefetch(body + LINE);
}

static void unlink_use(struct cache *cache, int32_t e)
{
    int32_t newer = cache->entry[e].newer, older = cache->entry[e].older;
    cache->entry[newer].older = older;
    cache->entry[older].newer = newer;
}

static void link_newest(struct cache *cache, int32_t e)
{
    int32_t newest = cache->entry[ENDS].older;
    cache->entry[e].newer = ENDS;
    cache->entry[e].older = newest;
    cache->entry[newest].newer = e;
    cache->entry[ENDS].older = e;
}

static void touch(struct cache *cache, int32_t e)
{
    unlink_use(cache, e);
    link_newest(cache, e);
}

static int32_t evict_oldest(struct cache *cache)
{
    int32_t e = cache->entry[ENDS].newer;
    int32_t *link = bucket_of(cache, cache->entry[e].id);
    while (*link != e)
        link = &cache->entry[*link].next;
    *link = cache->entry[e].next;
    unlink_use(cache, e);
    cache->counts.evictions++;
    cache->counts.bodies--;
    return e;
}

/* A new entry for the id, linked everywhere. */
static int32_t insert(struct cache *cache, int64_t id)
{
    int32_t e = cache->counts.bodies < cache->counts.capacity ? (int32_t) cache->counts.bodies + 1
                                                              : evict_oldest(cache);
    int32_t *bucket = bucket_of(cache, id);
    cache->entry[e].id = id;
    cache->entry[e].next = *bucket;
    *bucket = e;
    link_newest(cache, e);
    cache->counts.bodies++;
    return e;
}

/* Component by component, since they are stored with gaps in 2D. -0 and 0 are different. Of a size
 * that a compiler knows it needs no call. */
static bool same_component(const double *a, const double *b, int dim)
{
    return dim == 3 ? memcmp(a, b, 3 * sizeof *a) == 0 : memcmp(a, b, 2 * sizeof *a) == 0;
}

static bool same_body(const struct fmb_body *body, int dim, int shape, const double *components)
{
    if (body->dim != dim || body->shape != (enum fmb_shape) shape)
        return false;
    for (int i = 0; i < body->count; i++)
        if (!same_component(body->component[i], components + i * dim, dim))
            return false;
    return true;
}

const struct fmb_body *cache_keep(struct cache *cache, int64_t id, int dim, int shape,
                                  const double *components, int64_t *key)
{
    int32_t e = find(cache, id);
    if (e != NONE && same_body(&cache->held[e].body, dim, shape, components)) {
        cache->counts.hits++;
    } else {
        cache->counts.misses++;
        if (e == NONE)
            e = insert(cache, id);
        else
            cache->counts.replacements++;
        size_t count = (size_t) (fmb_component_count(dim, shape) * dim);
        enum fmb_status status = fmb_body_make(dim, shape, components, count, &cache->held[e].body);
        assert(status == FMB_OK);
        (void) status;
        cache->entry[e].key = cache->next_key++;
    }
    touch(cache, e);
    *key = cache->entry[e].key;
    return &cache->held[e].body;
}

const struct fmb_body *cache_find(struct cache *cache, int64_t id, int64_t key, int dim, int shape)
{
    int32_t e = find(cache, id);
    if (e == NONE || cache->entry[e].key != key || cache->held[e].body.dim != dim ||
        (int) cache->held[e].body.shape != shape)
        return NULL;
    cache->counts.hits++;
    touch(cache, e);
    return &cache->held[e].body;
}

size_t cache_capacity(const struct cache *cache)
{
    return (size_t) cache->counts.capacity;
}

struct cache_counts cache_counts(const struct cache *cache)
{
    return cache->counts;
}
