#include "fmb.h"

#include "certified.h"
#include "exact.h"
#include "gap.h"
#include "hull.h"
#include "inexact.h"
#include "aabb.h"

#include <string.h>

static enum fmb_status decide_exactly(const struct frame_pair *pair, unsigned want,
                                      struct fmb_answer *answer)
{
    if (hull_takes(pair->a.frame, pair->b.frame))
        return hull_decide(pair, want | FMB_WANT_TIMES, HULL_EXACT, answer);
    const enum fmb_status status = exact_decide(pair, want, answer);
    answer->has_gap = want & FMB_WANT_GAP;
    if (answer->has_gap)
        gap_exact_any_order(pair, answer->verdict, &answer->gap);
    return status;
}

static const struct fmb_method methods[] = {
    {"certified", 4, "never wrong: doubles with bounds, exact arithmetic where these are unsure",
     true, true, certified_decide},
    {"exact", 1, "right for every input, flat frames included (GMP)", true, true, decide_exactly},
    {"fmb", 2, "the article's elimination in doubles, with its loose box; inexact", false, true,
     eliminate_decide},
    {"sat", 3, "separating axes in doubles, no box; inexact", false, false, sat_decide},
};

enum { METHOD_COUNT = sizeof methods / sizeof *methods };

const struct fmb_method *fmb_method_default(void)
{
    return &methods[0];
}

const struct fmb_method *fmb_method_at(size_t index)
{
    return index < METHOD_COUNT ? &methods[index] : NULL;
}

const struct fmb_method *fmb_method_by_name(const char *name)
{
    for (size_t i = 0; i < METHOD_COUNT; i++)
        if (strcmp(methods[i].name, name) == 0)
            return &methods[i];
    return NULL;
}

const struct fmb_method *fmb_method_by_number(int number)
{
    if (number == 0)
        return fmb_method_default();
    for (size_t i = 0; i < METHOD_COUNT; i++)
        if (methods[i].number == number)
            return &methods[i];
    return NULL;
}

/* ---- Bodies of several frames ---- */

static void include(struct fmb_answer *all, const struct fmb_answer *one, int dim)
{
    if (one->verdict == FMB_SEPARATED)
        return;
    const bool first = all->verdict == FMB_SEPARATED;
    for (int end = 0; end < 2; end++) {
        const double sign = end ? 1 : -1;
        if (first || sign * one->contact[end] > sign * all->contact[end])
            all->contact[end] = one->contact[end];
        for (int axis = 0; axis < dim; axis++)
            if (first || sign * one->box[end][axis] > sign * all->box[end][axis])
                all->box[end][axis] = one->box[end][axis];
    }
    all->verdict = one->verdict > all->verdict ? one->verdict : all->verdict;
    all->has_contact = one->has_contact;
    all->has_box = one->has_box;
}

/* Frames of a body that are placed together. */
enum { CHUNK = 16 };

struct frame_chunk {
    const struct fmb_placement *placement;
    unsigned first, count;
    struct aabb box[CHUNK], all; /* over the window */
};

static void set_chunk(const struct fmb_placement *placement, unsigned first, double duration,
                      struct frame_chunk *out)
{
    const unsigned left = placement->body->frame_count - first;
    struct fmb_prepared prepared[CHUNK];
    out->placement = placement;
    out->first = first;
    out->count = left < CHUNK ? left : CHUNK;
    prepared_place(placement, first, out->count, prepared);
    for (unsigned i = 0; i < out->count; i++) {
        out->box[i] = aabb_of(&prepared[i], duration);
        out->all = i == 0 ? out->box[0] : aabb_union(out->all, out->box[i]);
    }
}

static struct placed_frame frame_at(const struct frame_chunk *chunk, unsigned i)
{
    return (struct placed_frame){fmb_body_frame(chunk->placement->body, chunk->first + i),
                                 chunk->placement};
}

/* Pairs of frames of two bodies. */
struct frames {
    const struct fmb_method *method;
    const struct fmb_placement *a, *b;
    double duration;
    unsigned want;
    bool swaps;            /* gap_swaps() */
    struct fmb_answer all; /* of those so far */
};

/* Frames whose boxes are farther apart than that neither meet nor have the least gap. */
static double reach_of(const struct frames *frames, const struct frame_chunk *a,
                       const struct frame_chunk *b)
{
    if (!(frames->want & FMB_WANT_GAP))
        return 0;
    return gap_reach(frames->all.gap.bounds[1], &a->all, &b->all);
}

/* Includes the pairs of frames of two chunks whose boxes are near enough. */
static enum fmb_status decide_chunks(struct frames *frames, const struct frame_chunk *a,
                                     const struct frame_chunk *b)
{
    for (unsigned i = 0; i < a->count; i++) {
        const double reach = reach_of(frames, a, b);
        const struct aabb against = aabb_probe_within(&a->box[i], reach);
        const struct aabb against_all = aabb_probe_within(&b->all, reach);
        for (unsigned j = 0; aabb_overlaps(&a->box[i], &against_all) && j < b->count; j++) {
            const struct frame_pair pair = {frame_at(a, i), frame_at(b, j), frames->duration};
            struct fmb_answer one = {0};
            if (!aabb_overlaps(&b->box[j], &against))
                continue;
            const enum fmb_status status = frames->method->decide(&pair, frames->want, &one);
            if (status != FMB_OK)
                return status;
            include(&frames->all, &one, pair.a.frame->dim);
            one.gap.frame[0] = a->first + i;
            one.gap.frame[1] = b->first + j;
            if (one.has_gap)
                gap_include(&frames->all.gap, &one.gap, &a->box[i], &b->box[j], frames->swaps);
        }
    }
    return FMB_OK;
}

static enum fmb_status decide_frames(struct frames *frames)
{
    enum fmb_status status = FMB_OK;
    const unsigned count_a = frames->a->body->frame_count, count_b = frames->b->body->frame_count;
    frames->all.verdict = FMB_SEPARATED;
    if (frames->want & FMB_WANT_GAP) {
        frames->all.has_gap = true;
        frames->all.gap = gap_none();
        frames->swaps = gap_swaps(frames->a, frames->b);
    }
    for (unsigned i = 0; i < count_a; i += CHUNK) {
        struct frame_chunk of_a, of_b;
        set_chunk(frames->a, i, frames->duration, &of_a);
        for (unsigned j = 0; j < count_b && status == FMB_OK; j += CHUNK) {
            set_chunk(frames->b, j, frames->duration, &of_b);
            status = decide_chunks(frames, &of_a, &of_b);
        }
    }
    gap_end(frames->all.verdict, &frames->all.gap);
    return status;
}

enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_placement *a,
                           const struct fmb_placement *b, double duration, unsigned want,
                           struct fmb_answer *answer)
{
    static const struct fmb_answer none;
    *answer = none;
    enum fmb_status status = placements_check(a, b, duration);
    if (status != FMB_OK)
        return status;
    if (want & ~(unsigned) (FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP))
        return FMB_UNKNOWN_WANT;
    if (want & FMB_WANT_GAP && !method->certain)
        return FMB_CANNOT_DECIDE;
    if (a->body->frame_count == 1 && b->body->frame_count == 1) {
        const struct frame_pair pair = {
            {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
        status = method->decide(&pair, want, answer);
    } else {
        struct frames frames = {method, a, b, duration, want, false, {0}};
        status = decide_frames(&frames);
        *answer = frames.all;
    }
    if (status != FMB_OK) /* a method may have gone some way before it knew */
        *answer = none;
    return status;
}
