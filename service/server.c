#include "server.h"

#include "answer.h"
#include "clock.h"
#include "expect.h"
#include "histogram.h"
#include "jobs.h"
#include "malformed.h"
#include "queue.h"
#include "say.h"
#include "turns.h"
#include "wire.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const struct {
    const char *query, *result;
    const char *(*read_header)(const void *bytes, uint32_t size, struct query_header *out);
    enum queue_line line;
} kinds[SERVER_KINDS] = {
    [SERVER_PAIRS] = {WIRE_PAIR_QUERY, WIRE_PAIR_RESULT, wire_read_pair_header, QUEUE_SHORT},
    [SERVER_SCENES] = {WIRE_SCENE_QUERY, WIRE_SCENE_RESULT, wire_read_scene_header, QUEUE_SCENES},
    [SERVER_DEFINITIONS] = {WIRE_DEFINITION_QUERY, WIRE_DEFINITION, wire_read_definition_header,
                            QUEUE_SHORT},
    [SERVER_STATUS] = {WIRE_STATUS, WIRE_STATUS, NULL, QUEUE_SHORT},
};

enum {
    QUEUE_CHUNKS = 8192, /* 32 MB: so many pairs, or 500 of the largest scenes */
    BATCH_MAX = 64
};

/* The bus is looked at so often. */
static const int64_t look_ns = 250000;

/* A scene that has used so much is stopped if others wait. One datagram can request a million pairs
 * that take milliseconds each; most scenes take less than one altogether. */
static const int64_t scene_ns = 100000000;

static const int64_t beat_ns = 1000000000;

struct server {
    bool (*publish)(void *user, const char *channel, const unsigned char *bytes, size_t size);
    void *user;
    const struct meter_clocks *clocks;
    char query_channel[SERVER_KINDS][BUS_CHANNEL_MAX];
    char result_channel[SERVER_KINDS][BUS_CHANNEL_MAX];
    struct answerer *answerer;
    struct queue *queue;
    struct turns *turns;
    struct jobs jobs;
    struct expect expect;
    struct meter meter;
    /* Clients whose messages were read since the last charge, and the time that they took. */
    int batch[BATCH_MAX], batch_count;
    int64_t batch_ns;
    int64_t empty_ns;                   /* when the bus was last found empty */
    int64_t unit_ns[TURNS_CLIENTS + 1]; /* average of what serving a client once takes */
    int served;                         /* the last client */
    struct histogram compute_ns;
    struct wire_status status; /* counts so far; the remainder is set when it is published */
    int64_t ready_ns, beat_at_ns;
    struct malformed malformed;
    /* The other service last heard from on the same channels (0: none), and when it was reported.
     */
    int64_t other_id, other_reported_ns;
    struct pair_query pair;
    struct pair_result pair_result;
    struct definition_query definition;
    struct definition definition_result;
    struct scene_result refused;
    unsigned char datagram[QUEUE_DATAGRAM_MAX]; /* that is being answered */
    unsigned char evicted[QUEUE_DATAGRAM_MAX];
    unsigned char out[QUERY_BYTES_MAX];
};

/* ---- Results ---- */

static void publish_result(struct server *server, enum server_kind kind, size_t size,
                           int32_t status)
{
    server->status.received++;
    server->status.scenes += kind == SERVER_SCENES;
    server->status.definitions += kind == SERVER_DEFINITIONS;
    if (!server->publish(server->user, server->result_channel[kind], server->out, size)) {
        server->status.unsent++;
        return;
    }
    server->status.answered++;
    server->status.results[status]++;
}

static void publish_pair(struct server *server, const struct pair_result *result)
{
    publish_result(server, SERVER_PAIRS, wire_write_pair_result(result, server->out),
                   result->status);
    server->status.pairs += result->status == FMB_OK;
}

static void publish_definition(struct server *server, const struct definition *result)
{
    publish_result(server, SERVER_DEFINITIONS, wire_write_definition(result, server->out),
                   result->status);
}

/* Pairs that the broad phase separated are decided too; those that a method cannot decide are not.
 */
static int64_t decided(const struct scene_result *result, int32_t first_pair)
{
    int64_t pairs = result->end_pair - first_pair;
    for (int32_t i = 0; i < result->verdict_count; i++)
        pairs -= result->verdict[i] == 0;
    return pairs;
}

static void publish_scene(struct server *server, int32_t first_pair,
                          const struct scene_result *result)
{
    publish_result(server, SERVER_SCENES, wire_write_scene_result(result, server->out),
                   result->status);
    if (result->status == FMB_OK)
        server->status.pairs += decided(result, first_pair);
}

static void note_malformed(struct server *server, enum server_kind kind, size_t size,
                           const char *error)
{
    malformed_note(&server->malformed, server->query_channel[kind], (uint32_t) size, error);
}

/* ---- Activity ---- */

static bool has_work(const struct server *server, int client)
{
    return server->jobs.of_client[client] || queue_has(server->queue, client, QUEUE_SHORT) ||
           queue_has(server->queue, client, QUEUE_SCENES);
}

/* A client that got its last answer is idle from now on. */
static void update_activity(struct server *server, int client)
{
    if (has_work(server, client)) {
        turns_activate(server->turns, client);
    } else {
        turns_deactivate(server->turns, client);
        expect_answered(&server->expect, client, server->meter.wall_ns);
    }
}

/* ---- Pairs and definitions ---- */

/* The line of scenes, since it needs a job. There is space: it has just been taken from the queue.
 */
static void defer_pair(struct server *server, int client, size_t size)
{
    const enum queue_put_result result =
        queue_put(server->queue, client, QUEUE_SCENES, SERVER_PAIRS, server->datagram, size);
    if (result == QUEUE_KEPT)
        return;
    answer_pair_refused(server->answerer, &server->pair, FMB_BUSY, &server->pair_result);
    publish_pair(server, &server->pair_result);
}

static void answer_a_pair(struct server *server, int client, size_t size)
{
    struct pair_result *result = &server->pair_result;
    const char *error = wire_read_pair_query(server->datagram, (uint32_t) size, &server->pair);
    if (error) {
        note_malformed(server, SERVER_PAIRS, size, error);
        return;
    }
    const int64_t begin_ns = server->clocks->wall_ns();
    if (!answer_pair(server->answerer, &server->pair, result)) {
        defer_pair(server, client, size);
        return;
    }
    result->compute_ns = server->clocks->wall_ns() - begin_ns;
    if (result->status == FMB_OK)
        histogram_add(&server->compute_ns, result->compute_ns);
    publish_pair(server, result);
}

static void answer_a_definition(struct server *server, size_t size)
{
    const char *error =
        wire_read_definition_query(server->datagram, (uint32_t) size, &server->definition);
    if (error) {
        note_malformed(server, SERVER_DEFINITIONS, size, error);
        return;
    }
    answer_definition(server->answerer, &server->definition, &server->definition_result);
    publish_definition(server, &server->definition_result);
}

/* ---- Scenes, and pairs of bodies of several frames ---- */

static void finish_pair(struct server *server, struct job *job)
{
    struct pair_result *result = pair_job_end(job->pair, server->answerer);
    result->compute_ns = job->used_ns;
    if (result->status == FMB_OK)
        histogram_add(&server->compute_ns, result->compute_ns);
    publish_pair(server, result);
}

static void finish_scene(struct server *server, struct job *job)
{
    struct scene_result *result = scene_job_result(job->scene);
    result->compute_ns = job->used_ns;
    if (result->status == FMB_OK)
        histogram_add(&server->compute_ns, result->compute_ns);
    publish_scene(server, scene_job_query(job->scene)->first_pair, result);
}

static void finish_job(struct server *server, struct job *job)
{
    if (job->is_pair)
        finish_pair(server, job);
    else
        finish_scene(server, job);
    jobs_give_back(&server->jobs, job);
}

/* A pair is refused as busy, and so is a scene without an answer. */
static void stop_job(struct server *server, struct job *job)
{
    if (!job->is_pair)
        scene_job_stop(job->scene);
    finish_job(server, job);
}

/* Stops the longest job, at the expense of its client. */
static void free_a_job(struct server *server, int for_client)
{
    struct job *job = jobs_longest(&server->jobs);
    const int client = job->client;
    turns_charge(server->turns, for_client, meter_read(&server->meter));
    stop_job(server, job);
    turns_charge(server->turns, client, meter_read(&server->meter));
    update_activity(server, client);
}

/* The next scene or pair of a client. NULL: its bytes are malformed. */
static struct job *begin_job(struct server *server, int client)
{
    struct queue_datagram next;
    if (server->jobs.free == 0)
        free_a_job(server, client);
    queue_pop(server->queue, client, QUEUE_SCENES, &next, server->datagram);
    struct job *job = jobs_take(&server->jobs, client);
    job->is_pair = next.kind == SERVER_PAIRS;
    const char *error =
        job->is_pair ? pair_job_begin(job->pair, server->answerer, server->datagram, next.size)
                     : scene_job_begin(job->scene, server->datagram, next.size);
    if (!error)
        return job;
    note_malformed(server, (enum server_kind) next.kind, next.size, error);
    jobs_give_back(&server->jobs, job);
    return NULL;
}

static bool other_scenes_wait(const struct server *server)
{
    return server->jobs.free < JOBS - 1 || queue_counts(server->queue).datagrams > 0;
}

static bool step(struct server *server, struct job *job)
{
    return job->is_pair ? pair_job_step(job->pair) : scene_job_step(job->scene, server->answerer);
}

/* A turn of at most so many nanoseconds. */
static void advance_job(struct server *server, int client, int64_t most_ns)
{
    const int64_t begin_ns = server->meter.wall_ns;
    struct job *job = server->jobs.of_client[client];
    if (!job)
        job = begin_job(server, client);
    if (!job)
        return;
    bool complete = false;
    int64_t turn = 0;
    while (!complete && turn < most_ns) {
        complete = step(server, job);
        turn = server->clocks->wall_ns() - begin_ns;
    }
    job->used_ns += turn;
    if (complete)
        finish_job(server, job);
    else if (job->used_ns > scene_ns && !job->is_pair && other_scenes_wait(server) &&
             scene_job_has_answers(job->scene))
        stop_job(server, job);
}

/* ---- Turns ---- */

static bool may_serve(const void *user, int client)
{
    const struct server *server = user;
    return server->jobs.of_client[client] || queue_has(server->queue, client, QUEUE_SHORT) ||
           server->jobs.free > 0 || jobs_longest((struct jobs *) &server->jobs);
}

/* What a client is charged for being served once. A long unit of work delays every other client,
 * puts their cores to sleep and empties the caches, all of which they pay for: so what it takes
 * beyond short_ns counts twice. */
static int64_t price(int64_t used_ns)
{
    static const int64_t short_ns = 50000;
    return used_ns > short_ns ? 2 * used_ns - short_ns : used_ns;
}

static void serve(struct server *server, int client, int64_t job_most_ns)
{
    struct queue_datagram next;
    if (client != server->served)
        meter_base(&server->meter);
    server->served = client;
    turns_begin(server->turns);
    if (!queue_pop(server->queue, client, QUEUE_SHORT, &next, server->datagram))
        advance_job(server, client, job_most_ns);
    else if (next.kind == SERVER_PAIRS)
        answer_a_pair(server, client, next.size);
    else
        answer_a_definition(server, next.size);
    const int64_t used_ns = meter_read(&server->meter);
    server->unit_ns[client] += (used_ns - server->unit_ns[client]) / 4;
    turns_charge(server->turns, client, price(used_ns));
    update_activity(server, client);
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Only while others wait, for a client that would be served before them; and only where it is far
 * behind them, or the work that would begin instead usually takes longer than the waiting. */
static bool begin_expecting(struct server *server, int client)
{
    const int next = has_work(server, client) ? -1 : turns_least(server->turns);
    if (next < 0)
        return false;
    const int64_t lead_ns = turns_lead(server->turns, client);
    return expect_begin(&server->expect, client, server->meter.wall_ns, lead_ns + TURNS_SLICE_NS,
                        lead_ns > TURNS_SLICE_NS ? INT64_MAX : server->unit_ns[next]);
}

static bool goes_on_expecting(struct server *server)
{
    struct expect *expect = &server->expect;
    const int64_t now_ns = server->clocks->wall_ns();
    const int client = expect->client;
    if (client < 0)
        return false;
    if (expect_poll(expect, now_ns) && !has_work(server, client) &&
        turns_lead(server->turns, client) > -TURNS_SLICE_NS)
        return true;
    turns_charge(server->turns, client, expect_end(expect, now_ns));
    return false;
}

enum server_state server_work(struct server *server)
{
    if (goes_on_expecting(server))
        return SERVER_EXPECTING;
    const int64_t until_ns = server->clocks->wall_ns() + look_ns;
    int64_t left_ns = look_ns;
    while (left_ns > 0) {
        int64_t lead_ns;
        const int client = turns_next(server->turns, may_serve, server, server->served, &lead_ns);
        if (client < 0)
            return SERVER_IDLE;
        serve(server, client,
              lead_ns < look_ns ? smaller(left_ns, lead_ns + TURNS_SLICE_NS) : left_ns);
        if (begin_expecting(server, client))
            return SERVER_EXPECTING;
        left_ns = until_ns - server->meter.wall_ns;
    }
    return turns_active(server->turns) > 0 ? SERVER_WORKING : SERVER_IDLE;
}

void server_resume(struct server *server)
{
    meter_skip(&server->meter);
}

/* ---- Queries that arrive ---- */

static void refuse_pair(struct server *server, const unsigned char *bytes, size_t size,
                        enum fmb_status status)
{
    const char *error = wire_read_pair_query(bytes, (uint32_t) size, &server->pair);
    if (error) {
        note_malformed(server, SERVER_PAIRS, size, error);
        return;
    }
    answer_pair_refused(server->answerer, &server->pair, status, &server->pair_result);
    publish_pair(server, &server->pair_result);
}

/* The header is enough, and has been read once. */
static void refuse_other(struct server *server, enum server_kind kind, const unsigned char *bytes,
                         size_t size, enum fmb_status status)
{
    struct query_header header;
    kinds[kind].read_header(bytes, (uint32_t) size, &header);
    if (kind == SERVER_SCENES) {
        answer_scene_refused(server->answerer, &header, status, &server->refused);
        publish_scene(server, 0, &server->refused);
    } else {
        answer_definition_refused(server->answerer, &header, status, &server->definition_result);
        publish_definition(server, &server->definition_result);
    }
}

/* At the expense of its client, not of the batch. */
static void refuse(struct server *server, const struct queue_datagram *datagram,
                   const unsigned char *bytes, enum fmb_status status)
{
    server->batch_ns += meter_read(&server->meter);
    if (datagram->kind == SERVER_PAIRS)
        refuse_pair(server, bytes, datagram->size, status);
    else
        refuse_other(server, (enum server_kind) datagram->kind, bytes, datagram->size, status);
    turns_charge(server->turns, datagram->client, meter_read(&server->meter));
}

static void put(struct server *server, const struct queue_datagram *datagram,
                const unsigned char *bytes)
{
    enum queue_put_result result;
    while ((result = queue_put(server->queue, datagram->client, kinds[datagram->kind].line,
                               datagram->kind, bytes, datagram->size)) == QUEUE_FULL) {
        struct queue_datagram evicted;
        if (!queue_evict(server->queue, &evicted, server->evicted))
            break;
        refuse(server, &evicted, server->evicted, FMB_BUSY);
        update_activity(server, evicted.client);
    }
    if (result == QUEUE_REFUSED)
        refuse(server, datagram, bytes, FMB_BUSY);
}

static void charge_batch(struct server *server, int datagrams)
{
    server->batch_ns += meter_read(&server->meter);
    for (int i = 0; i < server->batch_count; i++)
        turns_charge(server->turns, server->batch[i], server->batch_ns / datagrams);
    server->batch_count = 0;
    server->batch_ns = 0;
}

static void receive_query(struct server *server, enum server_kind kind, const unsigned char *bytes,
                          size_t size)
{
    struct query_header header;
    const char *error = kinds[kind].read_header(bytes, (uint32_t) size, &header);
    if (error) {
        note_malformed(server, kind, size, error);
        return;
    }
    const int client = turns_client(server->turns, header.client_id);
    const struct queue_datagram datagram = {.client = client, .kind = kind, .size = size};
    if (server->batch_count == BATCH_MAX)
        charge_batch(server, BATCH_MAX);
    server->batch[server->batch_count++] = client;
    expect_arrived(&server->expect, client, server->empty_ns);
    if (size > QUERY_BYTES_MAX)
        refuse(server, &datagram, bytes, FMB_OVER_LIMIT);
    else
        put(server, &datagram, bytes);
    update_activity(server, client);
}

/* The heartbeat of another service on the same channels: both answer every query. Each that is new
 * is reported, at most one a second. */
static void receive_status(struct server *server, const unsigned char *bytes, size_t size)
{
    struct wire_status other;
    if (wire_read_status(bytes, (uint32_t) size, &other) ||
        other.server_id == server->status.server_id || other.server_id == server->other_id ||
        !say_again(server->other_reported_ns))
        return;
    server->other_id = other.server_id;
    server->other_reported_ns = clock_ns();
    fprintf(stderr,
            "fmbd: another service (server %" PRId64
            ") is on %s: start one of them with --prefix\n",
            other.server_id, server->query_channel[SERVER_STATUS]);
}

void server_receive(struct server *server, enum server_kind kind, const unsigned char *bytes,
                    size_t size)
{
    if (kind == SERVER_STATUS)
        receive_status(server, bytes, size);
    else
        receive_query(server, kind, bytes, size);
}

void server_received(struct server *server, int datagrams)
{
    if (datagrams > 0)
        charge_batch(server, datagrams);
    server->empty_ns = server->meter.wall_ns;
}

/* ---- Heartbeat ---- */

static void complete_status(const struct server *server, const struct bus_counts *bus,
                            struct wire_status *status)
{
    const struct cache_counts cache = cache_counts(answerer_cache(server->answerer));
    const struct queue_counts queue = queue_counts(server->queue);
    *status = server->status;
    status->utime = clock_utime();
    status->uptime_us = (clock_ns() - server->ready_ns) / 1000;
    status->receive_buffer = bus->receive_buffer;
    status->malformed = server->malformed.count;
    status->foreign = (int64_t) (bus->foreign + bus->malformed);
    status->dropped = (int64_t) bus->dropped;
    status->waiting = queue.datagrams;
    status->most_waiting = queue.datagrams_most;
    status->bodies = cache.bodies;
    status->frames = cache.frames;
    status->frame_capacity = cache.frame_capacity;
    status->ids = cache.ids;
    status->hits = cache.hits;
    status->misses = cache.misses;
    status->evictions = cache.evictions;
    status->compute_p50_ns = histogram_quantile(&server->compute_ns, 0.50);
    status->compute_p99_ns = histogram_quantile(&server->compute_ns, 0.99);
    status->compute_max_ns = server->compute_ns.max;
}

int server_beat_due_ms(const struct server *server)
{
    const int64_t left_ns = server->beat_at_ns - clock_ns();
    return left_ns > 0 ? (int) ((left_ns + 999999) / 1000000) : 0;
}

void server_beat(struct server *server, const struct bus_counts *bus)
{
    struct wire_status status;
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    complete_status(server, bus, &status);
    const size_t size = wire_write_status(&status, bytes);
    server->publish(server->user, server->result_channel[SERVER_STATUS], bytes, size);
    malformed_say(&server->malformed);
    server->beat_at_ns = clock_ns() + beat_ns;
}

/* ---- Life ---- */

static bool open_server(struct server *server, const struct server_options *options)
{
    const struct answerer_options answerer = {.frames = options->frames,
                                              .server_id = options->server_id,
                                              .secret = {options->secret[0], options->secret[1]}};
    server->answerer = answerer_create(&answerer);
    server->queue = queue_create(QUEUE_CHUNKS, TURNS_CLIENTS + 1);
    server->turns = turns_create(options->secret[2]);
    const bool jobs = jobs_init(&server->jobs);
    if (!server->answerer || !server->queue || !server->turns || !jobs)
        return false;
    cache_take_memory(answerer_cache(server->answerer));
    server->status.server_id = options->server_id;
    snprintf(server->status.version, sizeof server->status.version, "%s", fmb_version());
    server->served = -1;
    expect_init(&server->expect);
    meter_init(&server->meter, server->clocks);
    server->ready_ns = clock_ns();
    return true;
}

struct server *server_create(const struct server_options *options)
{
    struct server *server = calloc(1, sizeof *server);
    if (!server)
        return NULL;
    server->publish = options->publish;
    server->user = options->user;
    server->clocks = options->clocks ? options->clocks : &meter_system_clocks;
    for (int kind = 0; kind < SERVER_KINDS; kind++) {
        bus_channel(server->query_channel[kind], options->prefix, kinds[kind].query);
        bus_channel(server->result_channel[kind], options->prefix, kinds[kind].result);
    }
    if (open_server(server, options))
        return server;
    server_destroy(server);
    return NULL;
}

void server_destroy(struct server *server)
{
    if (!server)
        return;
    jobs_release(&server->jobs);
    turns_destroy(server->turns);
    queue_destroy(server->queue);
    answerer_destroy(server->answerer);
    free(server);
}

const char *server_query_channel(const struct server *server, enum server_kind kind)
{
    return server->query_channel[kind];
}

const char *server_result_channel(const struct server *server, enum server_kind kind)
{
    return server->result_channel[kind];
}
