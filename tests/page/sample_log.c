#include "sample_log.h"

#include "answer_now.h"
#include "geometry_write.h"
#include "wire.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int64_t begin_utime = INT64_C(1714557600000000); /* 2024-05-01, 10:00 */

void sample_begin(struct sample_log *log, const char *title)
{
    const struct answerer_options options = {.frames = 4096, .server_id = 1};
    *log = (struct sample_log){.page = page_open(title, begin_utime),
                               .answerer = answerer_create(&options),
                               .job = answer_job_create(),
                               .log = "drive.log",
                               .utime = begin_utime,
                               .event_number = 1,
                               .offset = 28};
    if (!log->answerer || !log->job)
        abort();
}

bool sample_end(struct sample_log *log, FILE *out)
{
    page_write(log->page, out);
    page_close(log->page);
    answer_job_destroy(log->job);
    answerer_destroy(log->answerer);
    return fflush(out) == 0 && !ferror(out);
}

/* ---- Queries --------------------------------------------------------------------------------- */

static struct query_placement as_sent(const struct query_placement *placement)
{
    struct query_placement out = *placement;
    if (!handle_is_none(&out.body.handle))
        out.body = geometry_named(out.body.dim, &out.body.handle);
    return out;
}

static void take(struct sample_log *log, struct replayed *replayed, bool altered)
{
    replayed->log = log->log;
    replayed->event_number = log->event_number;
    replayed->offset = log->offset;
    replayed->utime = log->utime;
    replayed->outcome = altered ? REPLAY_DIFFERENT : log->outcome;
    page_take(log->page, replayed);
    log->event_number += 2; /* the result is an event too */
    log->offset += 512;
    log->outcome = REPLAY_SAME;
    log->alter_pair = NULL;
    log->alter_scene = NULL;
}

void sample_pair(struct sample_log *log, const struct pair_query *query)
{
    struct pair_query sent = *query;
    struct pair_result now, then;
    for (int i = 0; i < 2; i++)
        sent.placement[i] = as_sent(&query->placement[i]);
    answer_pair(log->answerer, &sent, &now);
    now.compute_ns = 840;
    then = now;
    if (log->alter_pair)
        log->alter_pair(&then);
    if (log->outcome == REPLAY_BUSY)
        answer_pair_refused(log->answerer, query, FMB_BUSY, &then);
    if (log->outcome == REPLAY_UNKNOWN)
        answer_pair_refused(log->answerer, query, FMB_UNKNOWN_BODY, &then);
    struct replayed replayed = {.pair = query,
                                .pair_now = &now,
                                .pair_then = log->outcome == REPLAY_UNRECORDED ? NULL : &then};
    take(log, &replayed, log->alter_pair != NULL);
}

void sample_scene(struct sample_log *log, const struct scene_query *query)
{
    static struct scene_query sent;
    static struct scene_result then;
    static unsigned char bytes[QUERY_BYTES_MAX];
    sent = *query;
    for (int32_t i = 0; i < query->placement_count; i++)
        sent.placement[i] = as_sent(&query->placement[i]);
    if (answer_job_begin(log->job, ANSWER_SCENE, bytes, wire_write_scene_query(&sent, bytes)))
        abort();
    while (!answer_job_step(log->job, log->answerer))
        continue;
    static struct scene_result now;
    now = *answer_job_scene_result(log->job);
    now.compute_ns = 52300;
    then = now;
    if (log->alter_scene)
        log->alter_scene(&then);
    struct replayed replayed = {.scene = query, .scene_now = &now, .scene_then = &then};
    take(log, &replayed, log->alter_scene != NULL);
}

void sample_wait(struct sample_log *log, double seconds)
{
    log->utime += llround(seconds * 1e6);
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

struct query_placement sample_body(int64_t id, int dim, enum fmb_shape shape,
                                   const double *components, const double *position)
{
    static unsigned char geometry[SAMPLE_BODIES_MAX][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    const int count = dim * fmb_component_count(dim, (int) shape);
    unsigned char *bytes = geometry[next++ % SAMPLE_BODIES_MAX];
    struct plain_frame frame = {.shape = (int) shape};
    memcpy(frame.components, components, (size_t) count * sizeof *components);
    struct query_placement out = {.placed.id = id, .body = geometry_write(dim, &frame, bytes)};
    memcpy(out.placed.position, position, (size_t) dim * sizeof *position);
    return out;
}

struct query_placement sample_solid(int64_t id, int dim, enum fmb_shape shape, double size,
                                    const double *position)
{
    double components[FMB_COMPONENTS_MAX] = {0};
    for (int i = 0; i < dim; i++)
        components[i * dim + i] = size;
    return sample_body(id, dim, shape, components, position);
}

void sample_move(struct query_placement *placement, const double *velocity)
{
    placement->velocity_count = placement->body.dim;
    memcpy(placement->placed.velocity, velocity, (size_t) placement->body.dim * sizeof *velocity);
}

void sample_define(struct sample_log *log, struct query_placement *placement)
{
    struct cache *cache = answerer_cache(log->answerer);
    cache_release(cache, cache_intern(cache, placement->placed.id, &placement->body));
}
