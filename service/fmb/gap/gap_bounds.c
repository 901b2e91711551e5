/* Bounds of f at the normals of a pair in 3D, without the normals.
 *
 * Method. With A_i, B_j the components (of a negated), w the offset of the centres of cuboids and
 * origins of simplices, D the drift, and normals N_k = A_i x A_j, M_k = B_i x B_j (i, j, k cyclic),
 * the normal n = e x f of an edge of each has
 *
 *     n . w = (w x e) . f,     n . D = (D x e) . f,
 *
 * and for the components that are not in the edge e = A_i, or e = A_q - A_p,
 *
 *     n . A_j = -N_k . f,  n . A_k = N_j . f;     n . A_p = N_r . f,  n . A_r = -(N_p + N_q) . f
 *
 * and with M_k . e and the other sign for those of B. So two edges f go side by side, and n is not
 * needed: |n|^2 = |e|^2 |f|^2 - (e . f)^2.
 *
 * Accuracy, with u = 2^-53. These are sums of triple products, each off by less than 20 u times the
 * lengths of its vectors; where A_p and A_q stand for e, by as much more as they are longer. Edges
 * that are more than 2^4 times shorter have no bound. So |n| f(n) is off by less than
 * 2^-44 |e| |f| R. Where it is negative its quotient with m = max(|n|, 2^-4 |e| |f|) bounds f(n),
 * and is off by less than 2^-40 R. The squares in |n|^2 are off by 14.1 u |e|^2 |f|^2, m^2 by less
 * than 2^-41 of itself. Together that is less than 2^-39 R, the margin. Bounds are squared: R
 * within 2^60 and 2^-60, and edges longer than 2^-100, do not let that overflow, or underflow by
 * more than 2^-600. */
#include "gap_bounds.h"

#include <math.h>
#include <string.h>

enum { GROUPS = GAP_EDGES / 2 };

#define GAP_BOUNDS_MARGIN 0x1p-39 /* relative to R */

/* What bounds are made of. */
struct products {
    const struct gap_edges *edges;
    double w[3];
    double square[2][GAP_EDGES]; /* of lengths; infinite: no bound */
    double normal[2][GAP_FACES][3];
    lanes f[3][GROUPS];        /* edges of b, side by side */
    lanes of_b[3][GROUPS];     /* normal k of a . f */
    double of_a[GAP_EDGES][3]; /* [e][k], normal k of b . e */
};

INLINE lanes lanes_at(const double x[2])
{
    return (lanes){x[0], x[1]};
}

INLINE lanes dots_at(const struct products *products, const double v[3], int g)
{
    return (v[0] * products->f[0][g] + v[1] * products->f[1][g]) + v[2] * products->f[2][g];
}

INLINE void set_squares(const struct gap_edge *edge, const bool simplex, double out[GAP_EDGES])
{
    memset(out, 0, GAP_EDGES * sizeof *out);
    for (int i = 0; i < (simplex ? GAP_EDGES : 3); i++) {
        double least = 0x1p-200;
        if (i >= 3)
            least +=
                0x1p-7 * (edge[gap_next(i - 3)].square + edge[gap_next(gap_next(i - 3))].square);
        const bool none = edge[i].at[0] == 0 && edge[i].at[1] == 0 && edge[i].at[2] == 0;
        out[i] = none ? 0 : edge[i].square >= least ? edge[i].square : INFINITY;
    }
}

INLINE void set_products(const struct gap_edges *edges, const bool simplex[2], struct products *out)
{
    out->edges = edges;
    memcpy(out->w, edges->pair->offset, sizeof out->w);
    for (int f = 0; f < 2; f++) {
        const struct gap_edge *edge = edges->of[f];
        set_squares(edge, simplex[f], out->square[f]);
        for (int axis = 0; axis < 3 && !simplex[f]; axis++)
            out->w[axis] += 0.5 * ((edge[0].at[axis] + edge[1].at[axis]) + edge[2].at[axis]);
        for (int k = 0; k < (simplex[f] ? 4 : 3); k++)
            vec3_cross(edge[gap_face_edge[k][0]].at, edge[gap_face_edge[k][1]].at,
                       out->normal[f][k]);
    }
    for (int g = 0; g < (simplex[1] ? 3 : 2); g++) {
        const struct gap_edge *edge = &edges->of[1][2 * g];
        for (int axis = 0; axis < 3; axis++)
            out->f[axis][g] = (lanes){edge[0].at[axis], edge[1].at[axis]};
        for (int k = 0; k < 3; k++)
            out->of_b[k][g] = dots_at(out, out->normal[0][k], g);
    }
    for (int i = 0; i < (simplex[0] ? 6 : 3); i++)
        for (int k = 0; k < 3; k++)
            out->of_a[i][k] = vec3_dot(out->normal[1][k], edges->of[0][i].at);
}

struct extent {
    lanes low, high;
};

/* Adds that of a frame along normals, x the products with the count components that have any. */
INLINE void add_extent(const bool simplex, const lanes *x, const int count, struct extent *out)
{
    lanes low = lanes_of(0), high = lanes_of(0), sum = lanes_of(0);
    UNROLL(3)
    for (int i = 0; i < count; i++) {
        if (simplex) {
            low = lanes_min(x[i], low);
            high = lanes_max(x[i], high);
        } else {
            sum += lanes_abs(x[i]);
        }
    }
    out->low += simplex ? low : -0.5 * sum;
    out->high += simplex ? high : 0.5 * sum;
}

/* Adds that of a drift. */
INLINE void add_swing(lanes swing, struct extent *out)
{
    out->low += lanes_min(swing, lanes_of(0));
    out->high += lanes_max(swing, lanes_of(0));
}

/* square: |n|^2; most: |e|^2 |f|^2. */
INLINE void add_bound(lanes middle, struct extent extent, lanes square, lanes most,
                      struct gap_bounds *out)
{
    const lanes above = lanes_max(middle + extent.low, -(middle + extent.high));
    const lanes best = lanes_min(above, lanes_of(0));
    CHECK_BOUND(GAP_BOUNDS_MARGIN, !(most[0] > 0 && most[0] < INFINITY), above[0],
                0x1p-4 * out->margin * sqrt(most[0]));
    CHECK_BOUND(GAP_BOUNDS_MARGIN, !(most[1] > 0 && most[1] < INFINITY), above[1],
                0x1p-4 * out->margin * sqrt(most[1]));
    out->square[out->count++] = best * best / lanes_max(square, 0x1p-8 * most);
}

/* Faces k and k + 1 of frame f. */
INLINE void bound_faces(const struct products *products, const bool simplex[2], int f, int k,
                        struct gap_bounds *out)
{
    const struct gap_edges *edges = products->edges;
    const double(*n)[3] = &products->normal[f][k];
    double own[2] = {0}, other[3][2] = {{0}}, middle[2] = {0}, swing[2] = {0}, square[2] = {0};
    double most[2] = {0};
    for (int lane = 0; lane < 2 && (simplex[f] || k + lane < 3); lane++) {
        const int *edge = gap_face_edge[k + lane];
        own[lane] = vec3_dot(n[lane], edges->of[f][(k + lane) % 3].at);
        for (int i = 0; i < 3; i++)
            other[i][lane] = k + lane == 3 ? vec3_dot(n[lane], edges->of[!f][i].at)
                             : f           ? products->of_a[i][k + lane]
                                           : products->of_b[k + lane][i / 2][i % 2];
        middle[lane] = vec3_dot(n[lane], products->w);
        if (edges->pair->drifts)
            swing[lane] = vec3_dot(n[lane], edges->drift.at);
        square[lane] = vec3_dot(n[lane], n[lane]);
        most[lane] = products->square[f][edge[0]] * products->square[f][edge[1]];
    }
    const lanes of_own = lanes_at(own);
    const lanes x[3] = {lanes_at(other[0]), lanes_at(other[1]), lanes_at(other[2])};
    struct extent extent = {lanes_of(0), lanes_of(0)};
    add_extent(simplex[f], &of_own, 1, &extent);
    add_extent(simplex[!f], x, 3, &extent);
    add_swing(lanes_at(swing), &extent);
    add_bound(lanes_at(middle), extent, lanes_at(square), lanes_at(most), out);
}

/* Edge i of a with all of b. */
INLINE void bound_edges(const struct products *products, const bool simplex[2], int i,
                        struct gap_bounds *out)
{
    const struct gap_edges *edges = products->edges;
    const double *e = edges->of[0][i].at, *m = products->of_a[i];
    const int r = i % 3, p = gap_next(r), q = gap_next(p);
    const lanes(*of_b)[GROUPS] = products->of_b;
    const lanes y[GROUPS][2] = {{{m[2], m[0]}, {-m[1], -m[2]}},
                                {{m[1], -m[0]}, {-m[0], m[1] + m[2]}},
                                {{-m[1], -m[2]}, {m[2] + m[0], m[0] + m[1]}}};
    double offset[3], drift[3];
    vec3_cross(products->w, e, offset);
    if (edges->pair->drifts)
        vec3_cross(edges->drift.at, e, drift);
    for (int g = 0; g < (simplex[1] ? 3 : 2); g++) {
        const lanes x[2] = {i < 3 ? -of_b[q][g] : of_b[r][g],
                            i < 3 ? of_b[p][g] : -(of_b[p][g] + of_b[q][g])};
        const lanes most = products->square[0][i] * lanes_at(&products->square[1][2 * g]);
        const lanes along = dots_at(products, e, g);
        struct extent extent = {lanes_of(0), lanes_of(0)};
        add_extent(simplex[0], x, 2, &extent);
        add_extent(simplex[1], y[g], 2, &extent);
        if (edges->pair->drifts)
            add_swing(dots_at(products, drift, g), &extent);
        add_bound(dots_at(products, offset, g), extent, most - along * along, most, out);
    }
}

INLINE void bound_all(const struct gap_edges *edges, const bool a, const bool b,
                      struct gap_bounds *out)
{
    const bool simplex[2] = {a, b};
    struct products products;
    set_products(edges, simplex, &products);
    for (int f = 0; f < 2; f++)
        for (int k = 0; k < GAP_FACES; k += 2)
            bound_faces(&products, simplex, f, k, out);
    for (int i = 0; i < 3; i++)
        bound_edges(&products, simplex, i, out);
    for (int i = 3; i < GAP_EDGES && a; i++)
        bound_edges(&products, simplex, i, out);
}

void gap_bounds_set(const struct gap_edges *edges, struct gap_bounds *out)
{
    const struct gap_pair *pair = edges->pair;
    out->margin = GAP_BOUNDS_MARGIN * pair->reach;
    out->count = 0;
    if (pair->simplex[0] && pair->simplex[1])
        bound_all(edges, true, true, out);
    else if (pair->simplex[0])
        bound_all(edges, true, false, out);
    else if (pair->simplex[1])
        bound_all(edges, false, true, out);
    else
        bound_all(edges, false, false, out);
    if (pair->reach >= 0x1p-60 && pair->reach <= 0x1p60)
        return;
    for (int i = 0; i < out->count; i++)
        out->square[i] = lanes_of(0);
}
