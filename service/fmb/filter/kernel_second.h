/* The second pass of the filter: prepared frames in lanes to outcomes, by what is exact about them.
 * The proof is in slabs_second.h. */
#ifndef FMB_KERNEL_SECOND_H
#define FMB_KERNEL_SECOND_H

#include "kernel_lanes.h"
#include "slabs_second.h"

INLINE lanes_bits bits_of(uint64_t bits)
{
    lanes_bits out = {0};
    return out + bits;
}

/* The flags of prepared frames from flag on: its bit is the lowest. */
INLINE lanes_bits flags_from(const struct frame_lanes *frame, unsigned flag)
{
    return frame->summary / ((uint64_t) flag << 3 * PREPARED_SIZE_BITS);
}

/* The lanes with PREPARED_CENTRED. */
INLINE lanes_mask is_centred(const struct frame_lanes *frame)
{
    return (flags_from(frame, PREPARED_CENTRED) & bits_of(1)) != 0;
}

/* The axes along which the extent of a frame is known exactly. */
INLINE lanes_bits known_axes(const struct kernel_traits traits, const struct frame_lanes *frame)
{
    const lanes_bits all = bits_of(traits.dim == 2 ? 3 : 7);
    const lanes_bits components = flags_from(frame, PREPARED_COMPONENTS_EXACT_X) & all;
    return (flags_from(frame, PREPARED_EXACT_X) & all) |
           (components & lanes_bits_where(is_centred(frame), all));
}

INLINE struct exact_extent extent_along(const struct kernel_traits traits, int which,
                                        const struct frame_lanes *frame, bool any_centred, int axis)
{
    struct exact_extent out =
        exact_extent_of(traits, which, frame->component, frame->origin[axis], axis);
    if (traits.simplex[which] || !any_centred)
        return out;
    double at[2][LANES];
    for (int lane = 0; lane < LANES; lane++) {
        const struct fmb_prepared *prepared = frame->prepared[lane];
        at[0][lane] = prepared->placement->position[axis];
        at[1][lane] = prepared->frame->centre[axis];
    }
    set_centred(is_centred(frame), lanes_load(at[0]), lanes_load(at[1]), &out);
    return out;
}

/* Sets pair->signed_axes; returns the largest gap along these axes. */
INLINE lanes set_signs(const struct kernel_traits traits, const struct frame_lanes *a,
                       const struct frame_lanes *b, struct pair_lanes *pair)
{
    lanes gap = lanes_of(-INFINITY);
    lanes_bits axes = known_axes(traits, a) & known_axes(traits, b);
    const bool any = lanes_mask_bits(is_centred(a) | is_centred(b));
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const struct exact_extent of_a = extent_along(traits, 0, a, any, axis);
        const struct exact_extent of_b = extent_along(traits, 1, b, any, axis);
        const struct exact_sum own = axis_gap(&of_a, &of_b, any);
        lanes_mask open = own.rounds != 0;
        if (traits.drifts)
            open |= a->velocity[axis] != b->velocity[axis];
        axes &= ~lanes_bits_where(open, bits_of(1u << axis));
        gap = lanes_select((axes & (1u << axis)) != 0, lanes_max(own.value, gap), gap);
    }
    pair->signed_axes = axes;
    return gap;
}

/* The lanes in which nothing rounds, and whose frames have no errors. A product of two numbers with
 * 26 significant bits each is exact unless it is tiny, and a multiple of g other than 0 is not
 * tiny. */
INLINE lanes_mask nothing_rounds(const struct kernel_traits traits, const struct frame_lanes *a,
                                 const struct frame_lanes *b, double duration,
                                 const struct pair_lanes *pair)
{
    const lanes at = grid_of(traits, pair->reach);
    const double scale = is_doubled(traits) ? 2 : 1;
    lanes_mask out = pair->in_range & (pair->error == 0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        out &= is_multiple(scale * a->origin[axis], at) & is_multiple(scale * b->origin[axis], at);
        if (lanes_mask_bits(out) == 0)
            break;
        UNROLL(2)
        for (int which = 0; which < 2; which++)
            UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            out &= is_multiple(pair->component[which][i][axis], at);
        if (!traits.drifts)
            continue;
        const lanes speed = b->velocity[axis] - a->velocity[axis], half = pair->half_drift[axis];
        out &= error_of_sum(b->velocity[axis], -a->velocity[axis], speed) == 0;
        out &= has_few_bits(speed) & has_few_bits(lanes_of(duration));
        out &= is_multiple(half, at) & ((half != 0) | (speed == 0));
    }
    return out;
}

/* Sets pair->across: for each edge the axes of pair->signed_axes along which it has no extent. */
INLINE void set_across(const struct kernel_traits traits, struct pair_lanes *pair)
{
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        UNROLL(6)
    for (int edge = 0; edge < edge_count(traits, which); edge++) {
        const int e = edge_at(traits, which, edge);
        lanes u[3];
        lanes_bits across = {0};
        edge_vector(traits, pair, which, e, u);
        UNROLL(3)
        for (int axis = 0; axis < traits.dim; axis++)
            across |= lanes_bits_where(u[axis] == 0, bits_of(1u << axis));
        pair->across[which][e] = across & pair->signed_axes;
    }
}

/* The outcomes of the second pass. Two cuboids whose signs are known along all axes are
 * axis-aligned, and have no other slabs: each extends along an axis with one edge. Two faces are
 * TOUCHING here if nothing rounds, no slab separates them, and some slab does not hold the offset
 * strictly. */
INLINE struct outcomes second_outcomes(const struct kernel_traits traits,
                                       const struct frame_lanes *a, const struct frame_lanes *b,
                                       double duration, struct pair_lanes *pair)
{
    const bool cuboids = !traits.simplex[0] && !traits.simplex[1];
    const bool faces = traits.face[0] && traits.face[1];
    const lanes gap = set_signs(traits, a, b, pair);
    lanes_mask exact = {0}; /* nothing rounds */
    struct slabs_result result;
    slabs_result_begin(&result);
    if (!cuboids || !lanes_all(pair->signed_axes == (traits.dim == 2 ? 3 : 7))) {
        exact = nothing_rounds(traits, a, b, duration, pair);
        pair->unit = lanes_select(exact, lanes_of(0), pair->unit);
        pair->reach = lanes_select(exact, lanes_of(0), pair->reach);
        set_across(traits, pair);
        evaluate_pair(traits, pair, &result);
    }
    const lanes_mask separated = pair->in_range & ((result.gap_low > 0) | (gap > 0));
    const lanes_mask inside = pair->in_range & (result.gap_high < 0);
    const lanes_mask overlapping = inside & (gap < 0) & ~separated;
    const lanes_mask touching = (faces ? exact : exact | inside) & ~separated & ~overlapping;
    return (struct outcomes){lanes_mask_bits(separated), lanes_mask_bits(touching),
                             lanes_mask_bits(overlapping)};
}

#endif
