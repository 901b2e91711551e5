/* The yardstick: the separating axis theorem in plain doubles, as a careful programmer writes it.
 * It is kept as it is, whatever becomes of the engine's own method sat, so that figures stay
 * comparable: it may only get faster.
 *
 * Two convex bodies are separated if and only if they are so along one of the normals of their
 * faces or of the planes of an edge of each; the drift of a moving pair is one more edge. All is
 * doubled, and relative to the origin of a, or to the centre where a is a cuboid: along an axis n a
 * cuboid extends to sum |n . c_i| on both sides of its centre, a sweep by w to |n . w| on both
 * sides of its middle, a tetrahedron from min(0, n . 2 c_i) to max(0, n . 2 c_i) from its origin.
 * There is no branch but the way out at an axis that separates, and no division. Rounding decides
 * near contact.
 *
 * Compiled with -ffinite-math-only -fno-signed-zeros (Makefile): the smaller and the larger of two
 * numbers are one instruction each. */
#include "lean_sat.h"

#include <math.h>

#ifndef __OPTIMIZE__
#define INLINED_NOT
#endif
#include "inlined.h"

/* Of loops that are to stay loops: dozens of axes for dozens of kinds are much code. */
#ifdef __clang__
#define ROLL _Pragma("clang loop unroll(disable)")
#else
#define ROLL UNROLL(1)
#endif

/* Edges of a body: its components, of a simplex also their differences. */
enum { EDGES_MAX = 6 };

struct kind {
    int dim;
    bool a_simplex, b_simplex;
    bool moving;
};

/* All kinds, in the order of kind_index(). */
/* clang-format off */
#define KIND_MAP(X) \
    X(2, 0, 0, 0) X(2, 0, 0, 1) X(2, 0, 1, 0) X(2, 0, 1, 1) \
    X(2, 1, 0, 0) X(2, 1, 0, 1) X(2, 1, 1, 0) X(2, 1, 1, 1) \
    X(3, 0, 0, 0) X(3, 0, 0, 1) X(3, 0, 1, 0) X(3, 0, 1, 1) \
    X(3, 1, 0, 0) X(3, 1, 0, 1) X(3, 1, 1, 0) X(3, 1, 1, 1)
/* clang-format on */

static int kind_index(const struct kind kind)
{
    return (kind.dim == 3) << 3 | kind.a_simplex << 2 | kind.b_simplex << 1 | kind.moving;
}

/* In 2D the third number of a vector is not read. */
struct sides {
    double a[EDGES_MAX][3], b[EDGES_MAX][3]; /* edges; of a simplex doubled */
    double offset[3];                        /* from a to b at first, doubled: see set_offset() */
    double drift[3];                         /* of b against a over the window */
};

/* A pair, while one axis after the other is tried. */
struct search {
    struct sides *sides;
    struct kind kind;
};

INLINE double dot(const int dim, const double *u, const double *v)
{
    const double plane = u[0] * v[0] + u[1] * v[1];
    return dim == 2 ? plane : plane + u[2] * v[2];
}

INLINE double least(double x, double y)
{
    return x < y ? x : y;
}

INLINE double most(double x, double y)
{
    return x > y ? x : y;
}

struct interval {
    double low, high;
};

INLINE struct interval extent(const int dim, const bool simplex, const double (*edge)[3],
                              const double *normal)
{
    double at[3] = {0};
    UNROLL(3)
    for (int i = 0; i < dim; i++)
        at[i] = dot(dim, normal, edge[i]);
    if (simplex) {
        const double low = least(at[0], at[1]), high = most(at[0], at[1]);
        return dim == 2
                   ? (struct interval){least(low, 0), most(high, 0)}
                   : (struct interval){least(low, least(at[2], 0)), most(high, most(at[2], 0))};
    }
    const double reach = fabs(at[0]) + fabs(at[1]) + fabs(at[2]);
    return (struct interval){-reach, reach};
}

/* False: the axis separates. One of no length has no extent, and says nothing. */
INLINE bool meet_along(struct search *search, const double *normal)
{
    const struct kind kind = search->kind;
    const struct sides *sides = search->sides;
    const struct interval a = extent(kind.dim, kind.a_simplex, sides->a, normal);
    const struct interval b = extent(kind.dim, kind.b_simplex, sides->b, normal);
    const double start = dot(kind.dim, normal, sides->offset);
    const double slope = kind.moving ? dot(kind.dim, normal, sides->drift) : 0;
    const double middle = start + slope, reach = fabs(slope);
    const double low = a.low - b.high - reach, high = a.high - b.low + reach;
    return !((middle < low) | (middle > high));
}

/* Along the normal of the plane of two edges; in 2D of the first. */
INLINE bool meet_across(struct search *search, const double *u, const double *v)
{
    if (search->kind.dim == 2)
        return meet_along(search, (const double[3]){-u[1], u[0], 0});
    return meet_along(search,
                      (const double[3]){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                        u[0] * v[1] - u[1] * v[0]});
}

/* The faces that components span: in 2D, where a face is an edge, it is the only one. */
INLINE bool meet_across_components(struct search *search, const double (*edge)[3])
{
    return meet_across(search, edge[0], edge[1]) &&
           meet_across(search, edge[1], search->kind.dim == 2 ? edge[1] : edge[2]) &&
           (search->kind.dim == 2 || meet_across(search, edge[2], edge[0]));
}

/* The face of a simplex opposite to its origin, and its other edges, which are set here: most
 * pairs that are separated are known to be so before. */
INLINE bool meet_across_last_face(struct search *search, const bool simplex, double (*edge)[3])
{
    const int dim = search->kind.dim;
    if (!simplex)
        return true;
    UNROLL(3)
    for (int axis = 0; axis < dim; axis++) {
        edge[dim][axis] = edge[1][axis] - edge[0][axis];
        if (dim == 2)
            continue;
        edge[4][axis] = edge[2][axis] - edge[0][axis];
        edge[5][axis] = edge[2][axis] - edge[1][axis];
    }
    return dim == 2 ? meet_across(search, edge[2], edge[2]) : meet_across(search, edge[3], edge[4]);
}

INLINE bool meet_across_edges(struct search *search, const double (*edge)[3], const int count,
                              const double (*other)[3], const int other_count)
{
    ROLL for (int i = 0; i < count; i++)
    {
        ROLL for (int j = 0; j < other_count;
                  j++) if (!meet_across(search, edge[i], other[j])) return false;
    }
    return true;
}

INLINE int edge_count(const bool simplex)
{
    return simplex ? EDGES_MAX : 3;
}

/* Along all axes of the bodies themselves. */
INLINE bool meet_at_some_time(struct search *search)
{
    const struct kind kind = search->kind;
    struct sides *sides = search->sides;
    return meet_across_components(search, sides->a) && meet_across_components(search, sides->b) &&
           meet_across_last_face(search, kind.a_simplex, sides->a) &&
           meet_across_last_face(search, kind.b_simplex, sides->b) &&
           (kind.dim == 2 || meet_across_edges(search, sides->a, edge_count(kind.a_simplex),
                                               sides->b, edge_count(kind.b_simplex)));
}

/* Along those that the drift adds. */
INLINE bool meet_across_drift(struct search *search)
{
    const struct kind kind = search->kind;
    const struct sides *sides = search->sides;
    const double(*drift)[3] = &sides->drift;
    if (!kind.moving)
        return true;
    if (kind.dim == 2)
        return meet_across(search, *drift, *drift);
    return meet_across_edges(search, sides->a, edge_count(kind.a_simplex), drift, 1) &&
           meet_across_edges(search, sides->b, edge_count(kind.b_simplex), drift, 1);
}

INLINE bool meet(struct search *search)
{
    return meet_at_some_time(search) && meet_across_drift(search);
}

/* components: one after the other, stride numbers apart. */
INLINE void set_components(const int dim, const bool simplex, const double *components,
                           const int stride, double (*edge)[3])
{
    UNROLL(3)
    for (int i = 0; i < dim; i++)
        for (int axis = 0; axis < dim; axis++)
            edge[i][axis] = (simplex ? 2 : 1) * components[i * stride + axis];
}

/* From origin to origin it is twice the difference, from and to centres less and more by the
 * components. */
INLINE void set_offset(const struct kind kind, const double *difference, struct sides *sides)
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        double to_a = 0, to_b = 0;
        for (int i = 0; i < kind.dim; i++) {
            to_a += kind.a_simplex ? 0 : sides->a[i][axis];
            to_b += kind.b_simplex ? 0 : sides->b[i][axis];
        }
        sides->offset[axis] = 2 * difference[axis] + (to_b - to_a);
    }
}

struct lean_pair {
    const struct lean_frame *a, *b;
    double duration;
};

INLINE bool pair_meets(const struct lean_pair *pair, const struct kind kind)
{
    const int dim = kind.dim;
    double difference[3];
    struct sides sides;
    struct search search = {.sides = &sides, .kind = kind};
    UNROLL(3)
    for (int axis = 0; axis < dim; axis++) {
        difference[axis] = pair->b->origin[axis] - pair->a->origin[axis];
        if (kind.moving)
            sides.drift[axis] =
                (pair->b->velocity[axis] - pair->a->velocity[axis]) * pair->duration;
    }
    set_components(dim, kind.a_simplex, pair->a->component[0], 3, sides.a);
    set_components(dim, kind.b_simplex, pair->b->component[0], 3, sides.b);
    set_offset(kind, difference, &sides);
    return meet(&search);
}

#define X(dim, a, b, moving)                                            \
    static bool meets_##dim##a##b##moving(const struct lean_pair *pair) \
    {                                                                   \
        return pair_meets(pair, (struct kind){dim, a, b, moving});      \
    }
KIND_MAP(X)
#undef X

bool lean_meets(const struct lean_frame *a, const struct lean_frame *b, double duration)
{
#define X(dim, a, b, moving) meets_##dim##a##b##moving,
    static bool (*const meets[])(const struct lean_pair *pair) = {KIND_MAP(X)};
#undef X
    const struct lean_pair pair = {a, b, duration};
    return meets[kind_index((struct kind){a->kind & LEAN_SPACE ? 3 : 2, a->kind & LEAN_SIMPLEX,
                                          b->kind & LEAN_SIMPLEX,
                                          (a->kind | b->kind) & LEAN_MOVING})](&pair);
}

/* ---- Placing ---- */

/* Half of the divisor of fmb.h is in the products, the squares that are subtracted from 1 are those
 * of the other two axes. */
static void set_matrix(const double *q, double m[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double twice = 2 / (w * w + x * x + (y * y + z * z));
    const double xs = twice * x, ys = twice * y, zs = twice * z;
    m[0][0] = 1 - (ys * y + zs * z);
    m[0][1] = xs * y - zs * w;
    m[0][2] = xs * z + ys * w;
    m[1][0] = xs * y + zs * w;
    m[1][1] = 1 - (xs * x + zs * z);
    m[1][2] = ys * z - xs * w;
    m[2][0] = xs * z - ys * w;
    m[2][1] = ys * z + xs * w;
    m[2][2] = 1 - (xs * x + ys * y);
}

static void place_in_space(const struct fmb_frame *frame, const struct fmb_placement *placement,
                           struct lean_frame *out)
{
    double m[3][3];
    set_matrix(placement->orientation, m);
    for (int axis = 0; axis < 3; axis++) {
        const double *row = m[axis];
        out->origin[axis] = placement->position[axis] + dot(3, row, frame->origin);
        for (int i = 0; i < 3; i++)
            out->component[i][axis] = frame->shape == FMB_BOX ? row[i] * frame->component[i][i]
                                                              : dot(3, row, frame->component[i]);
    }
}

static void place_in_plane(const struct fmb_frame *frame, const struct fmb_placement *placement,
                           struct lean_frame *out)
{
    const double w = placement->orientation[0], z = placement->orientation[1];
    const double twice = 2 / (w * w + z * z), sine = twice * w * z, cosine = 1 - twice * z * z;
    const double m[2][2] = {{cosine, -sine}, {sine, cosine}};
    for (int axis = 0; axis < 2; axis++) {
        out->origin[axis] = placement->position[axis] + dot(2, m[axis], frame->origin);
        for (int i = 0; i < 2; i++)
            out->component[i][axis] = dot(2, m[axis], frame->component[i]);
    }
}

static void place_unturned(const struct fmb_frame *frame, const struct fmb_placement *placement,
                           struct lean_frame *out)
{
    for (int axis = 0; axis < 3; axis++) {
        out->origin[axis] = placement->position[axis] + frame->origin[axis];
        for (int i = 0; i < 3; i++)
            out->component[i][axis] = frame->component[i][axis];
    }
}

void lean_place(const struct fmb_frame *frame, const struct fmb_placement *placement,
                struct lean_frame *out)
{
    const double *v = placement->velocity;
    out->kind = (v[0] != 0 || v[1] != 0 || v[2] != 0 ? LEAN_MOVING : 0) |
                (frame->shape == FMB_TETRAHEDRON ? LEAN_SIMPLEX : 0) |
                (frame->dim == 3 ? LEAN_SPACE : 0);
    for (int axis = 0; axis < 3; axis++)
        out->velocity[axis] = v[axis];
    if (placement->orientation_count == 0)
        place_unturned(frame, placement, out);
    else if (frame->dim == 3)
        place_in_space(frame, placement, out);
    else
        place_in_plane(frame, placement, out);
}
