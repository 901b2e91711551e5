/* Boxes in integers, for pairs whose box doubles (box_clip.h) do not give.
 *
 * In: two prepared frames in contact, solids or faces.
 *
 * Out: the box, within the limit of fmb.h.
 *
 * The segments of each frame are clipped to the slabs of the other, and edges that move cross, as
 * in box_clip.h (filter/BOXES.md). But how far a vertex is inside a bound, and how far a crossing
 * is inside the ranges of its parameters, are integers here: their signs are exact, and as doubles
 * they are off by less than 2.1 u of themselves, u = 2^-53. A segment crosses a bound between
 * vertices on either side, with values f >= 0 > g, at f / (f - g). The denominator is a sum of two
 * magnitudes, so the quotient is off by less than 6.2 u of itself. The order of two crossings
 * matters only if the segment enters the other frame within 2^-48 of where it leaves it; it is then
 * decided by comparing two products of integers. So points are off by no more than the slack of
 * box_ends.h, also where that is 6.1 u times four times all components, twice the length of a
 * segment. And every point that is used is certainly in the intersection. */
#ifndef FMB_LIMBS_BOX_H
#define FMB_LIMBS_BOX_H

#include "limbs_decide.h"

#include "kernel_box.h"

enum { LOW, HIGH, BOUNDS };

/* Of one frame: 4 faces of a tetrahedron; flat, the plane and 6 edges; 3 of a segment or point. */
enum { BOX_SLABS = 7 };

/* The slabs of one frame, and the vertices of the other. */
struct box_slabs {
    int count;
    /* How far vertices are inside the bounds: [bound][slab][vertex]; and the same in doubles. */
    limbs_number inside[BOUNDS][BOX_SLABS][CLIP_VERTICES];
    double value[BOUNDS][BOX_SLABS][CLIP_VERTICES];
};

/* A bound that a segment crosses, by number. slab < 0: none. */
struct bound_crossing {
    int bound, slab;
};

/* x, off by less than 2.1 u of itself. The two leading limbs of those that hold x with its sign are
 * at least 2^63 in magnitude; the limbs below are less than one. */
LIMBS_FUNCTION double to_double(int n, const uint64_t *x)
{
    const int used = limbs_needed(n, x);
    if (used < 2)
        return used == 0 ? 0 : (double) (int64_t) x[0];
    const uint64_t bits = (uint64_t) (1023 + 64 * (used - 2)) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return ((double) (int64_t) x[used - 1] * 0x1p64 + (double) x[used - 2]) * scale;
}

/* ---- Values at vertices ---- */

/* out += x, or out -= x. */
LIMBS_FUNCTION void add_signed(int n, uint64_t *out, int sign, const uint64_t *x)
{
    if (sign < 0)
        subtract(n, out, x);
    else
        add(n, out, x);
}

/* out[v] := value plus what the components of frame f add at vertex v, times sign; then, if drift
 * is not 0, the same with the drift times that. Vertices as in struct clip_wire. */
LIMBS_FUNCTION void set_limbs_at_vertices(const struct limbs_pair *pair,
                                          const struct limbs_products *of, int f, int sign,
                                          int drift, const uint64_t *value,
                                          limbs_number out[CLIP_VERTICES])
{
    const int n = pair->limbs, count = pair->frame[f]->count;
    const bool simplex = frame_is_simplex(pair->frame[f]);
    const bool centred = pair->frame[f]->shape == FMB_BOX;
    const size_t size = (size_t) n * sizeof *value;
    const int vertices = simplex ? count + 1 : 1 << count;
    memcpy(out[0], value, size);
    for (int i = 0; i < count; i++)
        for (int v = 0; v < (simplex ? 1 : 1 << i); v++) {
            uint64_t *next = out[simplex ? 1 + i : v | 1 << i];
            memcpy(next, out[v], size);
            add_signed(n, next, sign, of->component[f][i]);
            if (centred)
                add_signed(n, out[v], -sign, of->component[f][i]);
        }
    for (int v = 0; v < vertices && drift; v++) {
        memcpy(out[vertices + v], out[v], size);
        add_signed(n, out[vertices + v], drift, of->drift);
    }
}

/* ---- Slabs ---- */

/* Multiplies products by the missing factors, and adds the origins of the frames to the offset. */
LIMBS_FUNCTION void complete_products(const struct limbs_pair *pair, struct limbs_products *of)
{
    const int n = pair->limbs;
    scale_by(n, of->factor[WORLD], of->offset);
    scale_by(n, of->factor[WORLD], of->drift);
    for (int f = 0; f < 2; f++) {
        for (int i = 0; i < pair->frame[f]->count; i++)
            scale_by(n, of->factor[f], of->component[f][i]);
        if (pair->origin[f].limbs == 0)
            continue;
        scale_by(n, of->factor[f], of->origin[f]);
        (f == 0 ? subtract : add)(n, of->offset, of->origin[f]);
    }
}

LIMBS_FUNCTION bool complete_products_of(struct limbs_pair *pair, struct slab_normal edges,
                                         struct limbs_products *out)
{
    const bool exists = limbs_products_of(pair, edges, out);
    if (exists)
        complete_products(pair, out);
    return exists;
}

/* Adds a slab of frame f. at: memory. */
LIMBS_FUNCTION void add_slab_of(const struct limbs_pair *pair, int f,
                                const struct limbs_products *of, limbs_number at[CLIP_VERTICES],
                                struct box_slabs *out)
{
    const struct kernel_traits traits = pair->traits;
    const int n = pair->limbs, k = out->count++;
    const size_t size = (size_t) n * sizeof(uint64_t);
    limbs_number low, high, start = {0};
    limbs_extent(n, pair, of, f, low, high);
    add_signed(n, start, f ? -1 : 1, of->offset);
    set_limbs_at_vertices(pair, of, !f, 1, !traits.drifts ? 0 : f ? -1 : 1, start, at);
    for (int v = 0; v < vertex_count(traits, !f) * (traits.drifts ? 2 : 1); v++) {
        uint64_t *above = out->inside[LOW][k][v], *below = out->inside[HIGH][k][v];
        memcpy(above, at[v], size);
        subtract(n, above, low);
        memcpy(below, high, size);
        subtract(n, below, at[v]);
        out->value[LOW][k][v] = to_double(n, above);
        out->value[HIGH][k][v] = to_double(n, below);
    }
}

/* Sets the slabs of frame f. */
LIMBS_FUNCTION void set_limbs_slabs(struct limbs_pair *pair, int f, limbs_number at[CLIP_VERTICES],
                                    struct box_slabs *out)
{
    struct limbs_products of;
    struct slab_set set;
    struct normal normal;
    bool pins;
    out->count = 0;
    set_slabs_of(pair, f, f, &set);
    for (int i = 0; set_normal_of_set(pair, &set, i, &normal, &pins); i++) {
        limbs_set_products(pair, &normal, &of);
        complete_products(pair, &of);
        if (pins || !is_constant(pair, &of, f, f))
            add_slab_of(pair, f, &of, at, out);
    }
}

/* ---- Segments ---- */

/* The sign of x - y, where a segment from vertex v to w crosses two bounds: at f / (f - g), with
 * the values f and g of different signs at its ends, that is, |f| / (|f| + |g|). */
LIMBS_FUNCTION int compare_crossings(int n, const struct box_slabs *slabs, int v, int w,
                                     struct bound_crossing x, struct bound_crossing y)
{
    limbs_number factor[4];
    set_magnitude(n, slabs->inside[x.bound][x.slab][v], factor[0]);
    set_magnitude(n, slabs->inside[y.bound][y.slab][w], factor[1]);
    set_magnitude(n, slabs->inside[y.bound][y.slab][v], factor[2]);
    set_magnitude(n, slabs->inside[x.bound][x.slab][w], factor[3]);
    return compare_products(n, factor[0], factor[1], factor[2], factor[3]);
}

/* Clips the segment from vertex v to w, which are not both beyond one bound. Returns false if
 * nothing is left of it; otherwise sets the bounds where that begins and ends, unless it does so at
 * a vertex.
 */
LIMBS_FUNCTION bool clip_exactly(int n, const struct box_slabs *slabs, int v, int w,
                                 struct bound_crossing end[2])
{
    end[0].slab = end[1].slab = -1;
    for (int i = 0; i < BOUNDS * slabs->count; i++) {
        const struct bound_crossing at = {i % BOUNDS, i / BOUNDS};
        const bool enters = is_negative(n, slabs->inside[at.bound][at.slab][v]);
        const bool leaves = is_negative(n, slabs->inside[at.bound][at.slab][w]);
        if (enters && (end[0].slab < 0 || compare_crossings(n, slabs, v, w, at, end[0]) > 0))
            end[0] = at;
        if (leaves && (end[1].slab < 0 || compare_crossings(n, slabs, v, w, at, end[1]) < 0))
            end[1] = at;
    }
    return end[0].slab < 0 || end[1].slab < 0 ||
           compare_crossings(n, slabs, v, w, end[0], end[1]) <= 0;
}

/* The same in doubles, exactly if what is left may be a point. from of the result is NAN if nothing
 * is left. */
LIMBS_FUNCTION struct clip_span clip_in_limbs(int n, const struct box_slabs *slabs, int v, int w)
{
    const struct clip_span none = {NAN, NAN};
    struct bound_crossing end[2];
    struct clip_span span = {0, 1};
    for (int i = 0; i < BOUNDS * slabs->count; i++) {
        const double f = slabs->value[i % BOUNDS][i / BOUNDS][v];
        const double g = slabs->value[i % BOUNDS][i / BOUNDS][w];
        const double at = f / (f - g);
        if (f < 0 && g < 0)
            return none;
        if (f < 0)
            span.from = at > span.from ? at : span.from;
        else if (g < 0)
            span.to = at < span.to ? at : span.to;
    }
    if (span.to - span.from >= CLIP_SHORTEST)
        return span;
    if (span.to - span.from < -CLIP_SHORTEST || !clip_exactly(n, slabs, v, w, end))
        return none;
    return span;
}

/* ---- Crossings ---- */

/* A parameter of the crossings of edges from any vertex of A and of B: all times its value is the
 * sum of a number of each vertex. */
struct crossing_parameter {
    limbs_number at[2][CLIP_VERTICES], all; /* [frame][vertex] */
    double inverse;                         /* 1 / all */
    bool exists;
};

/* Sets a parameter from the products of the normal of the other two directions: that along edge e
 * of frame 0 or 1 (which), or the time (which = 2). It does not exist where the directions are
 * dependent. */
LIMBS_FUNCTION void set_parameter(const struct limbs_pair *pair, const struct limbs_products *of,
                                  int which, int e, struct crossing_parameter *out)
{
    const int n = pair->limbs;
    const size_t size = (size_t) n * sizeof(uint64_t);
    limbs_number all, offset = {0};
    memcpy(all, which == 2 ? of->drift : of->component[which][e < 3 ? e : edge_to(pair->traits, e)],
           size);
    if (which < 2 && e >= 3)
        subtract(n, all, of->component[which][edge_from(pair->traits, e)]);
    if (which < 2 && pair->frame[which]->shape == FMB_BOX)
        add(n, all, of->component[which][e]);
    out->exists = !is_zero(n, all);
    if (!out->exists)
        return;
    /* From A to B: s a - r b - t drift, so that r and t have the opposite sign. */
    const int sign = is_negative(n, all) == (which == 0) ? -1 : 1;
    add_signed(n, offset, sign, of->offset);
    for (int f = 0; f < 2; f++) {
        const limbs_number none = {0};
        set_limbs_at_vertices(pair, of, f, f ? sign : -sign, 0, f ? offset : none, out->at[f]);
    }
    set_magnitude(n, all, out->all);
    out->inverse = 1 / to_double(n, out->all);
}

/* Returns whether the parameter of the edges from vertices v of A and w of B is from 0 to 1, and
 * sets it if so. */
LIMBS_FUNCTION bool is_in_range(int n, const struct crossing_parameter *parameter, int v, int w,
                                double *out)
{
    limbs_number x, left;
    memcpy(x, parameter->at[0][v], (size_t) n * sizeof *x);
    add(n, x, parameter->at[1][w]);
    memcpy(left, parameter->all, (size_t) n * sizeof *left);
    subtract(n, left, x);
    if (is_negative(n, x) || is_negative(n, left))
        return false;
    *out = to_double(n, x) * parameter->inverse;
    return true;
}

/* Memory for one box. */
struct box_work {
    struct box_slabs slabs;
    limbs_number at[CLIP_VERTICES];
    struct crossing_parameter s, r, t;
    struct limbs_products of[2][SLABS_EDGES]; /* of the normals of edges and the drift */
    bool exists[2][SLABS_EDGES];
};

/* ---- The search ---- */

struct box_search {
    struct limbs_pair *pair;
    struct box_work *work;
    struct clip_wire wire[2];
    /* In doubles: the points of the frames, and how far the intersection reaches from 0, [below,
     * above][axis], but for errors of the coordinates. */
    struct clip_points points[2];
    double reach[2][3];
};

/* Adds the crossing of the edge of A along direction i, by index, from vertex v with an edge of B.
 * at: its parameters along the edge of A and in time. */
LIMBS_FUNCTION void add_crossing_point(struct box_search *search, int i, int v, const double at[2])
{
    const int path = search->wire[0].directions - 1;
    const struct clip_points *a = &search->points[0];
    for (int axis = 0; axis < 3; axis++) {
        const double x =
            a->vertex[axis][v] + (at[0] * a->along[axis][i] + at[1] * a->along[axis][path]);
        search->reach[0][axis] = fmax(search->reach[0][axis], -x);
        search->reach[1][axis] = fmax(search->reach[1][axis], x);
    }
}

/* The edges of a frame along a direction, by segment, at the start of the window. */
struct parallel_edges {
    int count, segment[4];
};

LIMBS_FUNCTION struct parallel_edges edges_along(const struct clip_wire *wire, int direction)
{
    struct parallel_edges out = {0};
    for (int n = 0; n < wire->segments; n++)
        if (wire->direction[n] == direction && wire->from[n] < wire->vertices)
            out.segment[out.count++] = n;
    return out;
}

/* Adds the crossings of the edges along i of A and j of B, by index. In: their parameters. */
LIMBS_FUNCTION void add_crossings_of(struct box_search *search, int i, int j)
{
    struct limbs_pair *pair = search->pair;
    struct box_work *work = search->work;
    const struct kernel_traits traits = search->pair->traits;
    const struct clip_wire *wire = search->wire;
    const struct parallel_edges a = edges_along(&wire[0], i), b = edges_along(&wire[1], j);
    const int n = pair->limbs;
    struct limbs_products of;
    work->t.exists = false;
    if (!complete_products_of(
            pair, (struct slab_normal){edge_number(traits, 0, i), edge_number(traits, 1, j)}, &of))
        return;
    for (int k = 0; k < a.count * b.count; k++) {
        const int edge = a.segment[k / b.count], v = wire[0].from[edge];
        const int w = wire[1].from[b.segment[k % b.count]];
        double at[2], at_r;
        if (!is_in_range(n, &work->s, v, w, &at[0]) || !is_in_range(n, &work->r, v, w, &at_r))
            continue;
        if (!work->t.exists)
            set_parameter(pair, &of, 2, 0, &work->t);
        if (work->t.exists && is_in_range(n, &work->t, v, w, &at[1]))
            add_crossing_point(search, i, v, at);
    }
}

/* The normal of an edge and the drift serves the edges of the other frame in all directions. */
LIMBS_FUNCTION void add_all_crossings(struct box_search *search)
{
    struct limbs_pair *pair = search->pair;
    struct box_work *work = search->work;
    const struct kernel_traits traits = search->pair->traits;
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < edge_count(traits, f); i++)
            work->exists[f][i] = complete_products_of(
                pair, (struct slab_normal){edge_number(traits, f, i), SLABS_DRIFT},
                &work->of[f][i]);
    for (int i = 0; i < edge_count(traits, 0); i++)
        for (int j = 0; j < edge_count(traits, 1); j++) {
            if (!work->exists[0][i] || !work->exists[1][j])
                continue;
            set_parameter(pair, &work->of[1][j], 0, edge_at(traits, 0, i), &work->s);
            set_parameter(pair, &work->of[0][i], 1, edge_at(traits, 1, j), &work->r);
            if (work->s.exists && work->r.exists)
                add_crossings_of(search, i, j);
        }
}

/* ---- Boxes in doubles ---- */

/* Sets the reach. */
LIMBS_FUNCTION void find_reach(struct box_search *search, const struct box_pair *box)
{
    const struct kernel_traits traits = search->pair->traits;
    for (int i = 0; i < 6; i++)
        search->reach[i / 3][i % 3] = -INFINITY;
    for (int f = 0; f < 2; f++) {
        const struct clip_wire *wire = &search->wire[f];
        struct box_slabs *slabs = &search->work->slabs;
        struct clip_span spans[CLIP_SEGMENTS];
        set_limbs_slabs(search->pair, !f, search->work->at, slabs);
        set_points(traits, f, wire, &box->frame[f], &search->points[f]);
        for (int s = 0; s < wire->segments; s++)
            spans[s] = clip_in_limbs(search->pair->limbs, slabs, wire->from[s], wire->to[s]);
        add_reach(traits, wire, &search->points[f], spans, search->reach);
    }
    if (traits.dim == 3 && traits.drifts)
        add_all_crossings(search);
}

#endif
