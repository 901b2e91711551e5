/* The gap of a pair in contact, in doubles.
 *
 * Method. f at the normals of all facets that P can have: of the faces of both frames, of each edge
 * of A with each edge of B and, where the pair drifts, of each edge with the drift
 * (limbs_decide.h); in 2D of each edge. The greatest f is the gap; its direction proves the lower
 * bound, all of them the upper one. In 3D they are bounded first (gap_bounds.c), and only those
 * that may be near the greatest are made.
 *
 * Accuracy, with u = 2^-53 and R the reach. The f of a direction at hand is within gap_error() of
 * that of the same direction for the true P. The greatest f moves by no more than P does, so that
 * the normals of the rounded frames do; but they are rounded too. A normal u x v is off by less
 * than 2.4 u |u| |v| (slabs.c: 2 / sqrt(3) times two roundings), and by 2 u |u| |v| where edges are
 * rounded differences. Directions of vectors that differ by x, one of length n, differ by at most
 * 2 x / n, and by less than 1.01 x / n where x < 0.1 n; so that of the normal is off by less than
 * 8.8 u / s, s the sine of the angle between the edges, and f by R times that ("slip").
 *
 * Where s is small, and edges are not rounded differences, v is replaced by w = v - k u with
 * k = u . v / u . u: the cross product is the same. k is off by 7.01 u |v| / |u|, so that |w| is at
 * most |v| (s + 7.01 u); each number of w is rounded once if it is found by a fused operation. So
 * u x w is off by 3.5 u |u| |w|, which is less than 6.6 u |u| |v| s for s of 2^-50 and more, and
 * its direction by less than 8 u.
 *
 * Edges whose sine is less than 2^-50, and that are not exactly parallel. Let their pairs, of
 * components of cuboids and the drift alone, connect them to groups; and let each edge of a group
 * be turned into the direction of its longest one, by leaving out the part across that. There are
 * at most 7 edges, so at most 6 pairs between an edge e and the longest one, and e moves by at most
 * 6 2^-50 |e|. So P moves by at most 6 2^-50 R. The facets of the new P have normals of pairs of
 * its edges that are not parallel: these are normals of the old list that are not among the nearly
 * parallel ones. Their f moves by no more than P. So the gap is at most the greatest f of the other
 * normals and 12 2^-50 R; R is less than 42 times the largest coordinate. */
#include "gap_bounds.h"

#include "interval.h"

#include <math.h>
#include <string.h>

/* Bounds on the error of the direction of a normal, s the sine of the angle between its edges: SLIP
 * / s of any edges; SLIP_WIDE where s^2 > WIDE_SINE_SQUARE; SLIP_CLOSE of edges that are not
 * rounded differences, and of any edge in 2D. */
#define SLIP 0x1p-49
#define SLIP_WIDE 0x1p-48
#define WIDE_SINE_SQUARE 0.08
#define SLIP_CLOSE 0x1p-50

/* Edges with a smaller sine have no normal, which changes f by less than BUNDLED R. */
#define LEAST_SINE 0x1p-50
#define BUNDLED (13 * LEAST_SINE)

struct depth {
    struct gap_edges edges;
    double greatest;  /* f */
    double upper;     /* the greatest of f + what its direction is off by, times R */
    bool bundled;     /* some edges are nearly parallel, and have no normal */
    double normal[3]; /* of unit length, of the greatest f */
};

/* ---- Edges ---- */

static struct gap_edge edge_of(const double v[3], bool simplex)
{
    struct gap_edge out = {{v[0], v[1], v[2]}, vec3_dot(v, v), simplex, true};
    return out;
}

/* Vector k. Normals are those of the vectors as they are rounded, the drift too. */
static struct gap_edge edge_at(const struct gap_pair *pair, int k)
{
    const double v[3] = {CHECK_GIVEN(gap_vector(pair, k, 0)), CHECK_GIVEN(gap_vector(pair, k, 1)),
                         CHECK_GIVEN(gap_vector(pair, k, 2))};
    return edge_of(v, k < GAP_DRIFT && pair->simplex[k / GAP_OF_B]);
}

static struct gap_edge difference_of(const struct gap_edge *x, const struct gap_edge *y)
{
    double v[3];
    bool exact = true;
    for (int axis = 0; axis < 3; axis++) {
        v[axis] = x->at[axis] - y->at[axis];
        exact = exact && prepared_exact_sum(x->at[axis], -y->at[axis], v[axis]);
    }
    struct gap_edge out = edge_of(v, true);
    out.exact = exact;
    return out;
}

/* Of frame f, of a negated. */
static void set_edges(const struct gap_pair *pair, int f, struct gap_edge out[GAP_EDGES])
{
    const double none[3] = {0, 0, 0};
    for (int i = 0; i < GAP_EDGES; i++)
        out[i] =
            i < pair->count[f] ? edge_at(pair, f * GAP_OF_B + i) : edge_of(none, pair->simplex[f]);
    if (pair->simplex[f] && pair->dim == 2)
        out[2] = difference_of(&out[1], &out[0]);
    for (int r = pair->count[f] == 2 ? 2 : 0; pair->simplex[f] && pair->dim == 3 && r < 3; r++)
        out[3 + r] = difference_of(&out[gap_next(gap_next(r))], &out[gap_next(r)]);
}

/* ---- Normals ---- */

/* Adds the ends of n . p over a simplex of vectors first to first + 2, and clears these. */
static void take_simplex(int first, lanes at[GAP_LANES], double ends[2])
{
    double low = 0, high = 0;
    for (int k = first; k < first + 3; k++) {
        const double x = at[k / 2][k % 2];
        low = x < low ? x : low;
        high = x > high ? x : high;
        at[k / 2][k % 2] = 0;
    }
    ends[0] += low;
    ends[1] += high;
}

/* The ends of n . p over P less the offset. */
static void set_ends(const struct gap_pair *pair, const double n[3], double ends[2])
{
    lanes at[GAP_LANES];
    ends[0] = ends[1] = 0;
    gap_dots(pair, n, at);
    for (int f = 0; f < 2; f++)
        if (pair->simplex[f])
            take_simplex(f * GAP_OF_B, at, ends);
    lanes low = lanes_min(at[0], lanes_of(0)), high = lanes_max(at[0], lanes_of(0));
    UNROLL(3)
    for (int i = 1; i < GAP_LANES; i++) {
        low += lanes_min(at[i], lanes_of(0));
        high += lanes_max(at[i], lanes_of(0));
    }
    ends[0] += low[0] + low[1];
    ends[1] += high[0] + high[1];
}

/* The greater f of n and -n; square: of the length of n; slip: how far its direction may be off. */
static void add_normal(struct depth *depth, const double n[3], double square, double slip)
{
    double ends[2];
    CHECK_NORMAL(GAP_SLIP, n, square, slip);
    if (!(square >= GAP_LEAST_SQUARE)) {
        depth->upper = INFINITY;
        return;
    }
    set_ends(depth->edges.pair, n, ends);
    const double offset = vec3_dot(n, depth->edges.pair->offset);
    const double low = offset + ends[0], high = offset + ends[1];
    const double best = low > -high ? low : -high, off = slip * depth->edges.pair->reach;
    const double most = (off - depth->greatest) * PREPARED_MARGIN;
    if (best < 0 && most > 0 && best * best > most * most * square)
        return; /* f + off is below the greatest f */
    const double inverse = 1 / sqrt(square);
    const double f = best * inverse;
    CHECK_BOUND(GAP_ROUNDING, false, f, GAP_ROUNDING * depth->edges.pair->reach);
    const double above = f + off;
    depth->upper = above > depth->upper ? above : depth->upper;
    if (f <= depth->greatest)
        return;
    depth->greatest = f;
    for (int axis = 0; axis < 3; axis++)
        depth->normal[axis] = (low > -high ? inverse : -inverse) * n[axis];
}

static bool are_parallel(const double u[3], const double v[3])
{
    return interval_same_products(u[1], v[2], u[2], v[1]) &&
           interval_same_products(u[2], v[0], u[0], v[2]) &&
           interval_same_products(u[0], v[1], u[1], v[0]);
}

/* The normal of edges that are nearly parallel, and not rounded. */
static void add_close(struct depth *depth, const struct gap_edge *u, const struct gap_edge *v)
{
    const double share = CHECK_GIVEN(vec3_dot(u->at, v->at) / u->square); /* any k will do */
    double w[3], n[3];
    if (are_parallel(u->at, v->at))
        return;
    for (int axis = 0; axis < 3; axis++)
        w[axis] = fma(-share, u->at[axis], v->at[axis]);
    vec3_cross(u->at, w, n);
    const double square = vec3_dot(n, n);
    if (square >= LEAST_SINE * LEAST_SINE * (u->square * v->square)) {
        add_normal(depth, n, square, SLIP_CLOSE);
    } else if (u->simplex || v->simplex) {
        depth->upper = INFINITY;
    } else {
        depth->bundled = true;
    }
}

static void add_edges(struct depth *depth, const struct gap_edge *u, const struct gap_edge *v)
{
    const double most = u->square * v->square;
    double n[3];
    vec3_cross(u->at, v->at, n);
    const double square = vec3_dot(n, n);
    CHECK_SLIP(GAP_SLIP, n, 1 / sqrt(WIDE_SINE_SQUARE), 1.01, SLIP_WIDE);
    CHECK_SLIP(GAP_SLIP, n, 1, 2, SLIP); /* each times 1 / s */
    if (square > WIDE_SINE_SQUARE * most)
        add_normal(depth, n, square, SLIP_WIDE);
    else if (u->exact && v->exact)
        add_close(depth, u, v);
    else if (square > 0)
        add_normal(depth, n, square, SLIP * sqrt(most / square));
    else
        depth->upper = INFINITY;
}

/* ---- All normals ---- */

/* That of a number in bounds. */
static void add_number(struct depth *depth, int number)
{
    const int f = number / GAP_FACES, k = number % GAP_FACES;
    const int of_b = depth->edges.pair->simplex[1] ? 6 : 4, edge = number - 2 * GAP_FACES;
    if (f < 2)
        add_edges(depth, &depth->edges.of[f][gap_face_edge[k][0]],
                  &depth->edges.of[f][gap_face_edge[k][1]]);
    else
        add_edges(depth, &depth->edges.of[0][edge / of_b], &depth->edges.of[1][edge % of_b]);
}

/* The first with the least square; -1: there is none. */
static int first_of(const struct gap_bounds *bounds)
{
    lanes least = lanes_of(INFINITY);
    for (int i = 0; i < bounds->count; i++)
        least = lanes_min(bounds->square[i], least);
    const double square = least[0] < least[1] ? least[0] : least[1];
    for (int i = 0; i < bounds->count && square < INFINITY; i++) {
        const unsigned bits = lanes_mask_bits(bounds->square[i] == square);
        if (bits)
            return 2 * i + !(bits & 1);
    }
    return -1;
}

/* The normal with the least bound, then all whose bound is not below its f. */
static void add_space(struct depth *depth)
{
    struct gap_bounds bounds;
    gap_bounds_set(&depth->edges, &bounds);
    const int first = first_of(&bounds);
    if (first >= 0)
        add_number(depth, first);
    const double most = (bounds.margin - depth->greatest) * PREPARED_MARGIN;
    const lanes limit = lanes_of(most * most);
    for (int i = 0; i < bounds.count; i++) {
        const unsigned bits = lanes_mask_bits(bounds.square[i] <= limit);
        for (int lane = 0; bits && lane < 2; lane++)
            if (bits >> lane & 1 && 2 * i + lane != first)
                add_number(depth, 2 * i + lane);
    }
    for (int f = 0; f < 2 && depth->edges.pair->drifts; f++)
        for (int i = 0; i < GAP_EDGES; i++)
            add_edges(depth, &depth->edges.of[f][i], &depth->edges.drift);
}

/* In 2D: the edge turned by a right angle. */
static void add_turned(struct depth *depth, const struct gap_edge *edge)
{
    const double n[3] = {-edge->at[1], edge->at[0], 0};
    add_normal(depth, n, edge->square, SLIP_CLOSE);
}

static void add_plane(struct depth *depth)
{
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < depth->edges.pair->count[f] + depth->edges.pair->simplex[f]; i++)
            add_turned(depth, &depth->edges.of[f][i]);
    if (depth->edges.pair->drifts)
        add_turned(depth, &depth->edges.drift);
}

enum gap_outcome gap_depth(const struct gap_pair *pair, enum fmb_verdict verdict,
                           struct fmb_gap *out)
{
    const double error = gap_error(pair);
    struct depth depth;
    depth.edges.pair = pair;
    depth.greatest = depth.upper = -INFINITY;
    depth.bundled = false;
    for (int f = 0; f < 2; f++)
        set_edges(pair, f, depth.edges.of[f]);
    depth.edges.drift = edge_at(pair, GAP_DRIFT);
    if (pair->dim == 3)
        add_space(&depth);
    else
        add_plane(&depth);
    if (depth.greatest == -INFINITY)
        return GAP_UNSURE;
    const double bundled = depth.bundled ? BUNDLED * pair->reach : 0;
    const double upper = depth.upper + bundled + error;
    out->bounds[0] = depth.greatest - error;
    out->bounds[1] = verdict == FMB_OVERLAPPING && upper < 0 ? upper : 0;
    memcpy(out->direction, depth.normal, sizeof depth.normal);
    if (!gap_is_tight(pair, out->bounds))
        return GAP_UNSURE;
    if (verdict == FMB_TOUCHING)
        out->bounds[0] = 0;
    return GAP_KNOWN;
}
