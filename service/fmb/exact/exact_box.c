/* The points that span the intersection of two frames over the window, and its exact box.
 *
 * In space and time (tau, p) the intersection is a convex polytope Q; its box is that of its
 * vertices. Let P be the polytope of all (tau, x, y), with parameters x of A and y of B that give
 * the same point at tau. Q is the image of P, and each vertex of Q is the image of a vertex of P.
 * At a vertex of P let x lie inside a face of A's cube or simplex of dimension i, and y inside one
 * of B's of dimension j (0 a vertex, 1 an edge, ...). No direction leads both ways out of a vertex.
 * So the map (dx, dy, dtau) -> sum dx c_A - sum dy c_B - dtau drift into space is one to one on
 * these faces, with dtau = 0 at an end of the window. Hence
 *
 *   inside the window i + j + 1 <= 3: a vertex of one frame against any part of the other
 *   (i = 0 or j = 0), or an edge against an edge, whose directions and the drift are
 *   independent;
 *   at an end of the window (and in a static pair) i + j <= 3: one of the two is a vertex or an
 *   edge.
 *
 * This holds for flat frames too; their vertices and edges are the images of those of the
 * parameters. So Q is the hull of
 *
 *   1. the ends of each edge of A clipped to B, and of B to A, at both ends of the window;
 *   2. the ends of the path of each vertex of A clipped to B, and of B to A (relative motion);
 *   3. the points and times where an edge of A crosses an edge of B.
 *
 * All of these lie in Q. Every vertex of Q is among them: in 1 and 2 because a vertex of Q is not
 * an inner point of a segment in Q.
 *
 * Cost, with numbers of W limbs as in exact.c: the values of the vertices on each slab, and each
 * crossing, are sums of triple products. Signs alone reject most segments. For one that remains, at
 * most 3 slabs of a cuboid (4 of a tetrahedron, 7 of a flat frame) move an end. Each compares two
 * quotients, in doubles unless these agree in 48 bits, and then by two products of (3 W)^2 limbs. A
 * point takes 15 products with numbers of at most 3 limbs and up to 6 quotients of 53 bits: less
 * than 20,000 products of limbs. Q has at most 77 vertices (14 facets in 4 dimensions); some are
 * found more than once. */
#include "exact.h"
#include "integer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    /* Slabs of one frame: 4 faces of a tetrahedron; flat, the plane and 6 edges; 3 of a
     * segment or point. */
    FRAME_SLABS_MAX = 7
};

/* The slabs of one frame, and how far the vertices of the other lie along their normals. */
struct clipper {
    int slabs;
    struct exact_range slab[FRAME_SLABS_MAX];
    /* [end of the window][slab][vertex of the other frame]: normal . w, w the vertex relative
     * to the origin of this frame. */
    mpz_t at[2][FRAME_SLABS_MAX][EXACT_VERTICES_MAX];
};

struct point_search {
    struct exact_pair *pair;
    point_visit visit;
    void *context;
    int clipping; /* the clipper that is being filled */
    int ends;     /* of the window: 2 if the pair is moving, else 1 */
    int vertices[2];
    struct clipper clipper[2]; /* [frame]: its slabs, the other's vertices */
    struct ratio part[2];      /* of a segment: from [0] to [1] */
    struct ratio crossing;
    mpz_t weight[3];
    struct exact_point found;
    mpz_t *scratch;
};

/* Calls one of mpz_init and mpz_clear for every number. */
static void point_search_each(struct point_search *search, void (*call)(mpz_ptr))
{
    for (int f = 0; f < 2; f++) {
        ratio_each(&search->part[f], call);
        for (int s = 0; s < FRAME_SLABS_MAX; s++) {
            exact_range_each(&search->clipper[f].slab[s], call);
            for (int v = 0; v < EXACT_VERTICES_MAX; v++) {
                call(search->clipper[f].at[0][s][v]);
                call(search->clipper[f].at[1][s][v]);
            }
        }
    }
    ratio_each(&search->crossing, call);
    for (int axis = 0; axis < 3; axis++)
        call(search->weight[axis]);
    for (int k = 0; k < EXACT_COORDINATES; k++)
        call(search->found.at[k]);
    call(search->found.den);
}

/* ---- Vertices ---- */

static int vertex_count(const struct exact_frame *frame)
{
    return frame->simplex ? frame->count + 1 : 1 << frame->count;
}

/* Vertex v of a cuboid is the sum of the components whose bits are set in v; of a simplex, the
 * origin, then the end of each component. */
static bool has_component(const struct exact_frame *frame, int v, int i)
{
    return frame->simplex ? v == i + 1 : v >> i & 1;
}

static bool is_edge(const struct exact_frame *frame, int v, int w)
{
    int bits = v ^ w;
    return frame->simplex || (bits & (bits - 1)) == 0;
}

/* out += sign normal . vertex v of frame f, its origin at 0 */
static void add_vertex(const struct exact_pair *pair, int sign, int f, int v,
                       mpz_t value[EXACT_VECTORS], mpz_t out)
{
    const struct exact_frame *frame = &pair->frame[f];
    for (int i = 0; i < frame->count; i++) {
        if (!has_component(frame, v, i))
            continue;
        if (sign > 0)
            mpz_add(out, out, value[f * EXACT_OF_B + i]);
        else
            mpz_sub(out, out, value[f * EXACT_OF_B + i]);
    }
}

/* ---- Points ---- */

/* Visits vertex v of frame f plus s / den of the way to vertex w, at the time tau / den. In units,
 * it is origin + sum weight_i component_i / den + tau displacement / den: products with the numbers
 * of the pair alone, which are short (exact.c). */
static void visit_point(struct point_search *search, int f, int v, int w, const mpz_t s,
                        const mpz_t tau, const mpz_t den)
{
    struct exact_frame *frame = &search->pair->frame[f];
    struct exact_point *found = &search->found;
    for (int i = 0; i < frame->count; i++) {
        const bool from = has_component(frame, v, i), to = has_component(frame, w, i);
        mpz_set_ui(search->weight[i], 0);
        if (from)
            mpz_set(search->weight[i], den);
        if (to && !from)
            mpz_add(search->weight[i], search->weight[i], s);
        else if (from && !to)
            mpz_sub(search->weight[i], search->weight[i], s);
    }
    for (int axis = 0; axis < 3; axis++) {
        mpz_t *at = &found->at[1 + axis];
        integer_multiply(*at, den, frame->origin[axis]);
        integer_add_product(*at, 1, tau, frame->displacement[axis], search->scratch[0]);
        for (int i = 0; i < frame->count; i++)
            integer_add_product(*at, 1, search->weight[i], frame->component[i][axis],
                                search->scratch[0]);
    }
    mpz_mul(found->at[0], tau, search->pair->scale);
    mpz_mul(found->den, den, search->pair->scale);
    search->visit(search->context, found);
}

/* ---- Kinds 1 and 2: segments cut by the slabs of the other frame ---- */

/* Seen from frame f, the origin of the other frame is at the offset (f = 0) or at minus that. */
static bool keep_slab(void *context, struct slab *slab)
{
    struct point_search *search = context;
    const int f = search->clipping, other = 1 - f;
    struct clipper *clipper = &search->clipper[f];
    assert(clipper->slabs < FRAME_SLABS_MAX);
    const int s = clipper->slabs++;
    mpz_set(clipper->slab[s].low, slab->low);
    mpz_set(clipper->slab[s].high, slab->high);
    for (int v = 0; v < search->vertices[other]; v++) {
        mpz_set(clipper->at[0][s][v], slab->value[EXACT_OFFSET]);
        if (f == 1)
            mpz_neg(clipper->at[0][s][v], clipper->at[0][s][v]);
        add_vertex(search->pair, 1, other, v, slab->value, clipper->at[0][s][v]);
        if (f == 0)
            mpz_add(clipper->at[1][s][v], clipper->at[0][s][v], slab->value[EXACT_DRIFT]);
        else
            mpz_sub(clipper->at[1][s][v], clipper->at[0][s][v], slab->value[EXACT_DRIFT]);
    }
    return true;
}

static void set_clippers(struct point_search *search)
{
    for (search->clipping = 0; search->clipping < 2; search->clipping++)
        slabs_walk(search->pair, search->clipping ? SLABS_OF_B : SLABS_OF_A, keep_slab, search);
}

/* Moves an end of the part of a segment to where it crosses a bound, if that is further inside. */
static void cut(struct point_search *search, int end, const mpz_t f0, const mpz_t f1,
                const mpz_t bound)
{
    ratio_cross(&search->crossing, f0, f1, bound);
    ratio_tighten(&search->part[end], true, end, &search->crossing, search->scratch);
}

/* Sets search->part of the segment on which normal . w goes from f0 to f1 for each slab; returns
 * how many ends it has: 0 if nothing is left of it, 1 if that is a point. */
static int clip(struct point_search *search, const struct clipper *clipper, int v, int end_v, int w,
                int end_w)
{
    for (int end = 0; end < 2; end++) {
        mpz_set_ui(search->part[end].num, (unsigned long) end);
        mpz_set_ui(search->part[end].den, 1);
    }
    for (int pass = 0; pass < 2; pass++) /* signs alone leave few segments to be cut */
        for (int s = 0; s < clipper->slabs; s++) {
            const struct exact_range *slab = &clipper->slab[s];
            const mpz_t *f0 = &clipper->at[end_v][s][v], *f1 = &clipper->at[end_w][s][w];
            const bool below0 = mpz_cmp(*f0, slab->low) < 0, below1 = mpz_cmp(*f1, slab->low) < 0;
            const bool above0 = mpz_cmp(*f0, slab->high) > 0, above1 = mpz_cmp(*f1, slab->high) > 0;
            if ((below0 && below1) || (above0 && above1))
                return 0;
            if (pass == 1 && (below0 || above0))
                cut(search, 0, *f0, *f1, below0 ? slab->low : slab->high);
            if (pass == 1 && (below1 || above1))
                cut(search, 1, *f0, *f1, below1 ? slab->low : slab->high);
        }
    return 1 - ratio_compare(&search->part[0], &search->part[1], search->scratch);
}

/* Clips the segment of frame f that goes from vertex v at one end of the window to vertex w at the
 * same or the other end to the other frame, and visits the ends of what is left. */
static void visit_segment(struct point_search *search, int f, int v, int end_v, int w, int end_w)
{
    const int ends = clip(search, &search->clipper[1 - f], v, end_v, w, end_w);
    for (int end = 0; end < ends; end++) {
        const struct ratio *s = &search->part[end];
        mpz_t *tau = &search->scratch[1];
        if (end_v != end_w) /* 0 and 1 */
            mpz_set(*tau, s->num);
        else
            mpz_mul_si(*tau, s->den, end_v);
        visit_point(search, f, v, w, s->num, *tau, s->den);
    }
}

static void visit_edges(struct point_search *search, int f, int end)
{
    for (int v = 0; v < search->vertices[f]; v++)
        for (int w = v + 1; w < search->vertices[f]; w++)
            if (is_edge(&search->pair->frame[f], v, w))
                visit_segment(search, f, v, end, w, end);
}

/* ---- Kind 3 ----
 *
 * The crossing of an edge p + s e of A with an edge q + u f + offset + tau drift of B, with
 * r = q + offset - p (all relative to the origin of A):
 *
 *     s e - u f - tau drift = r.
 *
 * Dot products with e x f, f x drift and e x drift leave one unknown each, and
 * det = drift . (e x f) = e . (f x drift) = -f . (e x drift):
 *
 *     tau = -r . (e x f) / det,   s = r . (f x drift) / det,   u = r . (e x drift) / det.
 *
 * Where det is 0 the directions and the drift are dependent: no vertex that is not of kind 1 or 2.
 */
struct crossing {
    /* Of e x f, f x drift, e x drift, signs turned so that det > 0. */
    mpz_t ef[EXACT_VECTORS], fd[EXACT_VECTORS], ed[EXACT_VECTORS];
    mpz_t det, s, u, tau;
};

static void crossing_each(struct crossing *crossing, void (*call)(mpz_ptr))
{
    for (int k = 0; k < EXACT_VECTORS; k++) {
        call(crossing->ef[k]);
        call(crossing->fd[k]);
        call(crossing->ed[k]);
    }
    call(crossing->det);
    call(crossing->s);
    call(crossing->u);
    call(crossing->tau);
}

/* Sets what depends on the directions alone; false if they never cross in one point. */
static bool crossing_set(struct crossing *crossing, struct exact_pair *pair,
                         const struct exact_edge *e, const struct exact_edge *f)
{
    const struct exact_edge drift = {EXACT_DRIFT, -1, pair->drift};
    exact_cross_values(pair, e, f, crossing->ef);
    const int sign = mpz_sgn(crossing->ef[EXACT_DRIFT]);
    if (sign == 0)
        return false;
    mpz_abs(crossing->det, crossing->ef[EXACT_DRIFT]);
    exact_cross_values(pair, f, &drift, crossing->fd);
    exact_cross_values(pair, e, &drift, crossing->ed);
    for (int k = 0; k < EXACT_VECTORS; k++) {
        if (sign > 0) {
            mpz_neg(crossing->ef[k], crossing->ef[k]);
        } else {
            mpz_neg(crossing->fd[k], crossing->fd[k]);
            mpz_neg(crossing->ed[k], crossing->ed[k]);
        }
    }
    return true;
}

/* out := r . the normal of these values; false if that is not from 0 to det. */
static bool crossing_number(const struct crossing *crossing, const struct exact_pair *pair, int v,
                            int w, mpz_t value[EXACT_VECTORS], mpz_t out)
{
    mpz_set(out, value[EXACT_OFFSET]);
    add_vertex(pair, 1, 1, w, value, out);
    add_vertex(pair, -1, 0, v, value, out);
    return mpz_sgn(out) >= 0 && mpz_cmp(out, crossing->det) <= 0;
}

/* Where the direction number e starts in vertex v, the vertex where that edge ends; else -1. */
static int end_of_edge(const struct exact_frame *frame, int e, int v)
{
    if (!frame->simplex)
        return v >> e & 1 ? -1 : v | 1 << e;
    const struct exact_edge *edge = &frame->edge[e];
    const int first = frame->edge[0].plus, start = edge->minus < 0 ? 0 : edge->minus - first + 1;
    return v == start ? edge->plus - first + 1 : -1;
}

/* Visits the crossings of all edges in one direction of A with all in one of B. */
static void visit_parallel_crossings(struct point_search *search, struct crossing *crossing, int e,
                                     int f)
{
    struct exact_pair *pair = search->pair;
    for (int v = 0; v < search->vertices[0]; v++) {
        const int end = end_of_edge(&pair->frame[0], e, v);
        if (end < 0)
            continue;
        for (int w = 0; w < search->vertices[1]; w++)
            if (end_of_edge(&pair->frame[1], f, w) >= 0 &&
                crossing_number(crossing, pair, v, w, crossing->ef, crossing->tau) &&
                crossing_number(crossing, pair, v, w, crossing->fd, crossing->s) &&
                crossing_number(crossing, pair, v, w, crossing->ed, crossing->u))
                visit_point(search, 0, v, end, crossing->s, crossing->tau, crossing->det);
    }
}

static void visit_crossings(struct point_search *search)
{
    struct exact_pair *pair = search->pair;
    struct crossing crossing;
    crossing_each(&crossing, mpz_init);
    for (int e = 0; e < pair->frame[0].edges; e++)
        for (int f = 0; f < pair->frame[1].edges; f++)
            if (crossing_set(&crossing, pair, &pair->frame[0].edge[e], &pair->frame[1].edge[f]))
                visit_parallel_crossings(search, &crossing, e, f);
    crossing_each(&crossing, mpz_clear);
}

void points_walk(struct exact_pair *pair, point_visit visit, void *context)
{
    struct point_search search = {.pair = pair,
                                  .visit = visit,
                                  .context = context,
                                  .ends = pair->moving ? 2 : 1,
                                  .scratch = pair->scratch};
    point_search_each(&search, mpz_init);
    for (int f = 0; f < 2; f++)
        search.vertices[f] = vertex_count(&pair->frame[f]);
    set_clippers(&search);
    for (int f = 0; f < 2; f++) {
        for (int end = 0; end < search.ends; end++)
            visit_edges(&search, f, end);
        for (int v = 0; v < search.vertices[f] && pair->moving; v++)
            visit_segment(&search, f, v, 0, v, 1);
    }
    if (pair->moving)
        visit_crossings(&search);
    point_search_each(&search, mpz_clear);
}

/* ---- The box ---- */

struct boxing {
    long unit;
    double box[2][3]; /* of the points so far; lower > upper: none yet */
    mpz_t scratch[2];
};

/* Whether num / den 2^unit surely lies strictly inside of the box along an axis. Numerators and
 * denominators are cut off at 53 bits: their quotient is off by less than 2^-50 of itself. */
static bool surely_inside(const struct boxing *boxing, int axis, const mpz_t num, const mpz_t den)
{
    long of_num, of_den;
    const double mantissa = mpz_get_d_2exp(&of_num, num) / mpz_get_d_2exp(&of_den, den);
    const long exponent = of_num - of_den + boxing->unit;
    if (exponent < -1000 || exponent > 1000)
        return false;
    const double x = ldexp(mantissa, (int) exponent), error = 0x1p-48 * fabs(x);
    return x - error > boxing->box[0][axis] && x + error < boxing->box[1][axis];
}

/* Rounding keeps order: the least of the rounded coordinates is the rounded least one. A coordinate
 * that is rounded down to less than the upper end is not above that when it is rounded up. */
static void include_point(void *context, const struct exact_point *point)
{
    struct boxing *boxing = context;
    for (int axis = 0; axis < 3; axis++) {
        const mpz_t *at = &point->at[1 + axis];
        double *low = &boxing->box[0][axis], *high = &boxing->box[1][axis];
        if (surely_inside(boxing, axis, *at, point->den))
            continue;
        const double down =
            integer_ratio_round(*at, point->den, boxing->unit, ROUND_DOWN, boxing->scratch);
        *low = down < *low ? down : *low;
        if (down < *high)
            continue;
        const double up =
            integer_ratio_round(*at, point->den, boxing->unit, ROUND_UP, boxing->scratch);
        *high = up > *high ? up : *high;
    }
}

void exact_pair_box(struct exact_pair *pair, double box[2][FMB_DIM_MAX])
{
    struct boxing boxing = {.unit = pair->unit};
    for (int axis = 0; axis < 3; axis++) {
        boxing.box[0][axis] = INFINITY;
        boxing.box[1][axis] = -INFINITY;
    }
    mpz_inits(boxing.scratch[0], boxing.scratch[1], NULL);
    points_walk(pair, include_point, &boxing);
    mpz_clears(boxing.scratch[0], boxing.scratch[1], NULL);
    assert(boxing.box[0][0] <= boxing.box[1][0]);
    memcpy(box, boxing.box, sizeof boxing.box);
}
