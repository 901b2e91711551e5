#include "teller.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int64_t begin_utime = INT64_C(1714557600000000); /* 2024-05-01, 10:00 */

void teller_begin(struct teller *teller, const char *title)
{
    memset(teller, 0, sizeof *teller);
    teller->page = page_open(title, begin_utime);
    teller->answerer.cache = cache_create(4096, 1);
    if (!teller->page || !teller->answerer.cache || !answer_prepare(&teller->answerer))
        abort();
    teller->log = "drive.log";
    teller->utime = begin_utime;
    teller->event_number = 1;
    teller->offset = 28;
}

bool teller_end(struct teller *teller, FILE *out)
{
    page_write(teller->page, out);
    page_close(teller->page);
    answer_release(&teller->answerer);
    cache_destroy((struct cache *) teller->answerer.cache);
    return fflush(out) == 0 && !ferror(out);
}

/* ---- Queries --------------------------------------------------------------------------------- */

static void take(struct teller *teller, struct replayed *replayed, bool spoilt)
{
    replayed->log = teller->log;
    replayed->event_number = teller->event_number;
    replayed->offset = teller->offset;
    replayed->utime = teller->utime;
    replayed->outcome = spoilt ? REPLAY_DIFFERENT : teller->outcome;
    page_take(teller->page, replayed);
    teller->event_number += 2; /* the result is an event too */
    teller->offset += 512;
    teller->outcome = REPLAY_SAME;
    teller->spoil_pair = NULL;
    teller->spoil_scene = NULL;
}

void teller_pair(struct teller *teller, const struct pair_query *query)
{
    struct pair_result now, then;
    memset(&now, 0, sizeof now);
    answer_pair(&teller->answerer, query, &now);
    now.compute_ns = 840;
    then = now;
    if (teller->spoil_pair)
        teller->spoil_pair(&then);
    if (teller->outcome == REPLAY_BUSY)
        answer_pair_refused(&teller->answerer, query, FMB_BUSY, &then);
    struct replayed replayed = {.pair = query,
                                .pair_now = teller->outcome == REPLAY_UNKNOWN ? NULL : &now,
                                .pair_then = teller->outcome == REPLAY_ALONE ? NULL : &then};
    take(teller, &replayed, teller->spoil_pair != NULL);
}

void teller_scene(struct teller *teller, const struct scene_query *query)
{
    static struct scene_result now, then;
    memset(&now, 0, sizeof now);
    answer_scene(&teller->answerer, query, &now);
    now.compute_ns = 52300;
    then = now;
    if (teller->spoil_scene)
        teller->spoil_scene(&then);
    struct replayed replayed = {.scene = query,
                                .scene_now = teller->outcome == REPLAY_UNKNOWN ? NULL : &now,
                                .scene_then = teller->outcome == REPLAY_ALONE ? NULL : &then};
    take(teller, &replayed, teller->spoil_scene != NULL);
}

void teller_wait(struct teller *teller, double seconds)
{
    teller->utime += llround(seconds * 1e6);
}

/* ---- Frames ---------------------------------------------------------------------------------- */

struct query_frame teller_frame(int64_t id, int dim, enum fmb_shape shape, const double *components,
                                const double *origin)
{
    struct query_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.body_id = id;
    frame.shape = (int32_t) shape;
    frame.dim = dim;
    frame.origin.count = dim;
    memcpy(frame.origin.number, origin, (size_t) dim * sizeof *origin);
    frame.components.count = dim * fmb_component_count(dim, (int) shape);
    memcpy(frame.components.number, components,
           (size_t) frame.components.count * sizeof *components);
    return frame;
}

struct query_frame teller_solid(int64_t id, int dim, enum fmb_shape shape, double size,
                                const double *origin)
{
    double components[FMB_COMPONENTS_MAX] = {0};
    for (int i = 0; i < dim; i++)
        components[i * dim + i] = size;
    return teller_frame(id, dim, shape, components, origin);
}

void teller_move(struct query_frame *frame, const double *velocity)
{
    frame->velocity.count = frame->dim;
    memcpy(frame->velocity.number, velocity, (size_t) frame->dim * sizeof *velocity);
}
