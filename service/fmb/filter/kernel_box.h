/* What boxes.h and the boxes in fixed-width integers have in common: pairs of prepared frames in
 * lanes. */
#ifndef FMB_KERNEL_BOX_H
#define FMB_KERNEL_BOX_H

#define KERNEL_BOX

#include "box_clip.h"
#include "kernel_second.h"

/* Sets what is exact: exact, level and apart. */
INLINE void set_exact(const struct kernel_traits traits, const struct pair_lanes *pair,
                      struct box_places *out)
{
    const struct frame_lanes *frame = out->frame;
    out->exact = nothing_rounds(traits, &frame[0], &frame[1], out->duration, pair);
    const lanes_bits axes = known_axes(traits, &frame[0]) & known_axes(traits, &frame[1]);
    const bool any = lanes_mask_bits(is_centred(&frame[0]) | is_centred(&frame[1]));
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes_mask level = (axes & (1u << axis)) != 0;
        if (traits.simplex[0] || traits.simplex[1])
            level = (lanes_mask){0};
        if (traits.drifts)
            level &= frame[0].velocity[axis] == frame[1].velocity[axis];
        if (lanes_mask_bits(level)) {
            const struct exact_extent a = extent_along(traits, 0, &frame[0], any, axis);
            const struct exact_extent b = extent_along(traits, 1, &frame[1], any, axis);
            for (int i = 0; i < 4; i++) {
                const struct exact_sum apart =
                    exact_difference(&a, &b, i / 2 ? a.high : a.low, i % 2 ? b.high : b.low, any);
                level &= apart.rounds == 0;
                out->apart[axis][i / 2][i % 2] = apart.value;
            }
        }
        out->level[axis] = level;
    }
}

/* Sets the rest of the places, which point to the frames, and the pair. */
INLINE void set_places(const struct kernel_traits traits, const struct frame_lanes frame[2],
                       double duration, struct pair_lanes *pair, struct box_places *out)
{
    set_pair(traits, &frame[0], &frame[1], duration, pair);
    out->frame = frame;
    out->duration = duration;
}

#endif
