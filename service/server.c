/* The path of a query: server_receive() puts it into the queue; server_work() takes it from there
 * when the scheduler chooses its client, answers it at once (one pair of frames, or a definition)
 * or in steps (a job), and publishes the result. All time that this takes is charged to the client.
 */
#include "server.h"

#include "answer.h"
#include "clock.h"
#include "histogram.h"
#include "jobs.h"
#include "queue.h"
#include "process.h"
#include "scheduler.h"
#include "wire.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* [kind] Channel names without prefix, header reader (NULL: not queued), and FIFO of the queue. */
static const struct {
    const char *query, *result;
    const char *(*read_header)(const void *bytes, uint32_t size, struct query_header *out);
    enum queue_fifo fifo;
} kinds[SERVER_KINDS] = {
    [SERVER_PAIRS] = {WIRE_PAIR_QUERY, WIRE_PAIR_RESULT, wire_read_pair_header, QUEUE_SHORT},
    [SERVER_SCENES] = {WIRE_SCENE_QUERY, WIRE_SCENE_RESULT, wire_read_scene_header, QUEUE_SCENES},
    [SERVER_DEFINITIONS] = {WIRE_DEFINITION_QUERY, WIRE_DEFINITION, wire_read_definition_header,
                            QUEUE_SHORT},
    [SERVER_STATUS] = {WIRE_STATUS, WIRE_STATUS, NULL, QUEUE_SHORT},
};

enum {
    QUEUE_CHUNKS = 8192, /* 32 MB: 8192 pair queries, or 500 of the largest scenes */
    BATCH_MAX = 64
};

/* How long server_work() serves clients before the bus is read again, which takes about half a
 * microsecond. A query that arrives meanwhile waits for this long, or for one turn: a pair or a
 * definition, or this much of a job. */
static const int64_t work_ns = 25000, job_turn_ns = 250000;

/* A scene that has used more time than this is stopped if other work is pending. One datagram can
 * request a million pairs that take milliseconds each; most scenes take less than one millisecond
 * altogether. */
static const int64_t scene_limit_ns = 100000000;

/* A client gets refusals_most refusals at once, and one more after each refusal_ns: 100 a second. A
 * client that has 64 queries under way gets all of them. */
static const int64_t refusal_ns = 10000000, refusals_most = 64;

/* Interval between heartbeats. */
static const int64_t heartbeat_ns = 1000000000;

struct server {
    bool (*publish)(void *user, const char *channel, const unsigned char *bytes, size_t size);
    void *user;
    int64_t (*clock_ns)(void);
    char query_channel[SERVER_KINDS][BUS_CHANNEL_MAX];
    char result_channel[SERVER_KINDS][BUS_CHANNEL_MAX];
    struct answerer *answerer;
    struct queue *queue;
    struct scheduler *scheduler;
    struct jobs jobs;
    int64_t charged_ns; /* time up to which all time has been charged to clients, or discarded */
    /* The client for whose next query the service waits (-1: none), since when, and how long. */
    int awaited;
    int64_t awaited_since_ns, patience_ns;
    /* Clients whose messages were read since the last charge, one entry for each message, and the
     * time that reading took. */
    int batch[BATCH_MAX], batch_count;
    int64_t batch_ns;
    int64_t bus_empty_ns; /* when the bus was last empty */
    /* [client] Theoretical arrival time of the next refusal (generic cell rate algorithm). */
    int64_t next_refusal_ns[SCHEDULER_CLIENTS + 1];
    struct histogram compute_ns; /* of all queries answered with FMB_OK */
    struct wire_status status;   /* counts so far; complete_status() sets the other fields */
    int64_t ready_ns, heartbeat_due_ns;
    /* Messages that cannot be decoded, and those of them not reported yet; the last one. */
    int64_t malformed_unreported, malformed_reported_ns;
    const char *malformed_reason;
    enum server_kind malformed_kind;
    uint32_t malformed_size;
    uint64_t fragmented_reported; /* bus_counts.fragmented when it was reported last */
    /* The other service on the same channels that was reported last (0: none), and when. */
    int64_t other_id, other_reported_ns;
    bool can_begin; /* a job is free or can be stopped */
    /* Buffers of the query being answered or refused, and of its result. */
    struct definition_query definition;
    struct definition definition_result;
    unsigned char evicted[QUEUE_DATAGRAM_MAX]; /* the query being refused after its eviction */
    unsigned char out[QUERY_BYTES_MAX];        /* the result, encoded */
};

/* ---- Results ---- */

static void count_query(struct server *server, enum server_kind kind, bool answered)
{
    server->status.received++;
    server->status.scenes += kind == SERVER_SCENES;
    server->status.definitions += kind == SERVER_DEFINITIONS;
    server->status.answered += answered;
    server->status.unsent += !answered;
}

/* Publishes server->out, size bytes, and counts it. */
static void publish_result(struct server *server, enum server_kind kind, size_t size,
                           int32_t status)
{
    const bool sent =
        server->publish(server->user, server->result_channel[kind], server->out, size);
    count_query(server, kind, sent);
    server->status.results[status] += sent;
}

/* Drops a query without a result. On input: counter: in server->status, of the reason. */
static void drop(struct server *server, enum server_kind kind, int64_t *counter)
{
    count_query(server, kind, false);
    ++*counter;
}

/* Publishes the result of a job. */
static void publish_answer(struct server *server, enum server_kind kind, struct answer_job *answer,
                           int64_t compute_ns)
{
    int32_t status;
    const size_t size = answer_job_write(answer, compute_ns, server->out, &status);
    publish_result(server, kind, size, status);
    server->status.pairs += answer_job_decided(answer);
    if (status == FMB_OK)
        histogram_add(&server->compute_ns, compute_ns);
}

/* Reports messages that could not be read and are not reported yet on stderr; at most one report a
 * second. */
static void report_malformed(struct server *server)
{
    if (server->malformed_unreported == 0 || !stderr_report_due(server->malformed_reported_ns))
        return;
    fprintf(stderr,
            "fmbd: malformed message on %s (%" PRIu32 " bytes): %s; %" PRId64
            " of them so far, %" PRId64 " since this was last said\n",
            server->query_channel[server->malformed_kind], server->malformed_size,
            server->malformed_reason, server->status.malformed, server->malformed_unreported);
    server->malformed_reported_ns = clock_ns();
    server->malformed_unreported = 0;
}

/* Notes a query that cannot be read. error: why it cannot; NULL: it can. */
static bool is_malformed(struct server *server, enum server_kind kind, size_t size,
                         const char *error)
{
    if (!error)
        return false;
    server->status.malformed++;
    server->malformed_unreported++;
    server->malformed_kind = kind;
    server->malformed_size = (uint32_t) size;
    server->malformed_reason = error;
    report_malformed(server);
    return true;
}

/* ---- Time ---- */

/* Returns the nanoseconds since charged_ns, which the caller charges, and advances charged_ns. */
static int64_t take_time(struct server *server)
{
    const int64_t before_ns = server->charged_ns;
    server->charged_ns = server->clock_ns();
    return server->charged_ns - before_ns;
}

static void charge(struct server *server, int client)
{
    scheduler_charge(server->scheduler, client, take_time(server));
}

/* ---- Activity ---- */

/* Makes a client that has a job or a query in the queue active, and any other idle. */
static void update_activity(struct server *server, int client)
{
    const int64_t *waiting = queue_waiting(server->queue, client);
    if (server->jobs.of_client[client] || waiting[QUEUE_SHORT] || waiting[QUEUE_SCENES])
        scheduler_activate(server->scheduler, client, server->bus_empty_ns, server->charged_ns);
    else
        scheduler_deactivate(server->scheduler, client, server->charged_ns);
}

/* ---- Refusals ---- */

/* Whether a refusal may be sent to a client now. If so, it is counted as sent. */
static bool take_refusal(struct server *server, int client)
{
    const int64_t now_ns = server->charged_ns;
    int64_t *next_ns = &server->next_refusal_ns[client];
    if (*next_ns - now_ns > (refusals_most - 1) * refusal_ns)
        return false;
    *next_ns = (*next_ns > now_ns ? *next_ns : now_ns) + refusal_ns;
    return true;
}

/* Refuses a query. No result is sent if its client has used up its refusals. The time is charged to
 * the client, not to the batch. */
static void refuse(struct server *server, const struct queue_datagram *datagram,
                   const unsigned char *bytes, enum fmb_status status)
{
    const enum server_kind kind = (enum server_kind) datagram->kind;
    size_t size;
    server->batch_ns += take_time(server);
    if (!take_refusal(server, datagram->client))
        drop(server, kind, &server->status.refusals_unsent);
    else if (!is_malformed(server, kind, datagram->size,
                           answer_refused(server->answerer, (enum answer_kind) kind, bytes,
                                          datagram->size, status, server->out, &size)))
        publish_result(server, kind, size, (int32_t) status);
    charge(server, datagram->client);
}

/* Evicts the newest query of a client and refuses it as busy. Returns false if it has none. */
static bool evict(struct server *server, int client)
{
    struct queue_datagram evicted;
    if (!queue_evict(server->queue, client, &evicted, server->evicted))
        return false;
    refuse(server, &evicted, server->evicted, FMB_BUSY);
    update_activity(server, client);
    return true;
}

/* ---- Queries ---- */

static void answer_definition_query(struct server *server, const unsigned char *bytes, size_t size)
{
    struct definition *result = &server->definition_result;
    const char *error = wire_read_definition_query(bytes, (uint32_t) size, &server->definition);
    if (is_malformed(server, SERVER_DEFINITIONS, size, error))
        return;
    answer_definition(server->answerer, &server->definition, result);
    publish_result(server, SERVER_DEFINITIONS, wire_write_definition(result, server->out),
                   result->status);
}

static void finish_job(struct server *server, struct job *job)
{
    publish_answer(server, (enum server_kind) job->kind, job->answer, job->used_ns);
    jobs_give_back(&server->jobs, job);
}

/* Ends a job early. A pair, or a scene in which no pair has been answered, gets FMB_BUSY; any other
 * scene, the pairs answered so far. */
static void stop_job(struct server *server, struct job *job)
{
    answer_job_stop(job->answer);
    finish_job(server, job);
}

/* Stops the job that has used most time, so that for_client can have one. The time spent so far is
 * charged to for_client; publishing the result, to the client of the job. */
static void stop_longest_job(struct server *server, int for_client)
{
    struct job *job = jobs_longest(&server->jobs);
    const int client = job->client;
    charge(server, for_client);
    stop_job(server, job);
    charge(server, client);
    update_activity(server, client);
}

/* Answers the query in jobs.spare if it is a short pair query. Returns whether it was. If not, its
 * bodies have been found, or one has been added: only the bodies tell whether a pair is short. */
static bool answer_short(struct server *server)
{
    struct answer_job *answer = server->jobs.spare;
    const int64_t begin_ns = server->clock_ns();
    /* Two steps: the first checks the fields, the second finds the bodies. */
    bool complete =
        answer_job_step(answer, server->answerer) || answer_job_step(answer, server->answerer);
    if (!complete && !answer_job_is_short(answer))
        return false;
    while (!complete)
        complete = answer_job_step(answer, server->answerer);
    publish_answer(server, SERVER_PAIRS, answer, server->clock_ns() - begin_ns);
    return true;
}

/* Answers a query at once, or begins a job for it; a pair that takes several steps, from the FIFO
 * of short queries, is moved to that of scenes if the client has other scenes or no job is free.
 * (The queue has capacity for it: it has just been popped.) It is begun again later, and bodies
 * that were found then count as hits twice. Returns the job; NULL: none. */
static struct job *begin(struct server *server, const struct queue_datagram *query,
                         enum queue_fifo fifo)
{
    const enum server_kind kind = (enum server_kind) query->kind;
    struct jobs *jobs = &server->jobs;
    if (kind == SERVER_DEFINITIONS) {
        answer_definition_query(server, answer_job_message(jobs->spare), query->size);
        return NULL;
    }
    const char *error = answer_job_begin(jobs->spare, (enum answer_kind) kind,
                                         answer_job_message(jobs->spare), query->size);
    if (is_malformed(server, kind, query->size, error) ||
        (fifo == QUEUE_SHORT && answer_short(server)))
        return NULL;
    if (fifo == QUEUE_SHORT && (jobs->of_client[query->client] || jobs->free == 0 ||
                                queue_waiting(server->queue, query->client)[QUEUE_SCENES] > 0)) {
        const enum queue_put_result put =
            queue_put(server->queue, QUEUE_SCENES, query, answer_job_message(jobs->spare));
        assert(put == QUEUE_ADDED); /* it has just been popped */
        (void) put;
        return NULL;
    }
    if (jobs->free == 0)
        stop_longest_job(server, query->client);
    return jobs_take(jobs, query->client, (int) kind);
}

/* Steps a job for a turn, which ends with the first step that reaches job_turn_ns. */
static void advance_job(struct server *server, struct job *job)
{
    const int64_t begin_ns = server->charged_ns;
    bool complete = false;
    int64_t turn_ns = 0;
    while (!complete && turn_ns < job_turn_ns) {
        complete = answer_job_step(job->answer, server->answerer);
        turn_ns = server->clock_ns() - begin_ns;
    }
    job->used_ns += turn_ns;
    if (complete)
        finish_job(server, job);
    else if (job->used_ns > scene_limit_ns && answer_job_has_answers(job->answer) &&
             (server->jobs.free < JOBS - 1 || queue_counts(server->queue).datagrams > 0))
        stop_job(server, job);
}

/* ---- Scheduling ---- */

/* Whether the client can be served now: its next query needs no job, it has one, or one is free or
 * can be stopped. */
static bool may_serve(const void *user, int client)
{
    const struct server *server = user;
    return server->jobs.of_client[client] || queue_waiting(server->queue, client)[QUEUE_SHORT] ||
           server->can_begin;
}

/* Does one unit of work for the client and charges it: answers its oldest short query or, if it has
 * none, advances its job or begins the next one. A query that has waited too long is dropped. */
static void serve(struct server *server, int client)
{
    struct job *job = server->jobs.of_client[client];
    struct queue_datagram query;
    unsigned char *message = answer_job_message(server->jobs.spare);
    const bool is_short = queue_pop(server->queue, client, QUEUE_SHORT, &query, message);
    const bool begins =
        is_short || (!job && queue_pop(server->queue, client, QUEUE_SCENES, &query, message));
    const bool expired = begins && server->clock_ns() - query.arrived_ns > SERVER_EXPIRY_NS;
    if (expired)
        drop(server, (enum server_kind) query.kind, &server->status.expired);
    if (begins)
        job = expired ? NULL : begin(server, &query, is_short ? QUEUE_SHORT : QUEUE_SCENES);
    if (job)
        advance_job(server, job);
    charge(server, client);
    update_activity(server, client);
}

/* Returns whether to keep waiting for the next query of the client that was served last. If not,
 * charges the client for the wait, but at most for the intended time, since other programs may have
 * run. */
static bool keep_waiting(struct server *server)
{
    if (server->awaited < 0)
        return false;
    const int64_t waited_ns = server->clock_ns() - server->awaited_since_ns;
    if (waited_ns < scheduler_patience(server->scheduler, server->awaited))
        return true;
    scheduler_charge(server->scheduler, server->awaited,
                     clock_earlier(waited_ns, server->patience_ns));
    server->awaited = -1;
    return false;
}

enum server_state server_work(struct server *server)
{
    if (keep_waiting(server))
        return SERVER_ANTICIPATING;
    const int64_t until_ns = server->charged_ns + work_ns;
    do {
        server->can_begin = server->jobs.free > 0 || jobs_longest(&server->jobs);
        const int client = scheduler_next(server->scheduler, may_serve, server);
        if (client < 0)
            return SERVER_IDLE;
        serve(server, client);
        server->patience_ns = scheduler_patience(server->scheduler, client);
        if (server->patience_ns > 0) {
            server->awaited = client;
            server->awaited_since_ns = server->charged_ns;
            return SERVER_ANTICIPATING;
        }
    } while (server->charged_ns < until_ns);
    return scheduler_active(server->scheduler) > 0 ? SERVER_WORKING : SERVER_IDLE;
}

void server_resume(struct server *server)
{
    server->charged_ns = server->clock_ns();
}

/* ---- Queries that arrive ---- */

/* Puts a query into the queue, and refuses the queries that are evicted for it. Refuses the query
 * itself if it exceeds its client's share of the queue, or if an older query of its client has
 * waited too long. */
static void enqueue(struct server *server, const struct queue_datagram *query,
                    const unsigned char *bytes)
{
    enum queue_put_result result = QUEUE_REFUSED;
    if (query->arrived_ns - queue_oldest_ns(server->queue, query->client) <= SERVER_BUSY_NS)
        while ((result = queue_put(server->queue, kinds[query->kind].fifo, query, bytes)) ==
                   QUEUE_FULL &&
               evict(server, queue_largest(server->queue)))
            continue;
    if (result != QUEUE_ADDED)
        refuse(server, query, bytes, FMB_BUSY);
}

/* Divides the time of a batch by the number of its datagrams, and charges each to its client. The
 * share of datagrams that are no queries is charged to none. */
static void charge_batch(struct server *server, int datagrams)
{
    server->batch_ns += take_time(server);
    for (int i = 0; i < server->batch_count; i++)
        scheduler_charge(server->scheduler, server->batch[i], server->batch_ns / datagrams);
    server->batch_count = 0;
    server->batch_ns = 0;
}

static void receive_query(struct server *server, enum server_kind kind, const unsigned char *bytes,
                          size_t size)
{
    struct query_header header;
    const char *error = kinds[kind].read_header(bytes, (uint32_t) size, &header);
    if (is_malformed(server, kind, size, error))
        return;
    const int client = scheduler_client(server->scheduler, header.client_id);
    const struct queue_datagram query = {client, kind, size, server->clock_ns()};
    if (server->batch_count == BATCH_MAX)
        charge_batch(server, BATCH_MAX);
    server->batch[server->batch_count++] = client;
    if (size > QUERY_BYTES_MAX)
        refuse(server, &query, bytes, FMB_OVER_LIMIT);
    else
        enqueue(server, &query, bytes);
    update_activity(server, client);
}

/* Handles the heartbeat of another service. One on the same channels is an error, since both answer
 * every query. It is reported unless it is the one reported last; at most one report a second. */
static void receive_status(struct server *server, const unsigned char *bytes, size_t size)
{
    struct wire_status other;
    if (wire_read_status(bytes, (uint32_t) size, &other) ||
        other.server_id == server->status.server_id || other.server_id == server->other_id ||
        !stderr_report_due(server->other_reported_ns))
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

void server_end_batch(struct server *server, int datagrams)
{
    if (datagrams > 0)
        charge_batch(server, datagrams);
    server->bus_empty_ns = server->charged_ns;
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
    status->foreign = (int64_t) (bus->foreign + bus->malformed);
    status->fragmented = (int64_t) bus->fragmented;
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

/* Reports on stderr the queries that arrived in fragments since the last heartbeat. */
static void report_fragmented(struct server *server, const struct bus_counts *bus)
{
    if (bus->fragmented == server->fragmented_reported || !stderr_ready())
        return;
    fprintf(stderr,
            "fmbd: a query on %s came in fragments (%" PRIu32
            " bytes) and is not answered: the "
            "limit is %d bytes, divide the scene; %" PRIu64 " of them so far\n",
            server->query_channel[bus->fragmented_listener], bus->fragmented_size,
            (int) QUERY_BYTES_MAX, bus->fragmented);
    server->fragmented_reported = bus->fragmented;
}

int server_heartbeat_due_ms(const struct server *server)
{
    return clock_left_ms(server->heartbeat_due_ns);
}

void server_heartbeat(struct server *server, const struct bus_counts *bus)
{
    struct wire_status status;
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    complete_status(server, bus, &status);
    const size_t size = wire_write_status(&status, bytes);
    server->publish(server->user, server->result_channel[SERVER_STATUS], bytes, size);
    report_malformed(server);
    report_fragmented(server, bus);
    server->heartbeat_due_ns = clock_ns() + heartbeat_ns;
}

/* ---- Life ---- */

static bool open_server(struct server *server, const struct server_options *options)
{
    const struct answerer_options answerer = {.frames = options->frames,
                                              .server_id = options->server_id,
                                              .secret = {options->secret[0], options->secret[1]}};
    server->answerer = answerer_create(&answerer);
    server->queue = queue_create(QUEUE_CHUNKS, SCHEDULER_CLIENTS + 1);
    server->scheduler = scheduler_create(options->secret[2]);
    const bool jobs = jobs_init(&server->jobs);
    if (!server->answerer || !server->queue || !server->scheduler || !jobs)
        return false;
    cache_prefault(answerer_cache(server->answerer));
    server->status.server_id = options->server_id;
    snprintf(server->status.version, sizeof server->status.version, "%s", fmb_version());
    server->awaited = -1;
    server->charged_ns = server->clock_ns();
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
    server->clock_ns = options->clock_ns ? options->clock_ns : clock_ns;
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
    scheduler_destroy(server->scheduler);
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
