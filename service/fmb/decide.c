#include "fmb.h"

#include "certified.h"
#include "exact.h"
#include "inexact.h"
#include "swept.h"

#include <string.h>

static const struct fmb_method methods[] = {
    {"certified", 4, "never wrong: doubles with bounds, exact arithmetic where these are unsure",
     true, true, certified_decide},
    {"exact", 1, "right for every input, flat frames included (GMP)", true, true, exact_decide},
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

/* The box of a frame over the window. */
static struct swept box_at(const struct fmb_placement *placement, unsigned i, double duration)
{
    const struct placed_frame placed = {fmb_body_frame(placement->body, i), placement};
    struct fmb_prepared prepared;
    prepared_set(&placed, &prepared);
    return swept_of(&prepared, duration);
}

static struct swept box_of_all(const struct fmb_placement *placement, double duration)
{
    struct swept box = box_at(placement, 0, duration);
    for (unsigned i = 1; i < placement->body->frame_count; i++)
        box = swept_hull(box, box_at(placement, i, duration));
    return box;
}

static enum fmb_status decide_frames(const struct fmb_method *method, struct frame_pair *pair,
                                     unsigned want, struct fmb_answer *answer)
{
    const struct fmb_body *a = pair->a.placement->body, *b = pair->b.placement->body;
    const struct swept of_b = box_of_all(pair->b.placement, pair->duration);
    const struct swept against_b = swept_against(&of_b);
    answer->verdict = FMB_SEPARATED;
    for (unsigned i = 0; i < a->frame_count; i++) {
        const struct swept of_a = box_at(pair->a.placement, i, pair->duration);
        const struct swept against_a = swept_against(&of_a);
        pair->a.frame = fmb_body_frame(a, i);
        for (unsigned j = 0; swept_meet(&of_a, &against_b) && j < b->frame_count; j++) {
            const struct swept one = box_at(pair->b.placement, j, pair->duration);
            struct fmb_answer of_frames = {0};
            if (!swept_meet(&one, &against_a))
                continue;
            pair->b.frame = fmb_body_frame(b, j);
            const enum fmb_status status = method->decide(pair, want, &of_frames);
            if (status != FMB_OK)
                return status;
            include(answer, &of_frames, a->dim);
        }
    }
    return FMB_OK;
}

enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_placement *a,
                           const struct fmb_placement *b, double duration, unsigned want,
                           struct fmb_answer *answer)
{
    memset(answer, 0, sizeof *answer);
    enum fmb_status status = placements_check(a, b, duration);
    if (status != FMB_OK)
        return status;
    if (want & ~(unsigned) FMB_WANT_BOX)
        return FMB_UNKNOWN_WANT;
    struct frame_pair pair = {
        {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
    const bool single = a->body->frame_count == 1 && b->body->frame_count == 1;
    status =
        single ? method->decide(&pair, want, answer) : decide_frames(method, &pair, want, answer);
    if (status != FMB_OK) /* a method may have gone some way before it knew */
        memset(answer, 0, sizeof *answer);
    return status;
}
