#include "server.h"

#include "answer.h"
#include "bus.h"
#include "histogram.h"
#include "senders.h"
#include "wire.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct server {
    lcm_t *lcm;
    lcm_subscription_t *subscription;
    char query_channel[BUS_CHANNEL_MAX];
    char result_channel[BUS_CHANNEL_MAX];
    char status_channel[BUS_CHANNEL_MAX];
    struct answerer answerer;
    struct senders senders;
    struct histogram compute_ns;
    struct wire_status status; /* counts so far; the rest is filled in when it is published */
    int64_t ready_ns;
    int64_t complained_ns; /* 0: never */
    int64_t unsaid;        /* malformed datagrams since the last complaint */
};

static int64_t clock_ns(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (int64_t) time.tv_sec * 1000000000 + time.tv_nsec;
}

/* Counts a datagram that cannot be read; says so at most once a second. */
static void complain(struct server *server, const char *channel, uint32_t size, const char *reason)
{
    int64_t now = clock_ns(CLOCK_MONOTONIC);
    server->status.malformed++;
    server->unsaid++;
    if (server->complained_ns && now - server->complained_ns < 1000000000)
        return;
    fprintf(stderr,
            "fmbd: malformed message on %s (%" PRIu32 " bytes): %s; %" PRId64
            " of them so far, %" PRId64 " since this was last said\n",
            channel, size, reason, server->status.malformed, server->unsaid);
    server->complained_ns = now;
    server->unsaid = 0;
}

static void publish_result(struct server *server, const struct pair_result *result)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    size_t size = wire_write_pair_result(result, bytes);
    if (lcm_publish(server->lcm, server->result_channel, bytes, (unsigned) size) == 0)
        server->status.answered++;
    else
        server->status.unsent++;
}

static bool in_range(int64_t id)
{
    return id >= 0 && id <= QUERY_ID_MAX;
}

static void on_pair_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct server *server = user;
    struct pair_query query;
    struct pair_result result;
    const char *error = wire_read_pair_query(buffer->data, buffer->data_size, &query);
    if (error) {
        complain(server, channel, buffer->data_size, error);
        return;
    }
    server->status.received++;

    int64_t begin = clock_ns(CLOCK_MONOTONIC);
    answer_pair(&server->answerer, &query, &result);
    result.compute_ns = clock_ns(CLOCK_MONOTONIC) - begin;

    if (in_range(query.client_id) && in_range(query.sequence_number))
        senders_note(&server->senders, query.client_id, query.sequence_number);
    histogram_add(&server->compute_ns, result.compute_ns);
    server->status.results[result.status]++;
    server->status.pairs += result.status == FMB_OK;
    publish_result(server, &result);
}

static bool subscribe(struct server *server)
{
    server->subscription = lcm_subscribe(server->lcm, server->query_channel, on_pair_query, server);
    return server->subscription &&
           lcm_subscription_set_queue_capacity(server->subscription, SERVER_QUEUE) == 0;
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
    server->ready_ns = clock_ns(CLOCK_MONOTONIC);
    if (!server->answerer.cache || !subscribe(server)) {
        server_destroy(server);
        return NULL;
    }
    return server;
}

void server_destroy(struct server *server)
{
    if (!server)
        return;
    if (server->subscription)
        lcm_unsubscribe(server->lcm, server->subscription);
    cache_destroy(server->answerer.cache);
    free(server);
}

static void complete_status(struct server *server, struct wire_status *status)
{
    struct cache_counts cache = cache_counts(server->answerer.cache);
    *status = server->status;
    status->utime = clock_ns(CLOCK_REALTIME) / 1000;
    status->uptime_us = (clock_ns(CLOCK_MONOTONIC) - server->ready_ns) / 1000;
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
    if (lcm_publish(server->lcm, server->status_channel, bytes, (unsigned) size) != 0)
        server->status.unsent++;
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
