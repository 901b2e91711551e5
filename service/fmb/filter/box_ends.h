/* Boxes of LANES pairs: where the points of the frames are, and from how far an intersection
 * reaches to the ends of its box.
 *
 * In: struct pair_lanes; struct box_places, the numbers of the frames as prepared.
 *
 * Out: struct box_pair, set by begin_box(); the box in world coordinates, from put_box().
 *
 * Frames are seen about the middle of the window, displaced by -travel to travel, in the lengths of
 * pair_lanes. u = 2^-53.
 *
 * SLACK
 *
 * A point of a frame is the sum of its origin, of components (the shift to the centre; from there
 * to a vertex; a part of an edge, at most twice its half), and of travel (to the middle of the
 * window; to one of its ends; a part of the way). Each of these is rounded at most 10 times on its
 * way into a coordinate ('make checked' counts), and a few more times in the sums below. So with
 * BOX_PLACE_ROUNDING = 20.1 u times the sum of their magnitudes, and 1.1 e for the errors e of both
 * frames, a coordinate is within the slack of that of the true point. */
#ifndef FMB_BOX_ENDS_H
#define FMB_BOX_ENDS_H

#include "kernel_lanes.h"
#include "slabs_second.h"

/* u. */
#define BOX_UNIT 0x1p-53
#define BOX_PLACE_ROUNDING (20.1 * BOX_UNIT)
#define BOX_PLACE_ROUNDING_EXACT (6.1 * BOX_UNIT)

/* Factor on the errors of frames; what exceeds 1 covers the rounding of the slack. */
#define BOX_PLACE_ERROR 1.1

/* Of the largest coordinate; the limit that fmb.h states is 1e-12. */
#define BOX_LIMIT 0.9e-12

/* The largest distance of an outer and an inner end, the slack on both sides included (2.1 of it,
 * for rounding). */
#define BOX_TOLERANCE (0.95 * BOX_LIMIT)

/* Rounds the largest coordinate, as computed, down. */
#define BOX_LARGEST_SHARE (1 - 0x1p-40)

/* Farther away nothing is said, for fear of overflow. */
#define BOX_FARTHEST 0x1p500

/* What boxes need besides struct pair_lanes. */
struct box_places {
    const struct frame_lanes *frame; /* [2], as prepared */
    lanes_mask exact;                /* nothing rounds (slabs_second.h) */
    double duration;
    /* Two cuboids, [axis]: the lanes in which both have exact coordinates along an axis along which
     * they do not drift, with [end of A][end of B] from one to the other (exact_difference()). */
    lanes_mask level[3];
    lanes apart[3][2][2];
};

/* A frame. Edges by number (slabs.h); those of a cuboid are half of what they are. */
struct box_frame {
    lanes edge[6][3];
    lanes centre[3];  /* of the reference point, in the middle of the window */
    lanes travel[3];  /* half of the displacement */
    lanes own_sum[3]; /* of the magnitudes of the components and travel */
};

struct box_pair {
    struct box_frame frame[2];
    lanes slack[3];    /* of a coordinate */
    lanes reach[3];    /* of a value: [axis], magnitudes of the vectors that it is made of */
    lanes largest;     /* coordinate, or a little less */
    lanes whole;       /* what ends may be apart, without the slack on both sides */
    lanes unit;        /* of the small numbers that ends are made of; 0: they are not */
    lanes_mask exact;  /* nothing rounds */
    lanes_mask usable; /* a box can be found */
};

/* How far the box reaches, [below 0, above][axis]: outer at most, inner surely. */
struct box_ends {
    lanes outer[2][3], inner[2][3];
};

INLINE lanes_mask is_not(lanes_mask mask)
{
    return mask == 0;
}

/* ---- Frames ---- */

/* The components from whose ends an edge that is a difference goes, and to which. */
INLINE int edge_from(const struct kernel_traits traits, int e)
{
    return traits.dim == 2 ? 0 : next(e % 3);
}

INLINE int edge_to(const struct kernel_traits traits, int e)
{
    return traits.dim == 2 ? 1 : next(next(e % 3));
}

INLINE lanes_mask has_bit(lanes_bits summary, unsigned bit)
{
    return (summary & (UINT64_C(1) << 3 * PREPARED_SIZE_BITS) * bit) != 0;
}

/* The sum of the magnitudes of the components along an axis. */
INLINE lanes magnitudes_along(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, int axis)
{
    lanes sum = lanes_abs(pair->component[which][0][axis]);
    UNROLL(2)
    for (int i = 1; i < component_count(traits, which); i++)
        sum += lanes_abs(pair->component[which][i][axis]);
    return sum;
}

INLINE lanes largest_along(const struct pair_lanes *pair, const struct kernel_traits traits,
                           int which, int axis)
{
    lanes largest = lanes_abs(pair->component[which][0][axis]);
    for (int i = 1; i < component_count(traits, which); i++)
        largest = lanes_max(lanes_abs(pair->component[which][i][axis]), largest);
    return largest;
}

/* Zeros become positive. */
INLINE void set_box_frame(const struct pair_lanes *pair, const struct kernel_traits traits,
                          int which, const struct box_places *places, struct box_frame *out)
{
    const lanes(*c)[3] = pair->component[which];
    const double twice = is_doubled(traits) ? 2 : 1;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes at = twice * places->frame[which].origin[axis];
        out->travel[axis] = traits.drifts ? (0.5 * twice) * (places->frame[which].velocity[axis] *
                                                             lanes_of(places->duration)) +
                                                0.0
                                          : lanes_of(0);
        out->centre[axis] =
            (traits.simplex[which] ? at : at + shift_of(traits, c, axis)) + out->travel[axis];
        out->own_sum[axis] =
            magnitudes_along(pair, traits, which, axis) + lanes_abs(out->travel[axis]);
        UNROLL(6)
        for (int index = 0; index < edge_count(traits, which); index++) {
            const int e = edge_at(traits, which, index);
            const lanes from = e < traits.dim ? lanes_of(0) : c[edge_from(traits, e)][axis];
            const lanes to = e < traits.dim ? c[e][axis] : c[edge_to(traits, e)][axis];
            out->edge[e][axis] = (e < traits.dim ? to : to - from) + 0.0;
        }
    }
}

/* The largest magnitude of a coordinate of a vertex over the window, or a little less. */
INLINE lanes largest_place(const struct pair_lanes *pair, const struct kernel_traits traits,
                           int which, const struct box_frame *frame)
{
    lanes largest = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes centre = frame->centre[axis];
        lanes farthest = lanes_abs(centre);
        if (!traits.simplex[which]) {
            largest = lanes_max(farthest + frame->own_sum[axis], largest);
            continue;
        }
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            farthest = lanes_max(lanes_abs(centre + pair->component[which][i][axis]), farthest);
        largest = lanes_max(farthest + lanes_abs(frame->travel[axis]), largest);
    }
    return BOX_LARGEST_SHARE * largest;
}

/* ---- Ends that are exact ----
 *
 * Where the ends of an extent are those of the box (boxes along the axes, a frame within the other)
 * they are as near as doubles go: a sum or product is rounded outward, if it rounds. Subtracting
 * the term of larger magnitude from a sum is exact, and shows which way it was rounded (Dekker).
 * The error of a product above 2^-900 is found from halves of the factors (Dekker); 2^-52 of a
 * normal number is between one and two units in its last place; sums that are not normal are exact.
 */

/* Where the sign of x is minus one, else the other; of -0 too. */
INLINE lanes choose_by_sign(lanes x, lanes negative, lanes other)
{
#if LANES == 4 && defined(__AVX__)
    return (lanes) _mm256_blendv_pd((__m256d) other, (__m256d) negative, (__m256d) x);
#elif LANES == 1
    return signbit(x) ? negative : other;
#else
    return lanes_select((lanes_mask) x >> 63, negative, other);
#endif
}

INLINE lanes with_sign_of(lanes x, lanes sign)
{
#if LANES == 1
    return signbit(sign) ? -x : x;
#else
    return (lanes) ((lanes_mask) x ^ ((lanes_mask) sign & INT64_MIN));
#endif
}

INLINE lanes sum_above(lanes x, lanes y)
{
    const lanes sum = x + y;
    const lanes_mask below = (sum - x < y) | (sum - y < x);
    return lanes_select(below, sum + 0x1p-52 * lanes_abs(sum), sum);
}

INLINE lanes upper_half(lanes x)
{
    const lanes large = 134217729 * x;
    return large - (large - x);
}

/* x y - product, exactly where nothing overflows or underflows (Dekker). */
INLINE lanes product_error(lanes x, lanes y, lanes product)
{
    const lanes x_high = upper_half(x), y_high = upper_half(y);
    const lanes x_low = x - x_high, y_low = y - y_high;
    return ((x_high * y_high - product) + x_high * y_low + x_low * y_high) + x_low * y_low;
}

/* What a product is off by at most, 0 where it is exact. Factors beyond 2^900 count as inexact: NAN
 * is not 0. */
INLINE lanes product_slack(lanes x, lanes y, lanes product)
{
    const lanes_mask errorless = product_error(x, y, product) == 0;
    const lanes_mask normal = lanes_abs(product) >= 0x1p-900;
    const lanes_mask zero = (x == 0) | (y == 0);
    return lanes_select((errorless & normal) | zero, lanes_of(0),
                        0x1p-52 * lanes_abs(product) + 0x1p-950);
}

/* Adds the end of a component, at x from the origin, to the ends of a frame: [0] how far it reaches
 * below 0, [1] above. Of a cuboid, x is added to the end on its side. */
INLINE void add_component(bool simplex, lanes origin, lanes x, lanes ends[2])
{
    const lanes from = simplex ? with_sign_of(origin, x) : choose_by_sign(x, ends[0], ends[1]);
    const lanes to = sum_above(from, lanes_abs(x));
    ends[0] = choose_by_sign(x, simplex ? lanes_max(to, ends[0]) : to, ends[0]);
    ends[1] = choose_by_sign(x, ends[1], simplex ? lanes_max(to, ends[1]) : to);
}

/* Cuts the box, in the lengths of the world; ends: as in add_component(). */
INLINE void cut_to_extent(const struct pair_lanes *pair, const struct kernel_traits traits,
                          int which, const struct box_places *places, int axis, lanes ends[2])
{
    const bool twice = is_doubled(traits) && traits.simplex[which];
    const lanes origin = places->frame[which].origin[axis];
    lanes own[2] = {-origin, origin};
    UNROLL(3)
    for (int i = 0; i < component_count(traits, which); i++) {
        const lanes c = pair->component[which][i][axis];
        add_component(traits.simplex[which], origin, twice ? 0.5 * c : c, own);
    }
    if (traits.drifts) {
        const lanes velocity = places->frame[which].velocity[axis],
                    time = lanes_of(places->duration);
        const lanes way = velocity * time, slack = product_slack(velocity, time, way);
        own[0] = sum_above(own[0], lanes_max(slack - way, lanes_of(0)));
        own[1] = sum_above(own[1], lanes_max(way + slack, lanes_of(0)));
    }
    const lanes_mask inexact =
        is_not(has_bit(places->frame[which].summary, (unsigned) PREPARED_EXACT_X << axis));
    if (lanes_mask_bits(inexact)) {
        const lanes error = lanes_select(inexact, places->frame[which].error, lanes_of(0));
        own[0] = sum_above(own[0], error);
        own[1] = sum_above(own[1], error);
    }
    ends[0] = lanes_min(own[0], ends[0]);
    ends[1] = lanes_min(own[1], ends[1]);
}

/* ---- Sizes ---- */

/* Sets sums of magnitudes and the slack along an axis. */
INLINE void set_sizes(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct box_places *places, int axis, struct box_pair *out)
{
    const double twice = is_doubled(traits) ? 2 : 1;
    const lanes half = lanes_abs(pair->half_drift[axis]);
    lanes slack = lanes_of(0);
    out->reach[axis] =
        twice * lanes_abs(places->frame[1].origin[axis] - places->frame[0].origin[axis]) + 2 * half;
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        const lanes sum = magnitudes_along(pair, traits, which, axis);
        const lanes at = twice * lanes_abs(places->frame[which].origin[axis]);
        out->reach[axis] +=
            traits.simplex[which] ? largest_along(pair, traits, which, axis) : 2 * sum;
        slack = lanes_max(at + 4 * out->frame[which].own_sum[axis], slack);
    }
    const lanes rounding = lanes_select(places->exact, lanes_of(BOX_PLACE_ROUNDING_EXACT),
                                        lanes_of(BOX_PLACE_ROUNDING));
    out->slack[axis] = rounding * slack + BOX_PLACE_ERROR * pair->error;
}

/* Of lanes in which nothing rounds: whether all numbers of the pair are multiples of g, with at =
 * 2^52 g, and the frames' own travels do not round either. */
INLINE lanes_mask are_multiples(const struct pair_lanes *pair, const struct kernel_traits traits,
                                const struct box_places *places, const struct box_pair *box,
                                lanes at)
{
    lanes_mask all = box->exact;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int which = 0; which < 2; which++) {
        if (lanes_mask_bits(all) == 0)
            break;
        all &= is_multiple(places->frame[which].origin[axis], at);
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            all &= is_multiple(pair->component[which][i][axis], at);
        if (!traits.drifts)
            continue;
        const lanes v = places->frame[which].velocity[axis], time = lanes_of(places->duration);
        all &= is_multiple(box->frame[which].travel[axis], at) &
               (product_slack(v, time, v * time) == 0);
    }
    return all;
}

/* Sets the frames, sizes, slack, and how far apart ends may be. */
INLINE void begin_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct box_places *places, struct box_pair *out)
{
    lanes largest = lanes_of(0), slack = lanes_of(0);
    lanes_mask lost = {0};
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_box_frame(pair, traits, which, places, &out->frame[which]);
        largest = lanes_max(largest_place(pair, traits, which, &out->frame[which]), largest);
    }
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        set_sizes(pair, traits, places, axis, out);
        slack = lanes_max(out->slack[axis], slack);
        if (traits.drifts)
            lost |= (places->frame[0].velocity[axis] != places->frame[1].velocity[axis]) &
                    (pair->half_drift[axis] == 0);
    }
    out->exact = places->exact;
    out->largest = largest;
    out->unit = lanes_of(0);
    if (lanes_mask_bits(out->exact)) {
        const lanes power =
            lanes_from_bits(lanes_as_bits(pair->reach) & UINT64_C(0x7ff0000000000000));
        out->unit = lanes_select(are_multiples(pair, traits, places, out, 0x1p45 * power),
                                 0x1p-7 * power, lanes_of(0));
    }
    const lanes tolerance = BOX_TOLERANCE * largest - 2.1 * slack;
    out->whole = lanes_select((out->unit != 0) | (tolerance < 0), lanes_of(0), tolerance);
    out->usable = is_not(lost) & (largest <= BOX_FARTHEST);
}

/* ---- Boxes along the axes ---- */

/* The lanes in which both frames are cuboids along the axes, and at rest: the intersection is that
 * of their extents along each axis. These are off by no more than the errors of the frames: with a
 * largest coordinate of L, sizes are at most 2.2 sqrt(3) L, and T at most 57 L in doubled lengths.
 */
INLINE lanes_mask are_aligned(const struct pair_lanes *pair, const struct kernel_traits traits,
                              const struct box_places *places)
{
    lanes_mask out = {0};
    if (traits.simplex[0] || traits.simplex[1] || traits.drifts)
        return out;
    out = pair->error <= 0x1p-51 * pair->reach;
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        const lanes(*c)[3] = pair->component[which];
        UNROLL(3)
        for (int axis = 0; axis < traits.dim; axis++) {
            const int i = axis, j = traits.dim == 2 ? 1 - axis : next(axis);
            out &= has_bit(places->frame[which].summary,
                           (unsigned) PREPARED_COMPONENTS_EXACT_X << axis);
            UNROLL(3)
            for (int k = 0; k < traits.dim; k++)
                out &= ((c[k][i] == 0) | (c[k][j] == 0)) & ((c[i][k] == 0) | (c[j][k] == 0));
        }
    }
    return out;
}

/* ---- The box ---- */

/* Ends that are small numbers, to the last bit. With the numbers of the pair multiples of a unit g,
 * and T < 2^8 g, a determinant is at most 4 T^3 / 81 < 2^20 g^3 (T^3 / 27 but for the normal of a
 * far face, a sum of three), and an end a fraction of g with a denominator below that. Two such
 * fractions, or one and a multiple of 2^-20 g, are 2^-40 g apart if they differ: where the end is
 * within 2^-41 g of such a multiple, it is that. */
INLINE lanes snapped(lanes outer, lanes inner, lanes unit)
{
    const lanes large = (0x1.8p52 * 0x1p-20) * unit, middle = 0.5 * (outer + inner);
    const lanes snap = (middle + large) - large;
    const lanes near = 0x1p-41 * unit;
    lanes_mask is_end = unit != 0;
    is_end &= lanes_abs(snap - outer) <= near;
    is_end &= lanes_abs(snap - inner) <= near;
    is_end &= lanes_abs(middle) <= 0x1p30 * unit;
    return lanes_select(is_end, snap, outer);
}

/* Widens the ends, which computed points gave, by the slack. Completes the inner ends: a box that
 * is not empty reaches as far to one side as its other end is from there. Returns the lanes in
 * which all outer ends are within the limit. */
INLINE lanes_mask are_near(const struct kernel_traits traits, const struct box_pair *box,
                           struct box_ends *ends)
{
    lanes_mask good = box->usable;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        UNROLL(2)
        for (int end = 0; end < 2; end++) {
            ends->outer[end][axis] += box->slack[axis];
            ends->inner[end][axis] -= box->slack[axis];
        }
        UNROLL(2)
        for (int end = 0; end < 2; end++) {
            lanes *inner = &ends->inner[end][axis];
            *inner = lanes_max(-ends->outer[!end][axis], *inner);
            good &= ends->outer[end][axis] - *inner <= BOX_LIMIT * box->largest;
        }
    }
    return good;
}

/* Puts the ends in the lengths of the world, cut to both frames. */
INLINE void put_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                    const struct box_places *places, const struct box_pair *from,
                    const struct box_ends *found, lanes box[2][3])
{
    const bool any_unit = lanes_mask_bits(from->unit != 0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes ends[2];
        UNROLL(2)
        for (int end = 0; end < 2; end++) {
            ends[end] = found->outer[end][axis];
            if (any_unit)
                ends[end] = snapped(ends[end], found->inner[end][axis], from->unit);
            if (is_doubled(traits))
                ends[end] *= 0.5;
        }
        UNROLL(2)
        for (int which = 0; which < 2; which++)
            cut_to_extent(pair, traits, which, places, axis, ends);
        box[0][axis] = 0.0 - ends[0]; /* never -0 */
        box[1][axis] = ends[1] + 0.0;
    }
}

#endif
