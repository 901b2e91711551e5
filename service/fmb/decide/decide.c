#include "fmb.h"

#include "certified.h"
#include "gap.h"
#include "inexact.h"
#include "memory.h"
#include "pair_number.h"

#include <string.h>

static enum fmb_status decide_exactly(const struct frame_pair *pair, unsigned want,
                                      struct fmb_answer *answer)
{
    if (pair_turns(pair))
        return certified_decide(pair, want, answer);
    return support_decide(pair, want | FMB_WANT_TIMES, SUPPORT_PROGRAMS, answer);
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

void fmb_scene_answer(const struct fmb_scene_answers *answers, size_t k, struct fmb_answer *out)
{
    memset(out, 0, sizeof *out);
    if (answers->verdicts[k] == 0)
        return;
    out->verdict = (enum fmb_verdict) answers->verdicts[k];
    out->has_contact = answers->contacts && out->verdict >= FMB_TOUCHING;
    out->has_box = answers->boxes && out->verdict >= FMB_TOUCHING;
    out->has_point = answers->points && out->verdict >= FMB_TOUCHING;
    out->has_gap = answers->gaps && gap_is_known(&answers->gaps[k]);
    if (out->has_contact)
        memcpy(out->contact, answers->contacts[k], sizeof out->contact);
    if (out->has_box)
        memcpy(out->box, answers->boxes[k], sizeof out->box);
    if (out->has_point)
        memcpy(out->point, answers->points[k], sizeof out->point);
    if (out->has_gap)
        out->gap = answers->gaps[k];
}

/* Decides a pair as a scene. */
static enum fmb_status decide_scene(const struct fmb_method *method, const struct fmb_placement *a,
                                    const struct fmb_placement *b, double duration, unsigned want,
                                    struct fmb_answer *answer)
{
    struct fmb_placement placement[2] = {*a, *b};
    struct fmb_scene scene = pair_scene(method, duration, want);
    placement[0].group = placement[1].group = 0;
    scene.placements = placement;
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&scene, &limits);
    const size_t bytes = fmb_scene_bytes(&limits);
    void *memory = memory_allocate(bytes);
    struct fmb_scene_state *state;
    enum fmb_status status = fmb_scene_begin(&scene, &limits, memory, &state);
    for (bool done = status != FMB_OK; !done;) {
        struct fmb_scene_answers answers;
        done = fmb_scene_step(state, &answers);
        if (answers.count > 0)
            fmb_scene_answer(&answers, 0, answer);
    }
    memory_release(memory, bytes);
    return status == FMB_OK && answer->verdict == 0 ? FMB_CANNOT_DECIDE : status;
}

enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_placement *a,
                           const struct fmb_placement *b, double duration, unsigned want,
                           struct fmb_answer *answer)
{
    memset(answer, 0, sizeof *answer);
    enum fmb_status status = placements_check(a, b, duration);
    if (status != FMB_OK)
        return status;
    if (want & ~(unsigned) (FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT))
        return FMB_UNKNOWN_WANT;
    if (want & FMB_WANT_GAP && !method->certain)
        return FMB_CANNOT_DECIDE;
    if (a->body->frame_count == 1 && b->body->frame_count == 1) {
        const struct frame_pair pair = {
            {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
        status = method->decide(&pair, want, answer);
    } else {
        status = decide_scene(method, a, b, duration, want, answer);
    }
    if (status != FMB_OK) /* a method may have gone some way before it knew */
        memset(answer, 0, sizeof *answer);
    return status;
}
