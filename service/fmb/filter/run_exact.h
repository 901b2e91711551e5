/* The second pass of the filter: prepared frames in lanes to outcomes, by what is exact of them
 * (walk_exact.h). */
#ifndef FMB_RUN_EXACT_H
#define FMB_RUN_EXACT_H

#include "run_lanes.h"
#include "walk_exact.h"

INLINE lanes_bits bits_of(uint64_t bits)
{
    lanes_bits out = {0};
    return out + bits;
}

/* The signs along axes that are known; returns the largest gap along one of them. */
INLINE lanes set_signs(const struct walk_kind kind, const struct run_frame *a,
                       const struct run_frame *b, struct walk_pair *pair)
{
    lanes gap = lanes_of(-INFINITY);
    lanes_bits axes =
        (a->summary & b->summary) / ((uint64_t) PREPARED_EXACT_X << 3 * PREPARED_SIZE_BITS);
    axes &= bits_of(kind.dim == 2 ? 3 : 7);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        const struct walk_sum along =
            gap_along(kind, a->component, a->origin, b->component, b->origin, axis);
        lanes_mask open = along.rounds != 0;
        if (kind.drifts)
            open |= a->velocity[axis] != b->velocity[axis];
        axes &= ~lanes_bits_where(open, bits_of(1u << axis));
        gap = lanes_select((axes & (1u << axis)) != 0, lanes_max(along.value, gap), gap);
    }
    pair->signed_axes = axes;
    return gap;
}

/* Whether nothing rounds in a lane, and its frames have no errors. A product of numbers that have
 * 26 bits is exact unless it is tiny, and a multiple of g that is not 0 is not. */
INLINE lanes_mask nothing_rounds(const struct walk_kind kind, const struct run_frame *a,
                                 const struct run_frame *b, double duration,
                                 const struct walk_pair *pair)
{
    const lanes at = grid_of(kind, pair->reach);
    const double scale = is_doubled(kind) ? 2 : 1;
    lanes_mask out = pair->in_range & (pair->error == 0);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        out &= is_multiple(scale * a->origin[axis], at) & is_multiple(scale * b->origin[axis], at);
        UNROLL(2)
        for (int which = 0; which < 2; which++)
            UNROLL(3)
        for (int i = 0; i < component_count(kind, which); i++)
            out &= is_multiple(pair->component[which][i][axis], at);
        if (!kind.drifts)
            continue;
        const lanes speed = b->velocity[axis] - a->velocity[axis], half = pair->half[axis];
        out &= error_of_sum(b->velocity[axis], -a->velocity[axis], speed) == 0;
        out &= has_few_bits(speed) & has_few_bits(lanes_of(duration));
        out &= is_multiple(half, at) & ((half != 0) | (speed == 0));
    }
    return out;
}

/* Of each edge the axes, of those whose signs are known, along which it has no extent. */
INLINE void set_across(const struct walk_kind kind, struct walk_pair *pair)
{
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        UNROLL(6)
    for (int edge = 0; edge < edge_count(kind, which); edge++) {
        const int e = edge_at(kind, which, edge);
        lanes u[3];
        lanes_bits across = {0};
        walk_edge(kind, pair, which, e, u);
        UNROLL(3)
        for (int axis = 0; axis < kind.dim; axis++)
            across |= lanes_bits_where(u[axis] == 0, bits_of(1u << axis));
        pair->across[which][e] = across & pair->signed_axes;
    }
}

/* Cuboids that have the signs of all axes lie along them, and have no other slabs: each extends
 * along an axis with one edge. Two faces are TOUCHING here where no slab separates them and some
 * slab does not hold them strictly. */
INLINE struct outcomes exact_outcomes(const struct walk_kind kind, const struct run_frame *a,
                                      const struct run_frame *b, double duration,
                                      struct walk_pair *pair)
{
    const bool cuboids = !kind.simplex[0] && !kind.simplex[1];
    const bool faces = kind.face[0] && kind.face[1];
    const lanes gap = set_signs(kind, a, b, pair);
    lanes_mask whole = {0};
    struct walk_found found;
    walk_begin(&found);
    if (!cuboids || !lanes_all(pair->signed_axes == (kind.dim == 2 ? 3 : 7))) {
        whole = nothing_rounds(kind, a, b, duration, pair);
        pair->unit = lanes_select(whole, lanes_of(0), pair->unit);
        pair->reach = lanes_select(whole, lanes_of(0), pair->reach);
        set_across(kind, pair);
        walk_pair_of(kind, pair, &found);
    }
    const lanes_mask separated = pair->in_range & ((found.surely > 0) | (gap > 0));
    const lanes_mask inside = pair->in_range & (found.possibly < 0);
    const lanes_mask overlapping = inside & (gap < 0) & ~separated;
    const lanes_mask touching = (faces ? whole : whole | inside) & ~separated & ~overlapping;
    return (struct outcomes){lanes_mask_bits(separated), lanes_mask_bits(touching),
                             lanes_mask_bits(overlapping)};
}

#endif
