/* The box of the intersection of two solids in 3D, at rest and in contact, of LANES pairs at once,
 * from their edges. This is faster than the search (box_search.h) where a frame is a tetrahedron,
 * and gives boxes that the search leaves open, such as those of cuboids that rest on each other
 * with a slight tilt.
 *
 * In: struct pair_lanes; struct box_search as begin_box() leaves it.
 *
 * Out: as search_box().
 *
 * Steps (clip_box()):
 *   1. set_slabs()    the slabs whose intersection a frame is
 *   2. clip_edges()   what is left of each edge of the other frame: of slabs that are surely wide
 *                     enough (outer), and of slabs that are surely narrow enough (inner)
 *   3. find_reach()   how far what is left reaches
 *   4. has_vague()    whether inner spans are as long as outer ones, within the limit; else
 *                     find_reach() of the inner ones
 *   5. put_box(), are_near() (box_search.h)
 *
 * THE METHOD
 *
 * A vertex of the intersection of two polytopes lies in the planes of three faces. Two of them are
 * of the same frame, so it is on an edge of that frame, and in the other frame. The other way
 * round, the part of an edge that is in the other frame belongs to the intersection. So the box is
 * that of all these parts.
 *
 * A cuboid is the intersection of three slabs: |n . x| <= |n . c_k| from its centre, with n = c_i x
 * c_j. A tetrahedron is that of four: with n_k = c_i x c_j and D = n_k . c_k for any k, n_k . x / D
 * is the barycentric coordinate of c_k, from 0 to 1, as is the sum of all three. So |n . x - D / 2|
 * <= |D| / 2, for each n_k and for their sum, whatever the sign of D.
 *
 * Along an edge p + t a (-1 <= t <= 1 of a cuboid, where a is half an edge; else 0 <= t <= 1) the
 * distance from the middle of a slab is s + t d, with d = n . a. With the radius r of the slab, t
 * is within r / |d| of -s / d.
 *
 * OUTER AND INNER ENDS
 *
 * The radius of a slab is r + E for the outer spans and r - E for the inner ones, where E bounds
 * the error of s + t d and r together, for the t of the edge. So nothing of a true edge that is in
 * the true other frame is lost from the outer span, and all of the inner span is in it. Both ends
 * are bounds by themselves, whether the frames as prepared are in contact or not. u = 2^-53.
 *
 * 1. Products. With the weight W of n as in box_search.h, coordinates of n are rounded twice,
 *    and a product n . w three times more: 5 u W . |w|. What is 0 for the true normal, n . c_i
 *    and n . c_j, is at most 2.01 u W . |c_i| for the computed one. The sum of three normals
 *    is rounded twice more; its weight is the sum of theirs. So all n . c_k agree with D to
 *    7.1 u W . |c_k|, since they have the same monomials. Together at most 7.1 u W .
 *    (magnitudes of all vectors at hand).
 * 2. The offset is off by 5 u times the magnitudes of what it is made of, and |n| is at most
 *    W.
 * 3. Sums and quotients, in magnitudes of products with n. s: 2 roundings of sums, as a
 *    quotient 2 more. r + E: 1, as a quotient 2 more. d: 1 where it is a difference. The sum
 *    of the two quotients: u |t|, which is u |d| for s + t d, since |t| > 1 is cut off.
 *    Together at most 7 u times the sum of the magnitudes of D (or n . c_k), of n . (the
 *    offset), and of n . (the components).
 * 4. Frames with errors: points of both are off by at most e together. A true edge is within
 *    its share of e of the computed one, point by point. A point x is in the true frame if the
 *    frame as prepared holds the ball around x whose radius is the frame's error: otherwise m
 *    . x > h(m) of the true frame for some direction m, but h(m) of the frame as prepared is
 *    at most |m| times the error more, and the ball reaches that far beyond x. So |n| e is
 *    enough for both ends, and |n| is at most its scale.
 * 5. |d| < E' 2^-20 is replaced by that, with E' = 1 to 3 together: s + t d changes by less
 *    than 2^-19 E'. E' is at least 2^-640 (else the lane is not good), so that what
 *    underflows, less than 2^-662 (slabs.c), is less than 2^-20 E' too. E' has 8 u where 1
 *    needs 7.1, and 3 does not need all of its 7 u. Quotients with s are at most 2^70, and
 *    never NAN; r / |d| may be infinite.
 * 6. With t from t_0 to t_1, p + t a is computed as p + (t_0 + t_1) (a / 2) +- (t_1 - t_0) |a
 *    / 2|: at most 6 roundings of |a|, 3 of |p|. With those of the centre that is less than 18
 *    u of the components and 9 u of the centre, the slack (box_search.h), which holds e too.
 *
 * Where nothing rounds (slabs_exact.h), frames often touch, and inner spans are empty: such pairs
 * are left to box_search.h, which has no errors there.
 *
 * For the pair with its frames swapped all numbers are the same, but for the sign of zeros. */
#ifndef FMB_BOX_CLIP_H
#define FMB_BOX_CLIP_H

#include "box_search.h"

enum { CLIP_OUTER, CLIP_INNER, CLIP_WAYS };
enum { CLIP_SLABS_MAX = 4, CLIP_EDGES_MAX = 12 };

/* A slab of one frame, as it is seen from the other, whose edges are clipped. */
struct clip_slab {
    lanes at[6];             /* products of the normal with the edges of the other frame */
    lanes middle;            /* of the reference point of the other, from the middle of the slab */
    lanes radius[CLIP_WAYS]; /* surely too wide, too narrow */
    lanes least;             /* magnitude of what is divided by */
};

/* A part of an edge, from one parameter to another; from > to: nothing. */
struct clip_span {
    lanes from, to;
};

/* What is left of the edges of a frame; those along component i of a cuboid are 4 i to 4 i + 3. */
struct clip_spans {
    struct clip_span edge[CLIP_WAYS][CLIP_EDGES_MAX];
};

/* Whether the boxes of a kind of pairs are clipped. */
INLINE bool is_clipped(const struct kernel_traits traits)
{
    return traits.dim == 3 && !traits.drifts && !traits.face[0] && !traits.face[1];
}

/* What 1 and 2 are for a weight of 1 along each axis. */
INLINE void set_weight_errors(const struct box_search *search, lanes out[3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (8 * BOX_UNIT) * search->size[axis] + (5 * BOX_UNIT) * search->offset_sum[axis];
}

INLINE void set_slab(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const struct box_normal *normal, const lanes weight_error[3], lanes_mask *good,
                     struct clip_slab *out)
{
    const lanes own = lanes_abs(normal->own), radius = traits.simplex[which] ? 0.5 * own : own;
    const lanes sum = ((own + lanes_abs(normal->middle)) + lanes_abs(normal->at[0])) +
                      (lanes_abs(normal->at[1]) + lanes_abs(normal->at[2]));
    const lanes rounded = dot(normal->weight, weight_error) + (7 * BOX_UNIT) * sum;
    const lanes error = rounded + normal->scale * pair->error;
    out->middle = traits.simplex[which] ? normal->middle - 0.5 * normal->own : normal->middle;
    out->radius[CLIP_OUTER] = radius + error;
    out->radius[CLIP_INNER] = radius - error;
    out->least = 0x1p-20 * rounded;
    *good &= rounded >= 0x1p-640;
    UNROLL(6)
    for (int e = 0; e < 6; e++)
        out->at[e] = normal->at[e];
}

/* Sets the slabs of a frame. Returns their number. */
INLINE int set_slabs(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const lanes weight_error[3], lanes_mask *good,
                     struct clip_slab slab[CLIP_SLABS_MAX])
{
    struct face_products side;
    struct box_normal normals[4];
    set_face_products(pair, traits, which, &side);
    set_normals(pair, traits, which, &side, normals);
    const int count = traits.simplex[which] ? 4 : 3;
    UNROLL(4)
    for (int k = 0; k < count; k++)
        set_slab(traits, pair, which, &normals[k], weight_error, good, &slab[k]);
    return count;
}

/* What is left of a span between middle - half and middle + half. */
INLINE struct clip_span clipped(struct clip_span span, lanes middle, lanes half)
{
    return (struct clip_span){lanes_max(middle - half, span.from),
                              lanes_min(middle + half, span.to)};
}

/* Clips edge e of a simplex; of a cuboid, the four edges along component e. */
INLINE void clip_edges(const struct kernel_traits traits, int which, int e,
                       const struct clip_slab *slab, int slabs, struct clip_spans *out)
{
    const bool simplex = traits.simplex[which];
    const int count = simplex ? 1 : 4, first = simplex ? e : 4 * e;
    struct clip_span span[CLIP_WAYS][4];
    UNROLL(8)
    for (int n = 0; n < 8; n++)
        span[n / 4][n % 4] = (struct clip_span){lanes_of(simplex ? 0 : -1), lanes_of(1)};
    UNROLL(4)
    for (int k = 0; k < slabs; k++) {
        const lanes *at = slab[k].at, d = at[e];
        const lanes negative = -1 / lanes_select(lanes_abs(d) >= slab[k].least, d, slab[k].least);
        lanes middle[4];
        if (simplex) {
            const lanes from = e < 3 ? slab[k].middle : slab[k].middle + at[edge_from(traits, e)];
            middle[0] = from * negative;
        } else {
            const lanes centre = slab[k].middle * negative;
            const lanes u = at[next(e)] * negative, v = at[next(next(e))] * negative;
            middle[0] = centre - (u + v);
            middle[1] = centre - (u - v);
            middle[2] = centre + (u - v);
            middle[3] = centre + (u + v);
        }
        UNROLL(2)
        for (int way = 0; way < CLIP_WAYS; way++) {
            const lanes half = slab[k].radius[way] * lanes_abs(negative);
            UNROLL(4)
            for (int n = 0; n < count; n++)
                span[way][n] = clipped(span[way][n], middle[n], half);
        }
    }
    UNROLL(2)
    for (int way = 0; way < CLIP_WAYS; way++)
        UNROLL(4)
    for (int n = 0; n < count; n++)
        out->edge[way][first + n] = span[way][n];
}

INLINE int clip_edge_count(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] ? 6 : 12;
}

INLINE const lanes *clip_edge(const struct kernel_traits traits, int which,
                              const struct box_search *search, int e)
{
    return search->frame[which].edge[traits.simplex[which] ? e : e / 4];
}

/* The point of an edge whose parameter is 0. */
INLINE lanes clip_base(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                       int e, int axis)
{
    const lanes(*c)[3] = pair->component[which];
    if (traits.simplex[which])
        return e < 3 ? lanes_of(0) : c[edge_from(traits, e)][axis];
    const lanes u = c[next(e / 4)][axis], v = c[next(next(e / 4))][axis];
    return e % 4 == 0 ? -(u + v) : e % 4 == 1 ? -(u - v) : e % 4 == 2 ? u - v : u + v;
}

/* What is left of an edge, along an axis: the middle, and half of the length. */
struct clip_extent {
    lanes middle, half;
};

INLINE struct clip_extent extent_of_span(const struct kernel_traits traits,
                                         const struct pair_lanes *pair, int which,
                                         const struct box_search *search, int e,
                                         struct clip_span span, int axis)
{
    const lanes half = 0.5 * clip_edge(traits, which, search, e)[axis];
    const lanes sum = lanes_select(span.to >= span.from, span.to + span.from, lanes_of(NAN));
    return (struct clip_extent){clip_base(traits, pair, which, e, axis) + sum * half,
                                (span.to - span.from) * lanes_abs(half)};
}

/* How far what is left of the edges of a frame reaches from its reference point. */
INLINE void find_reach(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                       const struct box_search *search, const struct clip_spans *spans, int way,
                       lanes reach[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        reach[0][axis] = reach[1][axis] = lanes_of(-INFINITY);
        UNROLL(12)
        for (int e = 0; e < clip_edge_count(traits, which); e++) {
            const struct clip_extent x =
                extent_of_span(traits, pair, which, search, e, spans->edge[way][e], axis);
            reach[0][axis] = lanes_max(x.half - x.middle, reach[0][axis]);
            reach[1][axis] = lanes_max(x.half + x.middle, reach[1][axis]);
        }
    }
}

/* The lanes in which an inner span, of an edge of which something is left, is shorter by more than
 * the ends of the box may be apart. */
INLINE lanes_mask has_vague(const struct kernel_traits traits, int which,
                            const struct box_search *search, const struct clip_spans *spans)
{
    lanes_mask out = {0};
    UNROLL(12)
    for (int e = 0; e < clip_edge_count(traits, which); e++) {
        const lanes *a = clip_edge(traits, which, search, e);
        const lanes longest =
            lanes_max(lanes_max(lanes_abs(a[0]), lanes_abs(a[1])), lanes_abs(a[2]));
        const struct clip_span *outer = &spans->edge[CLIP_OUTER][e];
        const struct clip_span *inner = &spans->edge[CLIP_INNER][e];
        const lanes length = outer->to - outer->from, certain = inner->to - inner->from;
        const lanes_mask near = (certain >= 0) & ((length - certain) * longest <= search->whole);
        out |= (length >= 0) & is_not(near);
    }
    return out;
}

/* The ends of the box, from the reaches of both frames; slack: 1 or -1 times it is added. */
INLINE void join_ends(const struct box_search *search, const lanes reach[2][2][3], double slack,
                      lanes ends[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++) {
        lanes to[2];
        UNROLL(2)
        for (int which = 0; which < 2; which++) {
            const lanes centre = search->frame[which].centre[axis];
            to[which] = ((end ? centre : -centre) + reach[which][end][axis]) +
                        slack * search->slack[which][axis];
        }
        ends[end][axis] = lanes_max(to[0], to[1]);
    }
}

/* Boxes, and in which lanes they are good. */
INLINE lanes_mask clip_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                           const struct box_places *places, const struct box_search *search,
                           lanes box[2][3])
{
    struct clip_spans spans[2];
    struct box_ends ends;
    lanes reach[2][2][3], weight_error[3];
    lanes_mask good = is_not(search->exact), vague = {0};
    if (!lanes_mask_bits(good & pair->in_range))
        return (lanes_mask){0};
    set_weight_errors(search, weight_error);
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        struct clip_slab slab[CLIP_SLABS_MAX];
        const int slabs = set_slabs(traits, pair, !which, weight_error, &good, slab);
        UNROLL(6)
        for (int e = 0; e < edge_count(traits, which); e++)
            clip_edges(traits, which, e, slab, slabs, &spans[which]);
        find_reach(traits, pair, which, search, &spans[which], CLIP_OUTER, reach[which]);
        vague |= has_vague(traits, which, search, &spans[which]);
    }
    join_ends(search, reach, 1, ends.outer);
    join_ends(search, reach, -1, ends.inner); /* of outer spans: within the limit, unless vague */
    if (lanes_mask_bits(vague)) {
        lanes inner[2][3];
        for (int which = 0; which < 2; which++)
            find_reach(traits, pair, which, search, &spans[which], CLIP_INNER, reach[which]);
        join_ends(search, reach, -1, inner);
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++)
            UNROLL(2)
        for (int end = 0; end < 2; end++)
            ends.inner[end][axis] = lanes_select(vague, inner[end][axis], ends.inner[end][axis]);
    }
    put_box(pair, traits, places, search, &ends, box);
    return are_near(traits, search, &ends) & good;
}

#endif
