/* Boxes of intersections from edges: two frames in contact, in 2D or 3D, at rest or moving, LANES
 * pairs at once.
 *
 * In: struct pair_lanes; struct box_pair as begin_box() leaves it (box_ends.h).
 *
 * Out: struct box_ends, and the lanes in which all ends are within the limit.
 *
 * Steps (clip_box()):
 *   1. set_plane_slabs(),     the slabs whose intersection is a frame
 *      set_space_slabs()
 *   2. clip_segments()        clips the segments of the other frame to these slabs: widened by the
 *                             bound on their error (outer spans), and narrowed by it (inner spans)
 *   3. add_reach(),           how far the outer spans reach along each axis; moving in 3D, also the
 *      add_crossings()        crossings of edges that are possible
 *   4. the same for the inner spans and crossings that are certain, in the lanes in which some
 *      outer one is not nearly as certain
 *   5. add_middles()          on request, the mean of middles of outer spans and of crossings: a
 *                             point that both frames contain, and its time
 *
 * Not here: why these points span the box, and the derivation of every error bound: BOXES.md, to
 * which the numbers (1) to (12) below refer; what follows from the ends (box_ends.h); the same in
 * integers (limbs/limbs_box.h). */
#ifndef FMB_BOX_CLIP_H
#define FMB_BOX_CLIP_H

#include "box_ends.h"

/* Bounds the error of a value by the sum of the magnitudes of its monomials (BOXES.md, 1 and 8). */
#define BOX_ROUNDING (33.1 * BOX_UNIT)

/* How much larger weights are in the plane of a face (1). */
#define BOX_IN_FACE 1.3

/* Spans shorter than this may be points, and are not certain (5). */
#define CLIP_SHORTEST 0x1p-48

/* Factor on the errors of frames; what exceeds 1 covers rounding (3, 8). */
#define BOX_FRAME_ERROR 1.01

/* Underflow is negligible beside an error of CLIP_LEAST_ERROR (6). The errors of crossings are that
 * large by adding CLIP_UNDERFLOW T, if no edge is shorter than CLIP_LEAST_SIZE (11). */
#define CLIP_LEAST_ERROR 0x1p-640
#define CLIP_UNDERFLOW 0x1p-93
#define CLIP_LEAST_SIZE 0x1p-180

/* A factor X below this may be 0. */
#define CLIP_LEAST_FACTOR 0x1p-1000

/* T, or its inverse, up to which products of two numbers do not overflow or underflow (5). */
#define CLIP_EXACT_RANGE 0x1p100

/* The largest error of a time of the mean. Times go from -1 to 1, so this is 0.45e-12 of the
 * window; fmb.h allows 1e-12 of it (12). */
#define CLIP_TIME 0.9e-12

enum { CLIP_OUTER, CLIP_INNER, CLIP_BOUNDS };
enum { CLIP_SLABS = 4, CLIP_VERTICES = 16, CLIP_SEGMENTS = 32, CLIP_DIRECTIONS = 7 };

/* ---- Segments ---- */

/* The segments of a frame: each goes from a vertex to another, in the direction of an edge, by
 * index, or, after all edges, of the path. A vertex of a cuboid is the sum of the components whose
 * bits are set; of a simplex, the origin, then the end of each component. If the kind drifts,
 * vertices at the end of the window follow those at its start. */
struct clip_wire {
    int vertices, segments, directions;
    unsigned char from[CLIP_SEGMENTS], to[CLIP_SEGMENTS], direction[CLIP_SEGMENTS];
};

INLINE int vertex_count(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] ? component_count(traits, which) + 1 : 1 << traits.dim;
}

INLINE void add_segment(struct clip_wire *wire, int from, int to, int direction)
{
    wire->from[wire->segments] = (unsigned char) from;
    wire->to[wire->segments] = (unsigned char) to;
    wire->direction[wire->segments++] = (unsigned char) direction;
}

INLINE void set_wire(const struct kernel_traits traits, int which, struct clip_wire *out)
{
    const int edges = edge_count(traits, which);
    out->vertices = vertex_count(traits, which);
    out->directions = traits.drifts ? edges + 1 : edges;
    out->segments = 0;
    for (int end = 0; end < (traits.drifts ? 2 : 1); end++)
        for (int index = 0; index < edges; index++) {
            const int e = edge_at(traits, which, index), first = end * out->vertices;
            if (traits.simplex[which])
                add_segment(out, first + (e < traits.dim ? 0 : 1 + edge_from(traits, e)),
                            first + 1 + (e < traits.dim ? e : edge_to(traits, e)), index);
            for (int v = 0; v < out->vertices && !traits.simplex[which]; v++)
                if (!(v >> e & 1))
                    add_segment(out, first + v, first + (v | 1 << e), index);
        }
    for (int v = 0; v < out->vertices && traits.drifts; v++)
        add_segment(out, v, out->vertices + v, edges);
}

/* Sets out[v] for all vertices of a frame. In: the value at the reference point in the middle of
 * the window, what it grows by along each component, and from there to the end of the window. */
INLINE void set_at_vertices(const struct kernel_traits traits, int which, lanes middle,
                            const lanes at[3], lanes swing, lanes out[CLIP_VERTICES])
{
    const int vertices = vertex_count(traits, which);
    out[0] = middle;
    for (int i = 0; i < component_count(traits, which); i++) {
        if (traits.simplex[which]) {
            out[1 + i] = middle + at[i];
            continue;
        }
        for (int v = 0; v < 1 << i; v++) {
            out[v | 1 << i] = out[v] + at[i];
            out[v] -= at[i];
        }
    }
    for (int v = 0; v < vertices && traits.drifts; v++) {
        out[vertices + v] = out[v] + swing;
        out[v] -= swing;
    }
}

/* Sets out[direction], what a value grows by along each direction. */
INLINE void set_along_directions(const struct kernel_traits traits, int which, const lanes at[3],
                                 lanes swing, lanes out[CLIP_DIRECTIONS])
{
    const int edges = edge_count(traits, which);
    for (int index = 0; index < edges; index++) {
        const int e = edge_at(traits, which, index);
        out[index] = !traits.simplex[which] ? at[e] + at[e]
                     : e < traits.dim       ? at[e]
                                            : at[edge_to(traits, e)] - at[edge_from(traits, e)];
    }
    if (traits.drifts)
        out[edges] = swing + swing;
}

/* ---- Slabs ---- */

/* The cross product with all signs positive. */
INLINE void cross_weight(const lanes u[3], const lanes v[3], lanes out[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = next(k), j = next(i);
        out[k] = lanes_abs(u[i] * v[j]) + lanes_abs(u[j] * v[i]);
    }
}

/* A slab of one frame, from low to high, and the values of the other frame in it. */
struct clip_slab {
    lanes low, high;
    lanes middle, swing, at[3]; /* of the reference point, the drift, the components */
    lanes weight[3], scale;     /* of the normal */
    bool exact;                 /* in lanes in which nothing rounds */
};

/* Sets the bounds to 0 and own, and turns the normal so that own >= 0; of a cuboid, -own and own.
 */
INLINE void set_bounds(const struct kernel_traits traits, int which, lanes own,
                       struct clip_slab *out)
{
    out->high = lanes_abs(own);
    out->low = traits.simplex[which] ? lanes_of(0) : -out->high;
    out->exact = true;
    if (!traits.simplex[which])
        return;
    out->middle = with_sign_of(out->middle, own);
    out->swing = with_sign_of(out->swing, own);
    for (int j = 0; j < 3; j++)
        out->at[j] = with_sign_of(out->at[j], own);
}

/* The edges of a frame in 2D. */
INLINE int set_plane_slabs(const struct pair_lanes *pair, const struct kernel_traits traits,
                           int which, const struct box_frame *frame, struct clip_slab *out)
{
    struct edge_products_2d edges;
    const lanes area = product(pair->component[which][0], pair->component[which][1]);
    set_edge_products_2d(pair, traits, which, &edges);
    for (int e = 0; e < edge_count(traits, which); e++) {
        lanes length[2];
        for (int axis = 0; axis < 2; axis++)
            length[axis] = e < 2
                               ? lanes_abs(frame->edge[e][axis])
                               : lanes_abs(frame->edge[0][axis]) + lanes_abs(frame->edge[1][axis]);
        out[e] = (struct clip_slab){.middle = which ? -edges.middle[e] : edges.middle[e],
                                    .swing = which ? -edges.swing[e] : edges.swing[e],
                                    .at = {edges.other[e][0], edges.other[e][1]},
                                    .weight = {length[1], length[0]},
                                    .scale = pair->size[which][e]};
        set_bounds(traits, which, e == 0 ? area : -area, &out[e]);
    }
    return edge_count(traits, which);
}

/* out := the sum of two or three normals. */
INLINE void add_normals(const struct clip_slab *slab, int count, struct clip_slab *out)
{
    *out = slab[0];
    for (int k = 1; k < count; k++) {
        out->middle += slab[k].middle;
        out->swing += slab[k].swing;
        out->scale += slab[k].scale;
        for (int axis = 0; axis < 3; axis++) {
            out->at[axis] += slab[k].at[axis];
            out->weight[axis] += slab[k].weight[axis];
        }
    }
}

/* Within the plane of a face, with the normal n: the coordinate along c_0 has the normal c_1 x n,
 * that along c_1 n x c_0, and |n|^2 at 1. */
INLINE void set_face_slab(const struct pair_lanes *pair, const struct kernel_traits traits,
                          int which, int i, const struct face_products *side,
                          const struct clip_slab *plane, struct clip_slab *out)
{
    const lanes(*c)[3] = pair->component[which];
    lanes normal[3];
    if (i == 0)
        cross(c[1], side->normal[2], normal);
    else
        cross(side->normal[2], c[0], normal);
    const lanes middle = dot(normal, pair->offset), swing = dot(normal, pair->half_drift);
    *out = (struct clip_slab){.middle = which ? -middle : middle,
                              .swing = which ? -swing : swing,
                              .scale = pair->size[which][1 - i] * plane->scale};
    cross_weight(c[1 - i], plane->weight, out->weight);
    for (int axis = 0; axis < 3; axis++)
        out->weight[axis] *= BOX_IN_FACE;
    for (int j = 0; j < component_count(traits, !which); j++)
        out->at[j] = dot(normal, pair->component[!which][j]);
    set_bounds(traits, which, dot(side->normal[2], side->normal[2]), out);
    out->exact = false;
}

/* The faces of a solid: those of two components, then the one across from the origin. A face has
 * three edges in its plane, and the plane. */
INLINE int set_space_slabs(const struct pair_lanes *pair, const struct kernel_traits traits,
                           int which, struct face_products *side, struct clip_slab *out)
{
    set_face_products(pair, traits, which, side);
    for (int k = first_plane(traits, which); k < 3; k++) {
        struct clip_slab *slab = &out[traits.face[which] ? 3 : k];
        const int i = next(k), j = next(i);
        *slab = (struct clip_slab){.middle = which ? -side->middle[k] : side->middle[k],
                                   .swing = which ? -side->swing[k] : side->swing[k],
                                   .at = {side->other[k][0], side->other[k][1], side->other[k][2]},
                                   .scale = pair->size[which][i] * pair->size[which][j]};
        cross_weight(pair->component[which][i], pair->component[which][j], slab->weight);
        set_bounds(traits, which, side->volume, slab);
    }
    if (traits.face[which]) {
        for (int i = 0; i < 2; i++)
            set_face_slab(pair, traits, which, i, side, &out[3], &out[i]);
        add_normals(out, 2, &out[2]);
    } else if (traits.simplex[which]) {
        add_normals(out, 3, &out[3]);
    }
    return traits.simplex[which] ? 4 : 3;
}

/* ---- Spans ---- */

/* How the slabs of one frame clip the segments of the other. */
struct clip_values {
    /* [slab][vertex]: what is left to the bounds of the slab, moved outward or inward. */
    lanes low[CLIP_BOUNDS][CLIP_SLABS][CLIP_VERTICES], high[CLIP_BOUNDS][CLIP_SLABS][CLIP_VERTICES];
    lanes along[CLIP_SLABS][CLIP_DIRECTIONS], inverse[CLIP_SLABS][CLIP_DIRECTIONS]; /* growth */
    lanes_mask exact; /* the order of quotients can be found (5) */
    bool any_exact;
};

/* The parameters of a segment that remain, [from, to], from 0 to 1; from is NAN: none. */
struct clip_span {
    lanes from, to;
};

/* The spans of the segments of a frame. */
struct clip_spans {
    struct clip_span part[CLIP_BOUNDS][CLIP_SEGMENTS];
};

INLINE void set_values(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                       const struct box_pair *box, const struct clip_slab *slab, int k,
                       lanes_mask *good, struct clip_values *out)
{
    const int vertices = vertex_count(traits, which) * (traits.drifts ? 2 : 1);
    lanes at[CLIP_VERTICES], along[CLIP_DIRECTIONS], weight = slab->weight[0] * box->reach[0];
    for (int axis = 1; axis < traits.dim; axis++)
        weight += slab->weight[axis] * box->reach[axis];
    const lanes rounded = BOX_ROUNDING * weight;
    const lanes_mask exact = slab->exact ? box->exact : (lanes_mask){0};
    const lanes error =
        lanes_select(exact, lanes_of(0), rounded + BOX_FRAME_ERROR * slab->scale * pair->error);
    const lanes_mask solid = traits.face[!which] && k == 3 ? is_not((lanes_mask){0})
                                                           : (lanes_mask) (slab->high > slab->low);
    *good &= (exact & solid) | (is_not(exact) & (rounded >= CLIP_LEAST_ERROR));
    set_at_vertices(traits, which, slab->middle, slab->at, slab->swing, at);
    set_along_directions(traits, which, slab->at, slab->swing, along);
    for (int v = 0; v < vertices; v++) {
        const lanes low = slab->low - at[v], high = slab->high - at[v];
        out->low[CLIP_OUTER][k][v] = low - error;
        out->low[CLIP_INNER][k][v] = low + error;
        out->high[CLIP_OUTER][k][v] = high + error;
        out->high[CLIP_INNER][k][v] = high - error;
    }
    for (int d = 0; d < edge_count(traits, which) + (traits.drifts ? 1 : 0); d++) {
        out->along[k][d] = along[d] + 0.0;
        out->inverse[k][d] = 1 / out->along[k][d]; /* of 0: +INFINITY */
    }
}

/* Two cuboids: replaces the values of slab k of a frame in the lanes in which its normal is a
 * coordinate axis, by exact differences along that axis (7). which: the other frame. */
INLINE void set_level_values(const struct kernel_traits traits, const struct pair_lanes *pair,
                             int which, const struct box_places *places, int k, int axis,
                             struct clip_values *out)
{
    const int vertices = vertex_count(traits, which);
    const lanes(*own)[3] = pair->component[!which], (*other)[3] = pair->component[which];
    const lanes(*apart)[2] = places->apart[axis];
    lanes_mask level = places->level[axis];
    lanes at[CLIP_VERTICES], component[3];
    for (int i = 0; i < traits.dim; i++) {
        level &= i == (traits.dim == 2 ? 1 - k : k) ? own[i][axis] != 0 : own[i][axis] == 0;
        component[i] = other[i][axis];
    }
    if (!lanes_mask_bits(level))
        return;
    set_at_vertices(traits, which, lanes_of(0), component, lanes_of(0), at);
    for (int v = 0; v < vertices * (traits.drifts ? 2 : 1); v++) {
        const lanes_mask above = at[v] > 0;
        const lanes low = which ? -lanes_select(above, apart[0][1], apart[0][0])
                                : lanes_select(above, apart[1][0], apart[0][0]);
        const lanes high = which ? -lanes_select(above, apart[1][1], apart[1][0])
                                 : lanes_select(above, apart[1][1], apart[0][1]);
        for (int bound = 0; bound < CLIP_BOUNDS; bound++) {
            out->low[bound][k][v] = lanes_select(level, low, out->low[bound][k][v]);
            out->high[bound][k][v] = lanes_select(level, high, out->high[bound][k][v]);
        }
    }
    for (int d = 0; d < traits.dim + (traits.drifts ? 1 : 0); d++) {
        const lanes along = d < traits.dim ? component[d] + 0.0 : lanes_of(0);
        out->along[k][d] = lanes_select(level, along, out->along[k][d]);
        out->inverse[k][d] = lanes_select(level, 1 / along, out->inverse[k][d]);
    }
}

/* The part of a span within slab k. On a bound with a value that does not change, the product is
 * NAN: nothing is clipped. */
INLINE struct clip_span clipped(const struct clip_values *values, int bound, int k, int v, int d,
                                struct clip_span span)
{
    const lanes inverse = values->inverse[k][d];
    const lanes_mask up = inverse > 0;
    const lanes low = values->low[bound][k][v], high = values->high[bound][k][v];
    const lanes first = lanes_select(up, low, high) * inverse;
    const lanes last = lanes_select(up, high, low) * inverse;
    return (struct clip_span){lanes_max(first, span.from), lanes_min(last, span.to)};
}

/* The lanes in which x y <= z w. In: these products and their errors neither overflow nor
 * underflow. */
INLINE lanes_mask is_no_more(lanes x, lanes y, lanes z, lanes w)
{
    const lanes one = x * y, other = z * w;
    return (one - other) + (product_error(x, y, one) - product_error(z, w, other)) <= 0;
}

/* Where nothing rounds: the lanes in which a segment enters each slab no later than it leaves any.
 * With what is left to the bounds at its start, a to that where it enters and b to the other, and
 * the growth g >= 0 of the value, it is in slab i from a_i / g_i to b_i / g_i. */
INLINE lanes_mask enters_in_time(const struct clip_values *values, int slabs, int v, int d)
{
    lanes a[CLIP_SLABS], b[CLIP_SLABS], g[CLIP_SLABS];
    lanes_mask out = is_not((lanes_mask){0});
    for (int k = 0; k < slabs; k++) {
        const lanes along = values->along[k][d];
        const lanes low = values->low[CLIP_OUTER][k][v], high = values->high[CLIP_OUTER][k][v];
        a[k] = lanes_select(along < 0, -high, low);
        b[k] = lanes_select(along < 0, -low, high);
        g[k] = lanes_abs(along);
        out &= (a[k] <= g[k]) & (b[k] >= 0);
    }
    for (int i = 0; i < slabs; i++)
        for (int j = 0; j < slabs; j++)
            out &= is_no_more(a[i], g[j], b[j], g[i]);
    return out;
}

/* The span, or none if it is shorter than so much. */
INLINE struct clip_span at_least(struct clip_span span, double length)
{
    span.from = lanes_select(span.to - span.from >= length, span.from, lanes_of(NAN));
    return span;
}

/* Clips a segment. plane: the last slab is the plane of a face. The inner span then is the range in
 * which the segment surely crosses the face, from its end to its start. */
INLINE void clip_segment(const struct clip_values *values, int slabs, bool plane, int v, int d,
                         struct clip_span *out_outer, struct clip_span *out_inner)
{
    const struct clip_span whole = {lanes_of(0), lanes_of(1)};
    struct clip_span outer = whole, inner = whole;
    for (int k = 0; k < (plane ? slabs - 1 : slabs); k++) {
        CHECK_SEGMENT(BOX_ROUNDING, values, k, v, d);
        outer = clipped(values, CLIP_OUTER, k, v, d, outer);
        inner = clipped(values, CLIP_INNER, k, v, d, inner);
    }
    if (plane) {
        const struct clip_span all = {lanes_of(-INFINITY), lanes_of(INFINITY)};
        CHECK_SEGMENT(BOX_ROUNDING, values, slabs - 1, v, d);
        const struct clip_span at = clipped(values, CLIP_OUTER, slabs - 1, v, d, all);
        const lanes_mask crosses =
            (at.from - inner.from >= CLIP_SHORTEST) & (inner.to - at.to >= CLIP_SHORTEST);
        outer.from = lanes_max(at.from, outer.from);
        outer.to = lanes_min(at.to, outer.to);
        inner.from = lanes_select(crosses, at.to, lanes_of(NAN));
        inner.to = at.from;
    } else {
        inner = at_least(inner, CLIP_SHORTEST);
    }
    outer = at_least(outer, -CLIP_SHORTEST);
    const lanes_mask ties = values->exact & (outer.to - outer.from < CLIP_SHORTEST);
    if (!plane && values->any_exact && lanes_mask_bits(ties)) {
        const lanes_mask in_time = enters_in_time(values, slabs, v, d);
        outer.from = lanes_select(ties & is_not(in_time), lanes_of(NAN), outer.from);
        inner.from = lanes_select(ties, outer.from, inner.from);
    }
    *out_outer = outer;
    *out_inner = inner;
}

/* Clips the segments of a frame. Returns the lanes in which, for some segment with an outer span,
 * there is no inner span, or one that is shorter by more than box->whole along some axis. */
INLINE lanes_mask clip_segments(const struct clip_wire *wire, const struct clip_values *values,
                                int slabs, bool plane, const lanes longest[CLIP_DIRECTIONS],
                                const struct box_pair *box, struct clip_spans *out)
{
    lanes_mask uncertain = {0};
    for (int n = 0; n < wire->segments; n++) {
        const int v = wire->from[n], d = wire->direction[n];
        struct clip_span *outer = &out->part[CLIP_OUTER][n], *inner = &out->part[CLIP_INNER][n];
        clip_segment(values, slabs, plane, v, d, outer, inner);
        const lanes lost = (outer->to - outer->from) - (inner->to - inner->from);
        const lanes_mask near = lost * longest[d] <= box->whole;
        uncertain |= (outer->from == outer->from) & is_not(near);
    }
    return uncertain;
}

/* ---- Reach ---- */

/* Where the vertices of a frame are, and its directions. */
struct clip_points {
    lanes vertex[3][CLIP_VERTICES], along[3][CLIP_DIRECTIONS];
    lanes longest[CLIP_DIRECTIONS];
};

INLINE void set_points(const struct kernel_traits traits, int which, const struct clip_wire *wire,
                       const struct box_frame *frame, struct clip_points *out)
{
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes at[3];
        for (int i = 0; i < component_count(traits, which); i++)
            at[i] = frame->edge[i][axis];
        set_at_vertices(traits, which, frame->centre[axis], at, frame->travel[axis],
                        out->vertex[axis]);
        set_along_directions(traits, which, at, frame->travel[axis], out->along[axis]);
        for (int d = 0; d < wire->directions; d++) {
            const lanes length = lanes_abs(out->along[axis][d]);
            out->longest[d] = axis ? lanes_max(length, out->longest[d]) : length;
        }
    }
}

/* Adds how far the spans of a frame reach from 0, [below, above][axis]. Where to < from, some point
 * of the range surely is in the intersection: the least reach of these. */
INLINE void add_reach(const struct kernel_traits traits, const struct clip_wire *wire,
                      const struct clip_points *points, const struct clip_span *part,
                      lanes reach[2][3])
{
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes below = reach[0][axis], above = reach[1][axis];
        for (int n = 0; n < wire->segments; n++) {
            const lanes at = points->vertex[axis][wire->from[n]];
            const lanes half = 0.5 * points->along[axis][wire->direction[n]];
            const lanes from = CHECK_GIVEN(part[n].from), to = CHECK_GIVEN(part[n].to);
            const lanes middle = at + (to + from) * half;
            const lanes length = (to - from) * lanes_abs(half);
            below = lanes_max(length - middle, below);
            above = lanes_max(length + middle, above);
        }
        reach[0][axis] = below;
        reach[1][axis] = above;
    }
}

/* ---- Mean ---- */

/* A frame, and what is left of its segments. */
struct clip_side {
    struct clip_points points;
    struct clip_spans spans;
};

/* Points of the intersection with their times, from -1 to 1: their sum, [time, coordinates], and
 * their number. */
struct clip_mean {
    lanes sum[1 + FMB_DIM_MAX], count;
};

INLINE void add_to_mean(lanes_mask counts, lanes x, lanes *sum)
{
    *sum += lanes_select(counts, CHECK_GIVEN(x), lanes_of(0));
}

/* Adds the middles of the outer spans of a frame that are certain enough for the limits on
 * positions and times (12). */
INLINE void add_middles(const struct kernel_traits traits, const struct clip_wire *wire,
                        const struct box_pair *box, const struct clip_side *side,
                        struct clip_mean *out)
{
    const struct clip_points *points = &side->points;
    for (int n = 0; n < wire->segments; n++) {
        const struct clip_span *outer = &side->spans.part[CLIP_OUTER][n];
        const struct clip_span *inner = &side->spans.part[CLIP_INNER][n];
        const int v = wire->from[n], d = wire->direction[n];
        const lanes lost = (outer->to - outer->from) - (inner->to - inner->from);
        const bool is_path = traits.drifts && d == wire->directions - 1;
        /* False if there is no span: it is NAN. */
        const lanes_mask counts = (lost * points->longest[d] <= box->whole) &
                                  (is_path ? lost <= CLIP_TIME : is_not((lanes_mask){0}));
        const lanes twice = outer->from + outer->to;
        for (int axis = 0; axis < traits.dim; axis++)
            add_to_mean(counts, points->vertex[axis][v] + twice * (0.5 * points->along[axis][d]),
                        &out->sum[1 + axis]);
        add_to_mean(counts, lanes_of(1), &out->count);
        if (!traits.drifts)
            continue;
        const lanes edge = lanes_of(v < wire->vertices ? -1 : 1);
        add_to_mean(counts, is_path ? edge + twice : edge, &out->sum[0]);
    }
}

/* ---- Crossings ---- */

/* How many edges of a frame have the same direction. */
INLINE int parallel_count(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] ? 1 : 4;
}

/* The value at the base of edge n along e, less that at the reference point. The base is the vertex
 * at which an edge of a simplex begins, the midpoint of an edge of a cuboid. at: [component]. */
INLINE lanes base_of_edge(const struct kernel_traits traits, int which, int e, int n,
                          const lanes at[3])
{
    if (traits.simplex[which])
        return e < 3 ? lanes_of(0) : at[edge_from(traits, e)];
    const lanes u = at[next(e)], v = at[next(next(e))];
    return n == 0 ? -(u + v) : n == 1 ? -(u - v) : n == 2 ? u - v : u + v;
}

/* (base x edge) . w, for the base of edge n along e. at[k]: normal[k] . w. */
INLINE lanes moment_of_edge(const struct kernel_traits traits, int which, int e, int n,
                            const lanes at[3])
{
    if (traits.simplex[which])
        return e < 3 ? lanes_of(0) : at[e - 3];
    const lanes u = -at[next(next(e))], v = at[next(e)];
    return n == 0 ? -(u + v) : n == 1 ? -(u - v) : n == 2 ? u - v : u + v;
}

/* What all crossings of a pair have in common. [i][m]: of edge m along edge i. */
struct clip_crossings {
    struct edge_products edges;
    lanes drift_middle[2][6]; /* [frame][edge]: (half_drift x offset) . edge */
    lanes length[2][6][3];    /* [frame][edge][axis]: of what an edge is made of */
    lanes error[2][6];        /* [frame][edge]: E_r for an edge of A, E_s for an edge of B */
    lanes scale_error;        /* what errors of frames and underflow add for a scale of 1 */
    lanes base[6][4][3];      /* where an edge of A begins */
    lanes r[6][4], s[6][4];   /* parts of r X by edges of A, of s X by edges of B */
};

/* Sets base, r and s. side[which]: the face products of a frame. */
INLINE void set_bases(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct box_frame *a, const struct face_products side[2],
                      struct clip_crossings *out)
{
    for (int which = 0; which < 2; which++)
        set_drift_middles(pair, traits, which, out->drift_middle[which]);
    for (int index = 0; index < edge_count(traits, 0); index++) {
        const int e = edge_at(traits, 0, index);
        for (int m = 0; m < parallel_count(traits, 0); m++) {
            out->r[e][m] = out->drift_middle[0][e] - moment_of_edge(traits, 0, e, m, side[0].swing);
            for (int axis = 0; axis < 3; axis++) {
                const lanes at[3] = {a->edge[0][axis], a->edge[1][axis],
                                     traits.face[0] ? lanes_of(0) : a->edge[2][axis]};
                out->base[e][m][axis] = a->centre[axis] + base_of_edge(traits, 0, e, m, at);
            }
        }
    }
    for (int index = 0; index < edge_count(traits, 1); index++) {
        const int e = edge_at(traits, 1, index);
        for (int n = 0; n < parallel_count(traits, 1); n++)
            out->s[e][n] = out->drift_middle[1][e] + moment_of_edge(traits, 1, e, n, side[1].swing);
    }
}

/* Returns the lanes in which nothing rounds, or every edge and a drift that is not 0 has a size of
 * at least 2^-180. */
INLINE lanes_mask set_crossings(const struct pair_lanes *pair, const struct kernel_traits traits,
                                const struct box_pair *box, struct clip_crossings *out)
{
    lanes least = lanes_select(pair->half_drift_size != 0, pair->half_drift_size, lanes_of(1));
    out->scale_error = BOX_FRAME_ERROR * pair->error + CLIP_UNDERFLOW * pair->reach;
    set_products(pair, traits, pair->offset, out->edges.middle);
    set_products(pair, traits, pair->half_drift, out->edges.swing);
    for (int which = 0; which < 2; which++) {
        const lanes(*c)[3] = pair->component[which];
        for (int index = 0; index < edge_count(traits, which); index++) {
            const int e = edge_at(traits, which, index);
            lanes weight[3], *length = out->length[which][e];
            for (int axis = 0; axis < 3; axis++)
                length[axis] = e < 3 ? lanes_abs(c[e][axis])
                                     : lanes_abs(c[edge_from(traits, e)][axis]) +
                                           lanes_abs(c[edge_to(traits, e)][axis]);
            cross_weight(length, pair->half_drift, weight);
            const lanes size = pair->size[which][e];
            const lanes error = BOX_ROUNDING * dot(weight, box->reach) +
                                out->scale_error * (size * pair->half_drift_size);
            out->error[which][e] = lanes_select(box->exact, lanes_of(0), error);
            least = lanes_min(size, least);
        }
    }
    return box->exact | (least >= CLIP_LEAST_SIZE);
}

/* x where it is inside its range from 0 to all, or from -all to all for an edge of a cuboid: by how
 * much. */
INLINE lanes inside_range(bool simplex, lanes x, lanes all)
{
    return simplex ? lanes_min(x, all - x) : all - lanes_abs(x);
}

/* The crossings of edges along i of A and j of B. Where X may be 0, the radius is infinite. */
struct clip_crossing {
    const lanes (*base)[3], *a_r, *b_s;                    /* [edge]: from struct clip_crossings */
    lanes a_s[4], a_t[4], b_r[4], b_t[4];                  /* [edge]: parts of s X, r X and t X */
    lanes det, turned, inverse, error_s, error_r, error_t; /* |X|, X, 1 / |X|, bounds */
    lanes along[3], travel[3], radius[3]; /* of s X, t X; of the error of a position */
    lanes_mask known, timed, crosses;     /* known: the position; timed: the time */
};

INLINE void set_parts(const struct kernel_traits traits, const struct clip_crossings *all,
                      const struct face_products side[2], int i, int j, struct clip_crossing *out)
{
    const lanes along_b[3] = {all->edges.swing[0][j], all->edges.swing[1][j],
                              traits.face[0] ? lanes_of(0) : all->edges.swing[2][j]};
    const lanes of_a[3] = {side[0].other[0][j], side[0].other[1][j], side[0].other[2][j]};
    const lanes of_b[3] = {side[1].other[0][i], side[1].other[1][i], side[1].other[2][i]};
    out->base = all->base[i];
    out->a_r = all->r[i];
    out->b_s = all->s[j];
    for (int m = 0; m < parallel_count(traits, 0); m++) {
        out->a_s[m] = base_of_edge(traits, 0, i, m, along_b);
        out->a_t[m] = moment_of_edge(traits, 0, i, m, of_a);
    }
    for (int n = 0; n < parallel_count(traits, 1); n++) {
        out->b_r[n] = base_of_edge(traits, 1, j, n, all->edges.swing[i]);
        out->b_t[n] = moment_of_edge(traits, 1, j, n, of_b) - all->edges.middle[i][j];
    }
}

INLINE void set_crossing(const struct pair_lanes *pair, const struct kernel_traits traits,
                         const struct box_places *places, const struct box_pair *box,
                         const struct face_products side[2], const struct clip_crossings *all,
                         int i, int j, struct clip_crossing *out)
{
    const struct box_frame *a = &box->frame[0];
    lanes weight[3], wide = lanes_of(0);
    set_parts(traits, all, side, i, j, out);
    out->turned = all->edges.swing[i][j];
    out->det = lanes_abs(out->turned);
    out->error_s = all->error[1][j];
    out->error_r = all->error[0][i];
    cross_weight(all->length[0][i], all->length[1][j], weight);
    out->error_t = lanes_select(box->exact, lanes_of(0),
                                BOX_ROUNDING * dot(weight, box->reach) +
                                    all->scale_error * (pair->size[0][i] * pair->size[1][j]));
    const lanes_mask some = out->det > CLIP_LEAST_FACTOR;
    const lanes inverse = lanes_select(some, 1 / CHECK_GIVEN(out->det), lanes_of(0));
    for (int axis = 0; axis < 3; axis++) {
        out->along[axis] = inverse * a->edge[i][axis];
        out->travel[axis] = inverse * a->travel[axis];
        const lanes radius = out->error_s * lanes_abs(out->along[axis]) +
                             out->error_t * lanes_abs(out->travel[axis]);
        out->radius[axis] = lanes_select(some, radius, lanes_of(INFINITY));
        wide = lanes_max(out->radius[axis], wide);
    }
    /* None if X is exactly 0: in exact numbers, or all three vectors are across a level axis. */
    out->crosses = (pair->half_drift_size != 0) & (some | is_not(box->exact));
    for (int axis = 0; axis < 3; axis++)
        out->crosses &= is_not(places->level[axis] & (a->edge[i][axis] == 0) &
                               (box->frame[1].edge[j][axis] == 0));
    out->known = wide <= 0.5 * box->whole;
    out->inverse = inverse;
    out->timed = some & (out->error_t <= CLIP_TIME * out->det);
}

/* The crossing of two edges: s X and t X, and how far s, r and t are inside their ranges, times X.
 */
struct clip_parameters {
    lanes s, t, in_s, in_r, in_t;
};

/* Returns the lanes in which the crossing of edge m of A and n of B is possible. */
INLINE lanes_mask is_possible(const struct kernel_traits traits, const struct clip_crossing *from,
                              int m, int n, struct clip_parameters *out)
{
    const lanes turned = from->turned;
    const lanes r = with_sign_of(from->a_r[m] - from->b_r[n], turned);
    out->s = with_sign_of(from->b_s[n] - from->a_s[m], turned);
    out->t = with_sign_of(from->b_t[n] + from->a_t[m], turned);
    out->in_s = inside_range(traits.simplex[0], out->s, from->det);
    out->in_r = inside_range(traits.simplex[1], r, from->det);
    out->in_t = inside_range(false, out->t, from->det);
    CHECK_BOUND(BOX_ROUNDING, is_not(from->crosses), out->in_s, from->error_s);
    CHECK_BOUND(BOX_ROUNDING, is_not(from->crosses), out->in_r, from->error_r);
    CHECK_BOUND(BOX_ROUNDING, is_not(from->crosses), out->in_t, from->error_t);
    return from->crosses & (out->in_s >= -from->error_s) & (out->in_r >= -from->error_r) &
           (out->in_t >= -from->error_t);
}

/* Adds the crossing to the reach of A: to the outer one where it is possible, to the inner one
 * where it is certain; to the mean where its time is known too. Returns the lanes in which it is
 * possible, but not certain, or has a position that is not known to within box->whole. */
INLINE lanes_mask add_crossing(const struct kernel_traits traits, const struct clip_crossing *from,
                               int m, int n, lanes reach[CLIP_BOUNDS][2][3], struct clip_mean *mean)
{
    struct clip_parameters at;
    const lanes none = lanes_of(-INFINITY);
    const lanes_mask possible = is_possible(traits, from, m, n, &at);
    const lanes_mask certain = possible & from->known & (at.in_s >= from->error_s) &
                               (at.in_r >= from->error_r) & (at.in_t >= from->error_t);
    const lanes_mask counted = certain & from->timed;
    for (int axis = 0; axis < 3; axis++) {
        const lanes part =
            CHECK_GIVEN(at.s) * from->along[axis] + CHECK_GIVEN(at.t) * from->travel[axis];
        const lanes middle = from->base[m][axis] + part;
        const lanes radius = CHECK_GIVEN(from->radius[axis]);
        for (int bound = 0; bound < CLIP_BOUNDS; bound++) {
            lanes *below = &reach[bound][0][axis], *above = &reach[bound][1][axis];
            const lanes_mask counts = bound == CLIP_OUTER ? possible : certain;
            const lanes half = bound == CLIP_OUTER ? radius : -radius;
            *below = lanes_max(lanes_select(counts, half - middle, none), *below);
            *above = lanes_max(lanes_select(counts, half + middle, none), *above);
        }
        if (mean)
            add_to_mean(counted, middle, &mean->sum[1 + axis]);
    }
    if (mean) {
        add_to_mean(counted, at.t * from->inverse, &mean->sum[0]);
        add_to_mean(counted, lanes_of(1), &mean->count);
    }
    return possible & is_not(certain);
}

/* Adds all crossings of edges in two directions. First all that are possible in some lane are
 * found, without branches; few are. Returns the lanes of add_crossing(). */
INLINE lanes_mask add_parallel_crossings(const struct kernel_traits traits,
                                         const struct clip_crossing *from,
                                         lanes reach[CLIP_BOUNDS][2][3], struct clip_mean *mean)
{
    unsigned any = 0;
    lanes_mask uncertain = {0};
    for (int m = 0; m < parallel_count(traits, 0); m++)
        for (int n = 0; n < parallel_count(traits, 1); n++) {
            struct clip_parameters at;
            const lanes_mask possible = is_possible(traits, from, m, n, &at);
            any |= (unsigned) (lanes_mask_bits(possible) != 0) << (4 * m + n);
        }
    for (; any != 0; any &= any - 1) {
        const int index = __builtin_ctz(any);
        uncertain |= add_crossing(traits, from, index / 4, index % 4, reach, mean);
    }
    return uncertain;
}

/* ---- All of it ---- */

/* Clips a frame to the other one. Out: side; other, the face products of the other. Returns the
 * lanes of clip_segments(). */
INLINE lanes_mask clip_frame(const struct pair_lanes *pair, const struct kernel_traits traits,
                             const struct box_places *places, int which,
                             const struct clip_wire *wire, const struct box_pair *box,
                             struct face_products *other, lanes_mask *good, struct clip_side *side)
{
    struct clip_slab slab[CLIP_SLABS];
    struct clip_values values;
    const int slabs = traits.dim == 2
                          ? set_plane_slabs(pair, traits, !which, &box->frame[!which], slab)
                          : set_space_slabs(pair, traits, !which, other, slab);
    values.exact =
        box->exact & (pair->reach >= 1 / CLIP_EXACT_RANGE) & (pair->reach <= CLIP_EXACT_RANGE);
    values.any_exact = lanes_mask_bits(values.exact);
    for (int k = 0; k < slabs; k++) {
        set_values(traits, pair, which, box, &slab[k], k, good, &values);
        for (int axis = 0; axis < traits.dim; axis++)
            if (lanes_mask_bits(places->level[axis]))
                set_level_values(traits, pair, which, places, k, axis, &values);
    }
    set_points(traits, which, wire, &box->frame[which], &side->points);
    return clip_segments(wire, &values, slabs, traits.face[!which], side->points.longest, box,
                         &side->spans);
}

/* Adds all crossings to the reach of A and to the mean. Returns the lanes of add_crossing(). */
INLINE lanes_mask add_crossings(const struct pair_lanes *pair, const struct kernel_traits traits,
                                const struct box_places *places, const struct box_pair *box,
                                const struct face_products side[2], lanes_mask *good,
                                lanes reach[CLIP_BOUNDS][2][3], struct clip_mean *mean)
{
    struct clip_crossings all;
    lanes_mask uncertain = {0};
    *good &= set_crossings(pair, traits, box, &all);
    set_bases(pair, traits, &box->frame[0], side, &all);
    for (int i = 0; i < edge_count(traits, 0); i++)
        for (int j = 0; j < edge_count(traits, 1); j++) {
            struct clip_crossing crossing;
            set_crossing(pair, traits, places, box, side, &all, edge_at(traits, 0, i),
                         edge_at(traits, 1, j), &crossing);
            uncertain |= add_parallel_crossings(traits, &crossing, reach, mean);
        }
    return uncertain;
}

/* Finds the ends of the box, and the mean unless it is NULL. Returns the lanes in which the ends
 * are good. */
INLINE lanes_mask clip_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                           const struct clip_wire wire[2], const struct box_places *places,
                           const struct box_pair *box, struct box_ends *ends,
                           struct clip_mean *mean)
{
    struct face_products products[2];
    struct clip_side side[2];
    lanes reach[CLIP_BOUNDS][2][3];
    lanes_mask good = is_not((lanes_mask){0}), uncertain = {0};
    for (int i = 0; i < CLIP_BOUNDS * 6; i++)
        reach[i / 6][i / 3 % 2][i % 3] = lanes_of(-INFINITY);
    for (int which = 0; which < 2; which++)
        uncertain |= clip_frame(pair, traits, places, which, &wire[which], box, &products[!which],
                                &good, &side[which]);
    if (traits.dim == 3 && traits.drifts)
        uncertain |= add_crossings(pair, traits, places, box, products, &good, reach, mean);
    for (int which = 0; which < 2 && mean; which++)
        add_middles(traits, &wire[which], box, &side[which], mean);
    for (int bound = 0; bound < (lanes_mask_bits(uncertain & good) ? 2 : 1); bound++)
        for (int which = 0; which < 2; which++)
            add_reach(traits, &wire[which], &side[which].points, side[which].spans.part[bound],
                      reach[bound]);
    for (int axis = 0; axis < traits.dim; axis++)
        for (int end = 0; end < 2; end++) {
            /* Where not uncertain, the outer reach is within box->whole of the true one. */
            lanes *inner = &ends->inner[end][axis];
            ends->outer[end][axis] = reach[CLIP_OUTER][end][axis];
            *inner =
                lanes_select(uncertain, reach[CLIP_INNER][end][axis], reach[CLIP_OUTER][end][axis]);
            CHECK_BOUND(BOX_PLACE_ROUNDING, box->exact, *inner, box->slack[axis]);
            CHECK_BOUND(BOX_PLACE_ROUNDING_EXACT, is_not(box->exact), *inner, box->slack[axis]);
        }
    return are_near(traits, box, ends) & good;
}

#endif
