/* One slab of a pair in lanes: what is found of it. */
#ifndef FMB_WALK_SLAB_H
#define FMB_WALK_SLAB_H

#include "walk_pair.h"

/* What a walk finds. */
struct walk_found {
    lanes surely;   /* largest of gap - error: > 0 where some slab surely separates */
    lanes possibly; /* largest of gap + error: < 0 where all slabs surely overlap */
    /* [outer, inner]: of the time of contact, from -1 (the start of the window) to 1, as far as
     * slabs bound it */
    lanes enter[2], leave[2];
#if LANES == 1
    struct slab_value *next; /* where the next slab is kept; NULL: no list is wanted */
#endif
};

/* ---- Extents along a normal ----
 *
 * Of a frame about its reference point: of a cuboid [-radius, radius], of a simplex [low, high]; of
 * D, the sum of both. */
struct walk_extent {
    lanes low, high, radius;
};

INLINE struct walk_extent extent_of_one(bool simplex, lanes x)
{
    if (!simplex)
        return (struct walk_extent){lanes_of(0), lanes_of(0), lanes_abs(x)};
    return (struct walk_extent){lanes_min(x, lanes_of(0)), lanes_max(x, lanes_of(0)), lanes_of(0)};
}

INLINE struct walk_extent extent_of_two(bool simplex, lanes x, lanes y)
{
    if (!simplex)
        return (struct walk_extent){lanes_of(0), lanes_of(0), lanes_abs(x) + lanes_abs(y)};
    return (struct walk_extent){lanes_min(lanes_min(x, y), lanes_of(0)),
                                lanes_max(lanes_max(x, y), lanes_of(0)), lanes_of(0)};
}

INLINE struct walk_extent extent_of_three(bool simplex, lanes x, lanes y, lanes z)
{
    if (!simplex)
        return (struct walk_extent){lanes_of(0), lanes_of(0),
                                    (lanes_abs(x) + lanes_abs(y)) + lanes_abs(z)};
    return (struct walk_extent){lanes_min(lanes_min(lanes_min(x, y), z), lanes_of(0)),
                                lanes_max(lanes_max(lanes_max(x, y), z), lanes_of(0)), lanes_of(0)};
}

/* Of all components along what makes at[] of them. */
INLINE struct walk_extent extent_of_frame(const struct walk_kind kind, int which, const lanes at[3])
{
    return component_count(kind, which) == 2
               ? extent_of_two(kind.simplex[which], at[0], at[1])
               : extent_of_three(kind.simplex[which], at[0], at[1], at[2]);
}

/* The extent of D = A - B from those of A and B along the same direction. */
INLINE struct walk_extent extent_difference(const struct walk_kind kind, struct walk_extent a,
                                            struct walk_extent b)
{
    struct walk_extent out = {lanes_of(0), lanes_of(0), lanes_of(0)};
    if (kind.simplex[0] && kind.simplex[1])
        return (struct walk_extent){a.low - b.high, a.high - b.low, out.radius};
    if (!kind.simplex[0] && !kind.simplex[1]) {
        out.radius = a.radius + b.radius;
        return out;
    }
    out.radius = kind.simplex[0] ? b.radius : a.radius;
    out.low = kind.simplex[0] ? a.low : -b.high;
    out.high = kind.simplex[0] ? a.high : -b.low;
    return out;
}

/* The same with the extent of B along the opposite direction. */
INLINE struct walk_extent extent_sum(const struct walk_kind kind, struct walk_extent a,
                                     struct walk_extent b)
{
    if (kind.simplex[0] && kind.simplex[1])
        return (struct walk_extent){a.low + b.low, a.high + b.high, lanes_of(0)};
    if (!kind.simplex[0] && !kind.simplex[1])
        return (struct walk_extent){lanes_of(0), lanes_of(0), a.radius + b.radius};
    return kind.simplex[0] ? (struct walk_extent){a.low, a.high, b.radius}
                           : (struct walk_extent){b.low, b.high, a.radius};
}

/* How far beyond D the offset is at most over the window: D widened by the drift. */
INLINE lanes gap_of(const struct walk_kind kind, struct walk_extent d, lanes middle, lanes swing)
{
    const bool round = !kind.simplex[0] && !kind.simplex[1];
    const lanes beyond = round ? lanes_abs(middle) : lanes_max(middle - d.high, d.low - middle);
    if (kind.simplex[0] && kind.simplex[1])
        return kind.drifts ? beyond - lanes_abs(swing) : beyond;
    return beyond - (kind.drifts ? d.radius + lanes_abs(swing) : d.radius);
}

/* ---- A slab ---- */

/* What is known of the time: middle + s swing lies within the bounds of D, s in [-1, 1].
 *
 * Let l be the computed low - middle, and w the swing, made longer by 2^-10 of the error e: then no
 * quotient overflows. What l - s w stands for is off by at most e - r, for all s in [-1, 1]; r is
 * what the error has to spare. So the true offset is below the bound where l - s w > e - r, and
 * above it where l - s w < -(e - r). For w > 0 it enters the slab
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
 *              t) + u < 6.2 u t + u. The slack covers u, and r / |w| the rest: 6.2 u e < r.
 *
 * An end that is not in [-1, 1] becomes -1 or 1, or is too far from the other one (times_of). What
 * r is: the error of a slab is SLABS_ROUNDING |u| |v| T and that of the frames, |u| |v| E. Of the
 * first 18 u, 16.2 u are used where no sum is made with the bound (slabs.c). The longer swing takes
 * 2^-10 of both, and w, which is at most |u| |v| T / 2, is rounded once more: 0.54 u |u| |v| T. The
 * rest, 1.2 u |u| |v| T, is more than 6.2 u of the first part. Of E the same shares are covered by
 * what E has to spare: a tenth (rotation.h), or half (sums counted twice, frame.c), but for the
 * rests of components that were rounded as differences of vertices, which are less than 2 u T.
 *
 * Where the swing is 0 both signs of w are right; what they have in common is the same for the pair
 * the other way round. */
INLINE void bound_times(const struct walk_kind kind, struct walk_extent d, lanes error,
                        lanes middle, lanes swing, lanes_mask nothing, struct walk_found *found)
{
    const bool both = kind.simplex[0] && kind.simplex[1];
    const bool none = !kind.simplex[0] && !kind.simplex[1];
    lanes low = both ? d.low : none ? -d.radius : d.low - d.radius;
    lanes high = both ? d.high : none ? d.radius : d.high + d.radius;
    low -= middle;
    high -= middle;
    if (kind.along) { /* what would bound nothing, in place of what was rounded */
        low = lanes_select(nothing, lanes_of(-4), low);
        high = lanes_select(nothing, lanes_of(4), high);
        swing = lanes_select(nothing, lanes_of(0), swing);
        error = lanes_select(nothing, lanes_of(1), error);
    }
    const lanes nearest = lanes_min(-low, high);
    low = lanes_select(swing == 0, -nearest, low);
    high = lanes_select(swing == 0, nearest, high);
    const lanes inverse = 1 / (swing + lanes_copysign(0x1p-10 * error, swing));
    const lanes one = low * inverse, other = high * inverse;
    const lanes slack = error * lanes_abs(inverse);
    const lanes enter = lanes_min(one, other), leave = lanes_max(one, other);
    found->enter[0] = lanes_max(enter - slack, found->enter[0]);
    found->enter[1] = lanes_max(enter + slack, found->enter[1]);
    found->leave[0] = lanes_min(leave + slack, found->leave[0]);
    found->leave[1] = lanes_min(leave - slack, found->leave[1]);
}

/* kind.exact: lanes in which the normal of two edges is parallel to an axis along which the sign of
 * the gap is known: their slab is decided by that. Bits as in walk_pair.across. */
INLINE lanes_mask is_along_axis(const struct walk_kind kind, lanes_bits across_u,
                                lanes_bits across_v)
{
    if (kind.exact)
        return (lanes_mask) ((across_u & across_v) != 0);
    return (lanes_mask){0};
}

/* nothing: lanes whose normal is zero, or whose gap is known; they say nothing. timeless: the slab
 * of a drift. */
INLINE void add_slab(const struct walk_kind kind, struct slab_normal normal, struct walk_extent d,
                     lanes scale, lanes unit, lanes middle, lanes swing, bool timeless,
                     lanes_mask nothing, struct walk_found *found)
{
    const lanes gap = gap_of(kind, d, middle, swing);
    const lanes above = gap + scale * unit;
    found->surely = lanes_max(gap - scale * unit, found->surely);
    found->possibly = lanes_max(
        kind.along || kind.exact ? lanes_select(nothing, lanes_of(-INFINITY), above) : above,
        found->possibly);
    if (kind.times && !timeless)
        bound_times(kind, d, scale * unit, middle, swing, nothing, found);
#if LANES == 1
    struct slab_value slab = {.normal = normal};
    if (!nothing) {
        slab.low = d.low - d.radius;
        slab.high = d.high + d.radius;
        slab.middle = middle;
        slab.swing = swing;
        slab.error = scale * unit;
    }
    if (found->next)
        *found->next++ = slab;
#else
    (void) normal;
#endif
}

/* Whether every pair is known to be separated, and no more is wanted. */
INLINE bool is_enough(const struct walk_kind kind, const struct walk_found *found)
{
    const unsigned separated = lanes_greater_bits(found->surely, lanes_of(0));
#if LANES == 1
    if (found->next)
        return false;
#endif
    return kind.mirrored ? separated != 0 : separated == (1u << LANES) - 1;
}

/* ---- Axes ----
 *
 * They are normals of slabs too, if not of facets: in space the first to ask, since they cost
 * little and part most pairs that are far from each other. In the plane a slab costs as little. */
INLINE void ask_axes(const struct walk_pair *pair, const struct walk_kind kind,
                     struct walk_found *found)
{
    lanes gap = lanes_of(-1);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        lanes at[2][3];
        UNROLL(2)
        for (int f = 0; f < 2; f++)
            UNROLL(3)
        for (int i = 0; i < component_count(kind, f); i++)
            at[f][i] = pair->component[f][i][axis];
        const struct walk_extent d = extent_difference(kind, extent_of_frame(kind, 0, at[0]),
                                                       extent_of_frame(kind, 1, at[1]));
        gap = lanes_max(gap_of(kind, d, pair->offset[axis], pair->half[axis]), gap);
    }
    found->surely =
        gap - ((kind.rough ? SLABS_ROUGH : 1) * SLABS_ROUNDING_AXES * pair->reach + pair->error);
}

#endif
