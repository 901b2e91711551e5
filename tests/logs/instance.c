#include "instance.h"

#include "answer_now.h"
#include <stdio.h>
#include <string.h>

static const char *const names[INSTANCE_CHANNELS] = {
    WIRE_PAIR_QUERY, WIRE_PAIR_RESULT, WIRE_SCENE_QUERY, WIRE_SCENE_RESULT, WIRE_STATUS};

/* From one query to the next, and from a query to its result. */
enum { QUERY_US = 60, RESULT_US = 45 };

bool instance_open(struct instance *instance, struct tape *tape,
                   const struct instance_options *options)
{
    const struct answerer_options answerer = {
        .frames = options->frames, .server_id = options->server_id, .secret = {1, 2}};
    *instance = (struct instance){.tape = tape};
    instance->status.server_id = options->server_id;
    instance->draw.state = (uint64_t) options->server_id;
    snprintf(instance->status.version, sizeof instance->status.version, "0.1.0");
    for (int i = 0; i < INSTANCE_CHANNELS; i++)
        bus_channel(instance->channel[i], options->prefix, names[i]);
    instance->answerer = answerer_create(&answerer);
    instance->job = answer_job_create();
    if (instance->answerer && instance->job)
        return true;
    instance_close(instance);
    return false;
}

void instance_close(struct instance *instance)
{
    answerer_destroy(instance->answerer);
    if (instance->job)
        answer_job_destroy(instance->job);
}

/* ---- What goes onto the tape ---- */

static unsigned char written[QUERY_BYTES_MAX];

static void put(struct instance *instance, enum instance_channel channel, int64_t utime,
                const unsigned char *bytes, size_t size)
{
    tape_put(instance->tape, utime, instance->channel[channel], bytes, size);
}

static void put_query(struct instance *instance, enum instance_channel channel,
                      const unsigned char *bytes, size_t size)
{
    put(instance, channel, tape_utime(instance->tape), bytes, size);
    tape_pass(instance->tape, QUERY_US);
}

/* What every result adds to the heartbeat. */
static void count(struct instance *instance, int32_t status, int64_t pairs)
{
    instance->status.received++;
    instance->status.answered++;
    instance->status.results[status]++;
    instance->status.pairs += pairs;
}

static void put_pair_result(struct instance *instance, int64_t utime,
                            const struct pair_result *result)
{
    count(instance, result->status, result->status == FMB_OK);
    put(instance, INSTANCE_PAIR_RESULT, utime + RESULT_US, written,
        wire_write_pair_result(result, written));
}

static void put_scene_result(struct instance *instance, int64_t utime, int32_t first_pair,
                             const struct scene_result *result)
{
    instance->status.scenes++;
    count(instance, result->status, result->status == FMB_OK ? result->end_pair - first_pair : 0);
    put(instance, INSTANCE_SCENE_RESULT, utime + RESULT_US, written,
        wire_write_scene_result(result, written));
}

/* ---- Answering ---- */

static void run_job(struct instance *instance, enum answer_kind kind, const unsigned char *bytes,
                    size_t size)
{
    answer_job_begin(instance->job, kind, bytes, size);
    while (!answer_job_step(instance->job, instance->answerer))
        continue;
}

void instance_query_pair(struct instance *instance, struct pair_query *query,
                         struct pair_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    const size_t size = wire_write_pair_query(query, bytes);
    put_query(instance, INSTANCE_PAIR_QUERY, bytes, size);
    run_job(instance, ANSWER_PAIR, bytes, size);
    *result = *answer_job_pair_result(instance->job);
    result->compute_ns = draw_int(&instance->draw, 300, 5000);
    put_pair_result(instance, query->utime, result);
}

void instance_query_scene(struct instance *instance, struct scene_query *query,
                          struct scene_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    const size_t size = wire_write_scene_query(query, bytes);
    put_query(instance, INSTANCE_SCENE_QUERY, bytes, size);
    run_job(instance, ANSWER_SCENE, bytes, size);
    *result = *answer_job_scene_result(instance->job);
    result->compute_ns = 4000 + 40 * result->verdict_count + draw_int(&instance->draw, 0, 3000);
    put_scene_result(instance, query->utime, query->first_pair, result);
}

void instance_beat(struct instance *instance)
{
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    struct wire_status *status = &instance->status;
    const struct cache_counts cache = cache_counts(answerer_cache(instance->answerer));
    status->utime = tape_utime(instance->tape);
    status->uptime_us = status->utime - TAPE_BEGIN_UTIME;
    status->bodies = cache.bodies;
    status->frames = cache.frames;
    status->frame_capacity = cache.frame_capacity;
    status->ids = cache.ids;
    status->hits = cache.hits;
    status->misses = cache.misses;
    status->evictions = cache.evictions;
    put(instance, INSTANCE_STATUS, status->utime, bytes, wire_write_status(status, bytes));
}
