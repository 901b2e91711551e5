#define _GNU_SOURCE /* qsort_r */
#include "match.h"

#include "allocate.h"
#include "wire.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

const char *match_key_of(enum log_kind kind, const struct log_event *event, struct match_key *out)
{
    static const char *(*const read[LOG_STATUS])(const void *bytes, uint32_t size,
                                                 struct query_header *out) = {
        [LOG_PAIR_QUERY] = wire_read_pair_header,
        [LOG_PAIR_RESULT] = wire_read_pair_result_header,
        [LOG_SCENE_QUERY] = wire_read_scene_header,
        [LOG_SCENE_RESULT] = wire_read_scene_result_header};
    struct query_header ids = {.utime = 0};
    const char *error = kind >= LOG_STATUS ? "neither a query nor a result"
                        : log_kind_is_result(kind) && event->kept < event->size
                            ? "longer than any message of this type"
                            : read[kind](event->data, (uint32_t) event->kept, &ids);
    *out =
        (struct match_key){log_kind_query_of(kind), ids.client_id, ids.sequence_number, ids.utime};
    return error;
}

struct match_place match_place_of(int log, const struct log_event *event)
{
    return (struct match_place){log, event->number, event->offset, event->utime};
}

const char *match_read(struct match_item *out, enum log_kind kind, int log,
                       const struct log_event *event, struct logged_result *memory)
{
    *out = (struct match_item){.place = match_place_of(log, event),
                               .is_result = log_kind_is_result(kind)};
    const char *error = match_key_of(kind, event, &out->key);
    if (error || !out->is_result || !memory)
        return error;
    error = logged_result_read(memory, (enum log_kind) out->key.kind, event->data,
                               (uint32_t) event->kept);
    out->transient = !error && logged_status_is_transient(memory->head.status);
    return error;
}

void match_add(struct match *match, const struct match_item *item)
{
    match->item =
        allocate_grow(match->item, &match->capacity, match->count + 1, sizeof *match->item);
    match->item[match->count++] = *item;
}

void match_clear(struct match *match)
{
    free(match->item);
    *match = (struct match){.count = 0};
}

/* ---- Items with the same key ---- */

static void set_result(struct match_item *query, struct match_item *result)
{
    result->other = query;
    if (query->other && result->transient) {
        result->second = true;
        return;
    }
    if (query->other)
        query->other->second = true;
    query->other = result;
}

/* In: the items of one key, in their order. exact: the key includes the time of sending; otherwise
 * a query has one result. waiting: memory for `count` items; those that wait for their counterpart
 * are all queries or all results. */
static void match_group(struct match_item **item, size_t count, bool exact,
                        struct match_item **waiting)
{
    struct match_item *closed = NULL; /* the last query that no longer waits */
    size_t first = 0, end = 0;
    for (size_t i = 0; i < count; i++) {
        struct match_item *next = item[i];
        if (!next->is_result && first < end && waiting[first]->other)
            closed = waiting[first++]; /* it had a transient result, and is repeated */
        struct match_item *other = first < end ? waiting[first] : NULL;
        if (other && other->is_result != next->is_result) {
            struct match_item *query = next->is_result ? other : next;
            set_result(query, next->is_result ? next : other);
            if (exact && next->is_result && next->transient && end - first == 1)
                continue;
            first++;
            closed = query;
        } else if (!other && next->is_result && closed && exact) {
            next->other = closed;
            next->second = true;
        } else {
            waiting[end++] = next;
        }
    }
}

/* ---- All items ---- */

enum { IDS_BYTES = offsetof(struct match_key, utime) };

/* Orders items by the first *bytes bytes of their keys, then by their position. */
static int compare(const void *a, const void *b, void *bytes)
{
    const struct match_item *left = *(struct match_item *const *) a;
    const struct match_item *right = *(struct match_item *const *) b;
    const int order = memcmp(&left->key, &right->key, *(const size_t *) bytes);
    return order ? order : (left > right) - (left < right);
}

/* Matches items whose keys agree in their first `bytes` bytes. */
static void match_by(size_t bytes, struct match_item **item, size_t count,
                     struct match_item **waiting)
{
    qsort_r(item, count, sizeof *item, compare, &bytes);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && memcmp(&item[end]->key, &item[begin]->key, bytes) == 0)
            end++;
        match_group(item + begin, end - begin, bytes == sizeof(struct match_key), waiting);
    }
}

void match_all(struct match *match)
{
    struct match_item **item = allocate(match->count, sizeof *item);
    struct match_item **waiting = allocate(match->count, sizeof *waiting);
    size_t left = 0;
    for (size_t i = 0; i < match->count; i++) {
        item[i] = &match->item[i];
        item[i]->other = NULL;
        item[i]->second = false;
    }
    match_by(sizeof(struct match_key), item, match->count, waiting);
    for (size_t i = 0; i < match->count; i++)
        if (!match->item[i].other)
            item[left++] = &match->item[i];
    match_by(IDS_BYTES, item, left, waiting);
    free(item);
    free(waiting);
}
