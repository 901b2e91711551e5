#include "match.h"

#include "wire.h"

#include <stdlib.h>
#include <string.h>
#include <utlist.h>

/* Number of notes: a hash table without chains, which consecutive sequence numbers of a client fill
 * in order. */
enum { NOTES = 4096 };

struct match {
    /* Hash table of the first item of each key. `always` is never removed: uthash frees its table
     * with the last item, and most logs have one query without a result at a time. */
    struct match_item *items, always;
    struct match_note note[NOTES];
};

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

struct match *match_open(void)
{
    struct match *match = allocate(1, sizeof *match);
    match->always.key.kind = -1;
    HASH_ADD(hh, match->items, key, sizeof match->always.key, &match->always);
    for (int i = 0; i < NOTES; i++)
        match->note[i].key.kind = -1;
    return match;
}

void match_close(struct match *match)
{
    if (!match)
        return;
    for (struct match_item *item; (item = match_any(match));) {
        match_remove(match, item);
        free(item);
    }
    HASH_CLEAR(hh, match->items);
    free(match);
}

struct match_item *match_find(const struct match *match, const struct match_key *key)
{
    struct match_item *item = NULL;
    if (match_any(match))
        HASH_FIND(hh, match->items, key, sizeof *key, item);
    return item;
}

static void put(struct match *match, struct match_item *item)
{
    struct match_item *first = match_find(match, &item->key);
    const bool is_first = !first;
    match_append(&first, item);
    if (is_first)
        HASH_ADD(hh, match->items, key, sizeof item->key, item);
}

struct match_item *match_new(const struct match_key *key, const struct match_place *place)
{
    struct match_item *item = allocate_unset(sizeof *item);
    *item = (struct match_item){.key = *key, .place = *place};
    return item;
}

struct match_item *match_add(struct match *match, const struct match_key *key,
                             const struct match_place *place, bool is_result)
{
    struct match_item *item = match_new(key, place);
    item->is_result = is_result;
    put(match, item);
    return item;
}

void match_remove(struct match *match, struct match_item *item)
{
    struct match_item *next = item->next;
    HASH_DELETE(hh, match->items, item);
    if (!next)
        return;
    next->last = item->last;
    HASH_ADD(hh, match->items, key, sizeof next->key, next);
}

struct match_item *match_take(struct match *match, const struct match_key *key,
                              const struct match_place *place, bool is_result)
{
    struct match_item *first = match_find(match, key);
    if (first && first->is_result != is_result) {
        match_remove(match, first);
        return first;
    }
    match_add(match, key, place, is_result);
    return NULL;
}

struct match_item *match_any(const struct match *match)
{
    return match->always.hh.next;
}

/* ---- The end ---- */

/* Removes all queries or all results from the table, in the order in which their keys were added.
 */
static struct match_item *take_all(struct match *match, bool results)
{
    struct match_item *list = NULL, *item, *next;
    for (item = match_any(match); item; item = next) {
        next = item->hh.next;
        while (item && item->is_result == results) {
            struct match_item *same_key = item->next;
            match_remove(match, item);
            match_append(&list, item);
            item = same_key;
        }
    }
    return list;
}

void match_finish(struct match *match, match_sink *sink, void *user)
{
    struct match_item *results = take_all(match, true), *queries = take_all(match, false), *item;
    while ((item = match_pop(&queries))) {
        item->key.utime = 0;
        put(match, item);
    }
    while ((item = match_pop(&results))) {
        item->key.utime = 0;
        struct match_item *query = match_find(match, &item->key);
        if (query)
            match_remove(match, query);
        sink(user, query, item);
    }
}

/* ---- Lists ---- */

void match_append(struct match_item **list, struct match_item *item)
{
    DL_APPEND2(*list, item, last, next);
}

struct match_item *match_pop(struct match_item **list)
{
    struct match_item *first = *list;
    if (first)
        DL_DELETE2(*list, first, last, next);
    return first;
}

/* ---- Notes ---- */

static size_t note_of(const struct match_key *key)
{
    return ((uint64_t) key->sequence_number + (uint64_t) key->client_id +
            (uint64_t) key->kind * (NOTES / 2)) %
           NOTES;
}

void match_note(struct match *match, const struct match_item *query,
                const struct match_place *result)
{
    if (query->unreadable)
        return;
    match->note[note_of(&query->key)] = (struct match_note){.key = query->key,
                                                            .query_log = query->place.log,
                                                            .result_log = result->log,
                                                            .query_offset = query->place.offset,
                                                            .result_offset = result->offset};
}

const struct match_note *match_noted(const struct match *match, const struct match_key *key)
{
    const struct match_note *note = &match->note[note_of(key)];
    return match_key_equal(&note->key, key) ? note : NULL;
}
