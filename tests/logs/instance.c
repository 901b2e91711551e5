#include "instance.h"

#include "answer_now.h"
#include <stdio.h>
#include <string.h>

static const char *const names[INSTANCE_CHANNELS] = {
    WIRE_PAIR_QUERY,       WIRE_PAIR_RESULT, WIRE_SCENE_QUERY, WIRE_SCENE_RESULT,
    WIRE_DEFINITION_QUERY, WIRE_DEFINITION,  WIRE_STATUS};

/* From one query to the next, and from a query to its result. */
enum { QUERY_US = 60, RESULT_US = 45 };

bool instance_open(struct instance *instance, struct tape *tape,
                   const struct instance_options *options)
{
    const struct answerer_options answerer = {
        .frames = options->frames, .server_id = options->server_id, .secret = {1, 2}};
    *instance = (struct instance){.tape = tape, .result_after_us = RESULT_US};
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

/* Returns when it came. */
static int64_t put_query(struct instance *instance, enum instance_channel channel,
                         const unsigned char *bytes, size_t size)
{
    const int64_t utime = tape_utime(instance->tape);
    put(instance, channel, utime, bytes, size);
    tape_pass(instance->tape, QUERY_US);
    return utime;
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
    put(instance, INSTANCE_PAIR_RESULT, utime + instance->result_after_us, written,
        wire_write_pair_result(result, written));
}

static void put_scene_result(struct instance *instance, int64_t utime, int32_t first_pair,
                             const struct scene_result *result)
{
    instance->status.scenes++;
    count(instance, result->status, result->status == FMB_OK ? result->end_pair - first_pair : 0);
    put(instance, INSTANCE_SCENE_RESULT, utime + instance->result_after_us, written,
        wire_write_scene_result(result, written));
}

/* ---- Answering ---- */

static bool answer_pair_at(struct instance *instance, int64_t utime, const unsigned char *bytes,
                           size_t size, struct pair_result *result)
{
    struct pair_query query;
    if (wire_read_pair_query(bytes, (uint32_t) size, &query)) {
        instance->status.malformed++;
        return false;
    }
    if (size > QUERY_BYTES_MAX) {
        size_t out = 0;
        answer_refused(instance->answerer, ANSWER_PAIR, bytes, size, FMB_OVER_LIMIT, written, &out);
        wire_read_pair_result(written, (uint32_t) out, result);
    } else {
        answer_job_begin(instance->job, ANSWER_PAIR, bytes, size);
        while (!answer_job_step(instance->job, instance->answerer))
            continue;
        *result = *answer_job_pair_result(instance->job);
        result->compute_ns = draw_int(&instance->draw, 300, 5000);
    }
    put_pair_result(instance, utime, result);
    return true;
}

bool instance_hear_pair(struct instance *instance, const unsigned char *bytes, size_t size,
                        struct pair_result *result)
{
    const int64_t utime = put_query(instance, INSTANCE_PAIR_QUERY, bytes, size);
    const bool answered = answer_pair_at(instance, utime, bytes, size, result);
    struct pair_result second;
    if (instance->other)
        answer_pair_at(instance->other, utime, bytes, size, &second);
    return answered;
}

static const struct scene_result *run_job(struct instance *instance)
{
    struct answer_job *job = instance->job;
    int steps = 0;
    while (!answer_job_step(job, instance->answerer))
        if (instance->stop_after > 0 && answer_job_has_answers(job) &&
            ++steps == instance->stop_after) {
            answer_job_stop(job);
            break;
        }
    return answer_job_scene_result(job);
}

static void refuse_scene(struct instance *instance, const unsigned char *bytes, size_t size,
                         enum fmb_status status, struct scene_result *result)
{
    struct query_header header;
    wire_read_scene_header(bytes, (uint32_t) size, &header);
    answer_scene_refused(instance->answerer, &header, status, result);
}

bool instance_hear_scene(struct instance *instance, const unsigned char *bytes, size_t size,
                         struct scene_result *result)
{
    static struct scene_query query;
    const int64_t utime = put_query(instance, INSTANCE_SCENE_QUERY, bytes, size);
    if (wire_read_scene_query(bytes, (uint32_t) size, &query)) {
        instance->status.malformed++;
        return false;
    }
    if (size > QUERY_BYTES_MAX) {
        refuse_scene(instance, bytes, size, FMB_OVER_LIMIT, result);
    } else {
        answer_job_begin(instance->job, ANSWER_SCENE, bytes, size);
        *result = *run_job(instance);
        result->compute_ns = 4000 + 40 * result->verdict_count + draw_int(&instance->draw, 0, 3000);
    }
    put_scene_result(instance, utime, query.first_pair, result);
    return true;
}

bool instance_hear_definition(struct instance *instance, const unsigned char *bytes, size_t size,
                              struct definition *result)
{
    static struct definition_query query;
    const int64_t utime = put_query(instance, INSTANCE_DEFINITION_QUERY, bytes, size);
    if (wire_read_definition_query(bytes, (uint32_t) size, &query)) {
        instance->status.malformed++;
        return false;
    }
    answer_definition(instance->answerer, &query, result);
    instance->status.definitions++;
    count(instance, result->status, 0);
    put(instance, INSTANCE_DEFINITION, utime + instance->result_after_us, written,
        wire_write_definition(result, written));
    return true;
}

/* ---- Sending ---- */

void instance_query_pair(struct instance *instance, struct pair_query *query,
                         struct pair_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    instance_hear_pair(instance, bytes, wire_write_pair_query(query, bytes), result);
}

void instance_query_scene(struct instance *instance, struct scene_query *query,
                          struct scene_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    instance_hear_scene(instance, bytes, wire_write_scene_query(query, bytes), result);
}

void instance_define(struct instance *instance, int64_t client_id, int64_t sequence_number,
                     const struct handle *handle, int32_t handles)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct definition_query query;
    static struct definition result;
    query = (struct definition_query){
        .client_id = client_id, .sequence_number = sequence_number, .handle_count = handles};
    if (handles > 0)
        memcpy(query.handle, handle, (size_t) handles * sizeof *handle);
    do {
        query.utime = tape_utime(instance->tape);
        instance_hear_definition(instance, bytes, wire_write_definition_query(&query, bytes),
                                 &result);
        query.first = result.next;
        query.sequence_number++;
    } while (result.status == FMB_OK && result.next != 0);
}

void instance_turn_away_pair(struct instance *instance, struct pair_query *query)
{
    struct pair_result result;
    instance_miss_pair(instance, query);
    answer_pair_refused(instance->answerer, query, FMB_BUSY, &result);
    put_pair_result(instance, query->utime, &result);
}

void instance_turn_away_scene(struct instance *instance, struct scene_query *query)
{
    static struct scene_result result;
    query->utime = tape_utime(instance->tape);
    const size_t size = wire_write_scene_query(query, written);
    put_query(instance, INSTANCE_SCENE_QUERY, written, size);
    refuse_scene(instance, written, size, FMB_BUSY, &result);
    put_scene_result(instance, query->utime, 0, &result);
}

void instance_miss_pair(struct instance *instance, struct pair_query *query)
{
    query->utime = tape_utime(instance->tape);
    put_query(instance, INSTANCE_PAIR_QUERY, written, wire_write_pair_query(query, written));
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
