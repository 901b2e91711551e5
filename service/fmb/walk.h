/* The list of slabs of a pair (slabs.h), walked for LANES pairs at once. */
#ifndef FMB_WALK_H
#define FMB_WALK_H

#include "lanes.h"
#include "slabs.h"

/* What is known when a kernel is compiled. */
struct walk_kind {
    int dim;
    bool tetrahedron[2]; /* of a, of b; else cuboids */
    bool drifts;
    bool along;   /* edges may be parallel to the same axis: zero normals are looked for (3D) */
    bool ordered; /* every number is to have the same bits for the pair the other way round */
    bool times;   /* the times of contact are wanted; ordered */
};

/* A pair, seen from the reference point of a: the centre of a cuboid, the origin of a tetrahedron.
 * In a pair with a cuboid all lengths are doubled, so that the halves of its edges are its
 * components. */
struct walk_pair {
    lanes component[2][3][3]; /* [frame][component][axis]; of a cuboid half of it, as above */
    lanes size[2][6];         /* of edges: no smaller than their lengths */
    lanes offset[3];          /* of b's reference point in the middle of the window */
    lanes half[3]; /* of the drift: the offset goes from offset - half to offset + half */
    lanes half_size;
    lanes reach;         /* T (walk_error) */
    lanes unit;          /* the error of a slab of scale 1 */
    lanes_mask in_range; /* doubles can say something of it */
};

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

INLINE int next(int i)
{
    return i == 2 ? 0 : i + 1;
}

INLINE int edge_count(const struct walk_kind kind, int which)
{
    return !kind.tetrahedron[which] ? kind.dim : kind.dim == 2 ? 3 : 6;
}

INLINE lanes dot(const lanes u[3], const lanes v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

INLINE void cross(const lanes u[3], const lanes v[3], lanes out[3])
{
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* In the plane. */
INLINE lanes product(const lanes x[3], const lanes y[3])
{
    return x[0] * y[1] - x[1] * y[0];
}

/* ---- The pair ---- */

/* Bound on the error of a gap, and of what it is made of, relative to the scale of the slab:
 * derived in slabs.c. */
INLINE double walk_error(const struct walk_kind kind)
{
    return kind.dim == 2 ? SLABS_ROUNDING_2D : SLABS_ROUNDING;
}

INLINE bool is_doubled(const struct walk_kind kind)
{
    return !kind.tetrahedron[0] || !kind.tetrahedron[1];
}

/* Components and sizes of a frame; returns its share of the reach. */
INLINE lanes set_frame(const struct walk_kind kind, int which, const lanes component[3][3],
                       const lanes size[3], struct walk_pair *out)
{
    const bool twice = is_doubled(kind) && kind.tetrahedron[which];
    lanes sum = size[0] + size[1];
    UNROLL(3)
    for (int i = 0; i < kind.dim; i++) {
        UNROLL(3)
        for (int axis = 0; axis < kind.dim; axis++)
            out->component[which][i][axis] =
                twice ? component[i][axis] + component[i][axis] : component[i][axis];
        out->size[which][i] = twice ? size[i] + size[i] : size[i];
    }
    if (kind.dim == 3)
        sum += size[2];
    lanes *own = out->size[which];
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        if (kind.tetrahedron[which] && kind.dim == 3)
            own[3 + i] = own[next(i)] + own[next(next(i))];
    if (kind.tetrahedron[which] && kind.dim == 2)
        own[2] = own[0] + own[1];
    return is_doubled(kind) ? sum + sum : sum;
}

/* From the origin of a frame to its reference point, along an axis. */
INLINE lanes shift_of(const struct walk_kind kind, const lanes component[3][3], int axis)
{
    const lanes sum = component[0][axis] + component[1][axis];
    return kind.dim == 2 ? sum : sum + component[2][axis];
}

/* The offset of the reference points at the middle of the window, along an axis. The same for the
 * pair the other way round, negative. */
INLINE lanes offset_of(const struct walk_kind kind, const lanes component[2][3][3], lanes offset,
                       lanes half, int axis)
{
    const lanes at = kind.drifts ? offset + half : offset;
    if (kind.tetrahedron[0])
        return kind.tetrahedron[1] ? at : at + shift_of(kind, component[1], axis);
    if (kind.tetrahedron[1])
        return at - shift_of(kind, component[0], axis);
    return at + (shift_of(kind, component[1], axis) - shift_of(kind, component[0], axis));
}

/* From components, sizes of components, offset of the origins and drift, as the frames have them.
 */
INLINE void walk_pair_set(const struct walk_kind kind, const lanes component[2][3][3],
                          const lanes size[2][3], const lanes offset[3], const lanes drift[3],
                          struct walk_pair *out)
{
    const lanes reach_a = set_frame(kind, 0, component[0], size[0], out);
    const lanes reach_b = set_frame(kind, 1, component[1], size[1], out);
    lanes offset_size = lanes_of(0), half_size = lanes_of(0);
    lanes_mask tiny = {0};
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        const lanes at = is_doubled(kind) ? offset[axis] + offset[axis] : offset[axis];
        const lanes half = !kind.drifts       ? lanes_of(0)
                           : is_doubled(kind) ? drift[axis]
                                              : 0.5 * drift[axis];
        out->half[axis] = half;
        out->offset[axis] = offset_of(kind, component, at, half, axis);
        offset_size += lanes_magnitude(at);
        half_size += lanes_magnitude(half);
        tiny |= (half != 0) & (lanes_magnitude(half) < 0x1p-400);
    }
    out->half_size = half_size;
    out->reach = (reach_a + reach_b) + (offset_size + (half_size + half_size));
    out->unit = walk_error(kind) * out->reach;
    out->in_range = offset_size <= 0x1p200;
    if (kind.drifts)
        out->in_range &= (half_size <= 0x1p200) & (half_size >= 0x1p-200);
    if (kind.drifts && kind.along)
        out->in_range &= tiny == 0;
}

/* ---- Extents along a normal ----
 *
 * Of a frame about its reference point: of a cuboid [-radius, radius], of a tetrahedron
 * [low, high]; of D, the sum of both. */
struct walk_extent {
    lanes low, high, radius;
};

INLINE struct walk_extent extent_of_one(bool tetrahedron, lanes x)
{
    if (!tetrahedron)
        return (struct walk_extent){lanes_of(0), lanes_of(0), lanes_magnitude(x)};
    return (struct walk_extent){lanes_least(x, lanes_of(0)), lanes_greatest(x, lanes_of(0)),
                                lanes_of(0)};
}

INLINE struct walk_extent extent_of_two(bool tetrahedron, lanes x, lanes y)
{
    if (!tetrahedron)
        return (struct walk_extent){lanes_of(0), lanes_of(0),
                                    lanes_magnitude(x) + lanes_magnitude(y)};
    return (struct walk_extent){lanes_least(lanes_least(x, y), lanes_of(0)),
                                lanes_greatest(lanes_greatest(x, y), lanes_of(0)), lanes_of(0)};
}

INLINE struct walk_extent extent_of_three(bool tetrahedron, lanes x, lanes y, lanes z)
{
    if (!tetrahedron)
        return (struct walk_extent){lanes_of(0), lanes_of(0),
                                    (lanes_magnitude(x) + lanes_magnitude(y)) + lanes_magnitude(z)};
    return (struct walk_extent){
        lanes_least(lanes_least(lanes_least(x, y), z), lanes_of(0)),
        lanes_greatest(lanes_greatest(lanes_greatest(x, y), z), lanes_of(0)), lanes_of(0)};
}

/* Of all components along what makes at[] of them. */
INLINE struct walk_extent extent_of_frame(const struct walk_kind kind, int which, const lanes at[3])
{
    return kind.dim == 2 ? extent_of_two(kind.tetrahedron[which], at[0], at[1])
                         : extent_of_three(kind.tetrahedron[which], at[0], at[1], at[2]);
}

/* The extent of D = A - B from those of A and B along the same direction. */
INLINE struct walk_extent extent_difference(const struct walk_kind kind, struct walk_extent a,
                                            struct walk_extent b)
{
    struct walk_extent out = {lanes_of(0), lanes_of(0), lanes_of(0)};
    if (kind.tetrahedron[0] && kind.tetrahedron[1])
        return (struct walk_extent){a.low - b.high, a.high - b.low, out.radius};
    if (!kind.tetrahedron[0] && !kind.tetrahedron[1]) {
        out.radius = a.radius + b.radius;
        return out;
    }
    out.radius = kind.tetrahedron[0] ? b.radius : a.radius;
    out.low = kind.tetrahedron[0] ? a.low : -b.high;
    out.high = kind.tetrahedron[0] ? a.high : -b.low;
    return out;
}

/* The same with the extent of B along the opposite direction. */
INLINE struct walk_extent extent_sum(const struct walk_kind kind, struct walk_extent a,
                                     struct walk_extent b)
{
    if (kind.tetrahedron[0] && kind.tetrahedron[1])
        return (struct walk_extent){a.low + b.low, a.high + b.high, lanes_of(0)};
    if (!kind.tetrahedron[0] && !kind.tetrahedron[1])
        return (struct walk_extent){lanes_of(0), lanes_of(0), a.radius + b.radius};
    return kind.tetrahedron[0] ? (struct walk_extent){a.low, a.high, b.radius}
                               : (struct walk_extent){b.low, b.high, a.radius};
}

/* How far beyond D the offset is at most over the window: D widened by the drift. */
INLINE lanes gap_of(const struct walk_kind kind, struct walk_extent d, lanes middle, lanes swing)
{
    const bool round = !kind.tetrahedron[0] && !kind.tetrahedron[1];
    const lanes beyond =
        round ? lanes_magnitude(middle) : lanes_greatest(middle - d.high, d.low - middle);
    if (kind.tetrahedron[0] && kind.tetrahedron[1])
        return kind.drifts ? beyond - lanes_magnitude(swing) : beyond;
    return beyond - (kind.drifts ? d.radius + lanes_magnitude(swing) : d.radius);
}

/* ---- A slab ---- */

/* What is known of the time: middle + s swing lies within the bounds of D, s in [-1, 1]. With
 * swing made a little longer no quotient overflows; the error has room for it (slabs.c). */
INLINE void bound_times(const struct walk_kind kind, struct walk_extent d, lanes error,
                        lanes middle, lanes swing, lanes_mask nothing, struct walk_found *found)
{
    const bool both = kind.tetrahedron[0] && kind.tetrahedron[1];
    const bool none = !kind.tetrahedron[0] && !kind.tetrahedron[1];
    lanes low = both ? d.low : none ? -d.radius : d.low - d.radius;
    lanes high = both ? d.high : none ? d.radius : d.high + d.radius;
    low -= middle;
    high -= middle;
    if (kind.along) {
        low = lanes_choose(nothing, lanes_of(-4), low);
        high = lanes_choose(nothing, lanes_of(4), high);
        error = lanes_choose(nothing, lanes_of(1), error);
    }
    const lanes inverse = 1 / (swing + lanes_with_sign(0x1p-10 * error, swing));
    const lanes one = low * inverse, other = high * inverse;
    const lanes slack = error * lanes_magnitude(inverse);
    const lanes enter = lanes_least(one, other), leave = lanes_greatest(one, other);
    found->enter[0] = lanes_greatest(enter - slack, found->enter[0]);
    found->enter[1] = lanes_greatest(enter + slack, found->enter[1]);
    found->leave[0] = lanes_least(leave + slack, found->leave[0]);
    found->leave[1] = lanes_least(leave - slack, found->leave[1]);
}

/* nothing: lanes whose normal is zero; they say nothing. timeless: the slab of a drift. */
INLINE void add_slab(const struct walk_kind kind, struct slab_normal normal, struct walk_extent d,
                     lanes scale, lanes unit, lanes middle, lanes swing, bool timeless,
                     lanes_mask nothing, struct walk_found *found)
{
    const lanes gap = gap_of(kind, d, middle, swing);
#if LANES == 1 /* where nothing rounds, a zero normal shows in that both frames have no extent */
    nothing |= unit == 0 && d.low == d.high && d.radius == 0;
#endif
    const lanes above = gap + scale * unit;
    found->surely = lanes_greatest(gap - scale * unit, found->surely);
    found->possibly = lanes_greatest(
        kind.along ? lanes_choose(nothing, lanes_of(-INFINITY), above) : above, found->possibly);
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

/* Whether every lane is known to be separated, and no more is wanted. */
INLINE bool is_enough(const struct walk_found *found)
{
#if LANES == 1
    if (found->next)
        return false;
#endif
    return lanes_all(found->surely > 0);
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
        for (int i = 0; i < kind.dim; i++)
            at[f][i] = pair->component[f][i][axis];
        const struct walk_extent d = extent_difference(kind, extent_of_frame(kind, 0, at[0]),
                                                       extent_of_frame(kind, 1, at[1]));
        gap = lanes_greatest(gap_of(kind, d, pair->offset[axis], pair->half[axis]), gap);
    }
    found->surely = gap - SLABS_ROUNDING_AXES * pair->reach;
}

/* ---- Space ---- */

/* What a frame has of its own, and what of the pair is linear in its normals. */
struct walk_side {
    lanes normal[3][3];        /* normal[k] = c_i x c_j */
    lanes volume;              /* normal[k] . c_k, any k */
    lanes other[3][6];         /* normal[k] . edges of the other frame */
    lanes middle[3], swing[3]; /* normal[k] . offset, normal[k] . half */
};

INLINE void add_differences(const struct walk_kind kind, int which, lanes value[6])
{
    if (!kind.tetrahedron[which])
        return;
    value[3] = value[2] - value[1];
    value[4] = value[0] - value[2];
    value[5] = value[1] - value[0];
}

INLINE void set_side(const struct walk_pair *pair, const struct walk_kind kind, int which,
                     struct walk_side *out)
{
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        cross(pair->component[which][next(k)], pair->component[which][next(next(k))],
              out->normal[k]);
        out->middle[k] = dot(out->normal[k], pair->offset);
        out->swing[k] = kind.drifts ? dot(out->normal[k], pair->half) : lanes_of(0);
        UNROLL(3)
        for (int j = 0; j < 3; j++)
            out->other[k][j] = dot(out->normal[k], pair->component[!which][j]);
        add_differences(kind, !which, out->other[k]);
    }
    out->volume = dot(out->normal[0], pair->component[which][0]);
}

/* The faces of a (which = 0) or of b. The extent of a frame along its own normals is that of one
 * component; across from the origin all three have the same. */
INLINE void add_face(const struct walk_pair *pair, const struct walk_kind kind, int which,
                     struct slab_normal normal, const struct walk_side *side, const lanes at[3],
                     lanes scale, lanes middle, lanes swing, struct walk_found *found)
{
    const struct walk_extent own = extent_of_one(kind.tetrahedron[which], side->volume);
    const struct walk_extent other = extent_of_frame(kind, !which, at);
    const lanes_mask none = {0};
    add_slab(kind, normal, extent_difference(kind, which ? other : own, which ? own : other), scale,
             pair->unit, middle, swing, false, none, found);
}

INLINE void add_faces(const struct walk_pair *pair, const struct walk_kind kind, int which,
                      const struct walk_side *side, struct walk_found *found)
{
    const int first = which ? SLABS_EDGE_OF_B : 0;
    const lanes *size = pair->size[which];
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        const int i = next(k), j = next(i);
        add_face(pair, kind, which, (struct slab_normal){first + i, first + j}, side,
                 side->other[k], size[i] * size[j], side->middle[k], side->swing[k], found);
    }
    if (!kind.tetrahedron[which])
        return;
    lanes at[3];
    UNROLL(3)
    for (int j = 0; j < 3; j++)
        at[j] = (side->other[0][j] + side->other[1][j]) + side->other[2][j];
    add_face(pair, kind, which, (struct slab_normal){first + 3, first + 4}, side, at,
             (size[0] * size[1] + size[1] * size[2]) + size[2] * size[0],
             (side->middle[0] + side->middle[1]) + side->middle[2],
             (side->swing[0] + side->swing[1]) + side->swing[2], found);
}

/* What is linear in an edge of each: [a b offset], [a b half]. */
struct walk_edges {
    lanes middle[6][6], swing[6][6];
};

/* The differences of a tetrahedron's components take part in both indices alike, so that the pair
 * the other way round has the same bits. */
INLINE void add_product_differences(const struct walk_kind kind, lanes value[6][6])
{
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), q = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            if (kind.tetrahedron[1])
                value[j][3 + i] = value[j][q] - value[j][p];
            if (kind.tetrahedron[0])
                value[3 + i][j] = value[q][j] - value[p][j];
        }
    }
    if (!kind.tetrahedron[0] || !kind.tetrahedron[1])
        return;
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), q = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            const int r = next(j), s = next(r);
            value[3 + i][3 + j] = kind.ordered
                                      ? (value[q][s] + value[p][r]) - (value[q][r] + value[p][s])
                                      : value[3 + i][s] - value[3 + i][r];
        }
    }
}

/* [a_i b_j w] for all i, j: (a_i x b_j) . w has the same bits the other way round, (w x a_i) . b_j
 * takes fewer operations. */
INLINE void set_products(const struct walk_pair *pair, const struct walk_kind kind,
                         const lanes w[3], lanes value[6][6])
{
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        lanes turned[3];
        if (!kind.ordered)
            cross(w, pair->component[0][i], turned);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            if (kind.ordered) {
                cross(pair->component[0][i], pair->component[1][j], turned);
                value[i][j] = dot(turned, w);
            } else {
                value[i][j] = dot(turned, pair->component[1][j]);
            }
        }
    }
    add_product_differences(kind, value);
}

/* The extent of a frame along e x f, e an edge of its own; at[k] = normal[k] . f. */
INLINE struct walk_extent extent_at_edge(const struct walk_kind kind, int which, int e, lanes at0,
                                         lanes at1, lanes at2)
{
    const lanes at[3] = {at0, at1, at2};
    if (e < 3)
        return extent_of_two(kind.tetrahedron[which],
                             kind.tetrahedron[which] ? -at[next(next(e))] : at[next(next(e))],
                             at[next(e)]);
    const int r = e - 3, p = next(r), q = next(p);
    return extent_of_two(true, at[r], -(at[p] + at[q]));
}

/* An edge by number; a difference that is 0 is exact, and none is tiny. */
INLINE void walk_edge(const struct walk_pair *pair, int which, int e, lanes out[3])
{
    const int p = next(e % 3), q = next(p);
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        out[axis] = e < 3 ? pair->component[which][e][axis]
                          : pair->component[which][q][axis] - pair->component[which][p][axis];
}

/* Whether u x v is exactly 0 because each of the products in it has a factor 0. No product of two
 * numbers that are not 0 is so small as to become 0. */
INLINE lanes_mask cross_is_nothing(const lanes u[3], const lanes v[3])
{
    const lanes x = lanes_magnitude(u[0]) * (lanes_magnitude(v[1]) + lanes_magnitude(v[2]));
    const lanes y = lanes_magnitude(u[1]) * (lanes_magnitude(v[2]) + lanes_magnitude(v[0]));
    const lanes z = lanes_magnitude(u[2]) * (lanes_magnitude(v[0]) + lanes_magnitude(v[1]));
    return (x + y) + z == 0;
}

INLINE void add_edges(const struct walk_pair *pair, const struct walk_kind kind,
                      const struct walk_side side[2], const struct walk_edges *edges,
                      struct walk_found *found)
{
    const struct walk_side *a = &side[0], *b = &side[1];
    UNROLL(6)
    for (int i = 0; i < edge_count(kind, 0); i++) {
        const lanes unit = kind.ordered ? pair->unit : pair->size[0][i] * pair->unit;
        lanes u[3], v[3];
        lanes_mask nothing = {0};
        if (kind.along)
            walk_edge(pair, 0, i, u);
        UNROLL(6)
        for (int j = 0; j < edge_count(kind, 1); j++) {
            const struct walk_extent of_a =
                extent_at_edge(kind, 0, i, a->other[0][j], a->other[1][j], a->other[2][j]);
            const struct walk_extent of_b =
                extent_at_edge(kind, 1, j, b->other[0][i], b->other[1][i], b->other[2][i]);
            if (kind.along) {
                walk_edge(pair, 1, j, v);
                nothing = cross_is_nothing(u, v);
            }
            const lanes scale =
                kind.ordered ? pair->size[0][i] * pair->size[1][j] : pair->size[1][j];
            add_slab(kind, (struct slab_normal){i, SLABS_EDGE_OF_B + j},
                     extent_sum(kind, of_a, of_b), scale, unit, edges->middle[i][j],
                     edges->swing[i][j], false, nothing, found);
        }
    }
}

/* The planes of the edges of a (which = 0) or of b with the drift: e x half. The offset at the
 * middle of the window is in them as good as any. [a half b] = -[a b half], [b half a] = [a b
 * half].
 */
INLINE void add_drift(const struct walk_pair *pair, const struct walk_kind kind, int which,
                      const struct walk_side *own, const struct walk_edges *edges,
                      struct walk_found *found)
{
    lanes plane[3], middle[6];
    cross(pair->half, pair->offset, plane);
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        middle[i] = dot(plane, pair->component[which][i]);
    add_differences(kind, which, middle);
    const lanes unit = pair->half_size * pair->unit;
    UNROLL(6)
    for (int i = 0; i < edge_count(kind, which); i++) {
        lanes at[3], edge[3];
        lanes_mask nothing = {0};
        UNROLL(3)
        for (int j = 0; j < 3; j++)
            at[j] = which ? edges->swing[j][i] : -edges->swing[i][j];
        if (kind.along) {
            walk_edge(pair, which, i, edge);
            nothing = cross_is_nothing(edge, pair->half);
        }
        const struct walk_extent of_own =
            extent_at_edge(kind, which, i, own->swing[0], own->swing[1], own->swing[2]);
        const struct walk_extent of_other = extent_of_frame(kind, !which, at);
        add_slab(kind, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + i, SLABS_DRIFT},
                 extent_difference(kind, which ? of_other : of_own, which ? of_own : of_other),
                 pair->size[which][i], unit, middle[i], lanes_of(0), true, nothing, found);
    }
}

INLINE void walk_space(const struct walk_pair *pair, const struct walk_kind kind,
                       struct walk_found *found)
{
    struct walk_side side[2];
    struct walk_edges edges;
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_side(pair, kind, which, &side[which]);
        add_faces(pair, kind, which, &side[which], found);
        if (is_enough(found))
            return;
    }
    set_products(pair, kind, pair->offset, edges.middle);
    if (kind.drifts)
        set_products(pair, kind, pair->half, edges.swing);
    else
        memset(edges.swing, 0, sizeof edges.swing);
    add_edges(pair, kind, side, &edges, found);
    if (!kind.drifts || is_enough(found))
        return;
    add_drift(pair, kind, 0, &side[0], &edges, found);
    add_drift(pair, kind, 1, &side[1], &edges, found);
}

/* ---- Plane ---- */

struct walk_plane_edges {
    lanes middle[3], swing[3]; /* [e offset], [e half] */
    lanes other[3][2];         /* [e, component of the other frame] */
};

INLINE void set_plane_edges(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            struct walk_plane_edges *out)
{
    UNROLL(2)
    for (int i = 0; i < 2; i++) {
        const lanes *e = pair->component[which][i];
        out->middle[i] = product(e, pair->offset);
        out->swing[i] = kind.drifts ? product(e, pair->half) : lanes_of(0);
        out->other[i][0] = product(e, pair->component[!which][0]);
        out->other[i][1] = product(e, pair->component[!which][1]);
    }
    if (!kind.tetrahedron[which])
        return;
    out->middle[2] = out->middle[1] - out->middle[0];
    out->swing[2] = out->swing[1] - out->swing[0];
    out->other[2][0] = out->other[1][0] - out->other[0][0];
    out->other[2][1] = out->other[1][1] - out->other[0][1];
}

/* Along the edge c_0 the component c_1 is at area = [c_0 c_1]; along c_1, c_0 at -area; along
 * c_1 - c_0 both at -area. */
INLINE void add_plane_edges(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const struct walk_plane_edges *edges, struct walk_found *found)
{
    const lanes area = product(pair->component[which][0], pair->component[which][1]);
    const lanes_mask none = {0};
    UNROLL(3)
    for (int e = 0; e < edge_count(kind, which); e++) {
        const struct walk_extent own =
            extent_of_one(kind.tetrahedron[which], e == 0 ? area : -area);
        const struct walk_extent other =
            extent_of_two(kind.tetrahedron[!which], edges->other[e][0], edges->other[e][1]);
        add_slab(kind, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + e, 0},
                 extent_difference(kind, which ? other : own, which ? own : other),
                 pair->size[which][e], pair->unit, edges->middle[e], edges->swing[e], false, none,
                 found);
    }
}

INLINE void add_plane_drift(const struct walk_pair *pair, const struct walk_kind kind,
                            const struct walk_plane_edges side[2], struct walk_found *found)
{
    const lanes_mask none = {0};
    const struct walk_extent a =
        extent_of_two(kind.tetrahedron[0], -side[0].swing[0], -side[0].swing[1]);
    const struct walk_extent b =
        extent_of_two(kind.tetrahedron[1], -side[1].swing[0], -side[1].swing[1]);
    add_slab(kind, (struct slab_normal){SLABS_DRIFT, 0}, extent_difference(kind, a, b),
             pair->half_size, pair->unit, product(pair->half, pair->offset), lanes_of(0), true,
             none, found);
}

INLINE void walk_plane(const struct walk_pair *pair, const struct walk_kind kind,
                       struct walk_found *found)
{
    struct walk_plane_edges side[2];
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_plane_edges(pair, kind, which, &side[which]);
        add_plane_edges(pair, kind, which, &side[which], found);
        if (is_enough(found))
            return;
    }
    if (kind.drifts)
        add_plane_drift(pair, kind, side, found);
}

/* ---- All of it ---- */

INLINE void walk_begin(struct walk_found *found)
{
    found->surely = lanes_of(-1);
    found->possibly = lanes_of(-INFINITY);
    found->enter[0] = found->enter[1] = lanes_of(-1);
    found->leave[0] = found->leave[1] = lanes_of(1);
}

INLINE void walk(const struct walk_pair *pair, const struct walk_kind kind,
                 struct walk_found *found)
{
    if (kind.dim == 2) {
        walk_plane(pair, kind, found);
        return;
    }
    ask_axes(pair, kind, found);
    if (!is_enough(found))
        walk_space(pair, kind, found);
}

#endif
