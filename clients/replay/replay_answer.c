/* Answers queries, in this process or on the bus. */
#include "replay_parts.h"

#include "wire.h"

#include <stdlib.h>
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
    replay_compare(replay, query, answered);
    free(query);
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
        match_append(&replay->again, query);
    return is_last;
}

/* Sends the bodies of a query that has no space for their frames ahead of it, as many in one scene
 * query as fit. The query itself then names them by handle. A service caches bodies with an id
 * only. */
static void supply_service(struct replay *replay, const struct query_placement *placement,
                           int32_t count)
{
    struct scene_query *supply = &replay->supply;
    for (int32_t next = 0; next < count;) {
        size_t size = WIRE_SCENE_QUERY_BYTES;
        supply->which = FMB_PAIRS_LISTED; /* none */
        for (supply->placement_count = 0; next < count; next++) {
            struct query_placement whole = placement[next];
            if (query_by_handle(&whole))
                continue;
            size += wire_placement_bytes(&whole);
            if (size > QUERY_BYTES_MAX)
                break;
            whole.placed.id = whole.placed.id ? whole.placed.id : 1;
            supply->placement[supply->placement_count++] = whole;
        }
        if (supply->placement_count == 0)
            return; /* no body is left, or a single one is too long */
        answer_bus_supply(replay->bus, replay->whole,
                          (uint32_t) wire_write_scene_query(supply, replay->whole));
    }
}

/* Sends a query again after the service lacked one of its bodies. Handles without a definition are
 * left unchanged. */
static void send_whole(struct replay *replay, struct match_item *query,
                       const struct message *message)
{
    int32_t count;
    struct query_placement *placement = logged_query_placements(&replay->query, &count);
    definitions_fill(replay->definitions, placement, count);
    const size_t size = logged_query_write(&replay->query, replay->whole);
    query->sent_whole = true;
    if (size > 0) {
        answer_bus_query(replay->bus, query, replay->whole, (uint32_t) size);
    } else {
        supply_service(replay, placement, count);
        answer_bus_query(replay->bus, query, message->bytes, message->size);
    }
}

static const char *read_query(struct replay *replay, const struct message *query)
{
    return logged_query_read(&replay->query, (enum log_kind) query->key.kind, query->bytes,
                             query->size);
}

static void send_again(struct replay *replay)
{
    for (struct match_item *query; (query = match_pop(&replay->again));) {
        struct message message;
        const bool read =
            replay_read_again(replay, &query->key, &query->place, replay->query_bytes, &message);
        if (read && !read_query(replay, &message)) {
            send_whole(replay, query, &message);
            continue;
        }
        if (read)
            replay_fail_changed(replay, query->place.log);
        free(query);
    }
}

/* ---- Queries ---- */

static void answer_here(struct replay *replay, struct match_item *query,
                        const struct message *message)
{
    struct new_result answered;
    if (!local_answer(replay->local, (enum log_kind) query->key.kind, message->bytes, message->size,
                      &answered)) {
        take_answer(replay, query, &answered);
        return;
    }
    replay_fail_changed(replay, query->place.log);
    free(query);
}

void replay_answer_query(struct replay *replay, const struct message *message)
{
    const struct recorded_query *recorded = &replay->recorded[replay->next];
    if (replay->next == replay->recorded_count || recorded->offset != message->place.offset) {
        replay_fail_changed(replay, message->place.log);
        return;
    }
    replay->next++;
    if (recorded->skipped)
        return;
    struct match_item *query = match_new(&message->key, &message->place);
    query->has_recorded = recorded->log >= 0;
    query->then = (struct match_place){.log = recorded->log, .offset = recorded->result};
    if (replay->local)
        answer_here(replay, query, message);
    else
        answer_bus_query(replay->bus, query, message->bytes, message->size);
    send_again(replay);
}

/* ---- The end ---- */

bool replay_has_ended(const struct replay *replay)
{
    return replay->bus && !answer_bus_is_running(replay->bus);
}

void replay_finish_answers(struct replay *replay)
{
    do {
        send_again(replay);
        if (replay->bus)
            answer_bus_finish(replay->bus);
    } while (replay->again && !replay_has_ended(replay));
    if (!replay_has_ended(replay) && replay->next < replay->recorded_count)
        replay_fail_changed(replay, replay->input.log);
}
