/* Matches queries with their recorded results. */
#include "replay_parts.h"

#include "allocate.h"

#include <stdlib.h>

static void refuse_result(struct replay *replay, const struct message *result, const char *error)
{
    if (result->place.in_range)
        replay_refuse(replay, log_kind_result_of((enum log_kind) result->key.kind), result, error);
}

/* Notes the result of a query, which is no longer in the table, and frees it. */
static void close_query(struct replay *replay, struct match_item *query,
                        const struct match_place *result)
{
    struct recorded_query *recorded = &replay->recorded[query->index];
    recorded->log = result->log;
    recorded->result = result->offset;
    replay_note_match(replay, query, result);
    free(query);
}

/* ---- Queries ---- */

void replay_take_query(struct replay *replay, const struct message *query, bool unreadable)
{
    const size_t index = replay->recorded_count++;
    replay->recorded = allocate_grow(replay->recorded, &replay->recorded_capacity,
                                     replay->recorded_count, sizeof *replay->recorded);
    replay->recorded[index] = (struct recorded_query){
        .offset = query->place.offset, .skipped = unreadable || !query->place.in_range, .log = -1};
    struct match_item *first = match_find(replay->match, &query->key);
    if (first && !first->is_result && first->has_recorded) {
        match_remove(replay->match, first); /* it had a transient result, and is repeated */
        close_query(replay, first, &first->then);
        first = match_find(replay->match, &query->key);
    }
    const bool has_result = first && first->is_result;
    struct match_item *item = has_result
                                  ? match_new(&query->key, &query->place)
                                  : match_add(replay->match, &query->key, &query->place, false);
    item->unreadable = unreadable;
    item->place.in_range = item->place.in_range && !unreadable;
    item->index = index;
    if (!has_result)
        return;
    match_remove(replay->match, first);
    close_query(replay, item, &first->place);
    free(first);
}

/* ---- Results ---- */

/* Handles a second result of a query that is no longer in the table. */
static void compare_second(struct replay *replay, const struct message *result,
                           const struct match_note *note)
{
    const struct match_place first = {.log = note->result_log, .offset = note->result_offset};
    struct message earlier;
    if (result->place.in_range &&
        replay_read_again(replay, &result->key, &first, replay->result_bytes, &earlier))
        replay_compare_second(replay, note, result, &earlier);
}

/* A query with a transient result stays in the table, unless it is repeated. */
static void take_result_of(struct replay *replay, struct match_item *query,
                           const struct message *result)
{
    const bool transient = compare_status_is_transient(logged_result_status(&replay->then));
    replay_channel(replay, &result->key, &result->place)->results_again +=
        query->has_recorded && result->place.in_range;
    if (!query->has_recorded || !transient)
        query->then = result->place;
    query->has_recorded = true;
    if (transient && !query->next)
        return;
    match_remove(replay->match, query);
    close_query(replay, query, &query->then);
}

void replay_take_result(struct replay *replay, const struct message *result)
{
    struct match_item *first = match_find(replay->match, &result->key);
    const struct match_note *note = first ? NULL : match_noted(replay->match, &result->key);
    const char *error = replay_read_result(replay, result);
    if (error)
        refuse_result(replay, result, error);
    else if (first && !first->is_result)
        take_result_of(replay, first, result);
    else if (note)
        compare_second(replay, result, note);
    else
        match_add(replay->match, &result->key, &result->place, true);
}

/* ---- The end ---- */

static void on_matched(void *user, struct match_item *query, struct match_item *result)
{
    struct replay *replay = user;
    if (!query && replay->options->golden) {
        match_append(&replay->unmatched, result);
        return;
    }
    if (query)
        close_query(replay, query, &result->place);
    else
        replay_channel(replay, &result->key, &result->place)->unmatched += result->place.in_range;
    free(result);
}

/* Closes queries that have only a transient result. */
static void close_queries(struct replay *replay)
{
    for (struct match_item *query = match_any(replay->match), *next; query; query = next) {
        next = query->hh.next;
        if (query->is_result || !query->has_recorded)
            continue;
        match_remove(replay->match, query);
        close_query(replay, query, &query->then);
    }
}

void replay_finish_matches(struct replay *replay)
{
    close_queries(replay);
    match_finish(replay->match, on_matched, replay);
    if (replay->options->golden) {
        replay_pair_results(replay);
        close_queries(replay);
    }
    for (struct match_item *item; (item = match_any(replay->match));) {
        match_remove(replay->match, item);
        if (item->is_result)
            replay_channel(replay, &item->key, &item->place)->unmatched++;
        else if (item->left_over && item->place.in_range)
            replay_count_left_over(replay, &item->key, &item->place);
        free(item);
    }
}
