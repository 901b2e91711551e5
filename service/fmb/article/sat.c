/* The separating axis theorem, the article's comparator. Two convex bodies are separated if and
 * only if they are separated along a normal of one of their faces, or of the plane of an edge of
 * each (Eberly and Schneider, the article's reference 1). A moving body sweeps a convex body too:
 * its drift over the window is one more edge. The times of contact are computed only for moving
 * pairs in contact: along each axis the contact is an interval of time, and all of these must
 * intersect.
 *
 * All numbers are doubled, and relative to the origin of a, or to its centre if a is a cuboid.
 * Along an axis n a cuboid extends to sum |n . c_i| on both sides of its centre, a sweep by w to |n
 * . w| on both sides of its middle, and a tetrahedron from min(0, n . 2 c_i) to max(0, n . 2 c_i)
 * from its origin. No vertex is computed. The only branch is the exit at an axis that separates,
 * and the only divisions are those for the interval. The kernel is instantiated for each dimension,
 * pair of shapes and motion by inlining.
 *
 * Accuracy: none is guaranteed. Rounding decides near contact, but only there: products that would
 * be 0 if nothing rounded, such as that of an edge with its own normal, are computed like the
 * others. The normal of nearly parallel edges consists of rounding errors. It is a direction all
 * the same, and extents along it are as accurate as along any other.
 *
 * This file is compiled with -ffinite-math-only -fno-signed-zeros (Makefile), so that least() and
 * most() are one instruction each. These options change no bit of an answer of sat_decide(), where
 * all numbers are finite and the sign of a 0 is not used. */
#include "inexact.h"

#ifndef __OPTIMIZE__ /* megabytes of it, for nothing */
#define INLINED_NOT
#endif
#include "inlined.h"
#include "prepared.h"

#include <math.h>

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

enum purpose { VERDICT, WHEN };

/* A search along one axis after another. (The sides are not members: compilers do not optimize
 * structs with arrays that are indexed.) */
struct sat_search {
    struct sides *sides;
    struct kind kind;
    enum purpose purpose;
    bool touching;  /* so far */
    double when[2]; /* tau of the first and the last contact so far, in windows */
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

struct sat_interval {
    double low, high;
};

INLINE struct sat_interval extent(const int dim, const bool simplex, const double (*edge)[3],
                                  const double *normal)
{
    double at[3] = {0};
    UNROLL(3)
    for (int i = 0; i < dim; i++)
        at[i] = dot(dim, normal, edge[i]);
    if (simplex) {
        const double low = least(at[0], at[1]), high = most(at[0], at[1]);
        return dim == 2
                   ? (struct sat_interval){least(low, 0), most(high, 0)}
                   : (struct sat_interval){least(low, least(at[2], 0)), most(high, most(at[2], 0))};
    }
    const double reach = fabs(at[0]) + fabs(at[1]) + fabs(at[2]);
    return (struct sat_interval){-reach, reach};
}

/* The pair is in contact along the axis while low <= start + 2 tau slope <= high. A slope of 0
 * says nothing of tau, as the verdict is known to be contact. */
INLINE void narrow(struct sat_search *search, struct sat_interval range, double start, double slope)
{
    const double still = slope == 0, rate = 2 * slope + still; /* never 0 */
    const double low = (range.low - start) / rate, high = (range.high - start) / rate;
    search->when[0] = most(search->when[0], still != 0 ? 0 : least(low, high));
    search->when[1] = least(search->when[1], still != 0 ? 1 : most(low, high));
}

/* False: the axis separates. One of no length has no extent, and says nothing. */
INLINE bool meet_along(struct sat_search *search, const double *normal)
{
    const struct kind kind = search->kind;
    const struct sides *sides = search->sides;
    const struct sat_interval a = extent(kind.dim, kind.a_simplex, sides->a, normal);
    const struct sat_interval b = extent(kind.dim, kind.b_simplex, sides->b, normal);
    const struct sat_interval range = {a.low - b.high, a.high - b.low};
    const double start = dot(kind.dim, normal, sides->offset);
    const double slope = kind.moving ? dot(kind.dim, normal, sides->drift) : 0;
    if (search->purpose == WHEN) {
        narrow(search, range, start, slope);
        return true;
    }
    const double middle = start + slope, reach = fabs(slope);
    const double low = range.low - reach, high = range.high + reach;
    search->touching |= (middle == low || middle == high) && low < high;
    return !((middle < low) | (middle > high));
}

/* Along the normal of the plane of two edges; in 2D of the first. */
INLINE bool meet_across(struct sat_search *search, const double *u, const double *v)
{
    if (search->kind.dim == 2)
        return meet_along(search, (const double[3]){-u[1], u[0], 0});
    return meet_along(search,
                      (const double[3]){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                        u[0] * v[1] - u[1] * v[0]});
}

/* The faces that components span: in 2D, where a face is an edge, it stands alone. */
INLINE bool meet_across_components(struct sat_search *search, const double (*edge)[3])
{
    return meet_across(search, edge[0], edge[1]) &&
           meet_across(search, edge[1], search->kind.dim == 2 ? edge[1] : edge[2]) &&
           (search->kind.dim == 2 || meet_across(search, edge[2], edge[0]));
}

/* The face of a simplex opposite to its origin, and its other edges, which are set here: most
 * pairs that are separated are known to be so before. */
INLINE bool meet_across_last_face(struct sat_search *search, const bool simplex, double (*edge)[3])
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

INLINE bool meet_across_edges(struct sat_search *search, const double (*edge)[3], const int count,
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
INLINE bool meet_at_some_time(struct sat_search *search)
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
INLINE bool meet_across_drift(struct sat_search *search)
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

INLINE bool meet(struct sat_search *search)
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

/* ---- The method ---- */

/* Rounding may have put the first contact after the last one, or both out of the window. */
static void answer_contact(const double when[2], double duration, struct fmb_answer *answer)
{
    const double middle = least(most((when[0] + when[1]) / 2, 0), 1);
    const bool in_order = when[0] <= when[1];
    const struct bounds bounds = {
        .strict = {in_order ? when[0] : middle, in_order ? when[1] : middle}, .closed = {0, 1}};
    bounds_answer_contact(&bounds, duration, answer); /* not here: it makes 0 of -0 */
}

INLINE void decide(const struct inexact_pair *pair, const struct kind kind,
                   struct fmb_answer *answer)
{
    struct sides sides;
    struct sat_search search = {.sides = &sides, .kind = kind, .purpose = VERDICT};
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++)
        sides.drift[axis] = pair->motion.drift[axis];
    set_components(kind.dim, kind.a_simplex, pair->a.component[0], 3, sides.a);
    set_components(kind.dim, kind.b_simplex, pair->b.component[0], 3, sides.b);
    set_offset(kind, pair->motion.offset, &sides);
    answer->verdict = FMB_SEPARATED;
    if (!meet(&search))
        return;
    answer->verdict = search.touching ? FMB_TOUCHING : FMB_OVERLAPPING;
    answer->has_contact = true;
    answer->contact[1] = pair->duration + 0.0; /* never -0 */
    if (!kind.moving)
        return;
    search.purpose = WHEN;
    search.when[0] = 0;
    search.when[1] = 1;
    meet_at_some_time(&search);
    answer_contact(search.when, pair->duration, answer);
}

#define X(dim, a, b, moving)                                                \
    static void decide_##dim##a##b##moving(const struct inexact_pair *pair, \
                                           struct fmb_answer *answer)       \
    {                                                                       \
        decide(pair, (struct kind){dim, a, b, moving}, answer);             \
    }
KIND_MAP(X)
#undef X

static double largest_of(const double v[3], double largest)
{
    for (int axis = 0; axis < 3; axis++)
        largest = most(fabs(v[axis]), largest);
    return largest;
}

/* Products of three lengths, differences and sums of a few of them, must neither overflow nor all
 * vanish: the largest length of the pair has to be within 2^-300 and 2^300. */
static bool in_range(const struct inexact_pair *pair)
{
    double largest = largest_of(pair->motion.offset, 0);
    largest = largest_of(pair->motion.drift, largest);
    for (int i = 0; i < 3; i++)
        largest = most(most(pair->a.size[i], pair->b.size[i]), largest);
    return largest >= 0x1p-300 && largest <= 0x1p300;
}

enum fmb_status sat_decide(const struct frame_pair *frames, unsigned want,
                           struct fmb_answer *answer)
{
#define X(dim, a, b, moving) decide_##dim##a##b##moving,
    static void (*const decide_kind[])(const struct inexact_pair *pair,
                                       struct fmb_answer *answer) = {KIND_MAP(X)};
#undef X
    (void) want;
    struct inexact_pair pair;
    if (!inexact_pair_of(frames, &pair) || !in_range(&pair))
        return FMB_CANNOT_DECIDE;
    decide_kind[kind_index((struct kind){pair.a.dim, pair.a.shape == FMB_TETRAHEDRON,
                                         pair.b.shape == FMB_TETRAHEDRON, pair.moving})](&pair,
                                                                                         answer);
    return FMB_OK;
}
