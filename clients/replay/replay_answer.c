/* Answers queries, in this process or on the bus; those with handles that are not defined so far
 * are answered after their definition. */
#include "replay_parts.h"

#include "allocate.h"
#include "wire.h"

#include <errno.h>
#include <string.h>

/* ---- Answers ---- */

static void count_answer(struct replay *replay, const struct match_item *query,
                         const struct new_result *answered)
{
    struct tally *tally = &replay->tally[query->place.log];
    struct tally_channel *channel = replay_channel(replay, &query->key, &query->place);
    channel->queries++;
    channel->pairs += answered->pairs;
    if (answered->status == FMB_OK)
        histogram_add(&tally->now, answered->compute_ns);
}

/* Sets compute_ns, the last field of results, to 0, so that golden logs have the same bytes on
 * every machine. */
static void write_golden(struct replay *replay, const struct match_item *query,
                         const struct new_result *answered)
{
    static const unsigned char no_time[sizeof(int64_t)];
    unsigned char bytes[QUERY_BYTES_MAX];
    const enum log_kind kind = log_kind_result_of((enum log_kind) query->key.kind);
    memcpy(bytes, answered->bytes, answered->size);
    memcpy(bytes + answered->size - sizeof no_time, no_time, sizeof no_time);
    if (!log_append(replay->new_golden, query->place.utime, replay->channels.name[kind],
                    replay->channels.length[kind], bytes, answered->size))
        replay_fail(replay, replay->options->write_golden.path);
}

static void take_answer(struct replay *replay, struct match_item *query,
                        const struct new_result *answered)
{
    count_answer(replay, query, answered);
    if (replay->new_golden)
        write_golden(replay, query, answered);
    query->now = memcpy(allocate_unset(answered->size), answered->bytes, answered->size);
    query->now_size = (uint32_t) answered->size;
    if (!query->in_table)
        replay_compare_recorded(replay, query);
}

/* ---- In this process ---- */

static void answer_here(struct replay *replay, struct match_item *query,
                        const struct new_result *answered)
{
    if (answered->status == FMB_UNKNOWN_BODY && !replay->at_end)
        match_list_add(&replay->undefined, query);
    else
        take_answer(replay, query, answered);
}

/* Excludes a query that cannot be read again: it is not answered or compared. */
static void exclude(struct match_item *query)
{
    query->place.in_range = false;
    match_drop(query);
}

/* Fails because a query that was decoded before can no longer be: the log has changed. */
static void fail_changed(struct replay *replay, struct match_item *query)
{
    errno = EIO;
    replay_fail_log(replay, query->place.log);
    exclude(query);
}

static void answer_again_here(struct replay *replay, struct match_item *query,
                              const struct message *message)
{
    struct new_result answered;
    if (local_answer(replay->local, (enum log_kind) query->key.kind, message->bytes, message->size,
                     &answered)) {
        fail_changed(replay, query);
        return;
    }
    answer_here(replay, query, &answered);
}

/* ---- By a service ---- */

/* The sink of answer_bus.h. It must not send queries. */
bool replay_on_answered(void *user, struct match_item *query, const struct new_result *answered)
{
    struct replay *replay = user;
    const bool is_last = answered->status != FMB_UNKNOWN_BODY || query->sent_whole;
    if (is_last)
        take_answer(replay, query, answered);
    else
        match_list_add(&replay->again, query);
    return is_last;
}

/* Replaces handles by the frames of their bodies. */
static void fill_frames(struct replay *replay, struct placement *placement, int32_t count)
{
    definitions_fill(replay->definitions, placement, count);
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]) &&
            definitions_find(replay->definitions, &placement[i].handle))
            memset(&placement[i].handle, 0, sizeof placement[i].handle);
}

/* Sends the bodies of a query that has no space for their frames ahead of it, as many in one scene
 * query as fit. The query itself then names them by handle. A service caches bodies with an id
 * only. */
static void supply_service(struct replay *replay, const struct placement *placement, int32_t count)
{
    struct scene_query *supply = &replay->supply;
    for (int32_t next = 0; next < count;) {
        size_t size = WIRE_SCENE_QUERY_BYTES;
        supply->which = FMB_PAIRS_LISTED; /* none */
        for (supply->placement_count = 0; next < count; next++) {
            struct placement whole = placement[next];
            if (placement_by_handle(&whole))
                continue;
            size += wire_placement_bytes(&whole);
            if (size > QUERY_BYTES_MAX)
                break;
            whole.body_id = whole.body_id ? whole.body_id : 1;
            supply->placement[supply->placement_count++] = whole;
        }
        if (supply->placement_count == 0)
            return; /* no body is left, or a single one is too long */
        answer_bus_supply(replay->bus, replay->whole,
                          (uint32_t) wire_write_scene_query(supply, replay->whole));
    }
}

/* Sends a query again after the service lacked one of its bodies. At the end, handles without a
 * definition are left unchanged. */
static void answer_again_on_bus(struct replay *replay, struct match_item *query,
                                const struct message *message)
{
    int32_t count;
    if (logged_query_read(&replay->query, (enum log_kind) query->key.kind, message->bytes,
                          message->size)) {
        fail_changed(replay, query);
        return;
    }
    struct placement *placement = logged_query_placements(&replay->query, &count);
    if (!replay->at_end && definitions_missing(replay->definitions, placement, count) >= 0) {
        match_list_add(&replay->undefined, query);
        return;
    }
    fill_frames(replay, placement, count);
    const size_t size = logged_query_write(&replay->query, replay->whole);
    query->sent_whole = true;
    if (size > 0) {
        answer_bus_query(replay->bus, query, replay->whole, (uint32_t) size);
    } else {
        supply_service(replay, placement, count);
        answer_bus_query(replay->bus, query, message->bytes, message->size);
    }
}

static void answer_again(struct replay *replay)
{
    for (struct match_item *query; (query = match_list_take(&replay->again));) {
        struct message message;
        if (!replay_read_again(replay, &query->key, &query->place, replay->query_bytes, &message))
            exclude(query);
        else if (replay->bus)
            answer_again_on_bus(replay, query, &message);
        else
            answer_again_here(replay, query, &message);
    }
}

/* ---- Definitions ---- */

void replay_take_definition(struct replay *replay, const struct log_event *event,
                            const struct match_place *place)
{
    const char *error = definitions_add_message(replay->definitions, LOG_DEFINITION, event->data,
                                                (uint32_t) event->kept);
    if (error) {
        replay->tally[place->log].unreadable_definitions++;
        replay->sink->unreadable(replay->sink->user, place, replay->channels.name[LOG_DEFINITION],
                                 error);
        return;
    }
    replay->tally[place->log].definitions++;
}

/* ---- Queries ---- */

/* Registers a query that cannot be decoded, or is outside the range of time: the log may have its
 * result. */
static void skip_query(struct replay *replay, struct message *query, bool unreadable)
{
    query->place.in_range = false;
    match_drop(replay_begin_query(replay, query, unreadable));
}

/* Decodes the query, and answers it or sends it to the service. */
void replay_take_query(struct replay *replay, struct message *query)
{
    const enum log_kind kind = (enum log_kind) query->key.kind;
    const bool here = replay->local && query->place.in_range;
    struct new_result answered = {.placement = NULL};
    const char *error =
        here ? local_answer(replay->local, kind, query->bytes, query->size, &answered)
             : logged_query_read(&replay->query, kind, query->bytes, query->size);
    if (!here)
        answered.placement = logged_query_placements(&replay->query, &answered.placement_count);
    if (error && query->place.in_range)
        replay_refuse(replay, kind, query, error);
    if (error || !query->place.in_range) {
        skip_query(replay, query, error);
    } else {
        struct match_item *item = replay_begin_query(replay, query, false);
        if (here)
            answer_here(replay, item, &answered);
        else
            answer_bus_query(replay->bus, item, query->bytes, query->size);
    }
    if (!error && replay->options->names)
        body_names_take(replay->options->names, query->key.client_id, answered.placement,
                        answered.placement_count);
    for (int32_t i = 0; !error && !answered.all_held && i < answered.placement_count; i++)
        definitions_add_placement(replay->definitions, &answered.placement[i]);
    answer_again(replay);
}

/* ---- The end ---- */

bool replay_has_ended(const struct replay *replay)
{
    return replay->bus && !answer_bus_is_running(replay->bus);
}

static void finish_answers(struct replay *replay)
{
    do {
        answer_again(replay);
        if (replay->bus)
            answer_bus_finish(replay->bus);
    } while (replay->again.first && !replay_has_ended(replay));
}

void replay_finish_answers(struct replay *replay)
{
    finish_answers(replay);
    if (replay_has_ended(replay))
        return;
    replay->at_end = true; /* no definition will follow */
    replay->again = replay->undefined;
    replay->undefined = (struct match_list){.first = NULL};
    finish_answers(replay);
}
