/* What is exact about a pair that the first pass leaves open: lanes in which nothing rounds, and
 * signs of gaps along coordinate axes.
 *
 * Nothing rounds. Let g be a power of two, and let all components, the origins, and the drift of a
 * lane be multiples of g in the lengths of struct pair_lanes. Then every number that
 * evaluate_slabs() computes is a sum of products of three of these (two in 2D), a multiple of g^3
 * (g^2), and so is every partial sum. slabs.c bounds the sum of the magnitudes of these products by
 * (2 / sqrt(3)) |u| |v| T. T counts every length in it: 2 |c| for a component of a cuboid, |c| for
 * one of a simplex, 2 |H| for the drift. So 2 (|u| + |v|) <= T for two edges of a cuboid, |u| + |v|
 * <= T for the edges of all other slabs, and |u| |v| <= T^2 / 4. For the face across from the
 * origin, |u| |v| stands for the sum of the three products of lengths, which is at most T^2 / 3.
 * With T <= 2^18 g,
 *
 *     (2 / sqrt(3)) T^3 / 3 < 0.385 * 2^54 g^3 < 2^53 g^3,
 *
 * and all of these numbers are doubles. In 2D the sum is at most |u| T <= T^2, and T <= 2^26 g is
 * enough. Then the gaps are exact, and so is the verdict.
 *
 * Axes. Let the coordinates of both frames along some axis be exact (PREPARED_EXACT_X), even if the
 * frames have errors (a box that is rotated about this axis), or be sums of doubles that are known
 * (PREPARED_CENTRED), and let the pair not drift along it. The gap along the axis is a sum of a few
 * doubles. The rounding errors of sums are doubles (Knuth), and so the sign of this gap is known
 * exactly. Call these axes X, and let every slab of the rounded S whose normal is not parallel to
 * one of X hold the offset w farther inside than the error e of the frames. Then the pair is
 *
 *     SEPARATED    if a gap along X is > 0,
 *     OVERLAPPING  if all gaps along X are < 0,
 *     TOUCHING     otherwise.
 *
 * The first holds because a gap > 0 along any direction separates. Proof of the others. For a unit
 * vector n let n' be its part orthogonal to X, and n'' that along X. The origin of a box may be
 * rounded along X (PREPARED_CENTRED), by r; let f be the error apart from that: |r|^2 + f^2 <= e^2.
 * With origins that are not rounded along X, the distance of w from the bound of a slab with the
 * normal n changes by at most |n''| |r|, so that more than e - |n''| |r| >= |n'| f of it is left.
 * Let K be the axes of X with gap 0, and F the part of the S of these origins on all of their
 * bounds: a face of S, in the flat L = {x : x_k = w_k for k in K}, that contains w. Let z be any
 * vector along L whose part orthogonal to X has a length of at most f, and whose coordinates along
 * X are at most d. For small d > 0, w + z lies in F: the bounds of the slabs that are not parallel
 * to X are farther than |n'| f away; those of the others are farther than 0, or parallel to L. So
 * the support function of F in the direction n, a unit vector along L, is at least n . w + f |n'| +
 * d |n''|. The true S has points near all vertices of F, each moved by f at most, and not moved
 * along X. So these are points of L too, and the support function of their hull is at least n . w
 * for every n: the hull contains w, and so does the true S. If K is empty, L is the space, and the
 * slabs that are not parallel to X leave more than |n'| f: w is in the interior of the true S.
 * Otherwise w lies on its boundary.
 *
 * TOUCHING is only given if S has an interior: never for two faces. */
#ifndef FMB_SLABS_SECOND_H
#define FMB_SLABS_SECOND_H

#include "pair_lanes.h"

/* ---- Nothing rounds ---- */

/* Whether x is a multiple of g, where at = 2^52 g: sums that are at least 2^52 g are multiples of
 * g. */
INLINE lanes_mask is_multiple(lanes x, lanes at)
{
    const lanes magnitude = lanes_abs(x);
    return (magnitude + at) - at == magnitude;
}

/* Whether x has at most 26 significant bits: a product of two such numbers does not round unless it
 * is tiny. */
INLINE lanes_mask has_few_bits(lanes x)
{
    return (lanes_as_bits(x) & 0x7ffffff) == 0;
}

/* The most that T may be in units of g. */
#define GRID_2D 0x1p26
#define GRID_3D 0x1p18

/* Returns 2^52 g, where 2^18 g (2^26 g in 2D) is the least power of two greater than T. */
INLINE lanes grid_of(const struct kernel_traits traits, lanes reach)
{
    const lanes power = lanes_from_bits(lanes_as_bits(reach) & 0x7ff0000000000000);
    return power * (traits.dim == 2 ? 0x1p53 / GRID_2D : 0x1p53 / GRID_3D);
}

/* ---- Axes ---- */

/* A sum of doubles as a pair of doubles: value + remainder, exact in lanes that are not in rounds.
 */
struct exact_sum {
    lanes value, remainder;
    lanes_mask rounds;
};

/* The error of x + y = sum (Knuth, The Art of Computer Programming, volume 2, 4.2.2, theorem B). */
INLINE lanes error_of_sum(lanes x, lanes y, lanes sum)
{
    const lanes part = sum - x;
    return (x - (sum - part)) + (y - part);
}

/* Relative to a sum as one double. */
#define EXACT_SUM_ROUNDING 0x1p-52

INLINE void add_exactly(struct exact_sum *sum, lanes x)
{
    const lanes value = sum->value + x, error = error_of_sum(sum->value, x, value);
    const lanes remainder = sum->remainder + error;
    sum->rounds |= error_of_sum(sum->remainder, error, remainder) != 0;
    sum->remainder = remainder;
    sum->value = value;
}

/* The extent of a frame along an axis: from origin + low to origin + high, origin being origin +
 * remainder; rounds: the lanes in which these are not exact. */
struct exact_extent {
    lanes origin, remainder, low, high;
    lanes_mask rounds;
};

/* In most cuboids one component extends along the axis. Then no sum of components rounds. */
INLINE struct exact_extent exact_extent_of(const struct kernel_traits traits, int which,
                                           const lanes component[3][3], lanes origin, int axis)
{
    lanes_mask some = {0};
    struct exact_extent out = {origin, lanes_of(0), lanes_of(0), lanes_of(0), some};
    UNROLL(3)
    for (int i = 0; i < component_count(traits, which); i++) {
        const lanes c = component[i][axis];
        const lanes low = lanes_min(c, lanes_of(0)), high = lanes_max(c, lanes_of(0));
        if (traits.simplex[which]) {
            out.low = lanes_min(low, out.low);
            out.high = lanes_max(high, out.high);
            continue;
        }
        const lanes_mask other = c != 0;
        out.rounds |= some & other;
        some |= other;
        out.low += low;
        out.high += high;
    }
    return out;
}

/* The lanes of boxes that are given by their centre: position + centre. */
INLINE void set_centred(lanes_mask centred, lanes position, lanes centre, struct exact_extent *out)
{
    const lanes sum = position + centre, half = 0.5 * (out->high - out->low);
    out->origin = lanes_select(centred, sum, out->origin);
    out->remainder = lanes_select(centred, error_of_sum(position, centre, sum), out->remainder);
    out->low = lanes_select(centred, -half, out->low);
    out->high = lanes_select(centred, half, out->high);
}

/* From end_a of a to end_b of b along an axis: low or high of each. Its value is off by less than
 * EXACT_SUM_ROUNDING of itself, and has the exact sign, but for the lanes in rounds. any: some
 * remainder is not 0. */
INLINE struct exact_sum exact_difference(const struct exact_extent *a, const struct exact_extent *b,
                                         lanes end_a, lanes end_b, bool any)
{
    const lanes offset = b->origin - a->origin;
    struct exact_sum out = {offset, error_of_sum(b->origin, -a->origin, offset),
                            a->rounds | b->rounds};
    if (any) {
        add_exactly(&out, b->remainder);
        add_exactly(&out, -a->remainder);
    }
    add_exactly(&out, end_b);
    add_exactly(&out, -end_a);
    out.value += out.remainder;
    CHECK_BOUND(EXACT_SUM_ROUNDING, out.rounds, out.value,
                EXACT_SUM_ROUNDING * lanes_abs(out.value));
    return out;
}

/* The gap along an axis; rounds: the lanes in which its sign is not known. */
INLINE struct exact_sum axis_gap(const struct exact_extent *a, const struct exact_extent *b,
                                 bool any)
{
    struct exact_sum out = exact_difference(a, b, a->high, b->low, any);
    const struct exact_sum below = exact_difference(a, b, a->low, b->high, any);
    out.value = lanes_max(out.value, -below.value);
    out.rounds |= below.rounds; /* of either */
    return out;
}

#endif
