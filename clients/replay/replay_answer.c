/* Answers queries, in this process or on the bus. */
#include "replay_parts.h"

#include "wire.h"

#include <string.h>

/* ---- Answers ---- */

static void count_answer(struct replay *replay, const struct match_item *query,
                         const struct new_result *answered)
{
    struct tally_channel *channel = replay_channel(replay, query);
    channel->queries++;
    channel->pairs += answered->pairs;
    if (answered->status == FMB_OK)
        histogram_add(&replay->tally[query->place.log].now, answered->compute_ns);
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

static void take_answer(struct replay *replay, const struct match_item *query,
                        const struct new_result *answered)
{
    count_answer(replay, query, answered);
    if (replay->new_golden && !answered->not_held)
        write_golden(replay, query, answered);
    replay_compare(replay, query, answered);
}

/* ---- By a service ---- */

/* The sink of answer_bus.h. It must not send queries. */
bool replay_on_answered(void *user, struct match_item *query, const struct new_result *answered)
{
    struct replay *replay = user;
    const bool is_last = answered->status != FMB_UNKNOWN_BODY || query->sent_whole;
    struct new_result taken = *answered;
    taken.not_held = answered->status == FMB_UNKNOWN_BODY && query->defined;
    if (is_last)
        take_answer(replay, query, &taken);
    else
        g_queue_push_tail(&replay->again, query);
    return is_last;
}

/* Sends the bodies of a query ahead of it, if the query has no space for their frames. Each scene
 * query carries as many bodies as fit, with ids: a service caches only bodies with an id. The query
 * itself then names the bodies by handle. */
static void supply_service(struct replay *replay, struct match_item *query)
{
    const struct query_placement *placement = replay->query.placement;
    const int32_t count = replay->query.placement_count;
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
        answer_bus_supply(replay->bus, query, replay->whole,
                          (uint32_t) wire_write_scene_query(supply, replay->whole));
    }
}

/* Sends queries again after the service lacked one of their bodies. Handles without a definition
 * are left unchanged. */
static void send_again(struct replay *replay)
{
    for (struct match_item *query; (query = g_queue_pop_head(&replay->again));) {
        uint32_t query_size;
        if (!replay_read_query(replay, &replay->input, query, replay->query_bytes, &query_size,
                               &replay->query))
            continue;
        query->defined = definitions_fill(replay->definitions, &replay->query) < 0;
        const size_t size = logged_query_write(&replay->query, replay->whole);
        query->sent_whole = true;
        if (size > 0) {
            answer_bus_query(replay->bus, query, replay->whole, (uint32_t) size);
        } else {
            supply_service(replay, query);
            answer_bus_query(replay->bus, query, replay->query_bytes, query_size);
        }
    }
}

/* ---- Queries ---- */

/* Whether a client can send the query: it is not too long for a datagram, and its ids are valid. */
static bool can_be_sent(const struct match_item *query, uint32_t size)
{
    return size <= QUERY_BYTES_MAX && query_id_ok(query->key.client_id) &&
           query_id_ok(query->key.sequence_number);
}

/* What cannot be sent is answered here, as a service would refuse it. */
static void answer_query(struct replay *replay, struct match_item *query)
{
    unsigned char *bytes = replay->query_bytes;
    struct new_result answered;
    uint32_t size;
    if (!input_read_again(&replay->input, query->place.log, query->place.offset, bytes, &size)) {
        replay_fail_log(replay, query->place.log);
    } else if (replay->bus && can_be_sent(query, size)) {
        answer_bus_query(replay->bus, query, bytes, size);
    } else if (local_answer(replay->local, (enum log_kind) query->key.kind, bytes, size,
                            &answered)) {
        replay_fail_changed(replay, query->place.log);
    } else {
        replay->not_sent++;
        take_answer(replay, query, &answered);
    }
}

bool replay_has_ended(const struct replay *replay)
{
    return replay->bus && !answer_bus_is_running(replay->bus);
}

/* Reading the logs counts as the first half of the progress. */
void replay_answer_queries(struct replay *replay)
{
    const size_t count = replay->match.count;
    const int64_t size = input_size(&replay->input), half = size / 2;
    for (size_t i = 0; i < count && !replay_has_ended(replay); i++) {
        struct match_item *item = &replay->match.item[i];
        if (item->is_result || item->unreadable)
            continue;
        answer_query(replay, item);
        send_again(replay);
        replay->sink->progress(replay->sink->user,
                               half + (int64_t) ((double) half * (double) i / (double) count),
                               size);
    }
    do {
        send_again(replay);
        if (replay->bus)
            answer_bus_finish(replay->bus);
    } while (!g_queue_is_empty(&replay->again) && !replay_has_ended(replay));
}
