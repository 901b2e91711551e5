#include "answer_now.h"

#include "allocate.h"
#include "answer.h"
#include "big_endian.h"
#include "clock.h"
#include "random_id.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* Any will do, as long as it is always the same. */
enum { SERVER_ID = 1 };

struct answer_now {
    struct answerer *answerer;
    struct scene_job *job;
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
    if (!now->answerer || !now->job)
        allocate_failed();
    return now;
}

void answer_now_close(struct answer_now *now)
{
    if (!now)
        return;
    scene_job_destroy(now->job);
    answerer_destroy(now->answerer);
    free(now);
}

/* ---- Definitions ---- */

const struct handle *answer_now_undefined(struct definitions *definitions,
                                          const struct placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]) &&
            !definitions_find(definitions, &placement[i].handle))
            return &placement[i].handle;
    return NULL;
}

/* Whether a service keeps the body: not one that it refuses. */
static bool can_be_kept(const struct geometry *geometry)
{
    struct geometry_frame frame;
    struct fmb_body body;
    int dim;
    if (big_endian_32(geometry->bytes + 4) != 1 || !geometry_read(geometry, &dim, &frame))
        return false;
    for (int axis = 0; axis < dim; axis++)
        if (frame.origin[axis] != 0)
            return false;
    return fmb_body_make(dim, frame.shape, frame.components, (size_t) (frame.count * dim), &body) ==
           FMB_OK;
}

/* Puts what the handles stand for into the cache. Those that it holds are looked up first: they are
 * not evicted for the others then. */
static void supply(struct answer_now *now, const struct placement *placement, int32_t count)
{
    struct cache *cache = answerer_cache(now->answerer);
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]))
            cache_find(cache, &placement[i].handle);
    for (int32_t i = 0; i < count; i++) {
        if (!placement_by_handle(&placement[i]) || cache_find(cache, &placement[i].handle))
            continue;
        const struct geometry *geometry = definitions_find(now->definitions, &placement[i].handle);
        if (geometry && can_be_kept(geometry))
            cache_keep(cache, 0, geometry);
    }
}

/* After UNKNOWN_BODY: whether to answer once more. */
static bool helps(struct answer_now *now, struct answered *out)
{
    const struct handle *undefined =
        answer_now_undefined(now->definitions, out->placement, out->placement_count);
    if (undefined)
        out->undefined = *undefined;
    else
        supply(now, out->placement, out->placement_count);
    return !undefined;
}

/* ---- Pairs ---- */

static void decide_pair(struct answer_now *now, struct answered *out)
{
    const int64_t begin = clock_ns();
    answer_pair(now->answerer, &now->query.pair, &now->pair);
    now->pair.compute_ns = out->compute_ns = clock_ns() - begin;
    out->status = now->pair.status;
    out->pairs = out->status == FMB_OK;
}

static const char *answer_one_pair(struct answer_now *now, const unsigned char *bytes,
                                   uint32_t size, struct answered *out)
{
    const char *error = any_query_read(&now->query, LOG_PAIR_QUERY, bytes, size);
    if (error)
        return error;
    out->placement = now->query.pair.placement;
    out->placement_count = 2;
    decide_pair(now, out);
    if (out->status == FMB_UNKNOWN_BODY && helps(now, out))
        decide_pair(now, out);
    out->size = wire_write_pair_result(&now->pair, now->bytes);
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
    const struct scene_query *query = &now->query.scene;
    const struct query_header header = {query->utime, query->client_id, query->sequence_number};
    answer_scene_refused(now->answerer, &header, FMB_OVER_LIMIT, &now->refused);
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
