/* Map.
 *
 * In: answer_bus_query() for each query of the log, in the order of the log, and
 * answer_bus_supply() for bodies that the service has to hold before a query. Out: one call of the
 * sink for each query, with the encoded result, which has the ids of the query in the log.
 *
 * Steps of a query:
 *   1. wait_for_capacity() handles results until the request engine has capacity for the query and
 *      its expected result (bytes_of()).
 *   2. send() takes a slot and passes the query to the engine (fmb_client_raw.h), which assigns
 *      its own ids, repeats lost queries and pauses while the service is busy.
 *   3. step() runs the engine, which calls on_result() for each result, or with a negative status
 *      after the last timeout.
 *   4. on_result() decodes the result, frees the slot, restores the ids and calls the sink. The
 *      sink must not send: a query to be repeated is passed again later by the caller.
 *
 * The end. stop() records the first reason: a signal, no service, or a failed bus. From then on no
 * query is sent and the sink is not called.
 *
 * Not here: comparison (replay_compare.c), which bodies a service lacks (replay_answer.c), timeouts
 * and repetition (client library). Tested by tests/system/replay_bus.bats and replay_set.bats. */
#include "answer_bus.h"

#include "allocate.h"
#include "big_endian.h"
#include "clock.h"
#include "complain.h"
#include "fmb_client_raw.h"
#include "exchange.h"
#include "process.h"

#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Signals are checked once in so many calls of answer_bus_is_running(). */
enum { POLL_EVERY = 256 };

/* Offsets in results of the ids of the query, and of the service's id. */
enum { CLIENT_AT = 16, SEQUENCE_AT = 24 };

/* A query under way. */
struct slot {
    struct answer_bus *bus; /* NULL: the slot is free */
    struct match_item *item;
    bool supplies; /* a query of answer_bus_supply() */
};

struct answer_bus {
    answer_bus_sink *sink;
    void *user;
    struct fmb_client *client;
    int signals; /* readable after SIGINT and SIGTERM */
    struct slot slot[FMB_CLIENT_RAW_WINDOW];
    int under_way;
    int64_t begun_at, server_id;
    unsigned polls;
    struct tally_bus counts;
    struct logged_query query;    /* the one to be sent */
    struct logged_query answered; /* the one that a result answers */
    struct logged_result result;
    unsigned char bytes[QUERY_BYTES_MAX];
};

static bool is_running(const struct answer_bus *bus)
{
    return bus->counts.end == ANSWER_BUS_NO_END;
}

/* Ends the replay; only the first call counts. */
static void stop(struct answer_bus *bus, enum answer_bus_end end)
{
    if (is_running(bus))
        bus->counts.end = end;
}

/* A query got no answer, with this status of the library. */
static void stop_at(struct answer_bus *bus, int status, const struct match_place *place)
{
    if (!is_running(bus))
        return;
    stop(bus, status == FMB_CLIENT_NO_BUS ? ANSWER_BUS_FAILED : ANSWER_BUS_NO_SERVICE);
    bus->counts.log = place->log;
    bus->counts.number = place->number;
    bus->counts.offset = place->offset;
}

/* ---- Results ---- */

static void count_service(struct answer_bus *bus)
{
    const int64_t server_id = bus->result.head.server_id;
    bus->counts.services += bus->counts.services == 0 || server_id != bus->server_id;
    bus->server_id = server_id;
}

static void decode_result(struct answer_bus *bus, enum log_kind kind,
                          const struct fmb_client_raw_result *result, struct new_result *out)
{
    /* Cannot fail: the library has decoded it. */
    logged_result_read(&bus->result, kind, bus->bytes, (uint32_t) out->size);
    out->compute_ns = bus->result.head.compute_ns;
    out->pairs = out->status == FMB_OK;
    if (kind == LOG_PAIR_QUERY)
        return;
    logged_query_read(&bus->answered, kind, result->query, (uint32_t) result->query_size);
    struct exchange exchange = {.query = &bus->answered, .result = &bus->result};
    exchange_begin(&exchange);
    out->pairs = exchange_decided(&exchange);
}

static void on_result(void *user, const struct fmb_client_raw_result *result)
{
    struct slot *slot = user;
    struct answer_bus *bus = slot->bus;
    struct match_item *item = slot->item;
    struct new_result answered = {
        .bytes = bus->bytes, .size = result->size, .status = result->status};
    bus->under_way--;
    slot->bus = NULL;
    if (result->status < 0)
        stop_at(bus, result->status, &item->place);
    if (!is_running(bus) || slot->supplies)
        return;
    memcpy(bus->bytes, result->bytes, result->size);
    decode_result(bus, (enum log_kind) item->key.kind, result, &answered);
    count_service(bus);
    big_endian_put_64(bus->bytes + CLIENT_AT, (uint64_t) item->key.client_id);
    big_endian_put_64(bus->bytes + SEQUENCE_AT, (uint64_t) item->key.sequence_number);
    bus->counts.ns = clock_ns() - bus->begun_at;
    bus->counts.answered += bus->sink(bus->user, item, &answered);
}

/* ---- Waiting ---- */

/* Runs the engine until something happens, or the time `until`, nanoseconds of clock_ns(). */
static void step(struct answer_bus *bus, int64_t until)
{
    const double seconds = 1e-9 * (double) (until - clock_ns());
    if (fmb_client_raw_step(bus->client, bus->signals, seconds > 0 ? seconds : 0) < 0)
        stop(bus, ANSWER_BUS_FAILED);
    bus->polls = POLL_EVERY - 1;
    answer_bus_is_running(bus);
}

void answer_bus_finish(struct answer_bus *bus)
{
    while (is_running(bus) && bus->under_way > 0)
        step(bus, clock_ns() + 1000000000);
}

bool answer_bus_is_running(struct answer_bus *bus)
{
    struct pollfd source = {.fd = bus->signals, .events = POLLIN};
    if (++bus->polls % POLL_EVERY == 0 && poll(&source, 1, 0) > 0)
        stop(bus, ANSWER_BUS_SIGNAL);
    return is_running(bus);
}

/* ---- Queries ---- */

/* Returns whether the replay goes on. */
static bool wait_for_capacity(struct answer_bus *bus, size_t bytes)
{
    while (is_running(bus) && !fmb_client_raw_ready(bus->client, bytes))
        step(bus, clock_ns() + 1000000000);
    return is_running(bus);
}

/* The larger of the query and its expected result, bytes. A result with many contacts may be
 * larger. */
static size_t bytes_of(const struct answer_bus *bus, uint32_t size)
{
    const struct scene_query *scene = &bus->query.scene;
    size_t bytes = 1024;
    if (bus->query.kind == LOG_PAIR_QUERY && bus->query.pair.want & FMB_WANT_CERTIFICATE)
        bytes = 4096;
    if (bus->query.kind == LOG_SCENE_QUERY)
        bytes += (size_t) scene->index_count / 2 + 100 * (size_t) scene->placement_count;
    bytes = bytes < QUERY_BYTES_MAX ? bytes : QUERY_BYTES_MAX;
    return bytes > size ? bytes : size;
}

static void send(struct answer_bus *bus, struct match_item *item, bool supplies,
                 const unsigned char *bytes, uint32_t size, size_t largest)
{
    struct slot *slot = bus->slot;
    while (slot->bus)
        slot++; /* there are as many slots as the engine has requests */
    *slot = (struct slot){bus, item, supplies};
    const int status = fmb_client_raw_send(
        bus->client, bus->query.kind == LOG_PAIR_QUERY ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE, bytes,
        size, largest, on_result, slot);
    if (status == FMB_OK) {
        bus->under_way++;
        return;
    }
    slot->bus = NULL;
    stop(bus, ANSWER_BUS_FAILED);
}

void answer_bus_supply(struct answer_bus *bus, struct match_item *item, const unsigned char *bytes,
                       uint32_t size)
{
    logged_query_read(&bus->query, LOG_SCENE_QUERY, bytes, size);
    if (!wait_for_capacity(bus, size))
        return;
    bus->counts.supplied++;
    send(bus, item, true, bytes, size, size);
    answer_bus_finish(bus);
}

void answer_bus_query(struct answer_bus *bus, struct match_item *item, const unsigned char *bytes,
                      uint32_t size)
{
    logged_query_read(&bus->query, (enum log_kind) item->key.kind, bytes, size);
    const size_t largest = bytes_of(bus, size);
    if (bus->begun_at == 0)
        bus->begun_at = clock_ns();
    if (!wait_for_capacity(bus, largest))
        return;
    bus->counts.whole += item->sent_whole;
    send(bus, item, false, bytes, size, largest);
}

struct tally_bus answer_bus_counts(const struct answer_bus *bus)
{
    struct fmb_client_counts client;
    fmb_client_get_counts(bus->client, &client);
    struct tally_bus counts = bus->counts;
    counts.resent = (int64_t) client.repeated;
    counts.malformed = (int64_t) client.malformed;
    return counts;
}

/* ---- Opening and closing ---- */

struct answer_bus *answer_bus_open(const struct fmb_client_options *options, answer_bus_sink *sink,
                                   void *user)
{
    char why[FMB_CLIENT_WHY_MAX];
    struct answer_bus *bus = allocate(1, sizeof *bus);
    *bus = (struct answer_bus){.sink = sink, .user = user, .signals = -1};
    bus->counts.used = 1;
    bus->client = fmb_client_open(options, why, sizeof why);
    if (!bus->client)
        complain("%s", why);
    else if ((bus->signals = signals_open()) < 0)
        perror("fmb: signals");
    if (bus->signals >= 0)
        return bus;
    answer_bus_close(bus);
    return NULL;
}

void answer_bus_close(struct answer_bus *bus)
{
    if (!bus)
        return;
    fmb_client_close(bus->client);
    if (bus->signals >= 0)
        close(bus->signals);
    free(bus);
}
