/* Matches queries with their recorded results. */
#include "replay_parts.h"

static void refuse_result(struct replay *replay, const struct message *result, const char *error)
{
    if (result->place.in_range)
        replay_refuse(replay, log_kind_result_of((enum log_kind) result->key.kind), result, error);
}

/* ---- Query and result ---- */

/* Compares a query that was removed from the table with its recorded result, which could be read
 * before. */
void replay_compare_recorded(struct replay *replay, struct match_item *query)
{
    struct message result;
    if (query->place.in_range &&
        replay_read_again(replay, &query->key, &query->then, replay->result_bytes, &result) &&
        !replay_read_result(replay, &result))
        replay_compare(replay, query);
    match_free(query);
}

/* Closes a query: no other result is accepted for it. It is compared now if it is answered,
 * otherwise when it is. */
static void close_query(struct replay *replay, struct match_item *query)
{
    match_remove(replay->match, query);
    replay_note_match(replay, query, &query->then);
    if (query->now || !query->place.in_range)
        replay_compare_recorded(replay, query);
}

/* ---- Queries ---- */

struct match_item *replay_begin_query(struct replay *replay, const struct message *query,
                                      bool unreadable)
{
    struct match_item *first = match_find(replay->match, &query->key);
    if (first && !first->is_result && first->has_recorded) {
        close_query(replay, first); /* it had a transient result, and is repeated */
        first = match_find(replay->match, &query->key);
    }
    const bool has_result = first && first->is_result;
    struct match_item *item = has_result
                                  ? match_new(&query->key, &query->place)
                                  : match_add(replay->match, &query->key, &query->place, false);
    item->unreadable = unreadable;
    if (!has_result)
        return item;
    item->then = first->place;
    item->has_recorded = true;
    match_remove(replay->match, first);
    match_free(first);
    replay_note_match(replay, item, &item->then);
    return item;
}

/* ---- Results ---- */

/* Handles a second result of a query that is no longer in the table. */
static void compare_second(struct replay *replay, const struct message *result,
                           const struct match_note *note)
{
    const struct match_place first = {.log = note->result_log, .offset = note->result_offset};
    struct message earlier;
    const char *error = replay_read_result(replay, result);
    if (error)
        refuse_result(replay, result, error);
    else if (result->place.in_range &&
             replay_read_again(replay, &result->key, &first, replay->result_bytes, &earlier))
        replay_compare_second(replay, note, result, &earlier);
}

/* Keeps a result of a query that has no answer yet, or a transient result: the query stays in the
 * table, unless it is repeated. */
static void keep_result(struct replay *replay, struct match_item *query,
                        const struct message *result)
{
    const bool transient = replay_is_transient(replay, (enum log_kind) query->key.kind);
    if (!query->has_recorded || !transient)
        query->then = result->place;
    query->has_recorded = true;
    if (!transient || query->next)
        close_query(replay, query);
}

/* Closes a query that has its answer and its result. */
static void complete_query(struct replay *replay, struct match_item *query,
                           const struct message *result, bool is_compared)
{
    match_remove(replay->match, query);
    replay_note_match(replay, query, &result->place);
    if (!is_compared)
        replay_compare(replay, query);
    match_free(query);
}

static void take_result_of(struct replay *replay, struct match_item *query,
                           const struct message *result)
{
    const enum log_kind kind = (enum log_kind) query->key.kind;
    const bool is_same = query->now && replay_same_bytes(replay, query, result);
    const char *error = is_same ? NULL : replay_read_result(replay, result);
    if (error) {
        refuse_result(replay, result, error);
        return;
    }
    replay_channel(replay, &result->key, &result->place)->results_again +=
        query->has_recorded && result->place.in_range;
    if (is_same || (query->now && !replay_is_transient(replay, kind)))
        complete_query(replay, query, result, is_same);
    else
        keep_result(replay, query, result);
}

/* Keeps a result that precedes its query, or has none. */
static void keep_early_result(struct replay *replay, const struct message *result)
{
    const char *error = replay_read_result(replay, result);
    if (error)
        refuse_result(replay, result, error);
    else
        match_add(replay->match, &result->key, &result->place, true);
}

void replay_take_result(struct replay *replay, const struct message *result)
{
    struct match_item *first = match_find(replay->match, &result->key);
    const struct match_note *note;
    if (first && !first->is_result)
        take_result_of(replay, first, result);
    else if (!first && (note = match_noted(replay->match, &result->key)))
        compare_second(replay, result, note);
    else
        keep_early_result(replay, result);
}

/* ---- The end ---- */

static void on_matched(void *user, struct match_item *query, struct match_item *result)
{
    struct replay *replay = user;
    if (query) {
        query->then = result->place;
        replay_note_match(replay, query, &result->place);
        replay_compare_recorded(replay, query);
    } else if (replay->golden) {
        match_list_add(&replay->unmatched, result);
        return;
    } else {
        replay_channel(replay, &result->key, &result->place)->unmatched += result->place.in_range;
    }
    match_free(result);
}

/* Closes queries that have only a transient result. */
static void close_queries(struct replay *replay)
{
    for (struct match_item *query = match_any(replay->match), *next; query; query = next) {
        next = query->hh.next;
        if (!query->is_result && query->has_recorded)
            close_query(replay, query);
    }
}

void replay_finish_matches(struct replay *replay)
{
    close_queries(replay);
    match_finish(replay->match, on_matched, replay);
    if (replay->golden) {
        replay_pair_results(replay);
        close_queries(replay);
    }
    for (struct match_item *item; (item = match_any(replay->match));) {
        match_remove(replay->match, item);
        if (item->is_result) {
            replay_channel(replay, &item->key, &item->place)->unmatched++;
        } else {
            replay_unrecorded(replay, item);
            if (item->left_over && item->place.in_range)
                replay_count_left_over(replay, &item->key, &item->place);
        }
        match_free(item);
    }
}
