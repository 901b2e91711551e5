#include "local_answerer.h"

#include "allocate.h"
#include "answer.h"
#include "clock.h"
#include "process.h"
#include "replayed.h"
#include "wire.h"

#include <stdlib.h>

/* Any constant. */
enum { SERVER_ID = 1 };

struct local_answerer {
    struct answerer *answerer;
    struct scene_job *job;
    struct pair_job *pair_job;
    struct definitions *definitions;
    struct logged_query query;         /* a pair query, or one that is too long */
    const struct placement *placement; /* [placement_count] of the query answered last */
    int32_t placement_count;
    struct pair_result pair;
    struct scene_result refused;
    unsigned char bytes[QUERY_BYTES_MAX];
};

struct local_answerer *local_answerer_open(size_t frames, struct definitions *definitions)
{
    struct local_answerer *local = allocate(1, sizeof *local);
    const struct answerer_options options = {
        .frames = frames,
        .server_id = SERVER_ID,
        .secret = {(uint64_t) random_id(), (uint64_t) random_id()}};
    local->definitions = definitions;
    local->answerer = answerer_create(&options);
    local->job = scene_job_create();
    local->pair_job = pair_job_create();
    if (!local->answerer || !local->job || !local->pair_job)
        allocate_failed();
    return local;
}

void local_answerer_close(struct local_answerer *local)
{
    if (!local)
        return;
    scene_job_destroy(local->job);
    pair_job_destroy(local->pair_job);
    answerer_destroy(local->answerer);
    free(local);
}

/* ---- Definitions ---- */

/* Whether the cache holds the body, which then becomes the most recently used one. */
static bool is_held(struct cache *cache, const struct handle *handle)
{
    const struct cached *cached = cache_find(cache, handle);
    if (cached)
        cache_release(cache, cached);
    return cached != NULL;
}

/* Adds the bodies of the handles of a query to the cache, except those that a service refuses.
 * Bodies already held are touched first, so that the others do not evict them. Returns false if a
 * handle is not defined. */
static bool supply(struct local_answerer *local)
{
    struct cache *cache = answerer_cache(local->answerer);
    bool defined = true;
    for (int32_t i = 0; i < local->placement_count; i++)
        if (placement_by_handle(&local->placement[i]))
            is_held(cache, &local->placement[i].handle);
    for (int32_t i = 0; i < local->placement_count; i++) {
        struct handle handle = local->placement[i].handle;
        if (!placement_by_handle(&local->placement[i]) || is_held(cache, &handle))
            continue;
        const struct geometry *geometry = definitions_find(local->definitions, &handle);
        const struct cached *kept =
            geometry && scene_takes(geometry) ? cache_intern(cache, 0, geometry, &handle) : NULL;
        defined = defined && geometry;
        if (kept)
            cache_release(cache, kept);
    }
    return defined;
}

/* ---- Answers ---- */

/* Decides a pair; a job does so if the bodies have several frames. */
static const char *decide_pair(struct local_answerer *local, const unsigned char *bytes,
                               uint32_t size, struct new_result *out)
{
    struct pair_result *result = &local->pair;
    const char *error = logged_query_read(&local->query, LOG_PAIR_QUERY, bytes, size);
    if (error)
        return error;
    const int64_t begin = clock_ns();
    if (!answer_pair(local->answerer, &local->query.pair, result)) {
        pair_job_begin(local->pair_job, local->answerer, bytes, size);
        while (!pair_job_step(local->pair_job))
            continue;
        result = pair_job_end(local->pair_job, local->answerer);
    }
    result->compute_ns = out->compute_ns = clock_ns() - begin;
    out->status = result->status;
    out->pairs = out->status == FMB_OK;
    local->placement = local->query.pair.placement;
    local->placement_count = 2;
    out->size = wire_write_pair_result(result, local->bytes);
    return NULL;
}

static const char *decide_scene(struct local_answerer *local, const unsigned char *bytes,
                                uint32_t size, struct new_result *out)
{
    const int64_t begin = clock_ns();
    const char *error = scene_job_begin(local->job, bytes, size);
    while (!error && !scene_job_step(local->job, local->answerer))
        continue;
    if (error)
        return error;
    const struct scene_query *query = scene_job_query(local->job);
    struct scene_result *result = scene_job_result(local->job);
    result->compute_ns = out->compute_ns = clock_ns() - begin;
    out->status = result->status;
    out->pairs = replayed_decided(query, result);
    local->placement = query->placement;
    local->placement_count = query_stored_placements(query);
    out->size = wire_write_scene_result(result, local->bytes);
    return NULL;
}

static const char *decide(struct local_answerer *local, enum log_kind kind,
                          const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    return kind == LOG_PAIR_QUERY ? decide_pair(local, bytes, size, out)
                                  : decide_scene(local, bytes, size, out);
}

/* Answers a query that is too long as a service does, which reads only its header. */
static const char *refuse(struct local_answerer *local, enum log_kind kind,
                          const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    const char *error = logged_query_read(&local->query, kind, bytes, size);
    if (error)
        return error;
    out->status = FMB_OVER_LIMIT;
    if (kind == LOG_PAIR_QUERY) {
        answer_pair_refused(local->answerer, &local->query.pair, FMB_OVER_LIMIT, &local->pair);
        out->size = wire_write_pair_result(&local->pair, local->bytes);
    } else {
        answer_scene_refused(local->answerer, &local->query.scene.header, FMB_OVER_LIMIT,
                             &local->refused);
        out->size = wire_write_scene_result(&local->refused, local->bytes);
    }
    return NULL;
}

const char *local_answer(struct local_answerer *local, enum log_kind kind,
                         const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    *out = (struct new_result){.bytes = local->bytes};
    if (size > QUERY_BYTES_MAX)
        return refuse(local, kind, bytes, size, out);
    const char *error = decide(local, kind, bytes, size, out);
    if (!error && out->status == FMB_UNKNOWN_BODY && supply(local))
        decide(local, kind, bytes, size, out);
    return error;
}
