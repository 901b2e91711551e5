/* Verdict and times of a pair in integers, by all slabs of the Minkowski difference of its frames.
 *
 * This is the article's elimination, carried out in advance. Fourier-Motzkin elimination removes
 * all parameters x from the rows of the pair. What remains are inequalities in the offset of the
 * frames only, and those that are not redundant are the facets of the Minkowski difference D = A -
 * B.
 *
 * D is the image of the parameters of both frames, a product of cubes and simplices, under a linear
 * map. A linear map takes relative interiors to relative interiors (Rockafellar, Convex Analysis,
 * theorem 6.6). So the frames overlap if and only if the offset lies in the relative interior of D,
 * flat or not.
 *
 * A facet of D is the sum of a face of A and a face of -B that together span a plane. A face of a
 * frame, flat or not, is the image of a face of its cube or simplex. It is therefore spanned by
 * images of that face's edges, which are directions of edges of the frame. If it spans a plane,
 * that plane is spanned by two components (cuboid) or by a triangle (simplex). The plane of the
 * facet contains two independent directions of edges: two of one face of A, two of one face of B,
 * or one of A and one of B. So, if D is solid, its facets are among the planes
 *
 *     of the faces of A, of the faces of B, of each edge of A with each edge of B:
 *     3 + 3 + 9 (cuboids), 3 + 4 + 18 (mixed), 4 + 4 + 36 (tetrahedra)
 *
 * A dependent pair of edges spans no plane and is left out. A plane that is no facet gives a slab
 * that is valid all the same, since its bounds are those of D along its normal. Every normal n
 * gives both bounds at once: n . D = [min n.A - max n.B, max n.A - min n.B]. The verdict of a solid
 * D also needs the slabs of each edge with the drift: slabs.h.
 *
 * If D is flat, it has a rank r < 3 (in 2D, r < 2). It pins the offset to its affine hull, and
 * within that
 *
 *   r = 2: its facets are its edges, each along an edge of A or B. The projection along an axis
 *          that is not parallel to the plane of D is one to one, and there the normal of the edge
 *          (e0, e1) is (-e1, e0);
 *   r = 1: it is a segment, with its ends along any axis in which it has length;
 *   r = 0: it is a point.
 *
 * A normal of these kinds is not constant on D. So a point is in the relative interior of D if and
 * only if it lies strictly between the bounds of all slabs that do not pin. The path of the offset
 * is clipped to these slabs: the part within those that pin is closed, the part strictly within the
 * others open. */
#ifndef FMB_LIMBS_DECIDE_H
#define FMB_LIMBS_DECIDE_H

#include "limbs_slab.h"

/* ---- The list of normals ---- */

/* Returns the number of edge i of a frame (slabs.h). */
static inline int edge_number(const struct kernel_traits traits, int f, int i)
{
    return (f ? SLABS_EDGE_OF_B : 0) + edge_at(traits, f, i);
}

/* Lists the normals of the faces of a frame, in 2D of its edges; returns their number. */
static inline int list_faces(const struct kernel_traits traits, int f, struct slab_normal out[4])
{
    static const unsigned char plane[4][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}};
    const int first = f ? SLABS_EDGE_OF_B : 0;
    const int faces = traits.face[f] ? 1 : traits.simplex[f] ? 4 : 3;
    const int count = traits.dim == 2 ? edge_count(traits, f) : faces;
    for (int i = 0; i < count; i++)
        out[i] = traits.dim == 2 ? (struct slab_normal){first + i, 0}
                                 : (struct slab_normal){first + plane[i][0], first + plane[i][1]};
    return count;
}

/* Lists the normals of a pair whose difference is solid; returns their number. */
static inline int list_normals(const struct kernel_traits traits, bool drifts,
                               struct slab_normal out[SLABS_MAX])
{
    const bool space = traits.dim == 3;
    int count = list_faces(traits, 0, out);
    count += list_faces(traits, 1, out + count);
    for (int i = 0; i < edge_count(traits, 0) && space; i++)
        for (int j = 0; j < edge_count(traits, 1); j++)
            out[count++] =
                (struct slab_normal){edge_number(traits, 0, i), edge_number(traits, 1, j)};
    for (int f = 0; f < 2 && drifts && space; f++)
        for (int i = 0; i < edge_count(traits, f); i++)
            out[count++] = (struct slab_normal){edge_number(traits, f, i), SLABS_DRIFT};
    if (drifts && !space)
        out[count++] = (struct slab_normal){SLABS_DRIFT, 0};
    return count;
}

/* ---- Sets of slabs ---- */

/* The slabs of one frame, or those of a flat difference of both. */
struct slab_set {
    int rank; /* of the frame or the difference; 3: solid, in 2D too */
    int axis; /* rank 1 and 2: in which the direction, or the normal of the plane, is not 0 */
    int faces;
    struct slab_normal face[4];           /* rank 3, of one frame; rank 2: the plane */
    const struct limbs_vector *direction; /* rank 1: in the world */
    int edges, edge[2 * SLABS_EDGES];
};

LIMBS_FUNCTION int nonzero_axis(int n, const struct limbs_vector *v)
{
    return !is_zero(n, v->at[2]) ? 2 : !is_zero(n, v->at[1]) ? 1 : 0;
}

LIMBS_FUNCTION bool is_constant(const struct limbs_pair *pair, const struct limbs_products *of,
                                int first, int last)
{
    bool zero = true;
    for (int f = first; f <= last; f++)
        for (int i = 0; i < pair->frame[f]->count; i++)
            zero = zero && is_zero(pair->limbs, of->component[f][i]);
    return zero;
}

/* Sets the slabs of frames first to last; of a solid difference only its rank. */
LIMBS_FUNCTION void set_slabs_of(struct limbs_pair *pair, int first, int last, struct slab_set *out)
{
    const bool plane = pair->traits.dim == 2;
    struct normal normal;
    struct limbs_products of;
    int u = 0;
    out->rank = 3;
    out->edges = out->axis = 0;
    out->faces = list_faces(pair->traits, first, out->face);
    if (!pair->frame[first]->flat || !pair->frame[last]->flat)
        return;
    for (int f = first; f <= last; f++)
        for (int i = 0; i < edge_count(pair->traits, f); i++)
            out->edge[out->edges++] = edge_number(pair->traits, f, i);
    while (u < out->edges && edge_in_view(pair, out->edge[u], LIMBS_WORLD)->limbs == 0)
        u++;
    out->rank = u < out->edges;
    if (out->rank == 0)
        return;
    out->direction = edge_in_view(pair, out->edge[u], LIMBS_WORLD);
    out->axis = nonzero_axis(pair->limbs, out->direction);
    for (int v = plane ? u : u + 1; v < out->edges; v++) {
        const struct slab_normal edges = {out->edge[u], out->edge[v]};
        if (!set_normal(pair, edges, &normal))
            continue;
        limbs_set_products(pair, &normal, &of);
        if (!is_constant(pair, &of, first, last)) {
            out->rank = 3;
        } else if (!plane) {
            out->rank = 2;
            out->axis = nonzero_axis(pair->limbs, normal.at[WORLD]);
            out->face[0] = edges;
        }
        return;
    }
}

/* Sets normal number i of a set, which is 0 of an edge of length 0. *pins: the set lies in its
 * plane. Returns false if there are no more. */
LIMBS_FUNCTION bool set_normal_of_set(struct limbs_pair *pair, const struct slab_set *set, int i,
                                      struct normal *out, bool *pins)
{
    const int n = pair->limbs, axis = set->rank == 0 ? 0 : set->axis, j = (axis + i) % 3;
    struct limbs_vector *world = &out->storage[WORLD];
    *pins = set->rank == 2 ? i == 0 : set->rank == 1 ? i > 0 : set->rank == 0;
    if (i >= (set->rank == 3 ? set->faces : set->rank == 2 ? 1 + set->edges : 3))
        return false;
    if (set->rank == 3 || (set->rank == 2 && i == 0)) {
        set_normal(pair, set->face[i], out);
        return true;
    }
    memset(world, 0, sizeof *world);
    if (set->rank == 2) {
        const struct limbs_vector *edge = edge_in_view(pair, set->edge[i - 1], LIMBS_WORLD);
        subtract(n, world->at[(axis + 1) % 3], edge->at[(axis + 2) % 3]);
        add(n, world->at[(axis + 2) % 3], edge->at[(axis + 1) % 3]);
    } else if (*pins && set->rank == 1) {
        add(n, world->at[j], set->direction->at[axis]);
        subtract(n, world->at[axis], set->direction->at[j]);
    } else {
        world->at[set->rank == 1 ? axis : i][0] = 1;
    }
    spread_from_world(pair, out);
    return true;
}

/* ---- The path of the offset ---- */

/* num / den, from 0 to 1. */
struct limbs_ratio {
    limbs_number num, den;
};

/* The part of the path offset + tau drift that lies in the slabs applied so far. */
struct limbs_path {
    struct limbs_ratio window[2]; /* the part within the slabs that pin: closed */
    struct limbs_ratio open[2];   /* the part strictly within the others, where it is bounded */
    bool bounded[2];
    bool interior; /* false: the path lies on a bound of a slab that does not pin */
};

/* A number with the sign of x y - z w. In: none is negative. */
LIMBS_FUNCTION int compare_products(int n, const uint64_t *x, const uint64_t *y, const uint64_t *z,
                                    const uint64_t *w)
{
    mp_limb_t product[2][2 * LIMBS_MAX];
    mpn_mul_n(product[0], x, y, n);
    mpn_mul_n(product[1], z, w, n);
    return mpn_cmp(product[0], product[1], 2 * n);
}

LIMBS_FUNCTION int compare_ratios(int n, const struct limbs_ratio *x, const struct limbs_ratio *y)
{
    return compare_products(n, x->num, y->den, y->num, x->den);
}

LIMBS_FUNCTION void begin_path(int n, struct limbs_path *path)
{
    const size_t size = (size_t) n * sizeof(uint64_t);
    for (int end = 0; end < 2; end++) {
        memset(path->window[end].num, 0, size);
        memset(path->window[end].den, 0, size);
        path->window[end].num[0] = (uint64_t) end;
        path->window[end].den[0] = 1;
        path->bounded[end] = false;
    }
    path->interior = true;
}

/* An end of the closed part, within all slabs and their bounds. */
LIMBS_FUNCTION const struct limbs_ratio *end_of_path(int n, const struct limbs_path *path, int end)
{
    const int sign =
        path->bounded[end] ? compare_ratios(n, &path->open[end], &path->window[end]) : 0;
    return (end == 0 ? sign > 0 : sign < 0) ? &path->open[end] : &path->window[end];
}

/* Moves an end to where the path crosses a bound, num / den, if that is further inside. */
LIMBS_FUNCTION void cut_path(int n, struct limbs_path *path, int end, bool pins,
                             const struct limbs_ratio *at)
{
    struct limbs_ratio *ratio = pins ? &path->window[end] : &path->open[end];
    const bool bounded = pins || path->bounded[end];
    const int sign = bounded ? compare_ratios(n, at, ratio) : 0;
    if (bounded && (end == 0 ? sign <= 0 : sign >= 0))
        return;
    memcpy(ratio->num, at->num, (size_t) n * sizeof *at->num);
    memcpy(ratio->den, at->den, (size_t) n * sizeof *at->den);
    path->bounded[end] = path->bounded[end] || !pins;
}

/* out := sign times (x - y) */
LIMBS_FUNCTION void set_difference(int n, int sign, const uint64_t *x, const uint64_t *y,
                                   uint64_t *out)
{
    memcpy(out, sign < 0 ? y : x, (size_t) n * sizeof *x);
    subtract(n, out, sign < 0 ? x : y);
}

/* Sets the time at which the path enters a slab (end 0) or leaves it: (bound - start) / slope. In:
 * slope, the sign of that of the path along the normal, is not 0. */
LIMBS_FUNCTION void set_time_of_bound(int n, const struct limbs_slab *slab, int slope, int end,
                                      struct limbs_ratio *out)
{
    static const limbs_number zero;
    set_difference(n, slope, slab->slope, zero, out->den);
    set_difference(n, slope, (slope > 0) == (end == 0) ? slab->low : slab->high, slab->start,
                   out->num);
}

/* Clips the path to a slab. Returns false if nothing is left of it.
 *
 * Where the path does not lie on a bound, it enters the slab at one of its bounds and leaves it at
 * the other. An entry before the window, and an exit after it, bound nothing. */
LIMBS_FUNCTION bool clip_path(int n, struct limbs_path *path, const struct limbs_slab *slab,
                              bool pins)
{
    const int slope = sign_of(n, slab->slope);
    struct limbs_ratio at;
    if (slope == 0) {
        const bool above = is_less(n, slab->low, slab->start);
        const bool below = is_less(n, slab->start, slab->high);
        if (is_less(n, slab->start, slab->low) || is_less(n, slab->high, slab->start))
            return false;
        path->interior = path->interior && (pins || (above && below));
        return true;
    }
    for (int end = 0; end < 2; end++) {
        set_time_of_bound(n, slab, slope, end, &at);
        const bool early = is_negative(n, at.num), late = is_less(n, at.den, at.num);
        if (end == 0 ? late : early)
            return false;
        if (!early && !late)
            cut_path(n, path, end, pins, &at);
    }
    return compare_ratios(n, end_of_path(n, path, 0), end_of_path(n, path, 1)) <= 0;
}

/* Whether some time of the closed window lies strictly within all slabs that do not pin. The open
 * interval (p, q) meets the closed interval [u, v], u <= v, if and only if p < q, p < v and u < q.
 */
LIMBS_FUNCTION bool path_has_interior(int n, const struct limbs_path *path)
{
    const struct limbs_ratio *p = &path->open[0], *q = &path->open[1];
    if (!path->interior)
        return false;
    if (path->bounded[0] && path->bounded[1] && compare_ratios(n, p, q) >= 0)
        return false;
    if (path->bounded[0] && compare_ratios(n, p, &path->window[1]) >= 0)
        return false;
    return !path->bounded[1] || compare_ratios(n, &path->window[0], q) < 0;
}

/* ---- Times ---- */

/* num / den of the window, from 0 to 1, in seconds, rounded outward: down for end 0, up for 1. */
LIMBS_FUNCTION double seconds_of(int n, const struct limbs_ratio *at, double duration, int end)
{
    const struct dyadic window = dyadic_of(duration);
    mpz_t num, den, scratch[2];
    if (window.mantissa == 0)
        return 0;
    mpz_inits(num, den, scratch[0], scratch[1], NULL);
    limbs_to_mpz(n, at->num, num);
    limbs_to_mpz(n, at->den, den);
    mpz_mul_si(num, num, window.mantissa);
    const double time =
        integer_ratio_round(num, den, window.exponent, end ? ROUND_UP : ROUND_DOWN, scratch);
    mpz_clears(num, den, scratch[0], scratch[1], NULL);
    return time;
}

/* Moves an end of the contact to where the offset enters or leaves a slab. Rounding is monotonic:
 * the latest of the rounded times is the latest time, rounded. */
LIMBS_FUNCTION void clip_end(int n, const struct limbs_slab *slab, double duration, int end,
                             double contact[2])
{
    const int slope = sign_of(n, slab->slope);
    struct limbs_ratio at;
    if (slope == 0)
        return;
    set_time_of_bound(n, slab, slope, end, &at);
    if (is_negative(n, at.num) || is_less(n, at.den, at.num))
        return;
    const double time = seconds_of(n, &at, duration, end);
    if (end ? time < contact[1] : time > contact[0])
        contact[end] = time;
}

/* ---- Verdicts ---- */

LIMBS_FUNCTION enum fmb_verdict verdict_of_flat(struct limbs_pair *pair, const struct slab_set *set,
                                                double duration, double contact[2])
{
    const int n = pair->limbs;
    struct limbs_path path;
    struct normal normal;
    struct limbs_products of;
    struct limbs_slab slab;
    bool pins;
    begin_path(n, &path);
    for (int i = 0; set_normal_of_set(pair, set, i, &normal, &pins); i++) {
        limbs_set_products(pair, &normal, &of);
        if (!pins && is_constant(pair, &of, 0, 1))
            continue; /* of an edge of length 0 */
        limbs_set_slab(pair, &of, &slab);
        if (!clip_path(n, &path, &slab, pins))
            return FMB_SEPARATED;
    }
    for (int end = 0; end < 2 && contact; end++)
        contact[end] = seconds_of(n, end_of_path(n, &path, end), duration, end);
    return path_has_interior(n, &path) ? FMB_OVERLAPPING : FMB_TOUCHING;
}

/* limbs_slabs() */
LIMBS_FUNCTION int sign_of_slabs(struct limbs_pair *pair, const struct slab_normal normal[],
                                 const bool open[][2], int count, double duration,
                                 double contact[2])
{
    int sign = -1;
    for (int i = 0; i < count && sign <= 0; i++) {
        struct limbs_products of;
        struct limbs_slab slab;
        if (!limbs_products_of(pair, normal[i], &of))
            continue;
        limbs_set_slab(pair, &of, &slab);
        for (int end = 0; end < 2 && contact; end++)
            if (!open || open[i][end])
                clip_end(pair->limbs, &slab, duration, end, contact);
        const int one = limbs_sign_of_gap(pair->limbs, &slab);
        sign = one > sign ? one : sign;
    }
    return sign;
}

LIMBS_FUNCTION enum fmb_verdict verdict_of_solid(struct limbs_pair *pair,
                                                 const struct frame_pair *frames, double contact[2])
{
    struct slab_normal normal[SLABS_MAX];
    const int count = list_normals(pair->traits, pair->drift.limbs > 0, normal);
    const int sign = sign_of_slabs(pair, normal, NULL, count, frames->duration, contact);
    return sign > 0 ? FMB_SEPARATED : sign == 0 ? FMB_TOUCHING : FMB_OVERLAPPING;
}

#endif
