#include "answer_now.h"

#include "allocate.h"
#include "answer.h"
#include "clock.h"
#include "random_id.h"
#include "scene_of_query.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* Any will do, as long as it is always the same. */
enum { SERVER_ID = 1 };

struct answer_now {
    struct answerer *answerer;
    struct scene_job *job;
    struct pair_job *pair_job;
    struct definitions *definitions;
    struct any_query query; /* a pair, or one that is too long */
    struct pair_result pair;
    struct scene_result refused;
    unsigned char bytes[QUERY_BYTES_MAX];
};

struct answer_now *answer_now_open(size_t frames, struct definitions *definitions)
{
    struct answer_now *now = allocate(1, sizeof *now);
    const struct answerer_options options = {
        .frames = frames,
        .server_id = SERVER_ID,
        .secret = {(uint64_t) random_id(), (uint64_t) random_id()}};
    now->definitions = definitions;
    now->answerer = answerer_create(&options);
    now->job = scene_job_create();
    now->pair_job = pair_job_create();
    if (!now->answerer || !now->job || !now->pair_job)
        allocate_failed();
    return now;
}

void answer_now_close(struct answer_now *now)
{
    if (!now)
        return;
    scene_job_destroy(now->job);
    pair_job_destroy(now->pair_job);
    answerer_destroy(now->answerer);
    free(now);
}

/* ---- Definitions ---- */

/* Whether the cache holds the body, which is then its most recently used one. */
static bool is_held(struct cache *cache, const struct handle *handle)
{
    const struct cached *cached = cache_find(cache, handle);
    if (cached)
        cache_release(cache, cached);
    return cached != NULL;
}

/* Puts what the handles stand for into the cache, except bodies that a service refuses. Those that
 * it holds are looked up first: they are not evicted for the others then. */
static void supply(struct answer_now *now, const struct placement *placement, int32_t count)
{
    struct cache *cache = answerer_cache(now->answerer);
    struct handle handle;
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]))
            is_held(cache, &placement[i].handle);
    for (int32_t i = 0; i < count; i++) {
        if (!placement_by_handle(&placement[i]) || is_held(cache, &placement[i].handle))
            continue;
        const struct geometry *geometry = definitions_find(now->definitions, &placement[i].handle);
        const struct cached *kept =
            geometry && scene_takes(geometry) ? cache_keep(cache, 0, geometry, &handle) : NULL;
        if (kept)
            cache_release(cache, kept);
    }
}

/* After UNKNOWN_BODY: whether to answer once more. */
static bool helps(struct answer_now *now, struct answered *out)
{
    const int32_t missing =
        definitions_missing(now->definitions, out->placement, out->placement_count);
    if (missing >= 0)
        out->undefined = out->placement[missing].handle;
    else
        supply(now, out->placement, out->placement_count);
    return missing < 0;
}

/* ---- Pairs ---- */

/* A pair of bodies of several frames is decided by a job. */
static const struct pair_result *decide_pair(struct answer_now *now, const unsigned char *bytes,
                                             uint32_t size, struct answered *out)
{
    const int64_t begin = clock_ns();
    struct pair_result *result = &now->pair;
    if (!answer_pair(now->answerer, &now->query.pair, result)) {
        pair_job_begin(now->pair_job, now->answerer, bytes, size);
        while (!pair_job_step(now->pair_job))
            continue;
        result = pair_job_end(now->pair_job, now->answerer);
    }
    result->compute_ns = out->compute_ns = clock_ns() - begin;
    out->status = result->status;
    out->pairs = out->status == FMB_OK;
    return result;
}

static const char *answer_one_pair(struct answer_now *now, const unsigned char *bytes,
                                   uint32_t size, struct answered *out)
{
    const char *error = any_query_read(&now->query, LOG_PAIR_QUERY, bytes, size);
    if (error)
        return error;
    out->placement = now->query.pair.placement;
    out->placement_count = 2;
    const struct pair_result *result = decide_pair(now, bytes, size, out);
    if (out->status == FMB_UNKNOWN_BODY && helps(now, out))
        result = decide_pair(now, bytes, size, out);
    out->size = wire_write_pair_result(result, now->bytes);
    return NULL;
}

/* ---- Scenes ---- */

static const char *decide_scene(struct answer_now *now, const unsigned char *bytes, uint32_t size,
                                struct answered *out)
{
    const int64_t begin = clock_ns();
    const char *error = scene_job_begin(now->job, bytes, size);
    while (!error && !scene_job_step(now->job, now->answerer))
        continue;
    if (error)
        return error;
    const struct scene_query *query = scene_job_query(now->job);
    struct scene_result *result = scene_job_result(now->job);
    result->compute_ns = out->compute_ns = clock_ns() - begin;
    out->status = result->status;
    out->pairs = out->status == FMB_OK ? result->end_pair - query->first_pair : 0;
    out->placement = query->placement;
    out->placement_count = query->placement_count < QUERY_PLACEMENTS_MAX ? query->placement_count
                                                                         : QUERY_PLACEMENTS_MAX;
    return NULL;
}

static const char *answer_one_scene(struct answer_now *now, const unsigned char *bytes,
                                    uint32_t size, struct answered *out)
{
    const char *error = decide_scene(now, bytes, size, out);
    if (error)
        return error;
    if (out->status == FMB_UNKNOWN_BODY && helps(now, out))
        decide_scene(now, bytes, size, out);
    out->size = wire_write_scene_result(scene_job_result(now->job), now->bytes);
    return NULL;
}

/* ---- Either ---- */

/* Of a query that is too long a service reads the header. */
static const char *refuse(struct answer_now *now, enum log_kind kind, const unsigned char *bytes,
                          uint32_t size, struct answered *out)
{
    const char *error = any_query_read(&now->query, kind, bytes, size);
    if (error)
        return error;
    out->status = FMB_OVER_LIMIT;
    if (kind == LOG_PAIR_QUERY) {
        answer_pair_refused(now->answerer, &now->query.pair, FMB_OVER_LIMIT, &now->pair);
        out->size = wire_write_pair_result(&now->pair, now->bytes);
        return NULL;
    }
    answer_scene_refused(now->answerer, &now->query.scene.header, FMB_OVER_LIMIT, &now->refused);
    out->size = wire_write_scene_result(&now->refused, now->bytes);
    return NULL;
}

const char *answer_now(struct answer_now *now, enum log_kind kind, const unsigned char *bytes,
                       uint32_t size, struct answered *out)
{
    struct cache *cache = answerer_cache(now->answerer);
    const int64_t misses = cache_counts(cache).misses;
    *out = (struct answered){.bytes = now->bytes};
    if (size > QUERY_BYTES_MAX)
        return refuse(now, kind, bytes, size, out);
    const char *error = kind == LOG_PAIR_QUERY ? answer_one_pair(now, bytes, size, out)
                                               : answer_one_scene(now, bytes, size, out);
    out->all_held = out->status == FMB_OK && cache_counts(cache).misses == misses;
    return error;
}
