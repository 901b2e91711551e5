/* The box of the intersection of two solids in 3D in contact, at rest or moving, of LANES pairs at
 * once, from their edges.
 *
 * In: struct pair_lanes; struct box_search as begin_box() leaves it.
 *
 * Out: as search_box() (box_search.h).
 *
 * Steps (clip_box()):
 *   1. set_slabs()            the slabs whose intersection a frame is
 *   2. clip_segments()        what is left of each segment of the other frame: of slabs that are
 *                             surely wide enough (outer), and of slabs that are surely narrow
 *                             enough (inner)
 *   3. find_reach()           how far what is left reaches
 *   4. has_vague()            whether inner spans are as long as outer ones, within the limit
 *   5. set_crossings(), add_crossing_reach()
 *                             moving: how far crossings of edges reach
 *   6. 3 and 5 of the inner ends, where they are not within the limit of the outer ones anyway
 *   7. put_box(), are_near()  (box_search.h)
 *
 * THE METHOD
 *
 * The box is that of the vertices of a polytope, the intersection in space and time. At rest, a
 * vertex lies in the planes of three faces. Two of them are of the same frame, so it is on an edge
 * of that frame, and in the other frame. The other way round, the part of an edge that is in the
 * other frame belongs to the intersection. So the box is that of all these parts.
 *
 * Where the frames move, the window goes from -1 to 1, and a vertex is
 *
 *   - at the start or the end of the window, on an edge as at rest;
 *   - or in three faces of one frame: on the path of one of its vertices, and in the other frame;
 *   - or in two faces of each: where an edge of A crosses an edge of B.
 *
 * Segments are the edges at rest; or the edges at the start, those at the end, and the paths.
 *
 * A cuboid is the intersection of three slabs: |n . x| <= |n . c_k| from its centre, with n = c_i x
 * c_j. A tetrahedron is that of four: with n_k = c_i x c_j and D = n_k . c_k for any k, n_k . x / D
 * is the barycentric coordinate of c_k, from 0 to 1, as is the sum of all three. So |n . x - D / 2|
 * <= |D| / 2, for each n_k and for their sum, whatever the sign of D.
 *
 * Along a segment p + t a (0 <= t <= 1 of an edge of a simplex; else -1 <= t <= 1, where a is half
 * an edge of a cuboid, or half the way) the distance from the middle of a slab is s + t d, with d =
 * n . a. With the radius r of the slab, t is within r / |d| of -s / d.
 *
 * OUTER AND INNER ENDS OF SPANS
 *
 * The radius of a slab is r + E for the outer spans and r - E for the inner ones, where E bounds
 * the error of s + t d and r together, for the t of the segment. So nothing of a true segment that
 * is in the true other frame is lost from the outer span, and all of the inner span is in it. Both
 * ends are bounds by themselves, whether the frames as prepared are in contact or not. u = 2^-53.
 *
 * 1. Products. With the weight W of n as in box_search.h, coordinates of n are rounded twice, and
 *    a product n . w three times more: 5 u W . |w|; once more where w is a difference. What is 0
 *    for the true normal, n . c_i and n . c_j, is at most 2.01 u W . |c_i| for the computed one.
 *    The sum of three products is rounded twice more; its weight is the sum of theirs. So all n .
 *    c_k agree with D to 7.1 u W . |c_k|, since they have the same monomials; and along an edge
 *    that is a difference, s + t d, with the same n . c_p in s and in d, is off by at most 8.1 u W
 *    . |c|. Together at most 8.1 u W . (magnitudes of all vectors at hand).
 * 2. The offset is rounded 4 times, half the drift twice: 5 u times the magnitudes of what they are
 *    made of, and |n| is at most W.
 * 3. Sums and quotients, in magnitudes of products with n. s: 3 roundings of sums, as a quotient 2
 *    more. r + E: 1, as a quotient 2 more. d: 1 where it is a difference. The sum of the two
 *    quotients: u |t|, which is u |d| for s + t d, since |t| > 1 is cut off. Together at most 7 u
 *    times the sum of the magnitudes of D (or n . c_k), of n . (the offset), n . (half the drift),
 *    and n . (the components).
 * 4. Frames with errors: points of both are off by at most e together. A true segment is within its
 *    share of e of the computed one, point by point. A point x is in the true frame if the frame as
 *    prepared holds the ball around x whose radius is the frame's error: otherwise m . x > h(m) of
 *    the true frame for some direction m, but h(m) of the frame as prepared is at most |m| times
 *    the error more, and the ball reaches that far beyond x. So |n| e is enough for both ends, and
 *    |n| is at most its scale.
 * 5. |d| < E' 2^-20 is replaced by that, with E' = 1 to 3 together: s + t d changes by less than
 *    2^-19 E'. E' is at least 2^-640 (else the lane is not good), so that what underflows, less
 *    than 2^-662 (slabs.c), is less than 2^-20 E' too. E' has 9 u where 1 needs 8.1, and 3 does
 *    not need all of its 7 u. Quotients with s are below 2^71, and never NAN; r / |d| may be
 *    infinite.
 * 6. With t from t_0 to t_1, p + t a is computed as p + (t_0 + t_1) (a / 2) +- (t_1 - t_0) |a / 2|.
 *    What p and a are made of is rounded at most 16 times in all, what the origin is made of 7
 *    times: less than the slack (box_search.h), which holds e too.
 *
 * CROSSINGS
 *
 * Let p + s a be an edge of A, q + r b one of B, both seen from their reference points, o the
 * offset and H half the drift. They cross at the time t where s a - r b - t H = g, with g = o + q -
 * p. With X = [a b H], the products of this equation with b x H, H x a and a x b are
 *
 *     s X = [o b H] + [q b H] - [p b H]
 *
 *     r X = [o a H] + [q a H] - [p a H]
 *
 *     t X = (q x b) . a + (p x a) . b - [a b o].
 *
 * p x a and q x b are made of the normals of faces (moment_of_edge()).
 *
 * 7. Let N_s be the computed right side of the first equation. For a crossing of the true edges
 *    within the ranges of its parameters, |N_s - s X| <= E_s, and E_r and E_t likewise. Rounded
 *    are, with the weight W of b x H: products of components 7 times (H 2, cross product 2, dot
 *    product 3); the difference that b is, N_s, and its sums 4 times more. So [o b H] is rounded
 *    11 times, after 4 times of o itself; what q is made of 10 times. For a simplex A, let a = Q -
 *    P, p = P. The products with P and Q, 7 times rounded, stand in N_s - s X with factors 1 - s
 *    and s, together 7 times the larger one; P is rounded twice more in N_s; P and Q twice more in
 *    X: at most 13 times the larger one, the farthest coordinate. A cuboid A has 10 times the sum
 *    of all components. So E_s = W . (13.1 u (|o| + the farthest coordinates) + 4.1 u (what o is
 *    made of)). E_r is the same. In the third equation all of these, and H, are rounded at most 9
 *    times.
 * 8. Frames with errors: every vertex is off by at most the frame's error (prepared.h), so at the
 *    same s, r and t, points of the true edges are off by e together, and N_s - s X by e |b x H|.
 *    scale_error has 1.01 e, for what 9 and 11 add.
 * 9. So s is within E_s / |X| of N_s / X. What p + s a + t (half of A's way) is off by along axis
 *    k is at most (E_s |a_k| + E_t |way_k|) / |X|. A crossing is possible if all parameters may be
 *    in their ranges; so none that is a vertex is lost, and the outer end of each is no less than
 *    the vertex. Quotients are rounded twice, and the distance from a range twice: 4 u.
 * 10. It is certain if all parameters are in their ranges by more than these errors. Then the
 *    true edges cross. First, as prepared: the error of X is at most 9 u W . (|P| + |Q|) < 2 E_s of
 *    a simplex, 8 u W . |a| < E_s of a cuboid, and X is more than that, since its range has the
 *    length 1 or 2: so X is not 0, and there is a crossing. Beyond its range the bound of 7 grows
 *    by less than |X| for each 1 that the parameter is out, so the crossing is in its ranges. Now
 *    move all vertices evenly from where they are as prepared to where they truly are. On the way,
 *    by 7 and 8, a crossing that is in its ranges is inside them by a margin. Where X were 0, it
 *    would be on a line of crossings, which leaves the ranges somewhere, without a margin. So X
 *    stays other than 0, the crossing moves steadily, and never leaves its ranges. So the inner end
 *    of each is no more than a true point.
 * 11. |X| < 2^-20 of the least of the three errors is replaced by that, which changes s X by less
 *    than 2^-19 of each. scale_error has 2^-93 T in addition: with sizes above 2^-180 (else the
 *    lane is not good) the errors are more than 2^-640, above all that underflows (5), and nothing
 *    overflows: quotients are below 2^500. Where the frames do not drift apart, there are none.
 * 12. Positions: what the components are made of is rounded at most 16 times, the ways 17 times,
 *    the origin 7 times: less than the slack.
 *
 * Where nothing rounds (slabs_exact.h), frames often touch, and inner spans are empty: such pairs
 * are left to box_search.h, which has no errors there. */
#ifndef FMB_BOX_CLIP_H
#define FMB_BOX_CLIP_H

#include "box_search.h"

enum { CLIP_OUTER, CLIP_INNER, CLIP_WAYS };
enum { CLIP_SLABS_MAX = 4, CLIP_SEGMENTS_MAX = 32 };

/* A linear function of the points of a frame: a coordinate, or the distance from the middle of a
 * slab. */
struct clip_form {
    lanes at[6];  /* [edge]: what it grows by along the edge */
    lanes middle; /* its value at the reference point in the middle of the window */
    lanes swing;  /* what it grows by from there to the end of the window */
};

/* A slab of one frame, as it is seen from the other. */
struct clip_slab {
    struct clip_form form;
    lanes radius[CLIP_WAYS]; /* surely too wide, too narrow */
    lanes least;             /* magnitude of what is divided by */
};

/* A part of a segment, from one parameter to another; from > to: nothing. */
struct clip_span {
    lanes from, to;
};

/* What is left of the segments of a frame. */
struct clip_spans {
    struct clip_span part[CLIP_WAYS][CLIP_SEGMENTS_MAX];
};

/* Whether the boxes of a kind of pairs can be found in this way. */
INLINE bool can_be_clipped(const struct kernel_traits traits)
{
    return traits.dim == 3 && !traits.face[0] && !traits.face[1];
}

/* ---- Segments ----
 *
 * They are numbered by their directions: those along edge e, at the start of the window and then at
 * its end; after all edges, the paths of the vertices. */

INLINE int direction_count(const struct kernel_traits traits, int which)
{
    return edge_count(traits, which) + (traits.drifts ? 1 : 0);
}

INLINE bool is_path(const struct kernel_traits traits, int which, int direction)
{
    return direction == edge_count(traits, which);
}

/* How many edges of a frame have the same direction. */
INLINE int parallel_count(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] ? 1 : 4;
}

INLINE int first_segment(const struct kernel_traits traits, int which, int direction)
{
    return direction * parallel_count(traits, which) * (traits.drifts ? 2 : 1);
}

INLINE int segment_count(const struct kernel_traits traits, int which, int direction)
{
    return is_path(traits, which, direction)
               ? 4 * parallel_count(traits, which) / (traits.simplex[which] ? 1 : 2)
               : parallel_count(traits, which) * (traits.drifts ? 2 : 1);
}

INLINE lanes along_direction(const struct kernel_traits traits, int which, int direction,
                             const struct clip_form *form)
{
    return is_path(traits, which, direction) ? form->swing : form->at[direction];
}

/* What a form makes of the base of edge n along e, seen from the reference point: of a simplex the
 * vertex where the edge begins, of a cuboid the middle of the edge. at: of the components. */
INLINE lanes base_of_edge(const struct kernel_traits traits, int which, int e, int n,
                          const lanes at[3])
{
    if (traits.simplex[which])
        return e < 3 ? lanes_of(0) : at[edge_from(traits, e)];
    const lanes u = at[next(e)], v = at[next(next(e))];
    return n == 0 ? -(u + v) : n == 1 ? -(u - v) : n == 2 ? u - v : u + v;
}

/* What a form is at the parameter 0 of the segments of a direction. */
INLINE void set_starts(const struct kernel_traits traits, int which, int direction,
                       const struct clip_form *form, lanes start[8])
{
    const lanes *at = form->at;
    const int parallel = parallel_count(traits, which);
    if (is_path(traits, which, direction) && traits.simplex[which]) {
        start[0] = form->middle;
        UNROLL(3)
        for (int i = 0; i < 3; i++)
            start[1 + i] = form->middle + at[i];
        return;
    }
    if (is_path(traits, which, direction)) {
        UNROLL(4)
        for (int n = 0; n < 4; n++) {
            const lanes base = form->middle + base_of_edge(traits, which, 0, n, at);
            start[n] = base - at[0];
            start[4 + n] = base + at[0];
        }
        return;
    }
    UNROLL(4)
    for (int n = 0; n < parallel; n++) {
        const bool none = traits.simplex[which] && direction < 3;
        const lanes base =
            none ? form->middle : form->middle + base_of_edge(traits, which, direction, n, at);
        start[n] = traits.drifts ? base - form->swing : base;
        if (traits.drifts)
            start[parallel + n] = base + form->swing;
    }
}

/* ---- Slabs ---- */

/* What 1 and 2 are for a weight of 1 along each axis. */
INLINE void set_weight_errors(const struct box_search *search, lanes out[3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (9 * BOX_UNIT) * search->size[axis] + (5 * BOX_UNIT) * search->offset_sum[axis];
}

INLINE void set_slab(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const struct box_normal *normal, const lanes weight_error[3], lanes_mask *good,
                     struct clip_slab *out)
{
    const lanes own = lanes_abs(normal->own), radius = traits.simplex[which] ? 0.5 * own : own;
    lanes sum = ((own + lanes_abs(normal->middle)) + lanes_abs(normal->at[0])) +
                (lanes_abs(normal->at[1]) + lanes_abs(normal->at[2]));
    if (traits.drifts)
        sum += lanes_abs(normal->swing);
    const lanes rounded = dot(normal->weight, weight_error) + (7 * BOX_UNIT) * sum;
    const lanes error = rounded + 1.01 * normal->scale * pair->error;
    out->form.middle = traits.simplex[which] ? normal->middle - 0.5 * normal->own : normal->middle;
    out->form.swing = normal->swing;
    out->radius[CLIP_OUTER] = radius + error;
    out->radius[CLIP_INNER] = radius - error;
    out->least = 0x1p-20 * rounded;
    *good &= rounded >= 0x1p-640;
    UNROLL(6)
    for (int e = 0; e < 6; e++)
        out->form.at[e] = normal->at[e];
}

/* Sets the slabs of a frame, and its face products. Returns their number. */
INLINE int set_slabs(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const lanes weight_error[3], struct face_products *side, lanes_mask *good,
                     struct clip_slab slab[CLIP_SLABS_MAX])
{
    struct box_normal normals[4];
    set_face_products(pair, traits, which, side);
    set_normals(pair, traits, which, side, normals);
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

/* Clips the segments of a direction to the slabs of the other frame. */
INLINE void clip_segments(const struct kernel_traits traits, int which, int direction,
                          const struct clip_slab *slab, int slabs, struct clip_spans *out)
{
    const int count = segment_count(traits, which, direction);
    const int first = first_segment(traits, which, direction);
    const bool from_end = traits.simplex[which] && !is_path(traits, which, direction);
    struct clip_span span[CLIP_WAYS][8];
    UNROLL(16)
    for (int n = 0; n < 16; n++)
        span[n / 8][n % 8] = (struct clip_span){lanes_of(from_end ? 0 : -1), lanes_of(1)};
    UNROLL(4)
    for (int k = 0; k < slabs; k++) {
        lanes start[8];
        const lanes d = along_direction(traits, which, direction, &slab[k].form);
        const lanes negative = -1 / lanes_select(lanes_abs(d) >= slab[k].least, d, slab[k].least);
        const lanes outer = slab[k].radius[CLIP_OUTER] * lanes_abs(negative);
        const lanes inner = slab[k].radius[CLIP_INNER] * lanes_abs(negative);
        set_starts(traits, which, direction, &slab[k].form, start);
        UNROLL(8)
        for (int n = 0; n < count; n++) {
            const lanes middle = start[n] * negative;
            span[CLIP_OUTER][n] = clipped(span[CLIP_OUTER][n], middle, outer);
            span[CLIP_INNER][n] = clipped(span[CLIP_INNER][n], middle, inner);
        }
    }
    UNROLL(2)
    for (int way = 0; way < CLIP_WAYS; way++)
        UNROLL(8)
    for (int n = 0; n < count; n++)
        out->part[way][first + n] = span[way][n];
}

/* ---- Reach ---- */

/* A coordinate of the points of a frame. */
INLINE void set_coordinate(const struct kernel_traits traits, int which, int axis,
                           const struct box_search *search, struct clip_form *out)
{
    const struct box_frame *frame = &search->frame[which];
    out->middle = frame->centre[axis];
    out->swing = frame->travel[axis];
    UNROLL(6)
    for (int e = 0; e < edge_count(traits, which); e++)
        out->at[e] = frame->edge[e][axis];
}

/* How far what is left of the segments of a frame reaches from 0, [below, above][axis]. */
INLINE void find_reach(const struct kernel_traits traits, int which,
                       const struct box_search *search, const struct clip_spans *spans, int way,
                       lanes reach[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        struct clip_form coordinate;
        set_coordinate(traits, which, axis, search, &coordinate);
        reach[0][axis] = reach[1][axis] = lanes_of(-INFINITY);
        UNROLL(7)
        for (int direction = 0; direction < direction_count(traits, which); direction++) {
            lanes start[8];
            const struct clip_span *part =
                &spans->part[way][first_segment(traits, which, direction)];
            const lanes half = 0.5 * along_direction(traits, which, direction, &coordinate);
            set_starts(traits, which, direction, &coordinate, start);
            UNROLL(8)
            for (int n = 0; n < segment_count(traits, which, direction); n++) {
                const lanes from = part[n].from, to = part[n].to;
                const lanes sum = lanes_select(to >= from, to + from, lanes_of(NAN));
                const lanes middle = start[n] + sum * half;
                const lanes length = (to - from) * lanes_abs(half);
                reach[0][axis] = lanes_max(length - middle, reach[0][axis]);
                reach[1][axis] = lanes_max(length + middle, reach[1][axis]);
            }
        }
    }
}

/* The lanes in which an inner span, of a segment of which something is left, is shorter by more
 * than the ends of the box may be apart. */
INLINE lanes_mask has_vague(const struct kernel_traits traits, int which,
                            const struct box_search *search, const struct clip_spans *spans)
{
    lanes_mask out = {0};
    UNROLL(7)
    for (int direction = 0; direction < direction_count(traits, which); direction++) {
        const lanes *a = is_path(traits, which, direction) ? search->frame[which].travel
                                                           : search->frame[which].edge[direction];
        const int first = first_segment(traits, which, direction);
        const lanes longest =
            lanes_max(lanes_max(lanes_abs(a[0]), lanes_abs(a[1])), lanes_abs(a[2]));
        UNROLL(8)
        for (int n = 0; n < segment_count(traits, which, direction); n++) {
            const struct clip_span *outer = &spans->part[CLIP_OUTER][first + n];
            const struct clip_span *inner = &spans->part[CLIP_INNER][first + n];
            const lanes length = outer->to - outer->from, certain = inner->to - inner->from;
            const lanes_mask near =
                (certain >= 0) & ((length - certain) * longest <= search->whole);
            out |= (length >= 0) & is_not(near);
        }
    }
    return out;
}

/* ---- Crossings ---- */

/* What the crossings of a pair are made of. */
struct clip_crossings {
    struct edge_products edges;
    lanes drift_middle[2][6]; /* [frame][edge]: (half_drift x offset) . edge */
    lanes error[2][6];        /* [frame][edge]: of products with the edge and the drift */
    lanes edge_error[3];      /* of those with an edge of each, for a weight of 1 along each axis */
    lanes scale_error;        /* for a scale of 1 */
};

INLINE lanes max_of_three(lanes x, lanes y, lanes z)
{
    return lanes_max(lanes_max(x, y), z);
}

/* The largest magnitude of a coordinate of the vertices of a frame, seen from its reference point.
 */
INLINE lanes farthest_along(const struct pair_lanes *pair, const struct kernel_traits traits,
                            int which, int axis)
{
    const lanes(*c)[3] = pair->component[which];
    return traits.simplex[which]
               ? max_of_three(lanes_abs(c[0][axis]), lanes_abs(c[1][axis]), lanes_abs(c[2][axis]))
               : magnitudes_along(pair, traits, which, axis);
}

/* Returns the lanes in which no error is so small that it may be lost (11). */
INLINE lanes_mask set_crossings(const struct pair_lanes *pair, const struct kernel_traits traits,
                                const struct box_search *search, struct clip_crossings *out)
{
    lanes drift_error[3], weight[3];
    lanes smallest = lanes_select(pair->half_drift_size != 0, pair->half_drift_size, lanes_of(1));
    set_products(pair, traits, pair->offset, out->edges.middle);
    set_products(pair, traits, pair->half_drift, out->edges.swing);
    out->scale_error = 1.01 * pair->error + (0x1p-40 * BOX_UNIT) * pair->reach;
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        const lanes sum = lanes_abs(pair->offset[axis]) + farthest_along(pair, traits, 0, axis) +
                          farthest_along(pair, traits, 1, axis);
        const lanes of_offset = (4.1 * BOX_UNIT) * search->offset_sum[axis];
        drift_error[axis] = (13.1 * BOX_UNIT) * sum + of_offset;
        out->edge_error[axis] =
            (9.1 * BOX_UNIT) * (sum + lanes_abs(pair->half_drift[axis])) + of_offset;
    }
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_drift_middles(pair, traits, which, out->drift_middle[which]);
        for (int e = 0; e < edge_count(traits, which); e++) {
            const lanes size = pair->size[which][e];
            cross_weight(search->frame[which].length[e], pair->half_drift, weight);
            out->error[which][e] =
                dot(weight, drift_error) + (size * pair->half_drift_size) * out->scale_error;
            smallest = lanes_min(size, smallest);
        }
    }
    return smallest >= 0x1p-180;
}

/* (base x edge) . w, for the base of edge n along e. at[k]: normal[k] . w. */
INLINE lanes moment_of_edge(const struct kernel_traits traits, int which, int e, int n, lanes at0,
                            lanes at1, lanes at2)
{
    const lanes at[3] = {at0, at1, at2};
    if (traits.simplex[which])
        return e < 3 ? lanes_of(0) : at[e - 3];
    const lanes u = -at[next(next(e))], v = at[next(e)];
    return n == 0 ? -(u + v) : n == 1 ? -(u - v) : n == 2 ? u - v : u + v;
}

/* How far the parameter of an edge is outside its range. */
INLINE lanes excess_of(const struct kernel_traits traits, int which, lanes x)
{
    return traits.simplex[which] ? lanes_abs(x - 0.5) - 0.5 : lanes_abs(x) - 1;
}

/* A crossing: the parameters of both edges, and the time. */
struct clip_crossing {
    lanes s, r, t;
};

/* Of edge one along edge i of A, and edge other along edge j of B. inverse: 1 / X. */
INLINE struct clip_crossing crossing_of(const struct kernel_traits traits,
                                        const struct clip_crossings *all,
                                        const struct face_products side[2], int i, int one, int j,
                                        int other, lanes inverse)
{
    const lanes(*swing)[6] = all->edges.swing;
    const lanes(*a)[6] = side[0].other, (*b)[6] = side[1].other;
    const lanes *of_a = side[0].swing, *of_b = side[1].swing;
    const lanes column[3] = {swing[0][j], swing[1][j], swing[2][j]};
    const lanes s =
        all->drift_middle[1][j] + moment_of_edge(traits, 1, j, other, of_b[0], of_b[1], of_b[2]);
    const lanes r =
        all->drift_middle[0][i] - moment_of_edge(traits, 0, i, one, of_a[0], of_a[1], of_a[2]);
    const lanes t = moment_of_edge(traits, 1, j, other, b[0][i], b[1][i], b[2][i]) +
                    moment_of_edge(traits, 0, i, one, a[0][j], a[1][j], a[2][j]);
    return (struct clip_crossing){inverse * (s - base_of_edge(traits, 0, i, one, column)),
                                  inverse * (r - base_of_edge(traits, 1, j, other, swing[i])),
                                  inverse * (t - all->edges.middle[i][j])};
}

/* Adds how far the crossings of edges reach, as find_reach(): outer, all that are possible; inner,
 * those that are certain. Returns the lanes in which one is possible, but not certain, or not known
 * to what the ends of the box may be apart. */
INLINE lanes_mask add_crossing_reach(const struct pair_lanes *pair,
                                     const struct kernel_traits traits,
                                     const struct box_search *search,
                                     const struct face_products side[2],
                                     const struct clip_crossings *all, int way, lanes reach[2][3])
{
    const struct box_frame *a = &search->frame[0], *b = &search->frame[1];
    const int parallel = parallel_count(traits, 1);
    const int crossings = parallel_count(traits, 0) * parallel;
    const lanes_mask drifts = pair->half_drift_size != 0;
    const double rounded = 4 * BOX_UNIT;
    lanes_mask vague = {0};
    for (int i = 0; i < edge_count(traits, 0); i++) {
        const lanes error_r = all->error[0][i];
        const lanes scale_error = pair->size[0][i] * all->scale_error;
        lanes error[3]; /* of products with edge i, for a weight of 1 of an edge of B */
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++) {
            const int u = next(axis), v = next(u);
            error[axis] =
                all->edge_error[u] * a->length[i][v] + all->edge_error[v] * a->length[i][u];
        }
        UNROLL(6)
        for (int j = 0; j < edge_count(traits, 1); j++) {
            const lanes error_s = all->error[1][j];
            const lanes error_t = dot(error, b->length[j]) + pair->size[1][j] * scale_error;
            const lanes least = 0x1p-20 * lanes_min(lanes_min(error_s, error_r), error_t);
            const lanes det = all->edges.swing[i][j];
            const lanes inverse = 1 / lanes_select(lanes_abs(det) >= least, det, least);
            const lanes size = lanes_abs(inverse);
            const lanes near_s = error_s * size, near_r = error_r * size, near_t = error_t * size;
            lanes width[3];
            UNROLL(3)
            for (int axis = 0; axis < 3; axis++)
                width[axis] =
                    near_s * lanes_abs(a->edge[i][axis]) + near_t * lanes_abs(a->travel[axis]);
            const lanes_mask wide =
                max_of_three(width[0], width[1], width[2]) > 0.5 * search->whole;
            UNROLL(16)
            for (int n = 0; n < crossings; n++) {
                const int one = n / parallel;
                const struct clip_crossing x =
                    crossing_of(traits, all, side, i, one, j, n % parallel, inverse);
                const lanes over_s = excess_of(traits, 0, x.s), over_r = excess_of(traits, 1, x.r),
                            over_t = lanes_abs(x.t) - 1;
                const lanes_mask possible =
                    max_of_three(over_s - near_s, over_r - near_r, over_t - near_t) <= rounded;
                const lanes_mask certain =
                    max_of_three(over_s + near_s, over_r + near_r, over_t + near_t) < -rounded;
                const lanes_mask counts = drifts & (way == CLIP_OUTER ? possible : certain);
                vague |= counts & (is_not(certain) | wide);
                UNROLL(3)
                for (int axis = 0; axis < 3; axis++) {
                    const lanes at[3] = {a->edge[0][axis], a->edge[1][axis], a->edge[2][axis]};
                    const lanes base = a->centre[axis] + base_of_edge(traits, 0, i, one, at);
                    const lanes middle = base + (x.s * a->edge[i][axis] + x.t * a->travel[axis]);
                    const lanes half =
                        lanes_select(counts, way == CLIP_OUTER ? width[axis] : -width[axis],
                                     lanes_of(-INFINITY));
                    reach[0][axis] = lanes_max(half - middle, reach[0][axis]);
                    reach[1][axis] = lanes_max(half + middle, reach[1][axis]);
                }
            }
        }
    }
    return vague;
}

/* ---- All of it ---- */

/* The ends of the box, from the reaches of both frames; slack: 1 or -1 times it is added. */
INLINE void join_ends(const struct box_search *search, const lanes reach[2][2][3], double slack,
                      lanes ends[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++)
        ends[end][axis] = lanes_max(reach[0][end][axis] + slack * search->slack[0][axis],
                                    reach[1][end][axis] + slack * search->slack[1][axis]);
}

/* Boxes, and in which lanes they are good. */
INLINE lanes_mask clip_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                           const struct box_places *places, struct box_search *search,
                           lanes box[2][3])
{
    struct face_products side[2];
    struct clip_spans spans[2];
    struct clip_crossings crossings;
    struct box_ends ends;
    lanes reach[2][2][3], weight_error[3];
    lanes_mask good = is_not(search->exact), vague = {0};
    if (!lanes_mask_bits(good & pair->in_range))
        return (lanes_mask){0};
    set_weight_errors(search, weight_error);
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        struct clip_slab slab[CLIP_SLABS_MAX];
        const int slabs = set_slabs(traits, pair, !which, weight_error, &side[!which], &good, slab);
        UNROLL(7)
        for (int direction = 0; direction < direction_count(traits, which); direction++)
            clip_segments(traits, which, direction, slab, slabs, &spans[which]);
        find_reach(traits, which, search, &spans[which], CLIP_OUTER, reach[which]);
        vague |= has_vague(traits, which, search, &spans[which]);
    }
    if (traits.drifts) {
        set_lengths(pair, traits, 0, &search->frame[0]);
        set_lengths(pair, traits, 1, &search->frame[1]);
        good &= set_crossings(pair, traits, search, &crossings);
        vague |= add_crossing_reach(pair, traits, search, side, &crossings, CLIP_OUTER, reach[0]);
    }
    join_ends(search, reach, 1, ends.outer);
    join_ends(search, reach, -1, ends.inner); /* of outer spans: within the limit, unless vague */
    if (lanes_mask_bits(vague)) {
        lanes inner[2][3];
        for (int which = 0; which < 2; which++)
            find_reach(traits, which, search, &spans[which], CLIP_INNER, reach[which]);
        if (traits.drifts)
            add_crossing_reach(pair, traits, search, side, &crossings, CLIP_INNER, reach[0]);
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
