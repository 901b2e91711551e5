#include "local_answerer.h"

#include "allocate.h"
#include "answer.h"
#include "clock.h"
#include "process.h"
#include "wire.h"

#include <stdio.h>
#include <stdlib.h>

/* Any constant. */
enum { SERVER_ID = 1 };

struct local_answerer {
    struct answerer *answerer;
    struct answer_job *job;
    struct definitions *definitions;
    const struct cached *pinned[QUERY_PLACEMENTS_MAX];
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
    local->job = answer_job_create();
    if (!local->answerer || !local->job)
        allocate_failed();
    return local;
}

void local_answerer_close(struct local_answerer *local)
{
    if (!local)
        return;
    answer_job_destroy(local->job);
    answerer_destroy(local->answerer);
    free(local);
}

/* ---- Definitions ---- */

/* Adds the bodies of the handles of a query to the cache, except those that a service refuses. All
 * stay pinned until the last is added, so that none evicts another. Returns false if a handle is
 * not defined. *held: whether the cache holds all that are defined. */
static bool supply(struct local_answerer *local, bool *held)
{
    struct cache *cache = answerer_cache(local->answerer);
    const struct cached **pinned = local->pinned;
    int32_t count;
    const struct query_placement *placement = answer_job_placements(local->job, &count);
    bool defined = true;
    *held = true;
    for (int32_t i = 0; i < count; i++) {
        const bool named = query_by_handle(&placement[i]);
        const struct body_view *found =
            named ? definitions_find(local->definitions, &placement[i].body.handle) : NULL;
        const bool taken = found && scene_takes(found);
        pinned[i] = taken ? cache_add(cache, 0, found, NULL) : NULL;
        *held = *held && (pinned[i] || !taken);
        defined = defined && (found || !named);
    }
    for (int32_t i = 0; i < count; i++)
        if (pinned[i])
            cache_release(cache, pinned[i]);
    return defined;
}

/* ---- Answers ---- */

/* Answers a query that is too long as a service does, but reads only its header. */
static const char *refuse(struct local_answerer *local, enum answer_kind kind,
                          const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    struct pair_result pair = {.server_id = SERVER_ID, .status = FMB_OVER_LIMIT};
    out->status = FMB_OVER_LIMIT;
    if (kind == ANSWER_SCENE)
        return answer_refused(local->answerer, kind, bytes, size, FMB_OVER_LIMIT, local->bytes,
                              &out->size);
    snprintf(pair.detail, sizeof pair.detail, "%s", fmb_status_text(pair.status));
    const char *error = wire_read_pair_header(bytes, size, &pair.header);
    out->size = error ? 0 : wire_write_pair_result(&pair, local->bytes);
    return error;
}

static const char *decide(struct local_answerer *local, enum log_kind kind,
                          const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    const enum answer_kind as = kind == LOG_PAIR_QUERY ? ANSWER_PAIR : ANSWER_SCENE;
    struct answer_job *job = local->job;
    if (size > QUERY_BYTES_MAX)
        return refuse(local, as, bytes, size, out);
    const int64_t begin = clock_ns();
    const char *error = answer_job_begin(job, as, bytes, size);
    while (!error && !answer_job_step(job, local->answerer))
        continue;
    if (error)
        return error;
    out->compute_ns = clock_ns() - begin;
    out->size = answer_job_write(job, out->compute_ns, local->bytes, &out->status);
    out->pairs = answer_job_decided(job);
    return NULL;
}

const char *local_answer(struct local_answerer *local, enum log_kind kind,
                         const unsigned char *bytes, uint32_t size, struct new_result *out)
{
    *out = (struct new_result){.bytes = local->bytes};
    const char *error = decide(local, kind, bytes, size, out);
    bool held;
    if (error || out->status != FMB_UNKNOWN_BODY || !supply(local, &held))
        return error;
    /* Bodies that fit into an empty cache may not fit between the bodies already held. */
    if (!held) {
        cache_clear(answerer_cache(local->answerer));
        supply(local, &held);
    }
    decide(local, kind, bytes, size, out);
    out->not_held = !held;
    return NULL;
}
