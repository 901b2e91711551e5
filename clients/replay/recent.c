#include "recent.h"

#include "allocate.h"
#include "random_id.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Items lie one behind the other in a ring, each in one piece: where the next does not fit before
 * the end, the rest stays empty and it begins at 0. The ring is small at first, so that it fits
 * into a cache; it becomes twice as long, up to all that was asked for, where one that is not
 * matched would have to go: more is under way than there was room for. Links are places in units of
 * UNIT bytes, plus 1, so that 0 is none. A bucket holds its items in two chains: those that are not
 * matched, in their order, and the others, with the one that was matched last in front. */
enum { UNIT = 8, NONE = 0, BUCKET_BITS = 13, BUCKETS = 1 << BUCKET_BITS };

enum { ROOM_FIRST = 1 << 20 };

/* Of memory that will be needed soon, bytes that are fetched at a time, and at most. */
enum { LINE = 64, EXPECTED = 1024 };

struct chain {
    uint32_t first, last;
};

struct bucket {
    struct chain chain[2]; /* [matched] */
};

/* Of a hash that a log cannot know: else it could have all its ids in one bucket. */
enum { HASHED = 4 };

struct recent {
    unsigned char *ring;
    size_t room, room_max;
    size_t begin,
        end; /* of what is used: from begin to end, or if it wraps to the wrap and on from 0 */
    size_t wrap;
    bool wraps;
    size_t count;
    struct bucket *bucket;       /* [BUCKETS] */
    uint64_t multiplier[HASHED]; /* random */
    void (*gone)(void *user, const struct recent_item *item);
    void *user;
};

struct recent *recent_open(size_t bytes, void (*gone)(void *user, const struct recent_item *item),
                           void *user)
{
    struct recent *recent = allocate(1, sizeof *recent);
    bytes -= bytes % UNIT;
    assert(bytes / UNIT < UINT32_MAX);
    *recent = (struct recent){.ring = allocate(bytes, 1),
                              .room = bytes < ROOM_FIRST ? bytes : ROOM_FIRST,
                              .room_max = bytes,
                              .bucket = allocate(BUCKETS, sizeof *recent->bucket),
                              .gone = gone,
                              .user = user};
    for (int i = 0; i < HASHED; i++)
        recent->multiplier[i] = query_id_mix(random_id());
    return recent;
}

void recent_close(struct recent *recent)
{
    if (!recent)
        return;
    free(recent->ring);
    free(recent->bucket);
    free(recent);
}

static struct recent_item *item_of(const struct recent *recent, uint32_t link)
{
    return link == NONE ? NULL : (struct recent_item *) (recent->ring + (size_t) (link - 1) * UNIT);
}

/* The upper bits of a sum of products: two sets of ids share a bucket by chance alone. */
static uint32_t bucket_of(const struct recent *recent, enum log_kind kind,
                          const struct query_header *ids)
{
    const uint64_t part[HASHED] = {kind, (uint64_t) ids->client_id, (uint64_t) ids->utime,
                                   (uint64_t) ids->sequence_number};
    uint64_t sum = 0;
    for (int i = 0; i < HASHED; i++)
        sum += part[i] * recent->multiplier[i];
    return (uint32_t) (sum >> (64 - BUCKET_BITS));
}

/* ---- Chains ---- */

static struct chain *chain_of(const struct recent *recent, const struct recent_item *item)
{
    return &recent->bucket[item->bucket].chain[item->matched];
}

static uint32_t link_of(const struct recent *recent, const struct recent_item *item)
{
    return (uint32_t) ((size_t) ((const unsigned char *) item - recent->ring) / UNIT) + 1;
}

static void unlink_item(struct recent *recent, struct recent_item *item)
{
    struct chain *chain = chain_of(recent, item);
    *(item->before ? &item_of(recent, item->before)->next : &chain->first) = item->next;
    *(item->next ? &item_of(recent, item->next)->before : &chain->last) = item->before;
}

static void link_first(struct recent *recent, struct recent_item *item)
{
    struct chain *chain = chain_of(recent, item);
    item->before = NONE;
    item->next = chain->first;
    *(item->next ? &item_of(recent, item->next)->before : &chain->last) = link_of(recent, item);
    chain->first = link_of(recent, item);
}

static void link_last(struct recent *recent, struct recent_item *item)
{
    struct chain *chain = chain_of(recent, item);
    item->next = NONE;
    item->before = chain->last;
    *(item->before ? &item_of(recent, item->before)->next : &chain->first) = link_of(recent, item);
    chain->last = link_of(recent, item);
}

/* ---- The ring ---- */

/* The next item to go is somewhere else in a larger memory than caches are, and what will be put in
 * its place is written all through. */
static void expect_next(const struct recent *recent, size_t length)
{
    const unsigned char *at = recent->ring + recent->begin;
    for (size_t i = 0; i < length && i < EXPECTED; i += LINE)
        __builtin_prefetch(at + i, 1);
}

static struct recent_item *oldest(const struct recent *recent)
{
    return (struct recent_item *) (recent->ring + recent->begin);
}

static void let_go(struct recent *recent)
{
    struct recent_item *item = oldest(recent);
    unlink_item(recent, item);
    recent->gone(recent->user, item);
    const size_t length = item->length;
    recent->begin += length;
    recent->count--;
    if (recent->wraps && recent->begin == recent->wrap) {
        recent->begin = 0;
        recent->wraps = false;
    }
    if (recent->begin + EXPECTED <= recent->room)
        expect_next(recent, length);
}

/* What lies from there on goes so much farther on, bytes. */
struct shift {
    size_t from, by;
};

static uint32_t shifted(struct shift shift, uint32_t link)
{
    const bool moves = link != NONE && (size_t) (link - 1) * UNIT >= shift.from;
    return moves ? link + (uint32_t) (shift.by / UNIT) : link;
}

static void shift_buckets(const struct recent *recent, struct shift shift)
{
    for (int i = 0; i < BUCKETS; i++)
        for (int matched = 0; matched < 2; matched++) {
            struct chain *chain = &recent->bucket[i].chain[matched];
            chain->first = shifted(shift, chain->first);
            chain->last = shifted(shift, chain->last);
        }
}

/* Those from begin to before end, where they are now. */
static void shift_items(const struct recent *recent, struct shift shift, size_t begin, size_t end)
{
    while (begin < end) {
        struct recent_item *item = (struct recent_item *) (recent->ring + begin);
        item->next = shifted(shift, item->next);
        item->before = shifted(shift, item->before);
        if (begin >= shift.from) {
            item->item.bytes += shift.by;
            item->item.more += shift.by;
        }
        begin += item->length;
    }
}

/* Of a ring that wraps, the older part goes to the new end. */
static void grow(struct recent *recent)
{
    recent->room = recent->room > recent->room_max / 2 ? recent->room_max : 2 * recent->room;
    if (!recent->wraps)
        return;
    const struct shift shift = {recent->begin, recent->room - recent->wrap};
    unsigned char *old = recent->ring + recent->begin;
    memmove(old + shift.by, old, recent->wrap - recent->begin);
    recent->begin += shift.by;
    recent->wrap = recent->room;
    shift_items(recent, shift, 0, recent->end);
    shift_items(recent, shift, recent->begin, recent->wrap);
    shift_buckets(recent, shift);
}

/* A place for so many bytes, or false. */
static bool find_place(struct recent *recent, size_t length, size_t *at)
{
    if (recent->count == 0) {
        recent->begin = recent->end = 0;
        recent->wraps = false;
    }
    *at = recent->end;
    if (recent->wraps)
        return recent->begin - recent->end >= length;
    if (recent->room - recent->end >= length)
        return true;
    if (recent->begin < length)
        return false;
    recent->wraps = true;
    recent->wrap = recent->end;
    *at = 0;
    return true;
}

struct recent_item *recent_put(struct recent *recent, const struct match_item *item)
{
    const size_t bytes = sizeof(struct recent_item) + item->size + item->more_size;
    const size_t length = (bytes + UNIT - 1) / UNIT * UNIT;
    size_t at;
    assert(length <= recent->room_max);
    while (!find_place(recent, length, &at)) {
        if (recent->room < recent->room_max && (recent->count == 0 || !oldest(recent)->matched))
            grow(recent);
        else
            let_go(recent);
    }
    recent->end = at + length;
    recent->count++;
    struct recent_item *put = (struct recent_item *) (recent->ring + at);
    unsigned char *copy = (unsigned char *) (put + 1);
    put->item = *item;
    put->matched = false;
    put->bucket = bucket_of(recent, item->kind, &item->ids);
    put->length = (uint32_t) length;
    put->item.bytes = memcpy(copy, item->bytes, item->size);
    put->item.more = copy + item->size;
    if (item->more_size > 0)
        memcpy(copy + item->size, item->more, item->more_size);
    link_last(recent, put);
    return put;
}

static struct recent_item *first_of(const struct recent *recent, bool matched, enum log_kind kind,
                                    const struct query_header *ids)
{
    if (recent->count == 0) /* of results it mostly is */
        return NULL;
    const struct bucket *bucket = &recent->bucket[bucket_of(recent, kind, ids)];
    struct recent_item *item = item_of(recent, bucket->chain[matched].first);
    while (item && !(item->item.kind == kind && item->item.ids.client_id == ids->client_id &&
                     item->item.ids.sequence_number == ids->sequence_number &&
                     item->item.ids.utime == ids->utime))
        item = item_of(recent, item->next);
    return item;
}

struct recent_item *recent_unmatched(const struct recent *recent, enum log_kind kind,
                                     const struct query_header *ids)
{
    return first_of(recent, false, kind, ids);
}

struct recent_item *recent_matched(const struct recent *recent, enum log_kind kind,
                                   const struct query_header *ids)
{
    return first_of(recent, true, kind, ids);
}

void recent_match(struct recent *recent, struct recent_item *item)
{
    assert(!item->matched);
    unlink_item(recent, item);
    item->matched = true;
    link_first(recent, item);
}

void recent_flush(struct recent *recent)
{
    while (recent->count > 0)
        let_go(recent);
}
