/* Boxes of prepared frames in lanes. */
#ifndef FMB_RUN_BOX_H
#define FMB_RUN_BOX_H

#include "run_exact.h"
#include "walk_box.h"

/* NAN where doubles do not give it within its limit; 0 in axes that are not there. */
INLINE void boxes_of(const struct walk_kind kind, const struct walk_pair *pair,
                     const struct run_frame frame[2], double duration, bool in_contact,
                     lanes box[2][3])
{
    struct box_places places = {.summary = {frame[0].summary, frame[1].summary},
                                .error = {frame[0].error, frame[1].error},
                                .duration = duration,
                                .in_contact = in_contact};
    places.exact = nothing_rounds(kind, &frame[0], &frame[1], duration, pair);
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        places.origin[which][axis] = frame[which].origin[axis];
        if (kind.drifts)
            places.velocity[which][axis] = frame[which].velocity[axis];
    }
    const lanes_mask good = pair->in_range & walk_box(pair, kind, &places, box);
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        box[end][axis] =
            axis < kind.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

#endif
