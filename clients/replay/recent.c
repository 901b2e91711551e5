#include "recent.h"

#include "allocate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Items lie one behind the other in a ring, each in one piece: where the next does not fit before
 * the end, the rest stays empty and it begins at 0. Links are places in units of UNIT bytes, plus
 * 1, so that 0 is none. A bucket holds its items in their order, so that the oldest of all is
 * always the first of its bucket. */
enum { UNIT = 8, NONE = 0, BUCKETS = 1 << 16 };

struct bucket {
    uint32_t first, last;
};

struct recent {
    unsigned char *ring;
    size_t room;
    size_t begin,
        end; /* of what is used: from begin to end, or if it wraps to the wrap and on from 0 */
    size_t wrap;
    bool wraps;
    size_t count;
    struct bucket *bucket; /* [BUCKETS] */
    void (*gone)(void *user, const struct recent_item *item);
    void *user;
};

struct recent *recent_open(size_t bytes, void (*gone)(void *user, const struct recent_item *item),
                           void *user)
{
    struct recent *recent = allocate(1, sizeof *recent);
    assert(bytes / UNIT < UINT32_MAX);
    *recent = (struct recent){.ring = allocate(bytes, 1),
                              .room = bytes,
                              .bucket = allocate(BUCKETS, sizeof *recent->bucket),
                              .gone = gone,
                              .user = user};
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

static uint32_t bucket_of(enum log_kind kind, const struct query_header *ids)
{
    const uint64_t some = query_id_mix(ids->client_id + kind) ^ (uint64_t) ids->utime;
    return (
        uint32_t) (query_id_mix((int64_t) query_id_mix((int64_t) some) ^ ids->sequence_number) >>
                   48);
}

static void let_go(struct recent *recent)
{
    struct recent_item *item = (struct recent_item *) (recent->ring + recent->begin);
    struct bucket *bucket = &recent->bucket[item->bucket];
    assert(item_of(recent, bucket->first) == item);
    bucket->first = item->next;
    if (item->next == NONE)
        bucket->last = NONE;
    recent->gone(recent->user, item);
    recent->begin += item->length;
    recent->count--;
    if (recent->wraps && recent->begin == recent->wrap) {
        recent->begin = 0;
        recent->wraps = false;
    }
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

static void link_last(struct recent *recent, struct recent_item *item, size_t at)
{
    struct bucket *bucket = &recent->bucket[item->bucket];
    const uint32_t link = (uint32_t) (at / UNIT) + 1;
    if (bucket->last == NONE)
        bucket->first = link;
    else
        item_of(recent, bucket->last)->next = link;
    bucket->last = link;
}

struct recent_item *recent_put(struct recent *recent, const struct match_item *item)
{
    const size_t bytes = sizeof(struct recent_item) + item->size + item->more_size;
    const size_t length = (bytes + UNIT - 1) / UNIT * UNIT;
    size_t at;
    assert(length <= recent->room);
    while (!find_place(recent, length, &at))
        let_go(recent);
    recent->end = at + length;
    recent->count++;
    struct recent_item *put = (struct recent_item *) (recent->ring + at);
    unsigned char *copy = (unsigned char *) (put + 1);
    *put = (struct recent_item){
        .item = *item, .bucket = bucket_of(item->kind, &item->ids), .length = (uint32_t) length};
    put->item.bytes = memcpy(copy, item->bytes, item->size);
    put->item.more = copy + item->size;
    if (item->more_size > 0)
        memcpy(copy + item->size, item->more, item->more_size);
    link_last(recent, put, at);
    return put;
}

static struct recent_item *same_from(const struct recent *recent, uint32_t link, enum log_kind kind,
                                     const struct query_header *ids)
{
    for (struct recent_item *item; (item = item_of(recent, link)); link = item->next)
        if (item->item.kind == kind && item->item.ids.client_id == ids->client_id &&
            item->item.ids.sequence_number == ids->sequence_number &&
            item->item.ids.utime == ids->utime)
            return item;
    return NULL;
}

struct recent_item *recent_first(const struct recent *recent, enum log_kind kind,
                                 const struct query_header *ids)
{
    return same_from(recent, recent->bucket[bucket_of(kind, ids)].first, kind, ids);
}

struct recent_item *recent_next(const struct recent *recent, const struct recent_item *item)
{
    return same_from(recent, item->next, item->item.kind, &item->item.ids);
}

void recent_flush(struct recent *recent)
{
    while (recent->count > 0)
        let_go(recent);
}
