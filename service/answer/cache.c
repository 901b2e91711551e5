#include "cache.h"

#include "big_endian.h"
#include "body.h"
#include "runs.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* A body takes a run of slots, one for each frame. Entry e belongs to the body that begins in slot
 * e - 1. Entries are linked by index: each into the chain of its bucket, and all that no query uses
 * into a ring in the order of use. Entry 0 holds no body. It closes the ring, with the newest entry
 * beyond it on one side and the oldest on the other, and it ends the chains: buckets start as the
 * zeros that calloc() provides without touching them. */
enum { NONE = 0, ENDS = 0 };

/* Apart from the body: each use of a body changes its neighbours in the order of use, which may be
 * any entries. Two entries share a cache line. */
struct entry {
    struct handle handle;
    int32_t next;         /* in the bucket */
    int32_t newer, older; /* in the order of use */
    uint32_t generation;  /* how many bodies have begun here before */
};

enum { LINE = 64 };

/* What is in the slots of a body: this, the frames but the first, the bytes of the geometry. */
struct held {
    int32_t ids;   /* that lead to this entry */
    int32_t users; /* queries, or placements of them */
    struct cached cached;
};

static_assert(sizeof(struct held) == offsetof(struct held, cached.body) + BODY_BYTES(1),
              "the frames of a body follow each other");

/* Enough for a body of one frame, and the more so for several. */
enum {
    SLOT_BYTES = (sizeof(struct held) + GEOMETRY_FRAME_BYTES_MAX + LINE - 1) / LINE * LINE,
};

/* The latest entry of an id. It is stale once the entry holds another body. */
struct latest {
    int64_t id;    /* 0: not used */
    int32_t entry; /* index */
    uint32_t generation;
};

/* An id has one set, and any place in it. The one that came first is replaced. */
enum { WAYS = LINE / sizeof(struct latest) };

struct id_set {
    _Alignas(LINE) struct latest way[WAYS]; /* the newest first */
};

struct cache {
    uint64_t bucket_multiplier, set_multiplier; /* odd, secret */
    int bucket_shift, set_shift;
    int32_t *bucket;    /* [2^(64 - bucket_shift)]: first entry of each */
    struct id_set *set; /* [2^(64 - set_shift)], in set_memory */
    void *set_memory, *entry_memory;
    struct entry *entry; /* [frame_capacity + 1] */
    unsigned char *slot; /* [frame_capacity][SLOT_BYTES] */
    struct runs runs;    /* of slots */
    uint64_t *begins;    /* bit s: a body begins in slot s */
    struct hasher *hasher;
    struct cache_counts counts;
};

/* ---- Memory ---- */

/* The least number of bits, from 1, that count so many things. */
static int bits_for(size_t count)
{
    int bits = 1;
    while (((size_t) 1 << bits) < count)
        bits++;
    return bits;
}

static size_t bucket_count(const struct cache *cache)
{
    return (size_t) 1 << (64 - cache->bucket_shift);
}

static size_t set_count(const struct cache *cache)
{
    return (size_t) 1 << (64 - cache->set_shift);
}

/* Untouched zeros at a multiple of a cache line. *memory: the address to free. */
static void *allocate_zero_lines(size_t count, size_t size, void **memory)
{
    *memory = calloc(count * size + LINE, 1);
    return *memory ? (char *) *memory + (LINE - (uintptr_t) *memory % LINE) : NULL;
}

static size_t begins_count(const struct cache *cache)
{
    return (size_t) cache->counts.frame_capacity / 64 + 1;
}

/* Allocates what cache->counts and the shifts say; sets and buckets are empty. */
static bool allocate(struct cache *cache)
{
    const size_t frames = (size_t) cache->counts.frame_capacity;
    cache->bucket = calloc(bucket_count(cache), sizeof *cache->bucket);
    cache->set = allocate_zero_lines(set_count(cache), sizeof *cache->set, &cache->set_memory);
    cache->entry = allocate_zero_lines(frames + 1, sizeof *cache->entry, &cache->entry_memory);
    cache->slot = aligned_alloc(LINE, frames * SLOT_BYTES);
    cache->runs.slot = calloc(frames, sizeof *cache->runs.slot);
    cache->begins = calloc(begins_count(cache), sizeof *cache->begins);
    cache->hasher = hasher_create();
    return cache->bucket && cache->set && cache->entry && cache->slot && cache->runs.slot &&
           cache->begins && cache->hasher;
}

struct cache *cache_create(size_t frames, const uint64_t secret[2])
{
    assert(frames >= 1 && frames <= CACHE_FRAMES_MAX);
    struct cache *cache = malloc(sizeof *cache);
    if (!cache)
        return NULL;
    *cache = (struct cache){.bucket_multiplier = secret[0] | 1,
                            .set_multiplier = secret[1] | 1,
                            .bucket_shift = 64 - bits_for(frames),
                            .set_shift = 64 - bits_for((frames + 1) / 2),
                            .counts = {.frame_capacity = (int64_t) frames}};
    if (!allocate(cache)) {
        cache_destroy(cache);
        return NULL;
    }
    runs_init(&cache->runs, cache->runs.slot, (int32_t) frames);
    cache->entry[ENDS].newer = cache->entry[ENDS].older = ENDS;
    return cache;
}

void cache_destroy(struct cache *cache)
{
    if (!cache)
        return;
    hasher_destroy(cache->hasher);
    free(cache->bucket);
    free(cache->set_memory);
    free(cache->entry_memory);
    free(cache->slot);
    free(cache->runs.slot);
    free(cache->begins);
    free(cache);
}

/* A page is allocated when it is written to. */
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
    const size_t frames = (size_t) cache->counts.frame_capacity;
    const size_t entry_bytes = (frames + 1) * sizeof *cache->entry;
    const size_t slot_bytes = frames * SLOT_BYTES;
    const size_t bucket_bytes = bucket_count(cache) * sizeof *cache->bucket;
    const size_t set_bytes = set_count(cache) * sizeof *cache->set;
    if (entry_bytes + slot_bytes + bucket_bytes + set_bytes > TAKEN_MAX)
        return;
    touch_pages(cache->entry, entry_bytes);
    touch_pages(cache->slot, slot_bytes);
    touch_pages(cache->bucket, bucket_bytes);
    touch_pages(cache->set, set_bytes);
    touch_pages(cache->begins, begins_count(cache) * sizeof *cache->begins);
    touch_pages(cache->runs.slot, frames * sizeof *cache->runs.slot);
}

/* ---- Hashing ----
 *
 * Multiply-shift: the upper bits of x times a secret odd number, modulo 2^64. For any two different
 * x of 64 bits, whatever the client knows of this code, they are equal for at most one in
 * (buckets / 2) of all odd numbers (Dietzfelbinger, Hagerup, Katajainen, Penttonen, "A Reliable
 * Randomized Algorithm for the Closest-Pair Problem", 1997). No result and no counter depends on
 * the secret but through which ids are known, so that n bodies or ids that a client has chosen
 * are, in the mean, each compared with fewer than 1 + 2 n / buckets.
 *
 * Of a handle x is the first half. The handles of bodies are hashes themselves: two bodies with the
 * same first half take some 2^32 hashes to find, three some 2^43, and a set that would make a chain
 * long is out of reach. Both halves in one sum of products would be no better: differences of 2^63
 * in both would cancel for all odd numbers. */

static int32_t *bucket_of(const struct cache *cache, const struct handle *handle)
{
    const uint64_t half = big_endian_64(handle->bytes);
    return &cache->bucket[half * cache->bucket_multiplier >> cache->bucket_shift];
}

static struct latest *ways_of(const struct cache *cache, int64_t id)
{
    return cache->set[(uint64_t) id * cache->set_multiplier >> cache->set_shift].way;
}

static int32_t find(const struct cache *cache, const struct handle *handle)
{
    int32_t e = *bucket_of(cache, handle);
    while (e != NONE && !handle_equal(&cache->entry[e].handle, handle))
        e = cache->entry[e].next;
    return e;
}

/* ---- Entries ---- */

static struct held *held_of(const struct cache *cache, int32_t e)
{
    return (struct held *) (cache->slot + (size_t) (e - 1) * SLOT_BYTES);
}

static int32_t entry_of(const struct cache *cache, const struct held *held)
{
    return (int32_t) (((const unsigned char *) held - cache->slot) / SLOT_BYTES) + 1;
}

static struct held *held_with(const struct cached *cached)
{
    return (struct held *) ((char *) cached - offsetof(struct held, cached));
}

static void set_begin(struct cache *cache, int32_t e, bool begins)
{
    const uint64_t bit = (uint64_t) 1 << (e - 1) % 64;
    uint64_t *word = &cache->begins[(e - 1) / 64];
    *word = begins ? *word | bit : *word & ~bit;
}

/* ---- Order of use ---- */

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

static const struct cached *use(struct cache *cache, int32_t e)
{
    struct held *held = held_of(cache, e);
    if (held->users++ == 0)
        unlink_use(cache, e);
    return &held->cached;
}

void cache_release(struct cache *cache, const struct cached *cached)
{
    struct held *held = held_with(cached);
    assert(held->users > 0);
    if (--held->users == 0)
        link_newest(cache, entry_of(cache, held));
}

/* ---- Ids ---- */

static bool is_live(const struct cache *cache, const struct latest *latest)
{
    return latest->id != 0 && cache->entry[latest->entry].generation == latest->generation;
}

static int way_of(const struct latest *way, int64_t id)
{
    int w = 0;
    while (w < WAYS && way[w].id != id)
        w++;
    return w;
}

/* The latest entry of the id, if it has this geometry. A stale one cannot mislead: whatever body is
 * there now is the right one if its bytes are the same. */
static int32_t find_latest(const struct cache *cache, int64_t id, const struct geometry *geometry)
{
    const struct latest *way = ways_of(cache, id);
    const int w = way_of(way, id);
    if (w == WAYS || !is_live(cache, &way[w]))
        return NONE;
    const struct geometry *held = &held_of(cache, way[w].entry)->cached.geometry;
    const bool same =
        held->size == geometry->size && memcmp(held->bytes, geometry->bytes, geometry->size) == 0;
    return same ? way[w].entry : NONE;
}

static void forget(struct cache *cache, const struct latest *latest)
{
    if (is_live(cache, latest)) {
        held_of(cache, latest->entry)->ids--;
        cache->counts.ids--;
    }
}

/* From now on the id leads to the entry. */
static void set_latest(struct cache *cache, int64_t id, int32_t e)
{
    struct latest *way = ways_of(cache, id);
    int w = way_of(way, id);
    if (w == WAYS)
        w = WAYS - 1;
    forget(cache, &way[w]);
    memmove(&way[1], &way[0], (size_t) w * sizeof *way);
    way[0] = (struct latest){id, e, cache->entry[e].generation};
    held_of(cache, e)->ids++;
    cache->counts.ids++;
}

/* ---- Bodies ---- */

/* Returns the first slot of the free run that the body leaves. */
static int32_t evict(struct cache *cache, int32_t e)
{
    const struct held *held = held_of(cache, e);
    int32_t *link = bucket_of(cache, &cache->entry[e].handle);
    while (*link != e)
        link = &cache->entry[*link].next;
    *link = cache->entry[e].next;
    unlink_use(cache, e);
    set_begin(cache, e, false);
    cache->entry[e].generation++;
    cache->counts.ids -= held->ids;
    cache->counts.evictions++;
    cache->counts.bodies--;
    cache->counts.frames -= held->cached.body.frame_count;
    return runs_free(&cache->runs, e - 1);
}

/* Evicts the body that begins in a slot. Returns the first slot of the free run; -1: there is no
 * such slot, or the body is in use. */
static int32_t evict_at(struct cache *cache, int32_t slot)
{
    const bool unused = slot >= 0 && held_of(cache, slot + 1)->users == 0;
    return unused ? evict(cache, slot + 1) : -1;
}

/* Evicts the oldest body and its neighbours, until there is a free run of so many slots or the
 * bodies on both sides are in use. */
static void evict_around_oldest(struct cache *cache, int32_t slots)
{
    int32_t free = evict(cache, cache->entry[ENDS].newer);
    while (free >= 0 && runs_length(&cache->runs, free) < slots) {
        const int32_t more = evict_at(cache, runs_after(&cache->runs, free));
        free = more >= 0 ? more : evict_at(cache, runs_before(&cache->runs, free));
    }
}

/* A free entry for a body of so many frames. NONE: there is no memory. */
static int32_t take_entry(struct cache *cache, int32_t frames)
{
    enum { ATTEMPTS = 4 };
    if (frames > cache->counts.frame_capacity)
        return NONE;
    int32_t slot = runs_take(&cache->runs, frames);
    for (int i = 0; slot < 0 && i < ATTEMPTS && cache->entry[ENDS].newer != ENDS; i++) {
        evict_around_oldest(cache, frames);
        slot = runs_take(&cache->runs, frames);
    }
    return slot + 1;
}

static void set_held(struct held *held, const struct handle *handle,
                     const struct geometry *geometry)
{
    const size_t frames = (size_t) body_frame_count(geometry);
    unsigned char *bytes = (unsigned char *) &held->cached.body + BODY_BYTES(frames);
    body_make(geometry, &held->cached.body);
    memcpy(bytes, geometry->bytes, geometry->size);
    held->cached.handle = *handle;
    held->cached.geometry = (struct geometry){bytes, geometry->size};
    held->ids = held->users = 0;
}

/* A new entry, linked everywhere. NONE: there is no memory. */
static int32_t insert(struct cache *cache, const struct handle *handle,
                      const struct geometry *geometry)
{
    const int32_t frames = body_frame_count(geometry), e = take_entry(cache, frames);
    if (e == NONE)
        return NONE;
    int32_t *bucket = bucket_of(cache, handle);
    set_held(held_of(cache, e), handle, geometry);
    cache->entry[e].handle = *handle;
    cache->entry[e].next = *bucket;
    *bucket = e;
    link_newest(cache, e);
    set_begin(cache, e, true);
    cache->counts.bodies++;
    cache->counts.frames += frames;
    return e;
}

const struct cached *cache_keep(struct cache *cache, int64_t id, const struct geometry *geometry,
                                struct handle *handle)
{
    int32_t e = id ? find_latest(cache, id, geometry) : NONE;
    if (e != NONE) {
        cache->counts.hits++;
        *handle = cache->entry[e].handle;
        return use(cache, e);
    }
    *handle = hasher_handle(cache->hasher, geometry->bytes, geometry->size);
    e = find(cache, handle);
    if (e != NONE) {
        cache->counts.hits++;
    } else {
        cache->counts.misses++;
        e = insert(cache, handle, geometry);
    }
    if (e == NONE)
        return NULL;
    if (id)
        set_latest(cache, id, e);
    return use(cache, e);
}

const struct cached *cache_find(struct cache *cache, const struct handle *handle)
{
    const int32_t e = find(cache, handle);
    if (e == NONE)
        return NULL;
    cache->counts.hits++;
    return use(cache, e);
}

const struct cached *cache_peek(const struct cache *cache, const struct handle *handle)
{
    const int32_t e = find(cache, handle);
    return e == NONE ? NULL : &held_of(cache, e)->cached;
}

/* ---- Prefetching ---- */

static void prefetch_entry(const struct cache *cache, int32_t e)
{
    if (e == NONE)
        return;
    const char *body = (const char *) held_of(cache, e);
    __builtin_prefetch(&cache->entry[e]);
    __builtin_prefetch(body);
    __builtin_prefetch(body + LINE);
}

void cache_prefetch(const struct cache *cache, const struct placement *placement)
{
    if (placement_by_handle(placement)) {
        prefetch_entry(cache, *bucket_of(cache, &placement->handle));
        return;
    }
    const struct latest *way = ways_of(cache, placement->body_id);
    const int w = way_of(way, placement->body_id);
    if (w == WAYS)
        return;
    prefetch_entry(cache, way[w].entry);
    if (placement->frame_count == 1 && way[w].entry != NONE)
        for (size_t at = sizeof(struct held); at < SLOT_BYTES; at += LINE)
            __builtin_prefetch((const char *) held_of(cache, way[w].entry) + at);
}

/* ---- All bodies, and counts ---- */

const struct cached *cache_next(const struct cache *cache, int64_t *position)
{
    const int64_t capacity = cache->counts.frame_capacity;
    int64_t slot = *position;
    if (slot < 0 || slot >= capacity)
        return NULL;
    uint64_t word = cache->begins[slot / 64] >> slot % 64;
    while (word == 0) {
        slot = (slot / 64 + 1) * 64;
        if (slot >= capacity)
            return NULL;
        word = cache->begins[slot / 64];
    }
    slot += __builtin_ctzll(word);
    *position = slot + 1;
    return &held_of(cache, (int32_t) slot + 1)->cached;
}

struct cache_counts cache_counts(const struct cache *cache)
{
    return cache->counts;
}

int64_t cache_longest_chain(const struct cache *cache)
{
    int64_t longest = 0;
    for (size_t b = 0; b < bucket_count(cache); b++) {
        int64_t length = 0;
        for (int32_t e = cache->bucket[b]; e != NONE; e = cache->entry[e].next)
            length++;
        longest = length > longest ? length : longest;
    }
    return longest;
}
