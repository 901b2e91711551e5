#include "work_steps.h"

#include "unit.h"

#include <math.h>
#include <stdlib.h>

double work_of_scene_step(const struct fmb_placement placements[2], double duration,
                          work_so_far *work, int *steps)
{
    static const unsigned pairs[1][2] = {{0, 1}};
    const struct fmb_scene scene = {
        .placements = placements,
        .placement_count = 2,
        .duration = duration,
        .instant = duration == 0,
        .which = FMB_PAIRS_LISTED,
        .pairs = pairs,
        .pair_count = 1,
        .want = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT};
    struct fmb_scene_limits limits;
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    double most = 0;
    fmb_scene_limits_of(&scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &state), FMB_OK);
    for (bool done = false; !done; ++*steps) {
        const double before = work();
        done = fmb_scene_step(state, &answers);
        most = fmax(most, work() - before);
    }
    free(memory);
    return most;
}

double work_of_certificate_step(const struct fmb_placement placements[2], double duration,
                                work_so_far *work, int *steps, bool *made)
{
    struct fmb_certificate_state *state;
    const char *text = NULL;
    double before = work();
    assert_int_equal(fmb_certificate_begin(&placements[0], &placements[1], duration, &state),
                     FMB_OK);
    double most = work() - before;
    for (; !text; ++*steps) {
        before = work();
        text = fmb_certificate_step(state);
        most = fmax(most, work() - before);
    }
    *made = text[0];
    fmb_certificate_end(state);
    return most;
}
