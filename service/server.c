#include "server.h"

#include "answer.h"
#include "bus.h"
#include "clock.h"
#include "histogram.h"
#include "malformed.h"
#include "queue.h"
#include "say.h"
#include "senders.h"
#include "wire.h"

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What queries there are. */
enum kind { PAIRS = SERVER_PAIRS, SCENES = SERVER_SCENES, KINDS };

static const struct {
    const char *query, *result;
    const char *(*read_header)(const void *bytes, uint32_t size, struct query_header *out);
    /* Room for the queries that wait, in pages: 4,096 pairs (16 MB), and 256 of the largest scenes
     * (17 MB), or more smaller ones. */
    size_t chunks;
    /* Messages that LCM keeps until they are drained, in memory of its own; beyond this many it
     * drops the newest, which the sequence numbers tell. Of scenes that is 33 MB at most. */
    int lcm_queue;
} kinds[KINDS] = {
    [PAIRS] = {WIRE_PAIR_QUERY, WIRE_PAIR_RESULT, wire_read_pair_header, 4096, 4096},
    [SCENES] = {WIRE_SCENE_QUERY, WIRE_SCENE_RESULT, wire_read_scene_header, 4352, 512},
};

enum {
    /* Messages drained before something is answered: a flood must not keep the service from it. */
    DRAINED_MAX = 256,
    /* Pairs answered before the bus is looked at again: as many. To refuse one takes no less time
     * than to answer it, most of it in sending: who answered fewer than it drains would spend its
     * time on refusing what it could have answered. */
    PAIRS_A_TURN = DRAINED_MAX
};

/* A scene is interrupted so often, to drain the bus and let pairs pass; or as long after the last
 * time as that took, so that half of the time is the scene's. */
static const int64_t interrupted_every_ns = 200000;

/* What a scene may take while others wait. One datagram can ask for a million pairs that need
 * milliseconds each; most scenes take less than one altogether. */
static const int64_t scene_turn_ns = 100000000;

/* What pairs may take before the bus is looked at again: far less than LCM's queue holds of a
 * flood, also where each needs milliseconds. */
static const int64_t pairs_turn_ns = 5000000;

static const int64_t beat_ns = 1000000000;

/* A subscription to the queries of a kind. */
struct intake {
    struct server *server;
    enum kind kind;
    char query_channel[BUS_CHANNEL_MAX];
    char result_channel[BUS_CHANNEL_MAX];
    lcm_subscription_t *subscription;
    struct queue *queue;
    unsigned char datagram[QUEUE_DATAGRAM_MAX]; /* that is being read */
};

struct server {
    lcm_t *lcm;
    lcm_subscription_t *statuses;
    struct intake intake[KINDS];
    char status_channel[BUS_CHANNEL_MAX];
    struct answerer answerer;
    struct senders senders;
    struct histogram compute_ns;
    struct wire_status status; /* counts so far; the rest is filled in when it is published */
    int64_t ready_ns, beat_at_ns;
    bool failed; /* the bus did */
    /* The scene that is being answered: since when, when the bus is to be looked at again, and the
     * time spent on others meanwhile. */
    struct scene_query scene;
    struct scene_result scene_result, refused;
    int64_t begin_ns, look_at_ns, elsewhere_ns;
    unsigned char thrown[QUEUE_DATAGRAM_MAX]; /* out of a queue, for others to have room */
    struct malformed malformed;
    /* The other service last heard on the same channels (0: none), and when that was said. */
    int64_t other_id, other_said_ns;
};

/* ---- Results ---- */

/* What all results have. */
static void publish(struct server *server, enum kind kind, const unsigned char *bytes, size_t size,
                    int32_t status)
{
    server->status.received++;
    server->status.scenes += kind == SCENES;
    if (lcm_publish(server->lcm, server->intake[kind].result_channel, bytes, (unsigned) size) !=
        0) {
        server->status.unsent++;
        return;
    }
    server->status.answered++;
    server->status.results[status]++;
}

static void publish_pair(struct server *server, const struct pair_result *result)
{
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    publish(server, PAIRS, bytes, wire_write_pair_result(result, bytes), result->status);
    server->status.pairs += result->status == FMB_OK;
}

/* Those that the broad phase kept apart are decided too; those that a method cannot decide are not.
 */
static int64_t decided(const struct scene_result *result, int32_t first_pair)
{
    int64_t pairs = result->end_pair - first_pair;
    for (int32_t i = 0; i < result->verdict_count; i++)
        pairs -= result->verdict[i] == 0;
    return pairs;
}

static void publish_scene(struct server *server, int32_t first_pair, struct scene_result *result)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    result->lost = senders_gaps(&server->senders, result->client_id);
    publish(server, SCENES, bytes, wire_write_scene_result(result, bytes), result->status);
    if (result->status == FMB_OK)
        server->status.pairs += decided(result, first_pair);
}

/* ---- Answering ---- */

static void answer_a_pair(struct server *server, const unsigned char *bytes, size_t size)
{
    struct pair_query query;
    struct pair_result result;
    const char *error = wire_read_pair_query(bytes, (uint32_t) size, &query);
    if (error) {
        malformed_note(&server->malformed, server->intake[PAIRS].query_channel, (uint32_t) size,
                       error);
        return;
    }
    const int64_t begin = clock_ns();
    answer_pair(&server->answerer, &query, &result);
    result.compute_ns = clock_ns() - begin;
    if (result.status == FMB_OK)
        histogram_add(&server->compute_ns, result.compute_ns);
    publish_pair(server, &result);
}

static void answer_a_scene(struct server *server, const unsigned char *bytes, size_t size)
{
    struct scene_query *query = &server->scene;
    struct scene_result *result = &server->scene_result;
    const char *error = wire_read_scene_query(bytes, (uint32_t) size, query);
    if (error) {
        malformed_note(&server->malformed, server->intake[SCENES].query_channel, (uint32_t) size,
                       error);
        return;
    }
    server->begin_ns = clock_ns();
    server->look_at_ns = server->begin_ns + interrupted_every_ns;
    server->elsewhere_ns = 0;
    answer_scene(&server->answerer, query, result);
    result->compute_ns = clock_ns() - server->begin_ns - server->elsewhere_ns;
    if (result->status == FMB_OK)
        histogram_add(&server->compute_ns, result->compute_ns);
    publish_scene(server, query->first_pair, result);
}

static bool answer_next(struct server *server, enum kind kind)
{
    struct intake *intake = &server->intake[kind];
    struct queue_datagram next;
    if (!queue_pop(intake->queue, &next, intake->datagram))
        return false;
    (kind == PAIRS ? answer_a_pair : answer_a_scene)(server, intake->datagram, next.size);
    return true;
}

static bool answer_pairs(struct server *server)
{
    const int64_t end = clock_ns() + pairs_turn_ns;
    int answered = 0;
    while (answered < PAIRS_A_TURN && answer_next(server, PAIRS)) {
        answered++;
        if (clock_ns() >= end)
            break;
    }
    return answered > 0;
}

bool server_answer(struct server *server)
{
    const bool pairs = answer_pairs(server);
    return answer_next(server, SCENES) || pairs;
}

bool server_is_waiting(const struct server *server)
{
    return queue_counts(server->intake[PAIRS].queue).datagrams +
               queue_counts(server->intake[SCENES].queue).datagrams >
           0;
}

static bool is_readable(const struct server *server)
{
    struct pollfd bus = {.fd = lcm_get_fileno(server->lcm), .events = POLLIN};
    return poll(&bus, 1, 0) > 0;
}

/* While a scene is answered. Returns whether to go on. */
static bool between(void *user)
{
    struct server *server = user;
    const int64_t begin = clock_ns();
    if (begin < server->look_at_ns)
        return true;
    if (is_readable(server))
        server_drain(server);
    server_beat(server);
    answer_pairs(server);
    const int64_t end = clock_ns(), took = end - begin;
    server->look_at_ns = end + (took > interrupted_every_ns ? took : interrupted_every_ns);
    server->elsewhere_ns += took;
    return queue_counts(server->intake[SCENES].queue).datagrams == 0 ||
           end - server->begin_ns - server->elsewhere_ns < scene_turn_ns;
}

/* ---- Queries coming in ---- */

static void refuse_pair(struct server *server, const unsigned char *bytes, uint32_t size,
                        enum fmb_status status)
{
    struct pair_query query;
    struct pair_result result;
    const char *error = wire_read_pair_query(bytes, size, &query);
    if (error) {
        malformed_note(&server->malformed, server->intake[PAIRS].query_channel, size, error);
        return;
    }
    answer_pair_refused(&server->answerer, &query, status, &result);
    publish_pair(server, &result);
}

/* Its header is enough, and has been read once. */
static void refuse_scene(struct server *server, const unsigned char *bytes, uint32_t size,
                         enum fmb_status status)
{
    struct query_header header;
    wire_read_scene_header(bytes, size, &header);
    answer_scene_refused(&server->answerer, &header, status, &server->refused);
    publish_scene(server, 0, &server->refused);
}

static void refuse(struct server *server, enum kind kind, const unsigned char *bytes, size_t size,
                   enum fmb_status status)
{
    (kind == PAIRS ? refuse_pair : refuse_scene)(server, bytes, (uint32_t) size, status);
}

/* Where there is no room, others that hold more of it lose their newest ones, or the sender does.
 */
static void put(struct intake *intake, int64_t client_id, const unsigned char *bytes, size_t size)
{
    struct server *server = intake->server;
    enum queue_put_result result;
    while ((result = queue_put(intake->queue, client_id, 0, bytes, size)) == QUEUE_FULL) {
        struct queue_datagram thrown;
        if (queue_throw(intake->queue, &thrown, server->thrown))
            refuse(server, intake->kind, server->thrown, thrown.size, FMB_BUSY);
    }
    if (result == QUEUE_REFUSED)
        refuse(server, intake->kind, bytes, size, FMB_BUSY);
}

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct intake *intake = user;
    struct server *server = intake->server;
    struct query_header header;
    (void) channel;
    const char *error = kinds[intake->kind].read_header(buffer->data, buffer->data_size, &header);
    if (error) {
        malformed_note(&server->malformed, intake->query_channel, buffer->data_size, error);
        return;
    }
    if (query_id_ok(header.client_id) && query_id_ok(header.sequence_number))
        senders_note(&server->senders, header.client_id, header.sequence_number);
    if (buffer->data_size > QUERY_BYTES_MAX)
        refuse(server, intake->kind, buffer->data, buffer->data_size, FMB_OVER_LIMIT);
    else
        put(intake, header.client_id, buffer->data, buffer->data_size);
}

bool server_drain(struct server *server)
{
    int drained = 0;
    do {
        server->failed = server->failed || lcm_handle(server->lcm) != 0;
    } while (!server->failed && ++drained < DRAINED_MAX && is_readable(server));
    return !server->failed;
}

/* The heartbeat of another service on the same channels: both answer every query, and neither
 * knows the other's keys. Said of each that is new, once a second at most. */
static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct server *server = user;
    struct wire_status other;
    if (wire_read_status(buffer->data, buffer->data_size, &other) ||
        other.server_id == server->status.server_id || other.server_id == server->other_id ||
        !say_again(server->other_said_ns))
        return;
    server->other_id = other.server_id;
    server->other_said_ns = clock_ns();
    fprintf(stderr,
            "fmbd: another service (server %" PRId64
            ") is on %s: start one of them with --prefix\n",
            other.server_id, channel);
}

/* ---- Heartbeat ---- */

static void complete_status(struct server *server, struct wire_status *status)
{
    const struct cache_counts cache = cache_counts(server->answerer.cache);
    const struct queue_counts pairs = queue_counts(server->intake[PAIRS].queue);
    const struct queue_counts scenes = queue_counts(server->intake[SCENES].queue);
    *status = server->status;
    status->utime = clock_utime();
    status->uptime_us = (clock_ns() - server->ready_ns) / 1000;
    status->malformed = server->malformed.count;
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
    status->waiting = pairs.datagrams + scenes.datagrams;
    status->most_waiting = pairs.datagrams_most + scenes.datagrams_most;
}

void server_publish_status(struct server *server)
{
    struct wire_status status;
    unsigned char bytes[WIRE_BYTES_MAX];
    complete_status(server, &status);
    size_t size = wire_write_status(&status, bytes);
    lcm_publish(server->lcm, server->status_channel, bytes, (unsigned) size); /* or the next one */
    malformed_say(&server->malformed);
}

int server_beat(struct server *server)
{
    const int64_t now = clock_ns();
    if (now >= server->beat_at_ns) {
        server_publish_status(server);
        server->beat_at_ns = now + beat_ns;
    }
    return (int) ((server->beat_at_ns - now + 999999) / 1000000);
}

/* ---- Life ---- */

static bool open_intake(struct server *server, enum kind kind, const struct server_options *options)
{
    struct intake *intake = &server->intake[kind];
    intake->server = server;
    intake->kind = kind;
    bus_channel(intake->query_channel, options->prefix, kinds[kind].query);
    bus_channel(intake->result_channel, options->prefix, kinds[kind].result);
    intake->queue = queue_create(kinds[kind].chunks, options->seed);
    if (!intake->queue)
        return false;
    intake->subscription =
        bus_subscribe(server->lcm, intake->query_channel, on_query, intake, kinds[kind].lcm_queue);
    return intake->subscription != NULL;
}

static bool open_server(struct server *server, const struct server_options *options)
{
    bus_channel(server->status_channel, options->prefix, WIRE_STATUS);
    server->answerer.server_id = options->server_id;
    server->answerer.between = between;
    server->answerer.user = server;
    server->answerer.cache = cache_create(options->bodies, options->first_key);
    server->status.server_id = options->server_id;
    server->status.restarts = options->restarts;
    server->status.receive_buffer = options->receive_buffer;
    snprintf(server->status.version, sizeof server->status.version, "%s", fmb_version());
    server->ready_ns = clock_ns();
    if (!server->answerer.cache || !answer_prepare(&server->answerer))
        return false;
    cache_take_memory(server->answerer.cache);
    for (int kind = 0; kind < KINDS; kind++)
        if (!open_intake(server, (enum kind) kind, options))
            return false;
    server->statuses = bus_subscribe(server->lcm, server->status_channel, on_status, server, 4);
    return server->statuses != NULL;
}

struct server *server_create(lcm_t *lcm, const struct server_options *options)
{
    struct server *server = calloc(1, sizeof *server);
    if (!server)
        return NULL;
    server->lcm = lcm;
    if (open_server(server, options))
        return server;
    server_destroy(server);
    return NULL;
}

static void close_intake(struct intake *intake)
{
    if (intake->subscription)
        lcm_unsubscribe(intake->server->lcm, intake->subscription);
    queue_destroy(intake->queue);
}

void server_destroy(struct server *server)
{
    if (!server)
        return;
    for (int kind = 0; kind < KINDS; kind++)
        close_intake(&server->intake[kind]);
    if (server->statuses)
        lcm_unsubscribe(server->lcm, server->statuses);
    cache_destroy(server->answerer.cache);
    answer_release(&server->answerer);
    free(server);
}

const char *server_query_channel(const struct server *server, int kind)
{
    return server->intake[kind].query_channel;
}

const char *server_result_channel(const struct server *server, int kind)
{
    return server->intake[kind].result_channel;
}

const char *server_status_channel(const struct server *server)
{
    return server->status_channel;
}
