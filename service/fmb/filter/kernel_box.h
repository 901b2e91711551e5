/* Boxes of prepared frames in lanes. */
#ifndef FMB_KERNEL_BOX_H
#define FMB_KERNEL_BOX_H

#include "kernel_exact.h"
#include "box_search.h"

/* A pair of the second pass, and its box. */
struct box_refinement {
    struct kernel_traits traits;
    struct pair_lanes pair;
    struct box_places places;
    struct box_left_out left_out;
    lanes_mask good;
    lanes box[2][3];
};

/* The second pass (box_refine.c). */
void KERNEL_PASTE(refine, KERNEL_NAME)(struct box_refinement *refinement);

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
    for (int axis = 0; axis < traits.dim; axis++) {
        places.origin[which][axis] = frame[which].origin[axis];
        if (traits.drifts)
            places.velocity[which][axis] = frame[which].velocity[axis];
    }
    struct box_left_out left_out;
    lanes_mask good = search_box(pair, traits, &places, false, &left_out, box);
    if (lanes_mask_bits(good | is_not(pair->in_range)) != (1u << LANES) - 1) {
        struct box_refinement again = {
            .traits = traits, .pair = *pair, .places = places, .left_out = left_out};
        KERNEL_PASTE(refine, KERNEL_NAME)(&again);
        memcpy(box, again.box, sizeof again.box);
        good = again.good;
    }
    good &= pair->in_range;
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        box[end][axis] =
            axis < traits.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

#endif
