#include "server.h"

#include "answer.h"
#include "bus.h"
#include "clock.h"
#include "histogram.h"
#include "senders.h"
#include "wire.h"

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct server {
    lcm_t *lcm;
    lcm_subscription_t *queries, *statuses;
    char query_channel[BUS_CHANNEL_MAX];
    char result_channel[BUS_CHANNEL_MAX];
    char status_channel[BUS_CHANNEL_MAX];
    struct answerer answerer;
    struct senders senders;
    struct histogram compute_ns;
    struct wire_status status; /* counts so far; the rest is filled in when it is published */
    int64_t ready_ns;
    /* Malformed datagrams: when one was last said, how many came since, and the last one. */
    int64_t said_ns; /* 0: never */
    int64_t unsaid;
    uint32_t malformed_size;
    const char *malformed_reason;
    /* The other service last heard on the same channels (0: none), and when that was said. */
    int64_t other_id, other_said_ns;
};

/* Whether something that was last said at a time (0: never) may be said again: once a second at
 * most, and only if standard error takes a line now, since a pipe that nobody reads must not
 * stop the service. */
static bool may_say(int64_t last_ns)
{
    struct pollfd wait = {.fd = STDERR_FILENO, .events = POLLOUT};
    return (last_ns == 0 || clock_ns() - last_ns >= 1000000000) && poll(&wait, 1, 0) == 1 &&
           wait.revents & POLLOUT;
}

/* Says what could not be read. */
static void say_malformed(struct server *server)
{
    if (server->unsaid == 0 || !may_say(server->said_ns))
        return;
    fprintf(stderr,
            "fmbd: malformed message on %s (%" PRIu32 " bytes): %s; %" PRId64
            " of them so far, %" PRId64 " since this was last said\n",
            server->query_channel, server->malformed_size, server->malformed_reason,
            server->status.malformed, server->unsaid);
    server->said_ns = clock_ns();
    server->unsaid = 0;
}

static void note_malformed(struct server *server, uint32_t size, const char *reason)
{
    server->status.malformed++;
    server->unsaid++;
    server->malformed_size = size;
    server->malformed_reason = reason;
    say_malformed(server);
}

static void publish_result(struct server *server, const struct pair_result *result)
{
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    size_t size = wire_write_pair_result(result, bytes);
    if (lcm_publish(server->lcm, server->result_channel, bytes, (unsigned) size) != 0) {
        server->status.unsent++;
        return;
    }
    server->status.answered++;
    server->status.results[result->status]++;
    server->status.pairs += result->status == FMB_OK;
}

static void on_pair_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct server *server = user;
    struct pair_query query;
    struct pair_result result;
    (void) channel;
    const char *error = wire_read_pair_query(buffer->data, buffer->data_size, &query);
    if (error) {
        note_malformed(server, buffer->data_size, error);
        return;
    }
    server->status.received++;
    if (query_id_ok(query.client_id) && query_id_ok(query.sequence_number))
        senders_note(&server->senders, query.client_id, query.sequence_number);

    int64_t begin = clock_ns();
    answer_pair(&server->answerer, &query, &result);
    result.compute_ns = clock_ns() - begin;
    if (result.status == FMB_OK)
        histogram_add(&server->compute_ns, result.compute_ns);
    publish_result(server, &result);
}

/* The heartbeat of another service on the same channels: both answer every query, and neither
 * knows the other's keys. Said of each that is new, once a second at most. */
static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct server *server = user;
    struct wire_status other;
    if (wire_read_status(buffer->data, buffer->data_size, &other) ||
        other.server_id == server->status.server_id || other.server_id == server->other_id ||
        !may_say(server->other_said_ns))
        return;
    server->other_id = other.server_id;
    server->other_said_ns = clock_ns();
    fprintf(stderr,
            "fmbd: another service (server %" PRId64
            ") is on %s: start one of them with --prefix\n",
            other.server_id, channel);
}

struct server *server_create(lcm_t *lcm, const struct server_options *options)
{
    struct server *server = calloc(1, sizeof *server);
    if (!server)
        return NULL;
    server->lcm = lcm;
    bus_channel(server->query_channel, options->prefix, WIRE_PAIR_QUERY);
    bus_channel(server->result_channel, options->prefix, WIRE_PAIR_RESULT);
    bus_channel(server->status_channel, options->prefix, WIRE_STATUS);
    server->answerer.server_id = options->server_id;
    server->answerer.cache = cache_create(options->bodies, options->first_key);
    server->status.server_id = options->server_id;
    server->status.receive_buffer = options->receive_buffer;
    snprintf(server->status.version, sizeof server->status.version, "%s", fmb_version());
    server->ready_ns = clock_ns();
    server->queries =
        bus_subscribe(lcm, server->query_channel, on_pair_query, server, SERVER_QUEUE);
    server->statuses = bus_subscribe(lcm, server->status_channel, on_status, server, 4);
    if (!server->answerer.cache || !server->queries || !server->statuses) {
        server_destroy(server);
        return NULL;
    }
    return server;
}

void server_destroy(struct server *server)
{
    if (!server)
        return;
    if (server->queries)
        lcm_unsubscribe(server->lcm, server->queries);
    if (server->statuses)
        lcm_unsubscribe(server->lcm, server->statuses);
    cache_destroy(server->answerer.cache);
    free(server);
}

static void complete_status(struct server *server, struct wire_status *status)
{
    struct cache_counts cache = cache_counts(server->answerer.cache);
    *status = server->status;
    status->utime = clock_utime();
    status->uptime_us = (clock_ns() - server->ready_ns) / 1000;
    status->sequence_gaps = server->senders.gaps;
    status->repeated = server->senders.repeated;
    status->bodies = cache.bodies;
    status->capacity = cache.capacity;
    status->hits = cache.hits;
    status->misses = cache.misses;
    status->replacements = cache.replacements;
    status->evictions = cache.evictions;
    status->compute_p50_ns = histogram_quantile(&server->compute_ns, 0.50);
    status->compute_p99_ns = histogram_quantile(&server->compute_ns, 0.99);
    status->compute_max_ns = server->compute_ns.max;
}

void server_publish_status(struct server *server)
{
    struct wire_status status;
    unsigned char bytes[WIRE_BYTES_MAX];
    complete_status(server, &status);
    size_t size = wire_write_status(&status, bytes);
    lcm_publish(server->lcm, server->status_channel, bytes, (unsigned) size); /* or the next one */
    say_malformed(server);
}

const char *server_query_channel(const struct server *server)
{
    return server->query_channel;
}

const char *server_result_channel(const struct server *server)
{
    return server->result_channel;
}

const char *server_status_channel(const struct server *server)
{
    return server->status_channel;
}
