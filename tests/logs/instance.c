#include "instance.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const names[INSTANCE_CHANNELS] = {
    WIRE_PAIR_QUERY, WIRE_PAIR_RESULT, WIRE_SCENE_QUERY, WIRE_SCENE_RESULT, WIRE_STATUS};

/* From one query to the next, and from a query to its result. */
enum { QUERY_US = 60, RESULT_US = 45 };

bool instance_open(struct instance *instance, struct tape *tape,
                   const struct instance_options *options)
{
    *instance = (struct instance){.tape = tape, .result_after_us = RESULT_US};
    instance->answerer.server_id = instance->status.server_id = options->server_id;
    instance->draw.state = (uint64_t) options->server_id;
    snprintf(instance->status.version, sizeof instance->status.version, "0.1.0");
    for (int i = 0; i < INSTANCE_CHANNELS; i++)
        bus_channel(instance->channel[i], options->prefix, names[i]);
    instance->answerer.cache = cache_create(options->bodies, options->first_key);
    instance->heard = malloc(sizeof *instance->heard);
    if (instance->answerer.cache && instance->heard && answer_prepare(&instance->answerer))
        return true;
    instance_close(instance);
    return false;
}

void instance_close(struct instance *instance)
{
    answer_release(&instance->answerer);
    cache_destroy(instance->answerer.cache);
    free(instance->heard);
}

/* ---- What goes onto the tape ---- */

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
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    count(instance, result->status, result->status == FMB_OK);
    put(instance, INSTANCE_PAIR_RESULT, utime + instance->result_after_us, bytes,
        wire_write_pair_result(result, bytes));
}

static void put_scene_result(struct instance *instance, int64_t utime, int32_t first_pair,
                             struct scene_result *result)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    result->lost = senders_gaps(&instance->senders, result->client_id);
    instance->status.scenes++;
    count(instance, result->status, result->status == FMB_OK ? result->end_pair - first_pair : 0);
    put(instance, INSTANCE_SCENE_RESULT, utime + instance->result_after_us, bytes,
        wire_write_scene_result(result, bytes));
}

/* ---- Answering ---- */

/* As the service does: before it knows whether it can read the rest. */
static void note(struct instance *instance, int64_t client_id, int64_t sequence_number)
{
    if (query_id_ok(client_id) && query_id_ok(sequence_number))
        senders_note(&instance->senders, client_id, sequence_number);
}

bool instance_hear_pair(struct instance *instance, const unsigned char *bytes, size_t size,
                        struct pair_result *result)
{
    struct pair_query query;
    const int64_t utime = put_query(instance, INSTANCE_PAIR_QUERY, bytes, size);
    if (wire_read_pair_query(bytes, (uint32_t) size, &query)) {
        instance->status.malformed++;
        return false;
    }
    note(instance, query.client_id, query.sequence_number);
    if (size > QUERY_BYTES_MAX) {
        answer_pair_refused(&instance->answerer, &query, FMB_OVER_LIMIT, result);
    } else {
        answer_pair(&instance->answerer, &query, result);
        result->compute_ns = draw_int(&instance->draw, 300, 5000);
    }
    put_pair_result(instance, utime, result);
    return true;
}

bool instance_hear_scene(struct instance *instance, const unsigned char *bytes, size_t size,
                         struct scene_result *result)
{
    struct scene_query *query = instance->heard;
    const int64_t utime = put_query(instance, INSTANCE_SCENE_QUERY, bytes, size);
    if (wire_read_scene_query(bytes, (uint32_t) size, query)) {
        instance->status.malformed++;
        return false;
    }
    note(instance, query->client_id, query->sequence_number);
    if (size > QUERY_BYTES_MAX) {
        const struct query_header header = {query->utime, query->client_id, query->sequence_number};
        answer_scene_refused(&instance->answerer, &header, FMB_OVER_LIMIT, result);
    } else {
        answer_scene(&instance->answerer, query, result);
        result->compute_ns = 4000 + 40 * result->verdict_count + draw_int(&instance->draw, 0, 3000);
    }
    put_scene_result(instance, utime, query->first_pair, result);
    return true;
}

/* ---- Asking ---- */

void instance_ask_pair(struct instance *instance, struct pair_query *query,
                       struct pair_result *result)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    instance_hear_pair(instance, bytes, wire_write_pair_query(query, bytes), result);
}

void instance_ask_scene(struct instance *instance, struct scene_query *query,
                        struct scene_result *result)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    instance_hear_scene(instance, bytes, wire_write_scene_query(query, bytes), result);
}

void instance_turn_away_pair(struct instance *instance, struct pair_query *query)
{
    struct pair_result result;
    instance_miss_pair(instance, query);
    note(instance, query->client_id, query->sequence_number);
    answer_pair_refused(&instance->answerer, query, FMB_BUSY, &result);
    put_pair_result(instance, query->utime, &result);
}

void instance_turn_away_scene(struct instance *instance, struct scene_query *query)
{
    static struct scene_result result;
    unsigned char bytes[QUERY_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    put_query(instance, INSTANCE_SCENE_QUERY, bytes, wire_write_scene_query(query, bytes));
    note(instance, query->client_id, query->sequence_number);
    const struct query_header header = {query->utime, query->client_id, query->sequence_number};
    answer_scene_refused(&instance->answerer, &header, FMB_BUSY, &result);
    put_scene_result(instance, query->utime, 0, &result);
}

void instance_miss_pair(struct instance *instance, struct pair_query *query)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    query->utime = tape_utime(instance->tape);
    put_query(instance, INSTANCE_PAIR_QUERY, bytes, wire_write_pair_query(query, bytes));
}

void instance_beat(struct instance *instance)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    struct wire_status *status = &instance->status;
    const struct cache_counts cache = cache_counts(instance->answerer.cache);
    status->utime = tape_utime(instance->tape);
    status->uptime_us = status->utime - TAPE_BEGIN_UTIME;
    status->sequence_gaps = instance->senders.gaps;
    status->repeated = instance->senders.repeated;
    status->bodies = cache.bodies;
    status->capacity = cache.capacity;
    status->hits = cache.hits;
    status->misses = cache.misses;
    status->replacements = cache.replacements;
    status->evictions = cache.evictions;
    put(instance, INSTANCE_STATUS, status->utime, bytes, wire_write_status(status, bytes));
}
