/* Boxes of prepared frames in lanes. */
#ifndef FMB_KERNEL_BOX_H
#define FMB_KERNEL_BOX_H

#include "kernel_exact.h"
#include "box_clip.h"

/* LANES pairs that are left open, and their boxes. */
struct box_refinement {
    struct kernel_traits traits;
    struct pair_lanes pair;
    struct box_places places;
    struct box_left_out left_out;
    lanes_mask good;
    lanes box[2][3];
};

/* The second pass of search_box(), then clip_box() for moving pairs with a cuboid (box_refine.h).
 */
void KERNEL_PASTE(refine, KERNEL_NAME)(struct box_refinement *refinement);

/* Whether the boxes of all lanes in range are good. */
INLINE bool all_good(lanes_mask good, const struct pair_lanes *pair)
{
    return lanes_mask_bits(good | is_not(pair->in_range)) == (1u << LANES) - 1;
}

/* Fills box[] from other[] in the lanes in which it is not good yet. more: the lanes in which
 * other[] is good. Returns the lanes in which box[] is good then. */
INLINE lanes_mask join_boxes(const struct kernel_traits traits, lanes_mask more,
                             const lanes other[2][3], lanes_mask good, lanes box[2][3])
{
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        box[end][axis] = lanes_select(good, box[end][axis], other[end][axis]);
    return good | more;
}

/* Finds boxes in up to three ways, until all that can be are good:
 *
 *     two cuboids in 2D, or at rest   search_box(), clip_box(), second pass of search_box()
 *     with a cuboid in 3D, moving     search_box(), second pass, clip_box() (box_refine.h)
 *     others without a face           clip_box(), search_box(), second pass
 *     faces                           search_box(), second pass
 *
 * Two cuboids are searched first, since they often rest on each other. The order for a lane does
 * not depend on the other lanes. Returns the lanes in which boxes are good. */
INLINE lanes_mask find_boxes(const struct kernel_traits traits, const struct pair_lanes *pair,
                             const struct box_places *places, lanes box[2][3])
{
    const bool clips = can_be_clipped(traits) && !is_clipped_last(traits);
    const bool clips_first = clips && (traits.simplex[0] || traits.simplex[1]);
    struct box_refinement last;
    struct box_search search;
    lanes other[2][3];
    lanes_mask more, good;
    begin_box(pair, traits, places, &search);
    good = clips_first ? clip_box(pair, traits, places, &search, box)
                       : search_box(pair, traits, places, false, &search, &last.left_out, box);
    if (all_good(good, pair))
        return good;
    if (clips) {
        more = clips_first ? search_box(pair, traits, places, false, &search, &last.left_out, other)
                           : clip_box(pair, traits, places, &search, other);
        good = join_boxes(traits, more, other, good, box);
    }
    if (all_good(good, pair))
        return good;
    last.traits = traits;
    last.pair = *pair;
    last.places = *places;
    KERNEL_PASTE(refine, KERNEL_NAME)(&last);
    return join_boxes(traits, last.good, last.box, good, box);
}

/* The boxes, [lower, upper][axis]: NAN in lanes in which doubles do not prove the limit of fmb.h, 0
 * along axes beyond dim. */
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
    const lanes_mask good = find_boxes(traits, pair, &places, box) & pair->in_range;
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        box[end][axis] =
            axis < traits.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

#endif
