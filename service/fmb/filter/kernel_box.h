/* Boxes of prepared frames in lanes. */
#ifndef FMB_KERNEL_BOX_H
#define FMB_KERNEL_BOX_H

#include "kernel_exact.h"
#include "box_search.h"

/* NAN where doubles do not give it within its limit; 0 in axes that are not there. */
INLINE void boxes_of(const struct kernel_traits traits, const struct pair_lanes *pair,
                     const struct frame_lanes frame[2], double duration, bool in_contact,
                     lanes box[2][3])
{
    struct box_places places = {.summary = {frame[0].summary, frame[1].summary},
                                .error = {frame[0].error, frame[1].error},
                                .duration = duration,
                                .in_contact = in_contact};
    places.exact = nothing_rounds(traits, &frame[0], &frame[1], duration, pair);
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        places.origin[which][axis] = frame[which].origin[axis];
        if (traits.drifts)
            places.velocity[which][axis] = frame[which].velocity[axis];
    }
    const lanes_mask good = pair->in_range & search_box(pair, traits, &places, box);
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        box[end][axis] =
            axis < traits.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

#endif
