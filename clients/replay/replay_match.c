#include "replay_parts.h"

static void refuse_result(struct replay *replay, const struct message *result, const char *error)
{
    if (result->place.mine)
        replay_refuse(replay, log_kind_result_of((enum log_kind) result->key.kind), result, error);
}

/* ---- Both are there ---- */

/* The query has its answer, and the judge has read the result. */
static void judge_and_free(struct replay *replay, struct match_item *query)
{
    if (!judge_both(replay->judge, query))
        replay_fail_log(replay, query->place.log);
    match_free(query);
}

/* The recorded result of a query that has been removed. It could be read before. */
void replay_judge_recorded(struct replay *replay, struct match_item *query)
{
    struct message result;
    if (query->place.mine &&
        replay_read_again(replay, &query->key, &query->then, replay->result_bytes, &result) &&
        !judge_read(replay->judge, (enum log_kind) query->key.kind, result.bytes, result.size))
        judge_and_free(replay, query);
    else
        match_free(query);
}

/* No other result will be taken for the query. It is judged now, or when it is answered. */
static void settle(struct replay *replay, struct match_item *query)
{
    match_remove(replay->match, query);
    match_note(replay->match, query, &query->then);
    if (query->now || !query->place.mine)
        replay_judge_recorded(replay, query);
}

/* ---- Queries ---- */

struct match_item *replay_begin_query(struct replay *replay, const struct message *query,
                                      bool unreadable)
{
    struct match_item *first = match_find(replay->match, &query->key);
    if (first && !first->is_result && first->has_then) {
        settle(replay, first); /* it had a result of the moment, and is repeated */
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
    item->has_then = true;
    match_remove(replay->match, first);
    match_free(first);
    match_note(replay->match, item, &item->then);
    return item;
}

/* ---- Results ---- */

/* A second result of a query: no other query waits for it. */
static void take_second(struct replay *replay, const struct message *result,
                        const struct match_note *note)
{
    const struct match_place first = {.log = note->result_log, .offset = note->result_offset};
    struct message earlier;
    const char *error =
        judge_read(replay->judge, (enum log_kind) result->key.kind, result->bytes, result->size);
    if (error)
        refuse_result(replay, result, error);
    else if (result->place.mine &&
             replay_read_again(replay, &result->key, &first, replay->result_bytes, &earlier) &&
             !judge_second(replay->judge, note, &result->place, earlier.bytes, earlier.size))
        replay_fail_log(replay, result->place.log);
}

/* The result of a query that has no answer yet, or one of the moment: the query keeps its place. */
static void keep_result(struct replay *replay, struct match_item *query,
                        const struct message *result)
{
    const bool of_the_moment = judge_of_the_moment(replay->judge, (enum log_kind) query->key.kind);
    if (!query->has_then || !of_the_moment)
        query->then = result->place;
    query->has_then = true;
    if (!of_the_moment)
        settle(replay, query);
}

/* A query that has its answer and its result. */
static void finish_query(struct replay *replay, struct match_item *query,
                         const struct message *result, bool is_judged)
{
    match_remove(replay->match, query);
    match_note(replay->match, query, &result->place);
    if (is_judged)
        match_free(query);
    else
        judge_and_free(replay, query);
}

static void take_result_of(struct replay *replay, struct match_item *query,
                           const struct message *result)
{
    const enum log_kind kind = (enum log_kind) query->key.kind;
    const bool is_same =
        query->now && judge_same(replay->judge, query, result->bytes, result->size);
    const char *error =
        is_same ? NULL : judge_read(replay->judge, kind, result->bytes, result->size);
    if (error) {
        refuse_result(replay, result, error);
        return;
    }
    replay_channel(replay, &result->key, &result->place)->results_again +=
        query->has_then && result->place.mine;
    if (is_same || (query->now && !judge_of_the_moment(replay->judge, kind)))
        finish_query(replay, query, result, is_same);
    else
        keep_result(replay, query, result);
}

/* A result before its query, or without one. */
static void keep_early_result(struct replay *replay, const struct message *result)
{
    const char *error =
        judge_read(replay->judge, (enum log_kind) result->key.kind, result->bytes, result->size);
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
        take_second(replay, result, note);
    else
        keep_early_result(replay, result);
}

/* ---- The end ---- */

static void on_matched(void *user, struct match_item *query, struct match_item *result)
{
    struct replay *replay = user;
    if (query) {
        query->then = result->place;
        replay_judge_recorded(replay, query);
    } else {
        replay_channel(replay, &result->key, &result->place)->results_alone += result->place.mine;
    }
    match_free(result);
}

/* Queries that have only a result of the moment. */
static void settle_all(struct replay *replay)
{
    for (struct match_item *query = match_any(replay->match), *next; query; query = next) {
        next = query->hh.next;
        if (!query->is_result && query->has_then)
            settle(replay, query);
    }
}

void replay_finish_matches(struct replay *replay)
{
    settle_all(replay);
    match_finish(replay->match, on_matched, replay);
    for (struct match_item *query; (query = match_any(replay->match));) {
        match_remove(replay->match, query);
        if (!judge_alone(replay->judge, query))
            replay_fail_log(replay, query->place.log);
        match_free(query);
    }
}
