#include "cache.h"

#include "big_endian.h"
#include "body.h"
#include "geometry.h"
#include "runs.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Data structure. A body takes a run of slots, one for each frame, and more for hulls. Entry e
 * belongs to the body that begins in slot e - 1. Entries are linked by index: each into the chain
 * of its hash bucket, and all that are not pinned into the LRU list. Entry 0 has no body. It is the
 * sentinel of the LRU list, a ring: its `older` is the newest entry and its `newer` the oldest.
 * Index 0 also ends the chains, so that the buckets can be zeros from calloc(), which are not
 * touched. */
enum { NONE = 0, SENTINEL = 0 };

/* Entries are stored apart from the bodies, since each use of a body changes its neighbours in the
 * LRU list, which may be any entries. Two entries share a cache line. */
struct cache_entry {
    struct handle handle;
    int32_t next;         /* in the chain of the bucket */
    int32_t newer, older; /* in the LRU list; unspecified while pinned */
    uint32_t generation;  /* number of bodies evicted from this entry */
};

enum { LINE = 64 }; /* bytes of a cache line */

/* The slots of a body contain this record, then the frames after the first, then the vertices of
 * hulls, then the bytes of the encoded body. */
struct cache_record {
    int32_t ids;  /* number of ids whose latest entry is this one */
    int32_t pins; /* number of uses that are not released */
    struct cached cached;
};

static_assert(sizeof(struct cache_record) ==
                  offsetof(struct cache_record, cached.body) + BODY_BYTES(1),
              "the frames of a body follow each other");

/* Bytes of a slot: enough for a body of one frame. A body of n frames that are no hulls fits into n
 * slots. A hull of up to 8 k vertices takes at most 8 (24 k + 4 k) bytes of memory, and 13 + 8 *
 * 24 k encoded: its k further slots hold all of them but the 13, for which its frame has space. */
enum {
    SLOT_BYTES = (sizeof(struct cache_record) + GEOMETRY_FRAME_BYTES_MAX + LINE - 1) / LINE * LINE,
};

static_assert(SLOT_BYTES >= CACHE_VERTICES * (28 + 24), "a slot holds 8 vertices");

/* The latest entry of an id. It is stale if the generation of the entry has changed since. */
struct latest {
    int64_t id;    /* 0: not used */
    int32_t entry; /* index */
    uint32_t generation;
};

/* The table of ids is set-associative. An id belongs to one set, in any of its ways. A new id
 * replaces the oldest of its set. */
enum { WAYS = LINE / sizeof(struct latest) };

struct id_set {
    _Alignas(LINE) struct latest way[WAYS]; /* [age] the one set last comes first */
};

struct cache {
    uint64_t bucket_multiplier, set_multiplier; /* odd, secret */
    int bucket_shift, set_shift;
    int32_t *bucket;           /* [2^(64 - bucket_shift)]: first entry of each chain */
    struct id_set *set;        /* [2^(64 - set_shift)] */
    struct cache_entry *entry; /* [frame_capacity + 1] */
    unsigned char *slot;       /* [frame_capacity][SLOT_BYTES] */
    struct runs runs;          /* of slots */
    uint64_t *begins;          /* bit s: a body begins in slot s */
    struct cache_counts counts;
    unsigned char *memory; /* owned: of all arrays */
    size_t size;           /* of memory, bytes */
};

/* ---- Memory ---- */

/* The least number of bits, 1 or more, whose power of two is at least count. */
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

/* Takes count elements of size bytes, aligned to a cache line, from the memory. While it is not
 * allocated, only adds up its size. */
static void *take(struct cache *cache, size_t count, size_t size)
{
    const size_t at = cache->size;
    cache->size += (count * size + LINE - 1) / LINE * LINE;
    return cache->memory ? cache->memory + at : NULL;
}

static void take_arrays(struct cache *cache)
{
    const size_t frames = (size_t) cache->counts.frame_capacity;
    cache->size = (LINE - (uintptr_t) cache->memory % LINE) % LINE; /* to the first line */
    cache->bucket = take(cache, bucket_count(cache), sizeof *cache->bucket);
    cache->set = take(cache, (size_t) 1 << (64 - cache->set_shift), sizeof *cache->set);
    cache->entry = take(cache, frames + 1, sizeof *cache->entry);
    cache->slot = take(cache, frames, SLOT_BYTES);
    cache->runs.slot = take(cache, frames, sizeof *cache->runs.slot);
    cache->begins = take(cache, frames / 64 + 1, sizeof *cache->begins);
}

/* Allocates the arrays, for the frame capacity and the shifts that are set: zeros that are not
 * touched. */
static bool allocate(struct cache *cache)
{
    take_arrays(cache);
    cache->memory = calloc(cache->size + LINE, 1);
    take_arrays(cache);
    return cache->memory;
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
    cache->entry[SENTINEL].newer = cache->entry[SENTINEL].older = SENTINEL;
    return cache;
}

void cache_destroy(struct cache *cache)
{
    if (!cache)
        return;
    free(cache->memory);
    free(cache);
}

void cache_prefault(struct cache *cache)
{
    enum { TAKEN_MAX = 64 << 20, PAGE = 4096 };
    volatile unsigned char *page = cache->memory;
    if (cache->size > TAKEN_MAX)
        return;
    /* The system allocates a page when it is first written to. */
    for (size_t at = 0; at < cache->size; at += PAGE)
        page[at] = page[at];
}

/* ---- Hashing ----
 *
 * Multiply-shift: the upper bits of x times a secret odd number, modulo 2^64. Any two different x
 * of 64 bits collide for at most a fraction 2 / buckets of all odd numbers (Dietzfelbinger,
 * Hagerup, Katajainen, Penttonen, "A Reliable Randomized Algorithm for the Closest-Pair Problem",
 * 1997), whatever the client knows of this code. Results and counters depend on the secret only
 * through which ids are known. Hence each of n bodies or ids that a client has chosen is, on
 * average, compared with fewer than 1 + 2 n / buckets.
 *
 * For a handle, x is its first half. Handles are hashes themselves: two bodies with the same first
 * half take some 2^32 hashes to find, three some 2^43, and a set that would make a long chain is
 * infeasible. A sum of products of both halves would be no better: differences of 2^63 in both
 * halves would cancel for all odd numbers. */

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

static struct cache_record *record_of(const struct cache *cache, int32_t e)
{
    return (struct cache_record *) (cache->slot + (size_t) (e - 1) * SLOT_BYTES);
}

static void set_begin(struct cache *cache, int32_t e, bool begins)
{
    const uint64_t bit = (uint64_t) 1 << (e - 1) % 64;
    uint64_t *word = &cache->begins[(e - 1) / 64];
    *word = begins ? *word | bit : *word & ~bit;
}

/* ---- LRU list ---- */

static void lru_unlink(struct cache *cache, int32_t e)
{
    int32_t newer = cache->entry[e].newer, older = cache->entry[e].older;
    cache->entry[newer].older = older;
    cache->entry[older].newer = newer;
}

static void lru_append(struct cache *cache, int32_t e)
{
    int32_t newest = cache->entry[SENTINEL].older;
    cache->entry[e].newer = SENTINEL;
    cache->entry[e].older = newest;
    cache->entry[newest].newer = e;
    cache->entry[SENTINEL].older = e;
}

static const struct cached *pin(struct cache *cache, int32_t e)
{
    struct cache_record *record = record_of(cache, e);
    if (record->pins++ == 0)
        lru_unlink(cache, e);
    return &record->cached;
}

void cache_release(struct cache *cache, const struct cached *cached)
{
    unsigned char *slot = (unsigned char *) cached - offsetof(struct cache_record, cached);
    struct cache_record *record = (struct cache_record *) slot;
    assert(record->pins > 0);
    if (--record->pins == 0)
        lru_append(cache, (int32_t) ((slot - cache->slot) / SLOT_BYTES) + 1);
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

/* The latest entry of the id, if it is live and has this body; otherwise NONE. If the 32-bit
 * generation has wrapped around and a stale entry seems live, comparing the bytes still finds the
 * right body only. */
static int32_t find_latest(const struct cache *cache, int64_t id, const struct body_view *view)
{
    const struct latest *way = ways_of(cache, id);
    const int w = way_of(way, id);
    if (w == WAYS || !is_live(cache, &way[w]))
        return NONE;
    const struct body_view *held = &record_of(cache, way[w].entry)->cached.view;
    const bool same = held->size == view->size && memcmp(held->bytes, view->bytes, view->size) == 0;
    return same ? way[w].entry : NONE;
}

/* Makes the entry the latest of the id. */
static void set_latest(struct cache *cache, int64_t id, int32_t e)
{
    struct latest *way = ways_of(cache, id);
    int w = way_of(way, id);
    if (w == WAYS)
        w = WAYS - 1;
    if (is_live(cache, &way[w])) {
        record_of(cache, way[w].entry)->ids--;
        cache->counts.ids--;
    }
    memmove(&way[1], &way[0], (size_t) w * sizeof *way);
    way[0] = (struct latest){id, e, cache->entry[e].generation};
    record_of(cache, e)->ids++;
    cache->counts.ids++;
}

/* ---- Bodies ---- */

/* The number of slots that a body takes. */
static int32_t slots_of(const struct body_view *view)
{
    struct geometry_reader reader = geometry_begin(view);
    struct geometry_frame frame;
    int32_t slots = view->frame_count;
    while (view->count_count > 0 && geometry_next(&reader, &frame))
        if (frame.shape == FMB_HULL)
            slots += ((int32_t) frame.count / view->dim + CACHE_VERTICES - 1) / CACHE_VERTICES;
    return slots;
}

/* Evicts a body that is not pinned. Returns the first slot of the free run that contains its slots.
 */
static int32_t evict(struct cache *cache, int32_t e)
{
    const struct cache_record *record = record_of(cache, e);
    int32_t *link = bucket_of(cache, &cache->entry[e].handle);
    while (*link != e)
        link = &cache->entry[*link].next;
    *link = cache->entry[e].next;
    lru_unlink(cache, e);
    set_begin(cache, e, false);
    cache->entry[e].generation++;
    cache->counts.ids -= record->ids;
    cache->counts.evictions++;
    cache->counts.bodies--;
    cache->counts.frames -= runs_length(&cache->runs, e - 1);
    return runs_free(&cache->runs, e - 1);
}

/* Evicts the body that begins in a slot, as evict() does. Returns -1, and does nothing, if slot is
 * -1 or the body is pinned. */
static int32_t evict_at(struct cache *cache, int32_t slot)
{
    const bool evictable = slot >= 0 && record_of(cache, slot + 1)->pins == 0;
    return evictable ? evict(cache, slot + 1) : -1;
}

/* Evicts the least recently used body, then its neighbours in memory, until the free run has so
 * many slots or the neighbours on both sides are pinned. */
static void evict_around_oldest(struct cache *cache, int32_t slots)
{
    int32_t free = evict(cache, cache->entry[SENTINEL].newer);
    while (free >= 0 && runs_length(&cache->runs, free) < slots) {
        const int32_t more = evict_at(cache, runs_after(&cache->runs, free));
        free = more >= 0 ? more : evict_at(cache, runs_before(&cache->runs, free));
    }
}

void cache_clear(struct cache *cache)
{
    while (cache->entry[SENTINEL].newer != SENTINEL)
        evict(cache, cache->entry[SENTINEL].newer);
}

/* An entry for a body that takes so many slots; evicts bodies if necessary. NONE: there are not
 * enough slots. */
static int32_t take_entry(struct cache *cache, int32_t slots)
{
    enum { ATTEMPTS = 4 };
    if (slots > cache->counts.frame_capacity)
        return NONE;
    int32_t slot = runs_allocate(&cache->runs, slots);
    for (int i = 0; slot < 0 && i < ATTEMPTS && cache->entry[SENTINEL].newer != SENTINEL; i++) {
        evict_around_oldest(cache, slots);
        slot = runs_allocate(&cache->runs, slots);
    }
    return slot + 1;
}

/* body NULL: it is made here. */
static void fill_record(struct cache_record *record, const struct body_view *view,
                        const struct fmb_body *body)
{
    unsigned char *bytes = (unsigned char *) &record->cached.body + body_bytes(view);
    if (body)
        body_copy(view, body, &record->cached.body);
    else
        body_make(view, &record->cached.body);
    record->cached.view = *view;
    record->cached.view.bytes = memcpy(bytes, view->bytes, view->size);
    record->ids = record->pins = 0;
}

/* Adds a body that is not held. Returns its entry, which is linked everywhere; NONE: there are not
 * enough slots. */
static int32_t insert(struct cache *cache, const struct body_view *view,
                      const struct fmb_body *body)
{
    const int32_t slots = slots_of(view), e = take_entry(cache, slots);
    if (e == NONE)
        return NONE;
    int32_t *bucket = bucket_of(cache, &view->handle);
    fill_record(record_of(cache, e), view, body);
    cache->entry[e].handle = view->handle;
    cache->entry[e].next = *bucket;
    *bucket = e;
    lru_append(cache, e);
    set_begin(cache, e, true);
    cache->counts.bodies++;
    cache->counts.frames += slots;
    return e;
}

const struct cached *cache_lookup(struct cache *cache, int64_t id, struct body_view *view)
{
    int32_t e = id ? find_latest(cache, id, view) : NONE;
    if (e != NONE) {
        cache->counts.hits++;
        view->handle = cache->entry[e].handle;
        return pin(cache, e);
    }
    view->handle = handle_of(view->bytes, view->size);
    e = find(cache, &view->handle);
    if (e == NONE) {
        cache->counts.misses++;
        return NULL;
    }
    cache->counts.hits++;
    if (id)
        set_latest(cache, id, e);
    return pin(cache, e);
}

const struct cached *cache_add(struct cache *cache, int64_t id, const struct body_view *view,
                               const struct fmb_body *body)
{
    int32_t e = find(cache, &view->handle);
    if (e == NONE)
        e = insert(cache, view, body);
    if (e == NONE)
        return NULL;
    if (id)
        set_latest(cache, id, e);
    return pin(cache, e);
}

const struct cached *cache_intern(struct cache *cache, int64_t id, struct body_view *view)
{
    const struct cached *cached = cache_lookup(cache, id, view);
    return cached ? cached : cache_add(cache, id, view, NULL);
}

const struct cached *cache_find(struct cache *cache, const struct handle *handle)
{
    const int32_t e = find(cache, handle);
    if (e == NONE)
        return NULL;
    cache->counts.hits++;
    return pin(cache, e);
}

const struct cached *cache_peek(const struct cache *cache, const struct handle *handle)
{
    const int32_t e = find(cache, handle);
    return e == NONE ? NULL : &record_of(cache, e)->cached;
}

/* ---- Prefetching ---- */

static void prefetch_entry(const struct cache *cache, int32_t e)
{
    if (e == NONE)
        return;
    const char *body = (const char *) record_of(cache, e);
    __builtin_prefetch(&cache->entry[e]);
    __builtin_prefetch(body);
    __builtin_prefetch(body + LINE);
}

void cache_prefetch(const struct cache *cache, const struct query_placement *placement)
{
    if (query_by_handle(placement)) {
        prefetch_entry(cache, *bucket_of(cache, &placement->body.handle));
        return;
    }
    const struct latest *way = ways_of(cache, placement->placed.id);
    const int w = way_of(way, placement->placed.id);
    if (w == WAYS)
        return;
    prefetch_entry(cache, way[w].entry);
    if (placement->body.frame_count == 1 && way[w].entry != NONE)
        for (size_t at = sizeof(struct cache_record); at < SLOT_BYTES; at += LINE)
            __builtin_prefetch((const char *) record_of(cache, way[w].entry) + at);
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
    return &record_of(cache, (int32_t) slot + 1)->cached;
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
