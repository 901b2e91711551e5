/* Answers queries, in this process or by a service on the bus.
 *
 * On the bus many queries are under way at a time. The request engine of the client library
 * (fmb_client_raw.h) assigns its own ids, repeats lost queries, and pauses while the service is
 * busy. Steps of a query, in the order of the log:
 *   1. wait_for_capacity() handles results until the engine has capacity for the query and its
 *      expected result (bytes_of()).
 *   2. send() takes a slot and passes the query to the engine.
 *   3. step() runs the engine, which calls on_result() for each result, or with a negative status
 *      after the last timeout.
 *   4. on_result() frees the slot, and counts and compares the result, with the ids of the log. It
 *      must not send: a query whose bodies the service lacks is put into replay->again.
 *   5. send_again() sends it with the frames of its bodies.
 *
 * stop() records the first reason to end: a signal, no service, or a failed bus. From then on no
 * query is sent, and results are ignored. Tested by tests/system/replay_bus.bats. */
#include "replay_parts.h"

#include "big_endian.h"
#include "clock.h"
#include "complain.h"
#include "process.h"
#include "wire.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

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
        replay_fail(replay, replay->options->write_golden.path, errno);
}

static void take_answer(struct replay *replay, const struct match_item *query,
                        const struct new_result *answered)
{
    count_answer(replay, query, answered);
    if (replay->new_golden && !answered->not_held)
        write_golden(replay, query, answered);
    replay_compare(replay, query, answered);
}

/* ---- The bus ---- */

/* Signals are checked once in so many calls of replay_has_ended(). */
enum { POLL_EVERY = 256 };

/* Offsets in results of the ids of the query. */
enum { CLIENT_AT = 16, SEQUENCE_AT = 24 };

static struct tally_bus *counts_of(struct replay *replay)
{
    return &replay->tally->bus;
}

bool replay_open_bus(struct replay *replay)
{
    char why[FMB_CLIENT_WHY_MAX];
    replay->client = fmb_client_open(replay->options->bus, why, sizeof why);
    if (!replay->client) {
        complain("%s", why);
        return false;
    }
    counts_of(replay)->used = 1;
    replay->signals = signals_open();
    if (replay->signals < 0)
        perror("fmb: signals");
    return replay->signals >= 0;
}

void replay_close_bus(struct replay *replay)
{
    struct fmb_client_counts counts;
    if (!replay->client)
        return;
    fmb_client_get_counts(replay->client, &counts);
    counts_of(replay)->resent = (int64_t) counts.repeated;
    counts_of(replay)->malformed = (int64_t) counts.malformed;
    fmb_client_close(replay->client);
    if (replay->signals >= 0)
        close(replay->signals);
}

/* Ends the replay; only the first call counts. */
static void stop(struct replay *replay, enum tally_end end)
{
    if (counts_of(replay)->end == TALLY_NO_END)
        counts_of(replay)->end = end;
}

bool replay_has_ended(struct replay *replay)
{
    struct pollfd source = {.fd = replay->signals, .events = POLLIN};
    if (replay->client && ++replay->polls % POLL_EVERY == 0 && poll(&source, 1, 0) > 0)
        stop(replay, TALLY_SIGNAL);
    return counts_of(replay)->end != TALLY_NO_END;
}

/* ---- Results ---- */

/* Cannot fail: the library has decoded both. */
static void decode(struct replay *replay, enum log_kind kind,
                   const struct fmb_client_raw_result *result, struct new_result *out)
{
    logged_result_read(&replay->now, kind, result->bytes, (uint32_t) result->size);
    out->compute_ns = replay->now.head.compute_ns;
    out->pairs = out->status == FMB_OK;
    if (kind == LOG_PAIR_QUERY)
        return;
    logged_query_read(&replay->compared, kind, result->query, (uint32_t) result->query_size);
    struct exchange exchange = {.query = &replay->compared, .result = &replay->now};
    exchange_begin(&exchange);
    out->pairs = exchange_decided(&exchange);
}

static void on_result(void *user, const struct fmb_client_raw_result *result)
{
    struct replay_slot *slot = user;
    struct replay *replay = slot->replay;
    struct tally_bus *counts = counts_of(replay);
    struct match_item *query = slot->query;
    unsigned char *bytes = replay->answered_bytes;
    struct new_result answered = {.bytes = bytes, .size = result->size, .status = result->status};
    replay->under_way--;
    slot->replay = NULL;
    if (result->status < 0 && counts->end == TALLY_NO_END) {
        counts->end = result->status == FMB_CLIENT_NO_BUS ? TALLY_BUS_FAILED : TALLY_NO_SERVICE;
        counts->log = query->place.log;
        counts->number = query->place.number;
        counts->offset = query->place.offset;
    }
    if (counts->end != TALLY_NO_END || slot->supplies)
        return;
    decode(replay, (enum log_kind) query->key.kind, result, &answered);
    const int64_t server_id = replay->now.head.server_id;
    counts->services += counts->services == 0 || server_id != replay->server_id;
    replay->server_id = server_id;
    counts->ns = clock_ns() - replay->begun_at;
    if (answered.status == FMB_UNKNOWN_BODY && !query->sent_whole) {
        g_queue_push_tail(&replay->again, query);
        return;
    }
    memcpy(bytes, result->bytes, result->size);
    big_endian_put_64(bytes + CLIENT_AT, (uint64_t) query->key.client_id);
    big_endian_put_64(bytes + SEQUENCE_AT, (uint64_t) query->key.sequence_number);
    answered.not_held = answered.status == FMB_UNKNOWN_BODY && query->defined;
    counts->answered++;
    take_answer(replay, query, &answered);
}

/* Runs the engine until something happens. */
static void step(struct replay *replay)
{
    if (fmb_client_raw_step(replay->client, replay->signals, 1) < 0)
        stop(replay, TALLY_BUS_FAILED);
    replay->polls = POLL_EVERY - 1;
}

/* Waits until all queries under way are answered. */
static void finish(struct replay *replay)
{
    while (!replay_has_ended(replay) && replay->under_way > 0)
        step(replay);
}

/* ---- Queries to the service ---- */

/* Returns whether the replay goes on. */
static bool wait_for_capacity(struct replay *replay, size_t bytes)
{
    while (!replay_has_ended(replay) && !fmb_client_raw_ready(replay->client, bytes))
        step(replay);
    return !replay_has_ended(replay);
}

/* The larger of a query and its expected result, bytes. A result with many contacts may be larger.
 */
static size_t bytes_of(const struct logged_query *query, uint32_t size)
{
    const struct scene_query *scene = &query->scene;
    size_t bytes = 1024;
    if (query->kind == LOG_PAIR_QUERY && query->pair.want & FMB_WANT_CERTIFICATE)
        bytes = 4096;
    if (query->kind == LOG_SCENE_QUERY)
        bytes += (size_t) scene->index_count / 2 + 100 * (size_t) scene->placement_count;
    bytes = bytes < QUERY_BYTES_MAX ? bytes : QUERY_BYTES_MAX;
    return bytes > size ? bytes : size;
}

/* supplies: the message only carries bodies of the query. largest: as bytes_of(). */
static void send(struct replay *replay, struct match_item *query, enum log_kind kind, bool supplies,
                 const unsigned char *bytes, uint32_t size, size_t largest)
{
    struct replay_slot *slot = replay->slot;
    while (slot->replay)
        slot++; /* there are as many slots as the engine has requests */
    *slot = (struct replay_slot){replay, query, supplies};
    const int status = fmb_client_raw_send(
        replay->client, kind == LOG_PAIR_QUERY ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE, bytes, size,
        largest, on_result, slot);
    if (status == FMB_OK) {
        replay->under_way++;
        return;
    }
    slot->replay = NULL;
    stop(replay, TALLY_BUS_FAILED);
}

static void send_query(struct replay *replay, struct match_item *query, const unsigned char *bytes,
                       uint32_t size)
{
    const enum log_kind kind = (enum log_kind) query->key.kind;
    logged_query_read(&replay->compared, kind, bytes, size);
    const size_t largest = bytes_of(&replay->compared, size);
    if (replay->begun_at == 0)
        replay->begun_at = clock_ns();
    if (!wait_for_capacity(replay, largest))
        return;
    counts_of(replay)->whole += query->sent_whole;
    send(replay, query, kind, false, bytes, size, largest);
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
        const uint32_t bytes = (uint32_t) wire_write_scene_query(supply, replay->whole);
        if (!wait_for_capacity(replay, bytes))
            return;
        counts_of(replay)->supplied++;
        send(replay, query, LOG_SCENE_QUERY, true, replay->whole, bytes, bytes);
        finish(replay);
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
            send_query(replay, query, replay->whole, (uint32_t) size);
        } else {
            supply_service(replay, query);
            send_query(replay, query, replay->query_bytes, query_size);
        }
    }
}

/* ---- Queries ---- */

/* A query that is too long for a datagram, or whose ids no client can have, is answered here, as a
 * service would refuse it. */
static void answer_query(struct replay *replay, struct match_item *query)
{
    unsigned char *bytes = replay->query_bytes;
    struct new_result answered;
    uint32_t size;
    if (!input_read_again(&replay->input, query->place.log, query->place.offset, bytes, &size)) {
        replay_fail(replay, replay->paths[query->place.log], errno);
    } else if (replay->client && size <= QUERY_BYTES_MAX && query_id_ok(query->key.client_id) &&
               query_id_ok(query->key.sequence_number)) {
        send_query(replay, query, bytes, size);
    } else if (local_answer(replay->local, (enum log_kind) query->key.kind, bytes, size,
                            &answered)) {
        replay_fail(replay, replay->paths[query->place.log], EIO);
    } else {
        if (replay->client) {
            counts_of(replay)->not_sent++;
            counts_of(replay)->answered++;
        }
        take_answer(replay, query, &answered);
    }
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
        finish(replay);
    } while (!g_queue_is_empty(&replay->again) && !replay_has_ended(replay));
}
