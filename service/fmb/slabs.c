/* Method. With [x y z] = (x x y) . z, the triple product, everything that the list needs of a
 * pair in 3D is a triple product of vectors among the components a_i and b_j, the offset d and
 * the drift D, or a sum of a few. With n_k = a_i x a_j (i, j, k cyclic) for the faces:
 *
 *     faces of A          n_k . a_k, n_k . b_j, n_k . d, n_k . D
 *     edges a_i, b_j      [a_i b_j w] for w = d, D; and [a_i b_j a_k] = b_j . (a_k x a_i) and
 *                         [a_i b_j b_k] = a_i . (b_j x b_k), which the faces have already
 *     edge a_i, drift     [a_i D a_k] = D . (a_k x a_i) and [a_i D b_j] = -[a_i b_j D], likewise;
 *                         [a_i D d]
 *
 * Edges of a tetrahedron that are not components are differences of two, and all of this is
 * linear in each edge. With p, q, r cyclic, e = a_q - a_p and any x:
 *
 *     [e x a_p] = [e x a_q] = x . (a_p x a_q) = x . n_r
 *     [e x a_r] = x . (a_r x a_q) - x . (a_r x a_p) = -x . n_p - x . n_q
 *
 * and the normal of the face across from the origin is n_0 + n_1 + n_2. In 2D the products
 * [x y] = x_0 y_1 - x_1 y_0 take the place of these.
 *
 * Accuracy, with u = 2^-53, for any order of summation and with or without fused operations.
 * Let |x| be the largest magnitude in x, |e| = |a_p| + |a_q| for an edge that is a difference, and
 * T = |d| + |D| + sum |a_i| + sum |b_j|. The gap of the slab u x v is a sum of products
 * n . w, at most one for each of the vectors w that T sums, and each of these is a sum of
 * monomials u_i v_j w_k of which at most 6 |u| |v| |w| is the sum of the magnitudes (two for each
 * entry of a cross product, three entries). A monomial is rounded at most
 *
 *     3 times before: d (once) and D (twice)
 *     2 times in a cross product, 3 in a dot product with it
 *     2 times where two edges are differences, 1 in x . n_p + x . n_q (face: 2)
 *     2 times in the extent of a cuboid, 3 in the gap
 *
 * which is 16 times: its share of the result has a factor within (1 +- u)^16, and the sum an error
 * of at most 16.01 u 6 |u| |v| T < 97 u |u| |v| T. Maxima and minima do not round, and move by
 * no more than what they choose from. The bound 2^-46 |u| |v| T = 128 u |u| |v| T is itself
 * computed with at most 15 roundings, which takes less than 2^-49 of it, and the sum of it and what
 * it bounds rounds once more, by less than 7 u |u| |v| T: what is left of it covers both. In 2D:
 * two monomials, rounded at most 3 + 2 + 1 + 1 + 3 = 10 times, 21 u |u| T against 32. (That of low,
 * high, start and slope alone is no larger.)
 *
 * The face across from the origin has |u| |v| = sum over i < j of |a_i| |a_j|: its normal is the
 * sum of these three cross products.
 *
 * Overflow and underflow: sizes and a drift that is not 0 lie between 2^-200 and 2^200, offsets
 * below 2^200 (slabs_prepare), so that nothing overflows. Entries and products may
 * underflow: each of at most 100 operations then adds less than 2^-1074, to cross products and
 * D before they are multiplied by at most 2^401, while |u| |v| T 2^-53 is at least
 * 2^-653: the rest of the bound covers that many times over. */
#include "slabs.h"

#include "inlined.h"
#include "weighed.h"

#include <math.h>

static double largest_of(double largest, const double v[3])
{
    return fmax(largest, fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))));
}

bool slabs_prepare(const struct fmb_pair *pair, struct slabs_pair *out)
{
    out->a = pair->a.body;
    out->b = pair->b.body;
    if (!out->a->in_range || !out->b->in_range || !relative_motion_of(pair, &out->motion))
        return false;
    double offset = largest_of(0, out->motion.offset);
    double drift = largest_of(0, out->motion.drift);
    out->drift_size = drift;
    out->reach = (offset + drift) + ((out->a->size[0] + out->a->size[1] + out->a->size[2]) +
                                     (out->b->size[0] + out->b->size[1] + out->b->size[2]));
    return offset <= 0x1p200 && drift <= 0x1p200 && (drift >= 0x1p-200 || !out->motion.drifts);
}

/* ---- The list ----
 *
 * The functions below are made for each kind of pair by inlining: shapes, dimension and motion are
 * constants there. Each slab is judged where it is found, and kept if a list is wanted. */

struct found {
    double surely;           /* largest of gap - error: > 0 where some slab surely separates */
    double possibly;         /* largest of gap + error: < 0 where all slabs surely overlap */
    struct slab_value *next; /* where the next slab is kept; NULL: no list is wanted */
};

struct kind {
    enum fmb_shape a, b;
    bool drifts;
};

struct range {
    double low, high;
};

INLINE double below_zero(double x)
{
    return x < 0 ? x : 0;
}

INLINE double above_zero(double x)
{
    return x > 0 ? x : 0;
}

INLINE double least(double x, double y)
{
    return x < y ? x : y;
}

INLINE double greatest(double x, double y)
{
    return x > y ? x : y;
}

/* Of a frame with its origin at 0, from normal . c of the components for which it is not 0. */
INLINE struct range extent_of_one(double x)
{
    return (struct range){below_zero(x), above_zero(x)};
}

INLINE struct range extent_of_two(enum fmb_shape shape, double x, double y)
{
    if (shape == FMB_CUBOID)
        return (struct range){below_zero(x) + below_zero(y), above_zero(x) + above_zero(y)};
    return (struct range){below_zero(least(x, y)), above_zero(greatest(x, y))};
}

INLINE struct range extent_of_three(enum fmb_shape shape, double x, double y, double z)
{
    if (shape == FMB_CUBOID)
        return (struct range){(below_zero(x) + below_zero(y)) + below_zero(z),
                              (above_zero(x) + above_zero(y)) + above_zero(z)};
    return (struct range){below_zero(least(least(x, y), z)),
                          above_zero(greatest(greatest(x, y), z))};
}

INLINE double dot(const double u[3], const double v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

INLINE void cross(const double u[3], const double v[3], double out[3])
{
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

INLINE int next(int i)
{
    return i == 2 ? 0 : i + 1;
}

INLINE int edge_count(enum fmb_shape shape)
{
    return shape == FMB_CUBOID ? 3 : 6;
}

/* What a frame has of its own, and what of the pair is linear in its normals. */
struct side {
    double n[3][3]; /* n[k] = c_i x c_j */
    double volume;  /* n[k] . c_k, any k */
    double size[SLABS_EDGES];
    double other[3][SLABS_EDGES]; /* n[k] . edges of the other frame */
    double start[3], slope[3];    /* n[k] . offset, n[k] . drift */
};

/* What is linear in an edge of each. */
struct edges {
    double start[SLABS_EDGES][SLABS_EDGES], slope[SLABS_EDGES][SLABS_EDGES]; /* [a b d], [a b D] */
};

INLINE void add_differences(enum fmb_shape shape, double value[SLABS_EDGES])
{
    if (shape == FMB_CUBOID)
        return;
    value[3] = value[2] - value[1];
    value[4] = value[0] - value[2];
    value[5] = value[1] - value[0];
}

INLINE void set_side(const struct slabs_pair *pair, const struct kind kind, int which,
                     struct side *out)
{
    const struct fmb_body *own = which ? pair->b : pair->a, *other = which ? pair->a : pair->b;
    const enum fmb_shape shape = which ? kind.b : kind.a, other_shape = which ? kind.a : kind.b;
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        cross(own->component[next(k)], own->component[next(next(k))], out->n[k]);
        out->size[k] = own->size[k];
        if (shape != FMB_CUBOID)
            out->size[3 + k] = own->size[next(k)] + own->size[next(next(k))];
        out->start[k] = dot(out->n[k], pair->motion.offset);
        out->slope[k] = kind.drifts ? dot(out->n[k], pair->motion.drift) : 0;
        UNROLL(3)
        for (int j = 0; j < 3; j++)
            out->other[k][j] = dot(out->n[k], other->component[j]);
        add_differences(other_shape, out->other[k]);
    }
    out->volume = dot(out->n[0], own->component[0]);
}

/* The differences of a tetrahedron's components take part in both indices alike, so that the pair
 * the other way round has the same bits. */
INLINE void add_product_differences(const struct kind kind, double value[SLABS_EDGES][SLABS_EDGES])
{
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), q = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            if (kind.b != FMB_CUBOID)
                value[j][3 + i] = value[j][q] - value[j][p];
            if (kind.a != FMB_CUBOID)
                value[3 + i][j] = value[q][j] - value[p][j];
            const int r = next(j), s = next(r);
            if (kind.a != FMB_CUBOID && kind.b != FMB_CUBOID)
                value[3 + i][3 + j] = (value[q][s] + value[p][r]) - (value[q][r] + value[p][s]);
        }
    }
}

INLINE void set_edges(const struct slabs_pair *pair, const struct kind kind, struct edges *out)
{
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        UNROLL(3)
    for (int j = 0; j < 3; j++) {
        double normal[3];
        cross(pair->a->component[i], pair->b->component[j], normal);
        out->start[i][j] = dot(normal, pair->motion.offset);
        out->slope[i][j] = kind.drifts ? dot(normal, pair->motion.drift) : 0;
    }
    add_product_differences(kind, out->start);
    if (kind.drifts)
        add_product_differences(kind, out->slope);
}

/* A zero normal says nothing. Since both frames are solid, it shows in that their extents along it
 * are zero: certain where nothing rounds. */
INLINE void judge(struct found *found, const struct slab_value *slab)
{
    const double gap = slab_gap(slab);
#ifndef SLABS_UNBOUNDED
    const bool says_nothing = slab->error == 0 && slab->low == slab->high;
    found->surely = greatest(gap - slab->error, found->surely);
    found->possibly = greatest(says_nothing ? -INFINITY : gap + slab->error, found->possibly);
#else /* for the benchmark: what the bounds cost */
    found->surely = found->possibly = greatest(gap, found->possibly);
#endif
}

INLINE void add_slab(struct found *found, struct slab_normal normal, double error, struct range a,
                     struct range b, double start, double slope)
{
    const struct slab_value slab = {.normal = normal,
                                    .low = a.low - b.high,
                                    .high = a.high - b.low,
                                    .start = start,
                                    .slope = slope,
                                    .error = error};
    judge(found, &slab);
    if (found->next)
        *found->next++ = slab;
}

/* The faces of A (which = 0) or of B. The extent of a frame along its own normals is that of one
 * component; across from the origin all three have the same. */
INLINE void add_faces(const struct kind kind, const struct side *side, int which, double unit,
                      struct found *found)
{
    const enum fmb_shape shape = which ? kind.b : kind.a, other_shape = which ? kind.a : kind.b;
    const int first = which ? SLABS_EDGE_OF_B : 0;
    const struct range own = extent_of_one(side->volume);
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        const double *at = side->other[k];
        const struct range other = extent_of_three(other_shape, at[0], at[1], at[2]);
        const int i = next(k), j = next(i);
        add_slab(found, (struct slab_normal){first + i, first + j},
                 side->size[i] * side->size[j] * unit, which ? other : own, which ? own : other,
                 side->start[k], side->slope[k]);
    }
    if (shape == FMB_CUBOID)
        return;
    double at[3];
    UNROLL(3)
    for (int j = 0; j < 3; j++)
        at[j] = (side->other[0][j] + side->other[1][j]) + side->other[2][j];
    const struct range other = extent_of_three(other_shape, at[0], at[1], at[2]);
    const double *size = side->size;
    const double scale = (size[0] * size[1] + size[1] * size[2]) + size[2] * size[0];
    add_slab(found, (struct slab_normal){first + 3, first + 4}, scale * unit, which ? other : own,
             which ? own : other, (side->start[0] + side->start[1]) + side->start[2],
             (side->slope[0] + side->slope[1]) + side->slope[2]);
}

/* The extent of a frame along e x f (f x e: the same with its ends exchanged and negative), e an
 * edge of its own; at[k] = n_k . f. */
INLINE struct range extent_at_edge(enum fmb_shape shape, int e, double at0, double at1, double at2)
{
    const double at[3] = {at0, at1, at2};
    if (e < 3)
        return extent_of_two(shape, -at[next(next(e))], at[next(e)]);
    const int r = e - 3, p = next(r), q = next(p);
    return extent_of_two(shape, at[r], -(at[p] + at[q]));
}

INLINE struct range negative(struct range x)
{
    return (struct range){-x.high, -x.low};
}

INLINE void add_edges(const struct kind kind, const struct side side[2], const struct edges *edges,
                      double unit, struct found *found)
{
    const struct side *a = &side[0], *b = &side[1];
    UNROLL(6)
    for (int i = 0; i < edge_count(kind.a); i++)
        UNROLL(6)
    for (int j = 0; j < edge_count(kind.b); j++) {
        struct range of_a =
            extent_at_edge(kind.a, i, a->other[0][j], a->other[1][j], a->other[2][j]);
        struct range of_b =
            negative(extent_at_edge(kind.b, j, b->other[0][i], b->other[1][i], b->other[2][i]));
        add_slab(found, (struct slab_normal){i, SLABS_EDGE_OF_B + j},
                 a->size[i] * b->size[j] * unit, of_a, of_b, edges->start[i][j],
                 kind.drifts ? edges->slope[i][j] : 0);
    }
}

/* The planes of the edges of A (which = 0) or of B with the drift: e x D. start = [e D d] for the
 * components, e . (D x d); the slope is 0. [a D b] = -[a b D], [b D a] = [a b D]. */
INLINE void add_drift(const struct slabs_pair *pair, const struct kind kind,
                      const struct side side[2], const struct edges *edges, int which, double unit,
                      struct found *found)
{
    const struct side *own = &side[which];
    const struct fmb_body *body = which ? pair->b : pair->a;
    const enum fmb_shape shape = which ? kind.b : kind.a, other_shape = which ? kind.a : kind.b;
    double plane[3], start[SLABS_EDGES];
    cross(pair->motion.drift, pair->motion.offset, plane);
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        start[i] = dot(plane, body->component[i]);
    add_differences(shape, start);
    UNROLL(6)
    for (int i = 0; i < edge_count(shape); i++) {
        double at[3];
        UNROLL(3)
        for (int j = 0; j < 3; j++)
            at[j] = which ? edges->slope[j][i] : -edges->slope[i][j];
        const struct range of_own =
            extent_at_edge(shape, i, own->slope[0], own->slope[1], own->slope[2]);
        const struct range of_other = extent_of_three(other_shape, at[0], at[1], at[2]);
        add_slab(found, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + i, SLABS_DRIFT},
                 own->size[i] * pair->drift_size * unit, which ? of_other : of_own,
                 which ? of_own : of_other, start[i], 0);
    }
}

/* ---- 2D ---- */

struct plane_edges {
    double size[3];
    double start[3], slope[3]; /* [e d], [e D] */
    double other[3][2];        /* [e, component of the other frame] */
};

INLINE double product(const double x[2], const double y[2])
{
    return x[0] * y[1] - x[1] * y[0];
}

INLINE void set_plane_edges(const struct slabs_pair *pair, const struct kind kind, int which,
                            struct plane_edges *out)
{
    const struct fmb_body *own = which ? pair->b : pair->a, *other = which ? pair->a : pair->b;
    UNROLL(2)
    for (int i = 0; i < 2; i++) {
        const double *e = own->component[i];
        out->size[i] = own->size[i];
        out->start[i] = product(e, pair->motion.offset);
        out->slope[i] = kind.drifts ? product(e, pair->motion.drift) : 0;
        out->other[i][0] = product(e, other->component[0]);
        out->other[i][1] = product(e, other->component[1]);
    }
    out->size[2] = out->size[0] + out->size[1];
    out->start[2] = out->start[1] - out->start[0];
    out->slope[2] = out->slope[1] - out->slope[0];
    out->other[2][0] = out->other[1][0] - out->other[0][0];
    out->other[2][1] = out->other[1][1] - out->other[0][1];
}

INLINE int plane_edge_count(enum fmb_shape shape)
{
    return shape == FMB_CUBOID ? 2 : 3;
}

/* Along the edge c_0 the component c_1 is at area = [c_0 c_1]; along c_1, c_0 at -area; along
 * c_1 - c_0 both at -area. */
INLINE void add_plane_edges(const struct slabs_pair *pair, const struct kind kind, int which,
                            const struct plane_edges *edges, double unit, struct found *found)
{
    const struct fmb_body *own = which ? pair->b : pair->a;
    const enum fmb_shape shape = which ? kind.b : kind.a, other_shape = which ? kind.a : kind.b;
    const double area = product(own->component[0], own->component[1]);
    UNROLL(3)
    for (int e = 0; e < plane_edge_count(shape); e++) {
        const struct range of_own = extent_of_one(e == 0 ? area : -area);
        const struct range of_other =
            extent_of_two(other_shape, edges->other[e][0], edges->other[e][1]);
        add_slab(found, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + e, 0},
                 edges->size[e] * unit, which ? of_other : of_own, which ? of_own : of_other,
                 edges->start[e], edges->slope[e]);
    }
}

INLINE void add_plane_drift(const struct slabs_pair *pair, const struct kind kind,
                            const struct plane_edges *a, const struct plane_edges *b, double unit,
                            struct found *found)
{
    add_slab(found, (struct slab_normal){SLABS_DRIFT, 0}, pair->drift_size * unit,
             extent_of_two(kind.a, -a->slope[0], -a->slope[1]),
             extent_of_two(kind.b, -b->slope[0], -b->slope[1]),
             product(pair->motion.drift, pair->motion.offset), 0);
}

/* ---- All of them ---- */

/* Asked between the parts of the list. */
INLINE bool is_enough(const struct found *found)
{
    return found->surely > 0 && !found->next;
}

INLINE void walk_plane(const struct slabs_pair *pair, const struct kind kind, double unit,
                       struct found *found)
{
    struct plane_edges a, b;
    set_plane_edges(pair, kind, 0, &a);
    add_plane_edges(pair, kind, 0, &a, unit, found);
    if (is_enough(found))
        return;
    set_plane_edges(pair, kind, 1, &b);
    add_plane_edges(pair, kind, 1, &b, unit, found);
    if (kind.drifts)
        add_plane_drift(pair, kind, &a, &b, unit, found);
}

INLINE void walk_space(const struct slabs_pair *pair, const struct kind kind, double unit,
                       struct found *found)
{
    struct side side[2];
    struct edges edges;
    for (int which = 0; which < 2; which++) {
        set_side(pair, kind, which, &side[which]);
        add_faces(kind, &side[which], which, unit, found);
        if (is_enough(found))
            return;
    }
    set_edges(pair, kind, &edges);
    add_edges(kind, side, &edges, unit, found);
    if (!kind.drifts || is_enough(found))
        return;
    add_drift(pair, kind, side, &edges, 0, unit, found);
    add_drift(pair, kind, side, &edges, 1, unit, found);
}

/* The error of a slab of scale 1. */
static double error_unit(const struct slabs_pair *pair, bool rounds)
{
    return rounds ? (pair->a->dim == 2 ? SLABS_ROUNDING_2D : SLABS_ROUNDING) * pair->reach : 0;
}

/* next: where slabs are to be kept, or NULL. */
static struct found walk(const struct slabs_pair *pair, bool rounds, struct slab_value *next)
{
    const double unit = error_unit(pair, rounds);
    struct found found = {-1, -INFINITY, next};
#define WALK(function, shape_a, shape_b)                                          \
    if (pair->a->shape == (shape_a) && pair->b->shape == (shape_b)) {             \
        if (pair->motion.drifts)                                                  \
            function(pair, (struct kind){shape_a, shape_b, true}, unit, &found);  \
        else                                                                      \
            function(pair, (struct kind){shape_a, shape_b, false}, unit, &found); \
        return found;                                                             \
    }
#define WALK_ALL(function)                      \
    WALK(function, FMB_CUBOID, FMB_CUBOID)      \
    WALK(function, FMB_CUBOID, FMB_TETRAHEDRON) \
    WALK(function, FMB_TETRAHEDRON, FMB_CUBOID) \
    WALK(function, FMB_TETRAHEDRON, FMB_TETRAHEDRON)
    if (pair->a->dim == 2) {
        WALK_ALL(walk_plane)
    } else {
        WALK_ALL(walk_space)
    }
#undef WALK_ALL
#undef WALK
    return found;
}

/* ---- What is made of them ---- */

/* The axes are normals of slabs too, if not of facets: the first to ask, since they cost next to
 * nothing. Roundings: 2 in an extent, 2 in the drift, 4 in the gap, of numbers of which T is the
 * sum: at most 8.01 u T. */
static bool extents_separate(const struct slabs_pair *pair)
{
    const double *offset = pair->motion.offset, *drift = pair->motion.drift;
    const double error = 0x1p-49 * pair->reach;
    double gap = -1;
    for (int axis = 0; axis < 3; axis++) {
        double above = (offset[axis] + below_zero(drift[axis])) -
                       (pair->a->extent[1][axis] - pair->b->extent[0][axis]);
        double below = (pair->a->extent[0][axis] - pair->b->extent[1][axis]) -
                       (offset[axis] + above_zero(drift[axis]));
        gap = greatest(gap, greatest(above, below));
    }
    return gap > error;
}

enum slabs_outcome slabs_filter(const struct slabs_pair *pair, bool rounds)
{
    if (extents_separate(pair))
        return SLABS_SEPARATED;
    const struct found found = walk(pair, rounds, NULL);
    if (found.surely > 0)
        return SLABS_SEPARATED;
    return found.possibly < 0 ? SLABS_OVERLAPPING : SLABS_UNSURE;
}

int slabs_list(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX])
{
    return (int) (walk(pair, rounds, out).next - out);
}

/* ---- One slab alone ---- */

static struct weighed edge_of(const struct slabs_pair *pair, int number)
{
    if (number == SLABS_DRIFT)
        return weigh(pair->motion.drift);
    const struct fmb_body *body = number < SLABS_EDGE_OF_B ? pair->a : pair->b;
    const int e = number % SLABS_EDGES;
    if (e < body->dim)
        return weigh(body->component[e]);
    const int p = body->dim == 2 ? 0 : next(e % 3), q = body->dim == 2 ? 1 : next(p);
    const struct weighed from = weigh(body->component[p]), to = weigh(body->component[q]);
    return weighed_sum(&to, -1, &from);
}

/* A number known within error. */
struct known {
    double value, error;
};

static struct known known_dot(const struct weighed *normal, const double w[FMB_DIM_MAX])
{
    const struct weighed vector = weigh(w);
    return (struct known){weighed_dot(normal->at, vector.at),
                          weighed_error(weighed_dot(normal->weight, vector.weight))};
}

static double middle_error(double low, double value, double high)
{
    return greatest(value - low, high - value);
}

/* The largest of 0 and of all x (simplex), or the sum of those that are positive (cuboid), from
 * sign x. A component that surely does not count brings no error. Subtractions and sums round by
 * less than what weighed_error() leaves room for. */
static struct known farthest(const struct fmb_body *body, const struct known x[FMB_DIM_MAX],
                             double sign)
{
    double value = 0, low = 0, high = 0;
    for (int i = 0; i < body->dim; i++) {
        const double at = sign * x[i].value;
        const double below = above_zero(at - x[i].error), above = above_zero(at + x[i].error);
        if (body->shape == FMB_CUBOID) {
            value += above_zero(at);
            low += above > 0 ? below - above_zero(at) : 0;
            high += above > 0 ? above - above_zero(at) : 0;
        } else {
            value = greatest(value, at);
            low = greatest(low, below);
            high = greatest(high, above);
        }
    }
    return (struct known){
        value, body->shape == FMB_CUBOID ? greatest(-low, high) : middle_error(low, value, high)};
}

void slab_inequalities(const struct slab_value *slab, struct inequality out[2])
{
    out[0] = (struct inequality){slab->start - slab->low, slab->slope, slab->error, slab->error};
    out[1] = (struct inequality){slab->high - slab->start, -slab->slope, slab->error, slab->error};
}

/* Below: start - low, with low = -(farthest of A against the normal) - farthest of B along it. */
void slabs_refine(const struct slabs_pair *pair, struct slab_normal edges, struct inequality out[2])
{
    const struct weighed u = edge_of(pair, edges.u), v = edge_of(pair, edges.v);
    const struct weighed normal = pair->a->dim == 2 ? weighed_turn(&u) : weighed_cross(&u, &v);
    const struct known start = known_dot(&normal, pair->motion.offset);
    const struct known slope = known_dot(&normal, pair->motion.drift);
    struct known a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    for (int i = 0; i < pair->a->dim; i++) {
        a[i] = known_dot(&normal, pair->a->component[i]);
        b[i] = known_dot(&normal, pair->b->component[i]);
    }
    for (int side = 0; side < 2; side++) {
        const double sign = side ? -1 : 1;
        const struct known of_a = farthest(pair->a, a, -sign), of_b = farthest(pair->b, b, sign);
        out[side] =
            (struct inequality){sign * start.value + (of_a.value + of_b.value), sign * slope.value,
                                start.error + (of_a.error + of_b.error), slope.error};
    }
}
