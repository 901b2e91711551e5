/* Boxes in fixed-width integers: the step between doubles (box_clip.h) and GMP (exact_box.c).
 *
 * In: two prepared frames in contact, solids or faces.
 *
 * Out: the box, within the limit of fmb.h.
 *
 * The segments of each frame are clipped to the slabs of the other, and edges that move cross, as
 * in box_clip.h. But how far a vertex is inside a bound, and how far a crossing is inside the
 * ranges of its parameters, are integers here: their signs are exact, and as doubles they are off
 * by less than 2.1 u of themselves, u = 2^-53. A segment crosses a bound between vertices on either
 * side, with values f >= 0 > g: at f / (f - g), a sum of two magnitudes, off by less than 6.2 u of
 * itself. Only where a segment enters the other frame within 2^-48 of where it leaves it, the order
 * of both matters, and is that of two products of integers. So points are off by no more than the
 * slack of box_ends.h: also where that is 6.1 u times four times all components, twice what a
 * segment is long. And a point that counts surely is in the intersection. */
#define INLINED_NOT
#include "limbs_box.h"

#define LANES 1
#include "kernel_box.h"
#include "limbs.h"

enum { LOW, HIGH, BOUNDS };

/* The slabs of one frame, and the vertices of the other. */
struct box_slabs {
    int count;
    /* How far vertices are inside the bounds: [bound][slab][vertex]. */
    limbs_number inside[BOUNDS][CLIP_SLABS][CLIP_VERTICES];
    double value[BOUNDS][CLIP_SLABS][CLIP_VERTICES];
};

/* A bound that a segment crosses, by number, and where. */
struct bound_crossing {
    int bound, slab;
    double at;
};

/* out := |x|, as a number without a sign. In: out is not x. */
static void set_magnitude(int n, const uint64_t *x, uint64_t *out)
{
    memset(out, 0, (size_t) n * sizeof *x);
    if (is_negative(n, x))
        subtract(n, out, x);
    else
        add(n, out, x);
}

/* x, off by less than 2.1 u of itself. The two leading limbs of those that hold x with its sign are
 * at least 2^63 in magnitude; the limbs below are less than one. */
static double to_double(int n, const uint64_t *x)
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
static void add_signed(int n, uint64_t *out, int sign, const uint64_t *x)
{
    if (sign < 0)
        subtract(n, out, x);
    else
        add(n, out, x);
}

/* out[v] := value plus what the components of frame f add at vertex v, times sign; then, if drift
 * is not 0, the same with the drift times that. Vertices as in struct clip_wire. */
static void set_limbs_at_vertices(const struct limbs_pair *pair, const struct limbs_products *of,
                                  int f, int sign, int drift, const uint64_t *value,
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

static bool is_less(int n, const uint64_t *x, const uint64_t *y)
{
    limbs_number difference;
    memcpy(difference, x, (size_t) n * sizeof *x);
    subtract(n, difference, y);
    return is_negative(n, difference);
}

/* [low, high] := the extent of frame f along the normal, from its origin; of a box, its centre. */
static void set_limbs_extent(const struct limbs_pair *pair, const struct limbs_products *of, int f,
                             uint64_t *low, uint64_t *high)
{
    const int n = pair->limbs;
    const size_t size = (size_t) n * sizeof *low;
    const bool simplex = frame_is_simplex(pair->frame[f]);
    memset(low, 0, size);
    memset(high, 0, size);
    for (int i = 0; i < pair->frame[f]->count; i++) {
        const uint64_t *at = of->component[f][i];
        if (!simplex)
            add(n, is_negative(n, at) ? low : high, at);
        else if (is_less(n, at, low))
            memcpy(low, at, size);
        else if (is_less(n, high, at))
            memcpy(high, at, size);
    }
    if (pair->frame[f]->shape != FMB_BOX)
        return;
    subtract(n, high, low);
    memset(low, 0, size);
    subtract(n, low, high);
}

/* ---- Slabs ---- */

/* Adds the slab of a normal of frame f. Returns false if the frame has no extent along it, and it
 * is not the plane of a face. */
static bool add_slab_of(const struct limbs_pair *pair, const struct kernel_traits traits, int f,
                        const struct limbs_products *of, bool plane, struct box_slabs *out)
{
    const int n = pair->limbs, k = out->count++;
    const size_t size = (size_t) n * sizeof(uint64_t);
    limbs_number low, high, start = {0}, at[CLIP_VERTICES];
    set_limbs_extent(pair, of, f, low, high);
    if (!plane && memcmp(low, high, size) == 0)
        return false;
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
    return true;
}

/* The slabs of frame f, as those of set_space_slabs() and set_plane_slabs(). Returns false for a
 * frame that is flat, other than a face with an area. */
static bool set_limbs_slabs(struct limbs_pair *pair, const struct kernel_traits traits, int f,
                            struct box_slabs *out)
{
    const int first = f ? SLABS_EDGE_OF_B : 0;
    const int count = traits.face[f] ? 1 : traits.simplex[f] ? traits.dim + 1 : traits.dim;
    struct limbs_products of;
    out->count = 0;
    for (int k = 0; k < count; k++) {
        const int u = traits.face[f] ? 0 : traits.dim == 2 ? k : k == 3 ? 3 : next(k);
        const int v = traits.face[f] ? 1 : k == 3 ? 4 : next(next(k));
        if (!limbs_products_of(pair, (struct slab_normal){first + u, first + v}, &of) ||
            !add_slab_of(pair, traits, f, &of, traits.face[f], out))
            return false;
    }
    for (int index = 0; index < 3 && traits.face[f]; index++) {
        limbs_products_in_face(pair, f, edge_at(traits, f, index), &of);
        if (!add_slab_of(pair, traits, f, &of, false, out))
            return false;
    }
    return true;
}

/* ---- Segments ---- */

/* Whether a segment from vertex v to w enters by a bound no later than it leaves by another. With
 * the values f < 0 <= g along the first bound, and F >= 0 > G along the second: if and only if f /
 * (f
 * - g) <= F / (F - G), that is, f G <= F g. */
static bool enters_in_order(int n, const struct box_slabs *slabs, int v, int w,
                            const struct bound_crossing *enter, const struct bound_crossing *leave)
{
    limbs_number factor[4];
    mp_limb_t product[2][2 * LIMBS_MAX];
    set_magnitude(n, slabs->inside[enter->bound][enter->slab][v], factor[0]);
    set_magnitude(n, slabs->inside[leave->bound][leave->slab][w], factor[1]);
    set_magnitude(n, slabs->inside[leave->bound][leave->slab][v], factor[2]);
    set_magnitude(n, slabs->inside[enter->bound][enter->slab][w], factor[3]);
    mpn_mul_n(product[0], factor[0], factor[1], n);
    mpn_mul_n(product[1], factor[2], factor[3], n);
    return mpn_cmp(product[0], product[1], 2 * n) <= 0;
}

/* Clips the segment from vertex v to w. from of the result is NAN if nothing is left. */
static struct clip_span clip_in_limbs(int n, const struct box_slabs *slabs, int v, int w)
{
    const struct clip_span none = {NAN, NAN};
    struct bound_crossing enter[BOUNDS * CLIP_SLABS], leave[BOUNDS * CLIP_SLABS];
    struct clip_span span = {0, 1};
    int enters = 0, leaves = 0;
    for (int i = 0; i < BOUNDS * slabs->count; i++) {
        const int bound = i % BOUNDS, k = i / BOUNDS;
        const double f = slabs->value[bound][k][v], g = slabs->value[bound][k][w];
        if (f < 0 && g < 0)
            return none;
        const double at = f / (f - g);
        if (f < 0) {
            enter[enters++] = (struct bound_crossing){bound, k, at};
            span.from = at > span.from ? at : span.from;
        } else if (g < 0) {
            leave[leaves++] = (struct bound_crossing){bound, k, at};
            span.to = at < span.to ? at : span.to;
        }
    }
    if (span.to - span.from >= CLIP_SHORTEST)
        return span;
    if (span.to - span.from < -CLIP_SHORTEST)
        return none;
    for (int i = 0; i < enters; i++)
        for (int j = 0; j < leaves; j++)
            if (!enters_in_order(n, slabs, v, w, &enter[i], &leave[j]))
                return none;
    return span;
}

/* ---- Crossings ---- */

/* A parameter of the crossings of edges from any vertex of A and of B: all times its value is the
 * sum of a number of each vertex. */
struct crossing_parameter {
    limbs_number at[2][CLIP_VERTICES], all;  /* [frame][vertex] */
    double value[2][CLIP_VERTICES], inverse; /* the same; 1 / all */
    bool exists;
};

/* Sets a parameter from the products of the normal of the other two directions: that along edge e
 * of frame 0 or 1 (which), or the time (which = 2). It does not exist where the directions are
 * dependent. */
static void set_parameter(const struct limbs_pair *pair, const struct kernel_traits traits,
                          const struct limbs_products *of, int which, int e,
                          struct crossing_parameter *out)
{
    const int n = pair->limbs;
    const size_t size = (size_t) n * sizeof(uint64_t);
    limbs_number all, offset = {0};
    memcpy(all, which == 2 ? of->drift : of->component[which][e < 3 ? e : edge_to(traits, e)],
           size);
    if (which < 2 && e >= 3)
        subtract(n, all, of->component[which][edge_from(traits, e)]);
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
        for (int v = 0; v < vertex_count(traits, f); v++)
            out->value[f][v] = to_double(n, out->at[f][v]);
    }
    set_magnitude(n, all, out->all);
    out->inverse = 1 / to_double(n, out->all);
}

/* Returns whether the parameter of the edges from vertices v of A and w of B is from 0 to 1, and
 * sets it. In doubles, the sum and its distance from 1 are off by less than 2^-50 of the
 * magnitudes; if that does not decide, in integers. */
static bool is_in_range(int n, const struct crossing_parameter *parameter, int v, int w,
                        double *out)
{
    const double of_a = parameter->value[0][v] * parameter->inverse;
    const double of_b = parameter->value[1][w] * parameter->inverse;
    const double error = 0x1p-50 * ((fabs(of_a) + fabs(of_b)) + 1);
    limbs_number x, left;
    *out = of_a + of_b;
    if (*out < -error || *out > 1 + error)
        return false;
    memcpy(x, parameter->at[0][v], (size_t) n * sizeof *x);
    add(n, x, parameter->at[1][w]);
    memcpy(left, parameter->all, (size_t) n * sizeof *left);
    subtract(n, left, x);
    *out = to_double(n, x) * parameter->inverse;
    return !is_negative(n, x) && !is_negative(n, left);
}

/* Where the edges of a frame along a direction begin, at the start of the window. */
struct edge_starts {
    int count, vertex[4];
};

static struct edge_starts starts_along(const struct clip_wire *wire, int direction)
{
    struct edge_starts out = {0};
    for (int n = 0; n < wire->segments; n++)
        if (wire->direction[n] == direction && wire->from[n] < wire->vertices)
            out.vertex[out.count++] = wire->from[n];
    return out;
}

/* Adds the crossings of the edges along i of A and j of B, by index, to the reach; s and r: their
 * parameters. */
static void add_crossings_of(struct limbs_pair *pair, const struct kernel_traits traits,
                             const struct clip_wire wire[2], const struct clip_points *a, int i,
                             int j, const struct crossing_parameter *s,
                             const struct crossing_parameter *r, double reach[2][3])
{
    const int n = pair->limbs;
    const struct edge_starts of_a = starts_along(&wire[0], i), of_b = starts_along(&wire[1], j);
    const double *along[3] = {a->along[0], a->along[1], a->along[2]};
    const int path = wire[0].directions - 1;
    struct limbs_products of;
    struct crossing_parameter t = {.exists = false};
    if (!limbs_products_of(
            pair,
            (struct slab_normal){edge_at(traits, 0, i), SLABS_EDGE_OF_B + edge_at(traits, 1, j)},
            &of))
        return;
    for (int k = 0; k < of_a.count * of_b.count; k++) {
        const int v = of_a.vertex[k / of_b.count], w = of_b.vertex[k % of_b.count];
        double at_s, at_r, at_t;
        if (!is_in_range(n, s, v, w, &at_s) || !is_in_range(n, r, v, w, &at_r))
            continue;
        if (!t.exists)
            set_parameter(pair, traits, &of, 2, 0, &t);
        if (!t.exists || !is_in_range(n, &t, v, w, &at_t))
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const double x =
                a->vertex[axis][v] + (at_s * along[axis][i] + at_t * along[axis][path]);
            reach[0][axis] = fmax(reach[0][axis], -x);
            reach[1][axis] = fmax(reach[1][axis], x);
        }
    }
}

/* The normal of an edge and the drift serves the edges of the other frame in all directions. */
static void add_all_crossings(struct limbs_pair *pair, const struct kernel_traits traits,
                              const struct clip_wire wire[2], const struct clip_points *a,
                              double reach[2][3])
{
    struct limbs_products of[2][SLABS_EDGES];
    bool exists[2][SLABS_EDGES];
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < edge_count(traits, f); i++)
            exists[f][i] = limbs_products_of(
                pair,
                (struct slab_normal){(f ? SLABS_EDGE_OF_B : 0) + edge_at(traits, f, i),
                                     SLABS_DRIFT},
                &of[f][i]);
    for (int i = 0; i < edge_count(traits, 0); i++)
        for (int j = 0; j < edge_count(traits, 1); j++) {
            struct crossing_parameter s, r;
            if (!exists[0][i] || !exists[1][j])
                continue;
            set_parameter(pair, traits, &of[1][j], 0, edge_at(traits, 0, i), &s);
            set_parameter(pair, traits, &of[0][i], 1, edge_at(traits, 1, j), &r);
            if (s.exists && r.exists)
                add_crossings_of(pair, traits, wire, a, i, j, &s, &r, reach);
        }
}

/* ---- All of it ---- */

/* Sets how far the intersection reaches from 0, [below, above][axis], but for errors of the
 * coordinates. Returns false for flat frames. */
static bool find_reach_in_limbs(struct limbs_pair *pair, const struct kernel_traits traits,
                                const struct box_pair *box, double reach[2][3])
{
    struct clip_wire wire[2];
    struct clip_points points[2];
    for (int i = 0; i < 6; i++)
        reach[i / 3][i % 3] = -INFINITY;
    for (int f = 0; f < 2; f++) {
        struct box_slabs slabs;
        struct clip_span spans[CLIP_SEGMENTS];
        if (!set_limbs_slabs(pair, traits, !f, &slabs))
            return false;
        set_wire(traits, f, &wire[f]);
        set_points(traits, f, &wire[f], &box->frame[f], &points[f]);
        for (int s = 0; s < wire[f].segments; s++)
            spans[s] = clip_in_limbs(pair->limbs, &slabs, wire[f].from[s], wire[f].to[s]);
        add_reach(traits, &wire[f], &points[f], spans, reach);
    }
    if (traits.dim == 3 && traits.drifts)
        add_all_crossings(pair, traits, wire, &points[0], reach);
    return true;
}

bool limbs_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
               int limbs_most, double box[2][FMB_DIM_MAX])
{
    bool swapped;
    const enum kernel_kind kind = kernel_box_kind(a, b, duration, &swapped);
    if (kind >= KERNEL_KINDS)
        return false;
    const struct fmb_prepared *frames[1][2] = {{swapped ? b : a, swapped ? a : b}};
    const struct fmb_prepared *const *of = frames[0];
    const struct frame_pair given = {
        {of[0]->frame, of[0]->placement}, {of[1]->frame, of[1]->placement}, duration};
    const struct kernel_traits traits = traits_of(kind);
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct box_places places;
    struct box_pair of_pair;
    struct box_ends ends;
    struct limbs_pair limbs;
    double reach[2][3];
    gather_pairs(traits, frames, frame);
    set_places(traits, frame, duration, &pair, &places);
    set_exact(traits, frame, &pair, &places);
    begin_box(&pair, traits, &places, &of_pair);
    if (!pair.in_range || !limbs_prepare_faces(&given, limbs_span_of(&given), &limbs) ||
        limbs.limbs > limbs_most || !find_reach_in_limbs(&limbs, traits, &of_pair, reach))
        return false;
    for (int i = 0; i < 6; i++) {
        const int end = i / 3, axis = i % 3;
        ends.outer[end][axis] = reach[end][axis] + of_pair.slack[axis];
        ends.inner[end][axis] = reach[end][axis] - of_pair.slack[axis];
    }
    if (!are_near(traits, &of_pair, &ends))
        return false;
    memset(box, 0, 2 * FMB_DIM_MAX * sizeof **box);
    put_box(&pair, traits, &places, &of_pair, &ends, box);
    return true;
}
