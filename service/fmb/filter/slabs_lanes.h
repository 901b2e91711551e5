/* One slab of LANES pairs, and what the slabs of a pair yield together. */
#ifndef FMB_SLABS_LANES_H
#define FMB_SLABS_LANES_H

#include "pair_lanes.h"

/* What all slabs so far yield. With SLABS_LIST, which requires one lane, all slabs are listed too.
 * The gap of a slab is how far the offset stays beyond its bounds (slabs.h). */
struct slabs_result {
    lanes gap_low;  /* lower bound on the largest gap: > 0 if some slab separates */
    lanes gap_high; /* upper bound on the largest gap: < 0 if all slabs overlap */
    /* [outer, inner]: bounds on the time of contact, from -1 (the start of the window) to 1 (its
     * end), as far as the slabs give them. */
    lanes enter[2], leave[2];
#ifdef SLABS_LIST
    struct slab_value *next; /* where the next slab is stored */
#endif
};

/* ---- Extents along a normal ----
 *
 * The extent of a frame about its reference point is [-radius, radius] for a cuboid, [low, high]
 * for a simplex. That of D is [low - radius, high + radius]. */
struct slab_extent {
    lanes low, high, radius;
};

/* The extent of a frame whose components are at x, and otherwise at 0, along the normal. */
INLINE struct slab_extent extent_of_one(bool simplex, lanes x)
{
    if (!simplex)
        return (struct slab_extent){lanes_of(0), lanes_of(0), lanes_abs(x)};
    return (struct slab_extent){lanes_min(x, lanes_of(0)), lanes_max(x, lanes_of(0)), lanes_of(0)};
}

INLINE struct slab_extent extent_of_two(bool simplex, lanes x, lanes y)
{
    if (!simplex)
        return (struct slab_extent){lanes_of(0), lanes_of(0), lanes_abs(x) + lanes_abs(y)};
    return (struct slab_extent){lanes_min(lanes_min(x, y), lanes_of(0)),
                                lanes_max(lanes_max(x, y), lanes_of(0)), lanes_of(0)};
}

INLINE struct slab_extent extent_of_three(bool simplex, lanes x, lanes y, lanes z)
{
    if (!simplex)
        return (struct slab_extent){lanes_of(0), lanes_of(0),
                                    (lanes_abs(x) + lanes_abs(y)) + lanes_abs(z)};
    return (struct slab_extent){lanes_min(lanes_min(lanes_min(x, y), z), lanes_of(0)),
                                lanes_max(lanes_max(lanes_max(x, y), z), lanes_of(0)), lanes_of(0)};
}

/* The extent of a frame whose components are at at[] along the normal. */
INLINE struct slab_extent extent_of_frame(const struct kernel_traits traits, int which,
                                          const lanes at[3])
{
    return component_count(traits, which) == 2
               ? extent_of_two(traits.simplex[which], at[0], at[1])
               : extent_of_three(traits.simplex[which], at[0], at[1], at[2]);
}

/* The extent of D = A - B from those of A and B along the same direction. */
INLINE struct slab_extent extent_difference(const struct kernel_traits traits, struct slab_extent a,
                                            struct slab_extent b)
{
    struct slab_extent out = {lanes_of(0), lanes_of(0), lanes_of(0)};
    if (traits.simplex[0] && traits.simplex[1])
        return (struct slab_extent){a.low - b.high, a.high - b.low, out.radius};
    if (!traits.simplex[0] && !traits.simplex[1]) {
        out.radius = a.radius + b.radius;
        return out;
    }
    out.radius = traits.simplex[0] ? b.radius : a.radius;
    out.low = traits.simplex[0] ? a.low : -b.high;
    out.high = traits.simplex[0] ? a.high : -b.low;
    return out;
}

/* The same with the extent of B along the opposite direction. */
INLINE struct slab_extent extent_sum(const struct kernel_traits traits, struct slab_extent a,
                                     struct slab_extent b)
{
    return extent_difference(traits, a, (struct slab_extent){-b.high, -b.low, b.radius});
}

/* The gap: how far the offset stays beyond D over the window, that is, beyond D widened by the
 * drift. */
INLINE lanes gap_of(const struct kernel_traits traits, struct slab_extent d, lanes middle,
                    lanes swing)
{
    const bool cuboids = !traits.simplex[0] && !traits.simplex[1];
    const lanes beyond = cuboids ? lanes_abs(middle) : lanes_max(middle - d.high, d.low - middle);
    if (traits.simplex[0] && traits.simplex[1])
        return traits.drifts ? beyond - lanes_abs(swing) : beyond;
    return beyond - (traits.drifts ? d.radius + lanes_abs(swing) : d.radius);
}

/* ---- A slab ---- */

/* A swing is made longer by this much of the error, so that no quotient overflows. */
#define SWING_LONGER 0x1p-10

/* Bounds the time of contact by a slab: the times s in [-1, 1] at which middle + s swing lies
 * within the bounds of D.
 *
 * Let l be the computed low - middle, and w the swing, made longer by 2^-10 of the error e: then no
 * quotient overflows. The true value that l - s w stands for differs from it by at most e - r, for
 * all s in [-1, 1]; r is the unused part of the error. So the true offset is below the bound where
 * l - s w > e - r, and above it where l - s w < -(e - r). For w > 0 it enters the slab
 *
 *     not before (l - e + r) / w,      surely by (l + e - r) / w,
 *
 * as far as these are in [-1, 1]. The same holds with w < 0 and at the other bound. Let q = |l /
 * w|, and t = e / |w|. Computed are l (1 / w) -+ e (1 / w), with u = 2^-53: either product is
 * rounded twice, so that they are off by 2.01 u (q + t), and their difference by another u of
 * itself.
 *
 *     q <= 2   An end in [-1, 1] has t <= 3. It is off by at most 2.01 u 5 + u < 12 u, and
 *              SLABS_TIMES_SLACK is 16 u.
 *     q > 2    An end in [-1, 1], computed or true, has t >= q - 1.01 > 0.49 q, however large both
 *              are: a slab that is nearly parallel to the drift. It is off by at most 2.01 u (q +
 *              t) + u < 6.2 u t + u. The slack covers u, and r / |w| the remainder: 6.2 u e < r.
 *
 * An end that is not in [-1, 1] becomes -1 or 1, or is too far from the other one (times_of()).
 *
 * The value of r. The error of a slab is the sum of SLABS_ROUNDING |u| |v| T for rounding, and |u|
 * |v| E for the errors of the frames. Of the 18 u of the first part, 16.2 u are used where no sum
 * is made with the bound (slabs.c). The longer swing takes 2^-10 of both parts, and w, which is at
 * most |u| |v| T / 2, is rounded once more: 0.54 u |u| |v| T. What is left, 1.2 u |u| |v| T, is
 * more than 6.2 u of the first part. Of E the same shares are covered by the unused part of E: a
 * tenth (rotation.h), or half (sums counted twice, frame.c), except for the remainders of
 * components that were rounded as differences of vertices, which are less than 2 u T.
 *
 * If the swing is 0, both signs of w are valid. The interval taken is what both give, which is the
 * same for the pair with its frames swapped. */
INLINE void bound_times(const struct kernel_traits traits, struct slab_extent d, lanes error,
                        lanes middle, lanes swing, lanes_mask ignored, struct slabs_result *result)
{
    const bool both = traits.simplex[0] && traits.simplex[1];
    const bool none = !traits.simplex[0] && !traits.simplex[1];
    lanes low = both ? d.low : none ? -d.radius : d.low - d.radius;
    lanes high = both ? d.high : none ? d.radius : d.high + d.radius;
    low -= middle;
    high -= middle;
    if (traits.axis_aligned) { /* values that bound nothing, in place of what was rounded */
        low = lanes_select(ignored, lanes_of(-4), low);
        high = lanes_select(ignored, lanes_of(4), high);
        swing = lanes_select(ignored, lanes_of(0), swing);
        error = lanes_select(ignored, lanes_of(1), error);
    }
    const lanes nearest = lanes_min(-low, high);
    low = lanes_select(swing == 0, -nearest, low);
    high = lanes_select(swing == 0, nearest, high);
    const lanes inverse = 1 / (swing + lanes_copysign(SWING_LONGER * error, swing));
    const lanes one = low * inverse, other = high * inverse;
    const lanes slack = error * lanes_abs(inverse);
    CHECK_QUOTIENT(SLABS_TIMES_SLACK, ignored, low, swing, inverse, one, error);
    CHECK_QUOTIENT(SLABS_TIMES_SLACK, ignored, high, swing, inverse, other, error);
    const lanes enter = lanes_min(one, other), leave = lanes_max(one, other);
    result->enter[0] = lanes_max(enter - slack, result->enter[0]);
    result->enter[1] = lanes_max(enter + slack, result->enter[1]);
    result->leave[0] = lanes_min(leave + slack, result->leave[0]);
    result->leave[1] = lanes_min(leave - slack, result->leave[1]);
}

/* traits.second: the lanes in which the normal of two edges is parallel to an axis along which the
 * sign of the gap is known. That sign decides their slab. Arguments: bits as in pair_lanes.across.
 */
INLINE lanes_mask is_known_axis(const struct kernel_traits traits, lanes_bits across_u,
                                lanes_bits across_v)
{
    if (traits.second)
        return (lanes_mask) ((across_u & across_v) != 0);
    return (lanes_mask){0};
}

/* Adds a slab to the result. The error of its gap is scale * unit. timeless: its normal is
 * orthogonal to the drift. ignored: lanes whose normal is zero, or whose gap is known otherwise;
 * their slab does not count. */
INLINE void add_slab(const struct kernel_traits traits, struct slab_normal normal,
                     struct slab_extent d, lanes scale, lanes unit, lanes middle, lanes swing,
                     bool timeless, lanes_mask ignored, struct slabs_result *result)
{
    const lanes gap = gap_of(traits, d, middle, swing);
    CHECK_BOUND(SLABS_ROUNDING, ignored, gap, scale * unit);
    const lanes above = gap + scale * unit;
    result->gap_low = lanes_max(gap - scale * unit, result->gap_low);
    result->gap_high = lanes_max(traits.axis_aligned || traits.second
                                     ? lanes_select(ignored, lanes_of(-INFINITY), above)
                                     : above,
                                 result->gap_high);
    if (traits.times && !timeless)
        bound_times(traits, d, scale * unit, middle, swing, ignored, result);
#ifdef SLABS_LIST
    struct slab_value slab = {.normal = normal};
    if (!ignored) {
        slab.low = d.low - d.radius;
        slab.high = d.high + d.radius;
        slab.middle = middle;
        slab.swing = swing;
        slab.error = scale * unit;
    }
    *result->next++ = slab;
#else
    (void) normal;
#endif
}

/* Whether all pairs are separated and no more is computed about them. */
INLINE bool is_enough(const struct kernel_traits traits, const struct slabs_result *result)
{
#ifdef SLABS_LIST
    return false;
#endif
    const unsigned separated = lanes_greater_bits(result->gap_low, lanes_of(0));
    return traits.mirrored ? separated != 0 : separated == (1u << LANES) - 1;
}

/* ---- Axes ----
 *
 * The coordinate axes are normals of slabs too, if not of facets. In 3D they come first: they cost
 * little and separate most pairs that are far from each other. In 2D another slab costs as little.
 * A monomial of a gap, which is one coordinate, is rounded at most 6 times, and the sum with the
 * bound once: 7.01 u T. */
/* Sets result->gap_low alone. */
INLINE void evaluate_axes(const struct pair_lanes *pair, const struct kernel_traits traits,
                          struct slabs_result *result)
{
    const lanes bound =
        (traits.rough ? SLABS_ROUGH : 1) * SLABS_ROUNDING_AXES * pair->reach + pair->error;
    lanes gap = lanes_of(-1);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes at[2][3];
        UNROLL(2)
        for (int f = 0; f < 2; f++)
            UNROLL(3)
        for (int i = 0; i < component_count(traits, f); i++)
            at[f][i] = pair->component[f][i][axis];
        const struct slab_extent d = extent_difference(traits, extent_of_frame(traits, 0, at[0]),
                                                       extent_of_frame(traits, 1, at[1]));
        const lanes own = gap_of(traits, d, pair->offset[axis], pair->half_drift[axis]);
        CHECK_BOUND(SLABS_ROUNDING_AXES, (lanes_mask){0}, own, bound);
        gap = lanes_max(own, gap);
    }
    result->gap_low = gap - bound;
}

#endif
