/* Boxes of intersections from edges: two solids in contact, in 2D or 3D, at rest or moving, LANES
 * pairs at once.
 *
 * In: struct pair_lanes; struct box_search as begin_box() leaves it, or search_box() after that.
 *
 * Out: as search_box() (box_search.h).
 *
 * Steps (clip_box()):
 *   1. set_slabs()            the slabs whose intersection is a frame
 *   2. clip_segments()        clips the segments of the other frame to these slabs: widened by the
 *                             bound on their error (outer spans), and narrowed by it (inner spans)
 *   3. find_reach()           how far the outer spans reach along each axis
 *   4. uncertain_spans()      the lanes in which an inner span is too short for the limit
 *   5. set_crossings(), add_crossing_reach()
 *                             moving in 3D: how far crossings of edges reach
 *   6. 3 and 5 for the inner ends, in the lanes that 4 or 5 return
 *   7. put_box(), are_near()  (box_search.h)
 *
 * THE METHOD
 *
 * The intersection is a polytope in space and time, and its box is that of its vertices. At rest, a
 * vertex lies in the planes of three faces. At least two of them belong to the same frame, so the
 * vertex is on an edge of that frame, and in the other frame. Conversely, the part of an edge that
 * is in the other frame belongs to the intersection. So the box is that of all these parts.
 *
 * Where the frames move, time runs from -1 to 1 over the window, and a vertex is
 *
 *   - at the start or the end of the window, on an edge as at rest;
 *   - or in three faces of one frame: on the path of one of its vertices, and in the other frame;
 *   - or in two faces of each: where an edge of A crosses an edge of B.
 *
 * In 2D edges take the place of faces: a vertex at rest is on an edge of one frame, and in the
 * other; else it is at the start or the end, or on two edges of one frame, so on the path of one of
 * its vertices. There are no crossings.
 *
 * Segments are the edges at rest; or the edges at the start, those at the end, and the paths.
 *
 * A cuboid is the intersection of three slabs: |n . x| <= |n . c_k| with x seen from its centre
 * and n = c_i x c_j; in 2D of two, with the normals of its edges. A tetrahedron is that of four:
 * with n_k = c_i x c_j and D = n_k . c_k for any k, n_k . x / D is the barycentric coordinate of
 * c_k, from 0 to 1, as is the sum of all three. So |n . x - D / 2| <= |D| / 2, for each n_k and for
 * their sum, whatever the sign of D. A triangle is that of three likewise.
 *
 * Along a segment p + t a, the value of n . x, less that in the middle of a slab, is s + t d, with
 * d = n . a. On an edge of a simplex 0 <= t <= 1. Else -1 <= t <= 1, and a is half an edge of a
 * cuboid, or travel, half of the displacement in the window. With the radius r of the slab, t is
 * within r / |d| of -s / d. Like s and d, r is a distance times |n|.
 *
 * OUTER AND INNER ENDS OF SPANS
 *
 * The radius of a slab is r + E for the outer spans and r - E for the inner ones. E bounds the
 * error of s + t d and that of r together, for every t of the segment. So the part of the true
 * segment that is in the true other frame lies in the outer span, and contains the inner one. This
 * holds whether or not the frames as prepared are in contact. u = 2^-53. The roundings are counted
 * in 3D; in 2D there are fewer.
 *
 * 1. Products, beside those of the exact normal of the frame as prepared. With the weight W of n as
 *    in box_search.h, coordinates of n are rounded twice, and a product n . w three times more: 5 u
 *    W . |w|; twice more in the sum of three products, whose weight is the sum of theirs. D is
 *    computed once. Exactly, all n_k . c_k are equal and have the same monomials, so the bound for
 *    D holds with any k. Along an edge c_q - c_p, s has n . c_p, and d has n . c_q - n . c_p from
 *    the same products; in a sum of three, these are subtracted before they are added. With p = W .
 *    |c_p| and q = W . |c_q|, s + t d is off by at most 5 u ((1 - t) p + t q) for the products, 2 u
 *    p for the sum in s, and 3 u t (p + q) for the difference and the sum in d. This is linear in
 *    t: 7 u p at t = 0 and u (5 p + 8 q) at t = 1, so at most 8 u (p + q). (In terms of the larger
 *    of p and q it is up to 13 u: the bound needs the sum over all components.) Together at most
 *    8.1 u W . (the sum of the magnitudes of all vectors at hand).
 * 2. The offset is rounded 4 times, half the drift twice: 5 u times the magnitudes of what they are
 *    made of, and |n| is at most W.
 * 3. Sums and quotients: roundings of the products with n. s: 3 in sums, 2 more as a quotient. r +
 *    E: 1, 2 more as a quotient. d: 1 where it is a difference. The sum of the two quotients is off
 *    by u |t|, and so s + t d by u |d|, since |t| > 1 is cut off. Together at most 7 u times the
 *    sum of the magnitudes of D (or n . c_k), of n . (the offset), n . (half the drift), and n .
 *    (the components).
 * 4. Frames with errors: let e be the sum of the errors of both. Each point of a true segment is
 *    within the error of its frame of the same point of the computed one. A point x is in a true
 *    frame if the frame as prepared contains the ball around x whose radius is the error of the
 *    frame: otherwise m . x > h(m) for some direction m, with the support function h of the true
 *    frame; that of the frame as prepared is at most |m| times the error more, and the ball reaches
 *    that far beyond x. So |n| e is enough for both ends, and |n| is at most its scale. set_slab()
 *    has 1.01 e, for rounding.
 * 5. Where |d| < 2^-20 E', with E' = 1 to 3 together, 2^-20 E' takes the place of d, which changes
 *    s + t d by less than 2^-19 E'. E' is at least 2^-640 (else the lane is not good). What
 *    underflows is less than 100 * 2^-1074 * 2^405 < 2^-662 (slabs.c), and so less than 2^-20 E'
 *    too. E' covers both: it has 9 u where 1 needs 8.1, and 3 does not need all of its 7 u.
 *    Quotients with s are below 2^71, and never NAN; r / |d| may be infinite.
 * 6. With t from t_0 to t_1, p + t a is computed as p + (t_0 + t_1) (a / 2) +- (t_1 - t_0) |a / 2|.
 *    What p and a are made of is rounded at most 16 times in all, what the origin is made of 7
 *    times: less than the slack (box_search.h), which includes e.
 *
 * CROSSINGS
 *
 * Let p + s a be an edge of A and q + r b one of B, each seen from the reference point of its
 * frame; s and r are their parameters (no longer those of a slab). Let o be the offset, H =
 * travel_B - travel_A half the drift, and t the time. The edges cross where s a - r b - t H = g,
 * with g = o + q - p. With X = [a b H], the products of this equation with b x H, H x a and a x b
 * are
 *
 *     s X = [o b H] + [q b H] - [p b H]
 *
 *     r X = [o a H] + [q a H] - [p a H]
 *
 *     t X = (q x b) . a + (p x a) . b - [a b o].
 *
 * p x a and q x b are made of the normals of faces (moment_of_edge()).
 *
 * 7. Let N_s be the computed right side of the first equation, X the computed factor on its left,
 *    and W the weight of b x H. Where the true edges cross within the ranges of the parameters,
 *    |N_s - s X| <= E_s. E_s is the sum of a bound for rounding, derived here, and one for the
 *    errors of the frames (8). E_r and E_t likewise. A product of components is rounded 7 times (H
 *    2, cross product 2, dot product 3), and at most 4 times more: in the difference that b may be,
 *    in sums of products, and in N_s. So [o b H] is rounded 11 times, after 4 roundings of o
 *    itself; what q is made of, 10 times. If A is a simplex, let p = P and a = Q - P. In N_s - s X
 *    the products with P and Q, rounded 7 times, have the factors 1 - s and s: together 7 times the
 *    larger one. P is rounded twice more in N_s, P and Q twice more in X: at most 13 times the
 *    larger one, the farthest coordinate. If A is a cuboid, it is 10 times the sum of all
 *    components. So the rounding part of E_s is W . (13.1 u (|o| + the farthest coordinates) + 4.1
 *    u (what o is made of)); that of E_r is the same with the weight of a x H. In the third
 *    equation all of these, and H, are rounded at most 9 times.
 * 8. Frames with errors: every vertex is off by at most the frame's error (prepared.h). So at the
 *    same s, r and t, points of the true edges are off by at most e together, and N_s - s X by at
 *    most e |b x H|, the other part of E_s. scale_error has 1.01 e, for what 9 and 11 add.
 * 9. So s is within E_s / |X| of N_s / X, and p + s a + t travel_A is off along axis k by at most
 *    (E_s |a_k| + E_t |travel_A[k]|) / |X|. A crossing is possible if, within these errors, all
 *    parameters are in their ranges. So no crossing that is a vertex is lost, and the outer end of
 *    each is no less than the vertex. Quotients are rounded twice, and the distance from a range
 *    twice: 4 u where |s| <= 1. Beyond 1, |s| is at most 4 u more than 1 + E_s / |X|, and its
 *    excess is rounded by at most 4 u (E_s / |X| + 4 u). The constants of E_s, E_r and E_t are at
 *    least 0.7 % larger than 7 and 8 need (13.1 for 13), which covers this and 11.
 * 10. It is certain if each parameter is in its range by more than these errors. Then the true
 *    edges cross. First, as prepared: the range of s has the length 2 for a cuboid and 1 for a
 *    simplex, so |X| > E_s for a cuboid and |X| > 2 E_s for a simplex. The error of X is less: at
 *    most 8 u W . |a| < E_s for a cuboid, 9 u W . (|P| + |Q|) < 2 E_s for a simplex. So the exact X
 *    is not 0, and there is a crossing. If a parameter were out of its range by x, the bound of 7
 *    would grow by less than |X| x. So the crossing is within the ranges. Now move all vertices
 *    linearly from where they are as prepared to where they truly are. On the way, by 7 and 8, a
 *    crossing that is within the ranges is inside them by a margin. Were the exact X 0 somewhere on
 *    the way, the crossing would be one of a line of crossings, and this line leaves the ranges at
 *    a crossing without a margin. So X stays other than 0, and the crossing moves continuously and
 *    never leaves the ranges. So the inner end of each is no more than a true point.
 * 11. Where |X| is less than 2^-20 of the least of E_s, E_r and E_t, that takes its place, which
 *    changes s X by less than 2^-19 of each. scale_error has 2^-93 T in addition (T: slabs.c). With
 *    sizes of at least 2^-180 (else the lane is not good) all three are more than 2^-640, above all
 *    that underflows (5), and nothing overflows: quotients are below 2^500. Where H is 0, there are
 *    no crossings.
 * 12. Positions: what the components are made of is rounded at most 16 times, travel 17 times, the
 *    origin 7 times: less than the slack where |s| and |t| are at most 1. Their excess
 *    over 1 adds at most 17 u of the error of the position in 9, within the same 0.7 %.
 *
 * Where nothing rounds (slabs_exact.h), frames often touch, and inner spans are empty. Such lanes
 * are left to box_search.h, where determinants and products with n are then exact. */
#ifndef FMB_BOX_CLIP_H
#define FMB_BOX_CLIP_H

#include "box_search.h"

enum { CLIP_OUTER, CLIP_INNER, CLIP_BOUNDS };
enum { CLIP_SLABS_MAX = 4, CLIP_SEGMENTS_MAX = 32 };

/* A linear function of the points of a frame: a coordinate, or n . x from the middle of a slab. */
struct clip_form {
    lanes at[6];  /* [edge]: what it grows by along the edge */
    lanes middle; /* its value at the reference point in the middle of the window */
    lanes swing;  /* what it grows by from there to the end of the window */
};

/* A slab of one frame, as it is seen from the other. */
struct clip_slab {
    struct clip_form form;
    lanes radius[CLIP_BOUNDS]; /* [outer, inner]: surely not too small, surely not too large */
    lanes least;               /* takes the place of a smaller |d| (5) */
};

/* The parameters of a segment that remain, [from, to]; from > to: none. */
struct clip_span {
    lanes from, to;
};

/* The spans of the segments of a frame. */
struct clip_spans {
    struct clip_span part[CLIP_BOUNDS][CLIP_SEGMENTS_MAX];
};

/* Whether the boxes of a kind of pairs can be found in this way. */
INLINE bool can_be_clipped(const struct kernel_traits traits)
{
    return !traits.face[0] && !traits.face[1];
}

/* Whether the edges of moving frames have so many crossings, 72 or 144, that other ways come first.
 */
INLINE bool is_clipped_last(const struct kernel_traits traits)
{
    return traits.dim == 3 && traits.drifts && !(traits.simplex[0] && traits.simplex[1]);
}

INLINE lanes max_of_three(lanes x, lanes y, lanes z)
{
    return lanes_max(lanes_max(x, y), z);
}

/* ---- Segments ----
 *
 * They are numbered by their directions: those along edge e, at the start of the window and then at
 * its end; after all edges, the paths of the vertices. Loops over the directions are unrolled, but
 * for moving frames in 3D: code for each of their segments would not fit into the instruction
 * cache.
 */

/* Executes a statement with each direction of a frame. path: whether it is that of the paths, a
 * constant in each copy of the statement, so that its loops have a constant number of turns. */
#define EACH_DIRECTION(traits, which, direction, path, statement)                         \
    do {                                                                                  \
        if (traits.dim == 3 && traits.drifts) {                                           \
            for (int direction = 0; direction < edge_count(traits, which); direction++) { \
                const bool path = false;                                                  \
                statement;                                                                \
            }                                                                             \
        } else {                                                                          \
            const bool path = false;                                                      \
            UNROLL(6)                                                                     \
            for (int direction = 0; direction < edge_count(traits, which); direction++)   \
                statement;                                                                \
        }                                                                                 \
        if (traits.drifts) {                                                              \
            const int direction = edge_count(traits, which);                              \
            const bool path = true;                                                       \
            statement;                                                                    \
        }                                                                                 \
    } while (0)

/* How many edges of a frame have the same direction. */
INLINE int parallel_count(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] ? 1 : traits.dim == 2 ? 2 : 4;
}

INLINE int first_segment(const struct kernel_traits traits, int which, int direction)
{
    return direction * parallel_count(traits, which) * (traits.drifts ? 2 : 1);
}

INLINE int segment_count(const struct kernel_traits traits, int which, bool path)
{
    const int parallel = parallel_count(traits, which);
    if (path)
        return traits.simplex[which] ? traits.dim + 1 : 2 * parallel;
    return traits.drifts ? 2 * parallel : parallel;
}

INLINE lanes along_direction(int direction, bool path, const struct clip_form *form)
{
    return path ? form->swing : form->at[direction];
}

/* The value of a form at the base of edge n along e, less that at the reference point. The base is
 * the vertex at which an edge of a simplex begins, the midpoint of an edge of a cuboid. at:
 * [component], what the form grows by along each. */
INLINE lanes base_of_edge(const struct kernel_traits traits, int which, int e, int n,
                          const lanes at[3])
{
    if (traits.simplex[which])
        return e < traits.dim ? lanes_of(0) : at[edge_from(traits, e)];
    if (traits.dim == 2)
        return n == 0 ? -at[1 - e] : at[1 - e];
    const lanes u = at[next(e)], v = at[next(next(e))];
    return n == 0 ? -(u + v) : n == 1 ? -(u - v) : n == 2 ? u - v : u + v;
}

/* The values of a form at parameter 0 of the segments of a direction: at the first vertex of an
 * edge of a simplex, else in the middle of the segment. */
INLINE void set_bases(const struct kernel_traits traits, int which, int direction, bool path,
                      const struct clip_form *form, lanes base[8])
{
    const lanes *at = form->at;
    const int parallel = parallel_count(traits, which);
    if (path && traits.simplex[which]) {
        base[0] = form->middle;
        UNROLL(3)
        for (int i = 0; i < traits.dim; i++)
            base[1 + i] = form->middle + at[i];
        return;
    }
    if (path) {
        UNROLL(4)
        for (int n = 0; n < parallel; n++) {
            const lanes middle = form->middle + base_of_edge(traits, which, 0, n, at);
            base[n] = middle - at[0];
            base[parallel + n] = middle + at[0];
        }
        return;
    }
    UNROLL(4)
    for (int n = 0; n < parallel; n++) {
        const bool none = traits.simplex[which] && direction < traits.dim;
        const lanes middle =
            none ? form->middle : form->middle + base_of_edge(traits, which, direction, n, at);
        base[n] = traits.drifts ? middle - form->swing : middle;
        if (traits.drifts)
            base[parallel + n] = middle + form->swing;
    }
}

/* ---- Slabs ---- */

/* What 1 and 2 are for a weight of 1 along each axis. */
INLINE void set_weight_errors(const struct kernel_traits traits, const struct box_search *search,
                              lanes out[3])
{
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        out[axis] = (9 * BOX_UNIT) * search->size[axis] + (5 * BOX_UNIT) * search->offset_sum[axis];
}

INLINE void set_slab(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const struct box_normal *normal, const lanes weight_error[3], lanes_mask *good,
                     struct clip_slab *out)
{
    const lanes own = lanes_abs(normal->own), radius = traits.simplex[which] ? 0.5 * own : own;
    lanes sum = ((own + lanes_abs(normal->middle)) + lanes_abs(normal->at[0])) +
                (traits.dim == 2 ? lanes_abs(normal->at[1])
                                 : lanes_abs(normal->at[1]) + lanes_abs(normal->at[2]));
    if (traits.drifts)
        sum += lanes_abs(normal->swing);
    const lanes rounded = weight_of(traits, normal->weight, weight_error) + (7 * BOX_UNIT) * sum;
    const lanes error = rounded + 1.01 * normal->scale * pair->error;
    out->form.middle = traits.simplex[which] ? normal->middle - 0.5 * normal->own : normal->middle;
    out->form.swing = normal->swing;
    out->radius[CLIP_OUTER] = radius + error;
    out->radius[CLIP_INNER] = radius - error;
    out->least = 0x1p-20 * rounded;
    *good &= rounded >= 0x1p-640;
    UNROLL(6)
    for (int e = 0; e < edge_count(traits, !which); e++)
        out->form.at[e] = normal->at[e];
}

/* Sets the slabs of a frame, and in 3D its face products. Returns their number. */
INLINE int set_slabs(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                     const struct box_search *search, struct face_products *side, lanes_mask *good,
                     struct clip_slab slab[CLIP_SLABS_MAX])
{
    struct box_normal normals[4];
    lanes weight_error[3];
    set_weight_errors(traits, search, weight_error);
    if (traits.dim == 2) {
        set_plane_normals(pair, traits, which, &search->frame[which], normals);
    } else {
        set_face_products(pair, traits, which, side);
        set_normals(pair, traits, which, side, normals);
    }
    const int count = traits.simplex[which] ? traits.dim + 1 : traits.dim;
    UNROLL(4)
    for (int k = 0; k < count; k++)
        set_slab(traits, pair, which, &normals[k], weight_error, good, &slab[k]);
    return count;
}

/* The part of a span within [middle - half, middle + half]. */
INLINE struct clip_span clipped(struct clip_span span, lanes middle, lanes half)
{
    return (struct clip_span){lanes_max(middle - half, span.from),
                              lanes_min(middle + half, span.to)};
}

/* Clips the segments of a direction to the slabs of the other frame. */
INLINE void clip_segments(const struct kernel_traits traits, int which, int direction, bool path,
                          const struct clip_slab *slab, int slabs, struct clip_spans *out)
{
    const int count = segment_count(traits, which, path);
    const int first = first_segment(traits, which, direction);
    const bool from_vertex = traits.simplex[which] && !path;
    struct clip_span span[CLIP_BOUNDS][8];
    UNROLL(16)
    for (int n = 0; n < 16; n++)
        span[n / 8][n % 8] = (struct clip_span){lanes_of(from_vertex ? 0 : -1), lanes_of(1)};
    UNROLL(4)
    for (int k = 0; k < slabs; k++) {
        lanes base[8];
        const lanes d = along_direction(direction, path, &slab[k].form);
        const lanes negative = -1 / lanes_select(lanes_abs(d) >= slab[k].least, d, slab[k].least);
        const lanes outer = slab[k].radius[CLIP_OUTER] * lanes_abs(negative);
        const lanes inner = slab[k].radius[CLIP_INNER] * lanes_abs(negative);
        set_bases(traits, which, direction, path, &slab[k].form, base);
        UNROLL(8)
        for (int n = 0; n < count; n++) {
            const lanes middle = base[n] * negative;
            span[CLIP_OUTER][n] = clipped(span[CLIP_OUTER][n], middle, outer);
            span[CLIP_INNER][n] = clipped(span[CLIP_INNER][n], middle, inner);
        }
    }
    UNROLL(2)
    for (int bound = 0; bound < CLIP_BOUNDS; bound++)
        UNROLL(8)
    for (int n = 0; n < count; n++)
        out->part[bound][first + n] = span[bound][n];
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

/* Adds the spans of a direction to what reach holds of an axis, [below, above]. */
INLINE void add_reach(const struct kernel_traits traits, int which, int direction, bool path,
                      const struct clip_form *coordinate, const struct clip_spans *spans, int bound,
                      lanes *below, lanes *above)
{
    lanes base[8];
    const struct clip_span *part = &spans->part[bound][first_segment(traits, which, direction)];
    const lanes half = 0.5 * along_direction(direction, path, coordinate);
    set_bases(traits, which, direction, path, coordinate, base);
    UNROLL(8)
    for (int n = 0; n < segment_count(traits, which, path); n++) {
        const lanes from = part[n].from, to = part[n].to;
        const lanes sum = lanes_select(to >= from, to + from, lanes_of(NAN));
        const lanes middle = base[n] + sum * half;
        const lanes length = (to - from) * lanes_abs(half);
        *below = lanes_max(length - middle, *below);
        *above = lanes_max(length + middle, *above);
    }
}

/* How far the spans of a frame reach from 0, [below, above][axis]; -INFINITY if all are empty. */
INLINE void find_reach(const struct kernel_traits traits, int which,
                       const struct box_search *search, const struct clip_spans *spans, int bound,
                       lanes reach[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        struct clip_form coordinate;
        lanes *below = &reach[0][axis], *above = &reach[1][axis];
        set_coordinate(traits, which, axis, search, &coordinate);
        *below = *above = lanes_of(-INFINITY);
        EACH_DIRECTION(
            traits, which, direction, path,
            add_reach(traits, which, direction, path, &coordinate, spans, bound, below, above));
    }
}

INLINE lanes_mask uncertain_along(const struct kernel_traits traits, int which, int direction,
                                  bool path, const struct box_search *search,
                                  const struct clip_spans *spans)
{
    lanes_mask out = {0};
    const struct box_frame *frame = &search->frame[which];
    const lanes *a = path ? frame->travel : frame->edge[direction];
    const int first = first_segment(traits, which, direction);
    lanes longest = lanes_max(lanes_abs(a[0]), lanes_abs(a[1]));
    if (traits.dim == 3)
        longest = lanes_max(longest, lanes_abs(a[2]));
    UNROLL(8)
    for (int n = 0; n < segment_count(traits, which, path); n++) {
        const struct clip_span *outer = &spans->part[CLIP_OUTER][first + n];
        const struct clip_span *inner = &spans->part[CLIP_INNER][first + n];
        const lanes length = outer->to - outer->from, certain = inner->to - inner->from;
        const lanes_mask near = (certain >= 0) & ((length - certain) * longest <= search->whole);
        out |= (length >= 0) & is_not(near);
    }
    return out;
}

/* The lanes in which, for some segment with an outer span that is not empty, the inner span is
 * empty, or shorter by more than search->whole along some axis. */
INLINE lanes_mask uncertain_spans(const struct kernel_traits traits, int which,
                                  const struct box_search *search, const struct clip_spans *spans)
{
    lanes_mask out = {0};
    EACH_DIRECTION(traits, which, direction, path,
                   out |= uncertain_along(traits, which, direction, path, search, spans));
    return out;
}

/* ---- Crossings ---- */

/* What all crossings of a pair have in common. */
struct clip_crossings {
    struct edge_products edges;
    lanes drift_middle[2][6]; /* [frame][edge]: (half_drift x offset) . edge */
    lanes error[2][6];        /* [frame][edge]: E_r for an edge of A, E_s for an edge of B */
    lanes edge_error[3]; /* [axis]: rounding part of E_t, for a weight of 1 of a x b along it */
    lanes scale_error;   /* 1.01 e + 2^-93 T: the other part, for a scale of 1 */
};

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

/* Returns the lanes in which every edge, and a drift that is not 0, has a size of at least 2^-180
 * (11). */
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

/* The edges along one direction of A, [edge]: their bases, and their parts of r X, and of s X and t
 * X of their crossings with edges along j of B. */
struct clip_edges_of_a {
    lanes base[4][3];
    lanes r[4], s[4][6], t[4][6]; /* [edge], [edge][j] */
};

INLINE void set_edges_of_a(const struct kernel_traits traits, const struct clip_crossings *all,
                           const struct face_products *side, const struct box_frame *a, int i,
                           struct clip_edges_of_a *out)
{
    const lanes(*swing)[6] = all->edges.swing, (*other)[6] = side->other;
    UNROLL(4)
    for (int n = 0; n < parallel_count(traits, 0); n++) {
        out->r[n] = all->drift_middle[0][i] -
                    moment_of_edge(traits, 0, i, n, side->swing[0], side->swing[1], side->swing[2]);
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++) {
            const lanes at[3] = {a->edge[0][axis], a->edge[1][axis], a->edge[2][axis]};
            out->base[n][axis] = a->centre[axis] + base_of_edge(traits, 0, i, n, at);
        }
        UNROLL(6)
        for (int j = 0; j < edge_count(traits, 1); j++) {
            const lanes at[3] = {swing[0][j], swing[1][j], swing[2][j]};
            out->s[n][j] = base_of_edge(traits, 0, i, n, at);
            out->t[n][j] = moment_of_edge(traits, 0, i, n, other[0][j], other[1][j], other[2][j]);
        }
    }
}

/* The edges along j of B, [edge]: their parts of r X, s X and t X of their crossings with edges
 * along i of A. */
struct clip_edges_of_b {
    lanes r[4], s[4], t[4];
};

INLINE void set_edges_of_b(const struct kernel_traits traits, const struct clip_crossings *all,
                           const struct face_products *side, int i, int j,
                           struct clip_edges_of_b *out)
{
    const lanes *drift = side->swing, (*other)[6] = side->other;
    UNROLL(4)
    for (int n = 0; n < parallel_count(traits, 1); n++) {
        out->r[n] = base_of_edge(traits, 1, j, n, all->edges.swing[i]);
        out->s[n] =
            all->drift_middle[1][j] + moment_of_edge(traits, 1, j, n, drift[0], drift[1], drift[2]);
        out->t[n] = moment_of_edge(traits, 1, j, n, other[0][i], other[1][i], other[2][i]);
    }
}

/* Adds the crossings of edges to the reach of A (find_reach()): for CLIP_OUTER those that are
 * possible, for CLIP_INNER those that are certain. Returns the lanes in which one of these is not
 * certain, or has a position that is not known to within search->whole. */
INLINE lanes_mask add_crossing_reach(const struct pair_lanes *pair,
                                     const struct kernel_traits traits,
                                     const struct box_search *search,
                                     const struct face_products side[2],
                                     const struct clip_crossings *all, int bound, lanes reach[2][3])
{
    const struct box_frame *a = &search->frame[0], *b = &search->frame[1];
    const int parallel_a = parallel_count(traits, 0), parallel_b = parallel_count(traits, 1);
    const lanes_mask drifts = pair->half_drift_size != 0;
    const double rounded = 4 * BOX_UNIT;
    lanes_mask uncertain = {0};
    for (int i = 0; i < edge_count(traits, 0); i++) {
        struct clip_edges_of_a of_a;
        struct clip_edges_of_b of_b;
        const lanes error_r = all->error[0][i];
        const lanes scale_error = pair->size[0][i] * all->scale_error;
        lanes error[3]; /* [axis]: rounding part of E_t, for an edge of B of length 1 along it */
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++) {
            const int u = next(axis), v = next(u);
            error[axis] =
                all->edge_error[u] * a->length[i][v] + all->edge_error[v] * a->length[i][u];
        }
        set_edges_of_a(traits, all, &side[0], a, i, &of_a);
        for (int j = 0; j < edge_count(traits, 1); j++) {
            const lanes error_s = all->error[1][j];
            const lanes error_t = dot(error, b->length[j]) + pair->size[1][j] * scale_error;
            const lanes least = 0x1p-20 * lanes_min(lanes_min(error_s, error_r), error_t);
            const lanes det = all->edges.swing[i][j];
            const lanes inverse = 1 / lanes_select(lanes_abs(det) >= least, det, least);
            const lanes size = lanes_abs(inverse);
            const lanes radius_s = error_s * size, radius_r = error_r * size,
                        radius_t = error_t * size;
            lanes radius[3];
            UNROLL(3)
            for (int axis = 0; axis < 3; axis++)
                radius[axis] =
                    radius_s * lanes_abs(a->edge[i][axis]) + radius_t * lanes_abs(a->travel[axis]);
            const lanes_mask wide =
                max_of_three(radius[0], radius[1], radius[2]) > 0.5 * search->whole;
            set_edges_of_b(traits, all, &side[1], i, j, &of_b);
            UNROLL(16)
            for (int index = 0; index < parallel_a * parallel_b; index++) {
                const int m = index / parallel_b, n = index % parallel_b;
                const lanes s = inverse * (of_b.s[n] - of_a.s[m][j]);
                const lanes r = inverse * (of_a.r[m] - of_b.r[n]);
                const lanes t = inverse * ((of_b.t[n] + of_a.t[m][j]) - all->edges.middle[i][j]);
                const lanes over_s = excess_of(traits, 0, s), over_r = excess_of(traits, 1, r),
                            over_t = lanes_abs(t) - 1;
                const lanes_mask possible = max_of_three(over_s - radius_s, over_r - radius_r,
                                                         over_t - radius_t) <= rounded;
                const lanes_mask certain = max_of_three(over_s + radius_s, over_r + radius_r,
                                                        over_t + radius_t) < -rounded;
                const lanes_mask counts = drifts & (bound == CLIP_OUTER ? possible : certain);
                uncertain |= counts & (is_not(certain) | wide);
                UNROLL(3)
                for (int axis = 0; axis < 3; axis++) {
                    const lanes middle =
                        of_a.base[m][axis] + (s * a->edge[i][axis] + t * a->travel[axis]);
                    const lanes half =
                        lanes_select(counts, bound == CLIP_OUTER ? radius[axis] : -radius[axis],
                                     lanes_of(-INFINITY));
                    reach[0][axis] = lanes_max(half - middle, reach[0][axis]);
                    reach[1][axis] = lanes_max(half + middle, reach[1][axis]);
                }
            }
        }
    }
    return uncertain;
}

/* ---- All of it ---- */

/* The ends of the box: for each, the farther reach of the two frames, with the slack added (sign =
 * 1) or subtracted (sign = -1). */
INLINE void join_ends(const struct kernel_traits traits, const struct box_search *search,
                      const lanes reach[2][2][3], double sign, lanes ends[2][3])
{
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++)
        ends[end][axis] = lanes_max(reach[0][end][axis] + sign * search->slack[0][axis],
                                    reach[1][end][axis] + sign * search->slack[1][axis]);
}

/* Clips a frame to the other one. Out: other, the face products of that; spans; reach, of the outer
 * spans. Returns the lanes of uncertain_spans(). */
INLINE lanes_mask clip_frame(const struct pair_lanes *pair, const struct kernel_traits traits,
                             int which, const struct box_search *search,
                             struct face_products *other, lanes_mask *good,
                             struct clip_spans *spans, lanes reach[2][3])
{
    struct clip_slab slab[CLIP_SLABS_MAX];
    const int slabs = set_slabs(traits, pair, !which, search, other, good, slab);
    EACH_DIRECTION(traits, which, direction, path,
                   clip_segments(traits, which, direction, path, slab, slabs, spans));
    find_reach(traits, which, search, spans, CLIP_OUTER, reach);
    return uncertain_spans(traits, which, search, spans);
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
    lanes reach[2][2][3];
    lanes_mask good = is_not(search->exact), uncertain;
    if (!lanes_mask_bits(good & pair->in_range))
        return (lanes_mask){0};
    if (traits.dim == 2 || traits.drifts) {
        set_lengths(pair, traits, 0, &search->frame[0]);
        set_lengths(pair, traits, 1, &search->frame[1]);
    }
    uncertain = clip_frame(pair, traits, 0, search, &side[1], &good, &spans[0], reach[0]);
    uncertain |= clip_frame(pair, traits, 1, search, &side[0], &good, &spans[1], reach[1]);
    if (traits.dim == 3 && traits.drifts) {
        good &= set_crossings(pair, traits, search, &crossings);
        uncertain |=
            add_crossing_reach(pair, traits, search, side, &crossings, CLIP_OUTER, reach[0]);
    }
    join_ends(traits, search, reach, 1, ends.outer);
    /* Where not uncertain, these are within search->whole of the true ends. */
    join_ends(traits, search, reach, -1, ends.inner);
    if (lanes_mask_bits(uncertain)) {
        lanes inner[2][3];
        find_reach(traits, 0, search, &spans[0], CLIP_INNER, reach[0]);
        find_reach(traits, 1, search, &spans[1], CLIP_INNER, reach[1]);
        if (traits.dim == 3 && traits.drifts)
            add_crossing_reach(pair, traits, search, side, &crossings, CLIP_INNER, reach[0]);
        join_ends(traits, search, reach, -1, inner);
        UNROLL(3)
        for (int axis = 0; axis < traits.dim; axis++)
            UNROLL(2)
        for (int end = 0; end < 2; end++)
            ends.inner[end][axis] =
                lanes_select(uncertain, inner[end][axis], ends.inner[end][axis]);
    }
    put_box(pair, traits, places, search, &ends, box);
    return are_near(traits, search, &ends) & good;
}

#endif
