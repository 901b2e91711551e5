/* The points that span the intersection of two frames over the window, and its exact box.
 *
 * In space and time (tau, p) the intersection is a convex polytope Q; its box is that of its
 * vertices. Q is the image of the polytope P of all (tau, x, y), parameters x of A and y of B
 * that at tau give the same point, and each vertex of Q is the image of a vertex of P. At a
 * vertex of P let x lie inside a face of A's cube or simplex of dimension i, and y inside one
 * of B's of dimension j (0 a vertex, 1 an edge, ...). No direction leads both ways out of a
 * vertex, so the map (dx, dy, dtau) -> sum dx c_A - sum dy c_B - dtau drift into space is one to
 * one on these faces, with dtau = 0 at an end of the window. Hence
 *
 *   inside the window i + j + 1 <= 3: a vertex of one frame against whatever part of the other
 *   (i = 0 or j = 0), or an edge against an edge, whose directions and the drift are
 *   independent;
 *   at an end of the window (and in a static pair) i + j <= 3: one of the two is a vertex or an
 *   edge.
 *
 * This holds for flat frames too, whose vertices and edges are meant as the images of those of
 * the parameters. So Q is the hull of
 *   1. the ends of each edge of A clipped to B, and of B to A, at both ends of the window;
 *   2. the ends of the path of each vertex of A clipped to B, and of B to A (relative motion);
 *   3. the points and times where an edge of A crosses an edge of B.
 * All of these lie in Q, and every vertex of Q is among them: in 1 and 2 since a vertex of Q is
 * no inner point of a segment in Q. */
#include "exact.h"
#include "integer.h"

#include <assert.h>

enum {
    /* Slabs of one frame: 4 faces of a tetrahedron; flat, the plane and 6 edges; 3 of a
     * segment or point. */
    FRAME_SLABS_MAX = 7
};

/* The slabs of one frame, and how far the vertices of the other lie along their normals. */
struct clipper {
    int slabs;
    struct slab slab[FRAME_SLABS_MAX];
    /* [end of the window][slab][vertex of the other frame]: normal . w, w the vertex relative
     * to the origin of this frame. */
    mpz_t at[2][FRAME_SLABS_MAX][EXACT_VERTICES_MAX];
};

struct walk {
    struct exact_pair *pair;
    point_visit visit;
    void *context;
    int ends; /* of the window: 2 if the pair is moving, else 1 */
    int vertices[2];
    mpz_t vertex[2][EXACT_VERTICES_MAX][3]; /* [frame][vertex][axis], origin of the frame at 0 */
    struct clipper clipper[2];              /* [frame]: its slabs, the other's vertices */
    struct span span;
    mpz_t point[3], path[3];
    struct exact_point found;
    mpz_t scratch[EXACT_SCRATCH];
};

/* Calls one of mpz_init and mpz_clear for every number. */
static void walk_each(struct walk *walk, void (*call)(mpz_ptr))
{
    for (int f = 0; f < 2; f++) {
        for (int v = 0; v < EXACT_VERTICES_MAX; v++)
            for (int axis = 0; axis < 3; axis++)
                call(walk->vertex[f][v][axis]);
        for (int s = 0; s < FRAME_SLABS_MAX; s++) {
            struct slab *slab = &walk->clipper[f].slab[s];
            call(slab->low);
            call(slab->high);
            for (int axis = 0; axis < 3; axis++)
                call(slab->normal[axis]);
            for (int v = 0; v < EXACT_VERTICES_MAX; v++) {
                call(walk->clipper[f].at[0][s][v]);
                call(walk->clipper[f].at[1][s][v]);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        call(walk->point[axis]);
        call(walk->path[axis]);
        call(walk->found.at[axis]);
    }
    call(walk->found.tau);
    call(walk->found.den);
    for (int i = 0; i < EXACT_SCRATCH; i++)
        call(walk->scratch[i]);
}

/* Vertex v of a cuboid: the sum of the components whose bits are set in v; of a simplex: the
 * origin, then the end of each component. */
int frame_vertices(const struct exact_frame *frame, mpz_t vertex[EXACT_VERTICES_MAX][3])
{
    int vertices = frame->simplex ? frame->count + 1 : 1 << frame->count;
    for (int v = 0; v < vertices; v++)
        for (int axis = 0; axis < 3; axis++)
            mpz_set_ui(vertex[v][axis], 0);
    for (int v = 1; v < vertices; v++)
        for (int i = 0; i < frame->count; i++)
            if (frame->simplex ? v == i + 1 : v >> i & 1)
                for (int axis = 0; axis < 3; axis++)
                    mpz_add(vertex[v][axis], vertex[v][axis], frame->component[i][axis]);
    return vertices;
}

static bool is_edge(const struct exact_frame *frame, int v, int w)
{
    int bits = v ^ w;
    return frame->simplex || (bits & (bits - 1)) == 0;
}

static bool keep_slab(void *context, struct slab *slab)
{
    struct clipper *clipper = context;
    assert(clipper->slabs < FRAME_SLABS_MAX);
    struct slab *kept = &clipper->slab[clipper->slabs++];
    for (int axis = 0; axis < 3; axis++)
        mpz_set(kept->normal[axis], slab->normal[axis]);
    mpz_set(kept->low, slab->low);
    mpz_set(kept->high, slab->high);
    kept->pins = slab->pins;
    return true;
}

/* A vertex p of the other frame lies at w = p + offset + tau drift from the origin of frame 0,
 * and at w = p - offset - tau drift from that of frame 1. */
static void set_clipper(struct walk *walk, int f)
{
    struct exact_pair *pair = walk->pair;
    struct clipper *clipper = &walk->clipper[f];
    mpz_t *shift = walk->scratch;
    slabs_walk(&pair->frame[f], NULL, keep_slab, clipper, walk->scratch);
    for (int s = 0; s < clipper->slabs; s++) {
        mpz_t *normal = clipper->slab[s].normal;
        integer_dot(shift[0], normal, pair->offset);
        integer_dot(shift[1], normal, pair->drift);
        if (f == 1) {
            mpz_neg(shift[0], shift[0]);
            mpz_neg(shift[1], shift[1]);
        }
        mpz_add(shift[1], shift[1], shift[0]);
        for (int v = 0; v < walk->vertices[1 - f]; v++) {
            integer_dot(shift[2], normal, walk->vertex[1 - f][v]);
            for (int end = 0; end < walk->ends; end++)
                mpz_add(clipper->at[end][s][v], shift[2], shift[end]);
        }
    }
}

/* Visits point + s path, at the time that found holds as tau: its numerator, over that of s. */
static void visit_point(struct walk *walk, const struct ratio *s)
{
    struct exact_point *found = &walk->found;
    for (int axis = 0; axis < 3; axis++) {
        mpz_mul(found->at[axis], walk->point[axis], s->den);
        mpz_addmul(found->at[axis], walk->path[axis], s->num);
    }
    mpz_set(found->den, s->den);
    walk->visit(walk->context, found);
}

/* Visits point + s path of a segment between two ends of the window. */
static void visit_end(struct walk *walk, const struct ratio *s, int end_v, int end_w)
{
    if (end_v != end_w) /* 0 and 1 */
        mpz_set(walk->found.tau, s->num);
    else
        mpz_mul_si(walk->found.tau, s->den, end_v);
    visit_point(walk, s);
}

/* Clips the segment point + s path of frame f, which goes from vertex v at one end of the
 * window to vertex w at the same or the other end, to the other frame, and visits the ends of what
 * is left. */
static void visit_segment(struct walk *walk, int f, int v, int end_v, int w, int end_w)
{
    struct clipper *clipper = &walk->clipper[1 - f];
    span_reset(&walk->span);
    for (int s = 0; s < clipper->slabs; s++) {
        struct slab *slab = &clipper->slab[s];
        if (!span_apply(&walk->span, clipper->at[end_v][s][v], clipper->at[end_w][s][w], slab->low,
                        slab->high, slab->pins))
            return;
    }
    visit_end(walk, span_lower(&walk->span), end_v, end_w);
    visit_end(walk, span_upper(&walk->span), end_v, end_w);
}

/* point := vertex v of frame f in the world, at an end of the window. */
static void set_point(struct walk *walk, int f, int v, int end)
{
    const struct exact_frame *frame = &walk->pair->frame[f];
    for (int axis = 0; axis < 3; axis++) {
        mpz_add(walk->point[axis], frame->origin[axis], walk->vertex[f][v][axis]);
        if (end)
            mpz_add(walk->point[axis], walk->point[axis], frame->displacement[axis]);
    }
}

/* Kind 1. */
static void visit_edges(struct walk *walk, int f, int end)
{
    for (int v = 0; v < walk->vertices[f]; v++) {
        set_point(walk, f, v, end);
        for (int w = v + 1; w < walk->vertices[f]; w++) {
            if (!is_edge(&walk->pair->frame[f], v, w))
                continue;
            for (int axis = 0; axis < 3; axis++)
                mpz_sub(walk->path[axis], walk->vertex[f][w][axis], walk->vertex[f][v][axis]);
            visit_segment(walk, f, v, end, w, end);
        }
    }
}

/* Kind 2. */
static void visit_paths(struct walk *walk, int f)
{
    for (int axis = 0; axis < 3; axis++)
        mpz_set(walk->path[axis], walk->pair->frame[f].displacement[axis]);
    for (int v = 0; v < walk->vertices[f]; v++) {
        set_point(walk, f, v, 0);
        visit_segment(walk, f, v, 0, v, 1);
    }
}

/* The crossing of an edge p + s e of A with an edge q + u f + offset + tau drift of B, with
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
    mpz_t ef[3], fd[3], ed[3]; /* e x f, f x drift, e x drift; signs turned so that det > 0 */
    mpz_t det;
    mpz_t r[3];
    mpz_t s, u;
    struct ratio tau;
};

static void crossing_each(struct crossing *crossing, void (*call)(mpz_ptr))
{
    for (int axis = 0; axis < 3; axis++) {
        call(crossing->ef[axis]);
        call(crossing->fd[axis]);
        call(crossing->ed[axis]);
        call(crossing->r[axis]);
    }
    call(crossing->det);
    call(crossing->s);
    call(crossing->u);
    call(crossing->tau.num);
    call(crossing->tau.den);
}

static bool in_unit(const mpz_t num, const mpz_t den)
{
    return mpz_sgn(num) >= 0 && mpz_cmp(num, den) <= 0;
}

/* Sets what depends on the directions alone; false if they never cross in one point. */
static bool crossing_set(struct crossing *crossing, mpz_t e[3], mpz_t f[3], mpz_t drift[3],
                         mpz_t scratch)
{
    integer_cross(crossing->ef, e, f, scratch);
    integer_dot(crossing->det, crossing->ef, drift);
    int sign = mpz_sgn(crossing->det);
    if (sign == 0)
        return false;
    integer_cross(crossing->fd, f, drift, scratch);
    integer_cross(crossing->ed, e, drift, scratch);
    mpz_abs(crossing->det, crossing->det);
    for (int axis = 0; axis < 3; axis++) {
        if (sign > 0) {
            mpz_neg(crossing->ef[axis], crossing->ef[axis]);
        } else {
            mpz_neg(crossing->fd[axis], crossing->fd[axis]);
            mpz_neg(crossing->ed[axis], crossing->ed[axis]);
        }
    }
    return true;
}

/* p and q: the vertices in which the edges start. True if they cross, at crossing->tau. */
static bool crossing_at(struct crossing *crossing, mpz_t p[3], mpz_t q[3], mpz_t offset[3])
{
    for (int axis = 0; axis < 3; axis++) {
        mpz_add(crossing->r[axis], q[axis], offset[axis]);
        mpz_sub(crossing->r[axis], crossing->r[axis], p[axis]);
    }
    integer_dot(crossing->tau.num, crossing->r, crossing->ef);
    if (!in_unit(crossing->tau.num, crossing->det))
        return false;
    integer_dot(crossing->s, crossing->r, crossing->fd);
    if (!in_unit(crossing->s, crossing->det))
        return false;
    integer_dot(crossing->u, crossing->r, crossing->ed);
    return in_unit(crossing->u, crossing->det);
}

/* Visits p + s e + tau displacement of A. All have the denominator det: with the
 * path s e + tau displacement, taken times det, the parameter is 1 / det. */
static void visit_crossing(struct walk *walk, struct crossing *crossing, int v, mpz_t e[3])
{
    const struct exact_frame *a = &walk->pair->frame[0];
    set_point(walk, 0, v, 0);
    for (int axis = 0; axis < 3; axis++) {
        mpz_mul(walk->path[axis], crossing->s, e[axis]);
        mpz_addmul(walk->path[axis], crossing->tau.num, a->displacement[axis]);
    }
    mpz_set(walk->found.tau, crossing->tau.num);
    mpz_set_ui(crossing->tau.num, 1);
    mpz_set(crossing->tau.den, crossing->det);
    visit_point(walk, &crossing->tau);
}

/* Whether an edge in direction number e starts in vertex v: of a cuboid where the bit of the
 * component is not set; of a simplex in the vertex from which the direction was taken. */
static bool starts_in(const struct exact_frame *frame, int e, int v)
{
    if (!frame->simplex)
        return (v >> e & 1) == 0;
    static const int start_of_two[3] = {0, 0, 1};
    static const int start_of_three[EXACT_EDGES_MAX] = {0, 0, 0, 1, 1, 2};
    return v == (frame->count == 2 ? start_of_two[e] : start_of_three[e]);
}

/* Kind 3, for one direction of A and one of B. */
static void visit_parallel_crossings(struct walk *walk, struct crossing *crossing, int e, int f)
{
    struct exact_pair *pair = walk->pair;
    for (int v = 0; v < walk->vertices[0]; v++) {
        if (!starts_in(&pair->frame[0], e, v))
            continue;
        for (int w = 0; w < walk->vertices[1]; w++)
            if (starts_in(&pair->frame[1], f, w) &&
                crossing_at(crossing, walk->vertex[0][v], walk->vertex[1][w], pair->offset))
                visit_crossing(walk, crossing, v, pair->frame[0].edge[e]);
    }
}

static void visit_crossings(struct walk *walk)
{
    struct exact_pair *pair = walk->pair;
    struct crossing crossing;
    crossing_each(&crossing, mpz_init);
    for (int e = 0; e < pair->frame[0].edges; e++)
        for (int f = 0; f < pair->frame[1].edges; f++)
            if (crossing_set(&crossing, pair->frame[0].edge[e], pair->frame[1].edge[f], pair->drift,
                             walk->scratch[0]))
                visit_parallel_crossings(walk, &crossing, e, f);
    crossing_each(&crossing, mpz_clear);
}

static void visit_all(struct walk *walk)
{
    for (int f = 0; f < 2; f++)
        walk->vertices[f] = frame_vertices(&walk->pair->frame[f], walk->vertex[f]);
    for (int f = 0; f < 2; f++)
        set_clipper(walk, f);
    for (int f = 0; f < 2; f++) {
        for (int end = 0; end < walk->ends; end++)
            visit_edges(walk, f, end);
        if (walk->pair->moving)
            visit_paths(walk, f);
    }
    if (walk->pair->moving)
        visit_crossings(walk);
}

void points_walk(struct exact_pair *pair, point_visit visit, void *context)
{
    struct walk walk = {
        .pair = pair, .visit = visit, .context = context, .ends = pair->moving ? 2 : 1};
    walk_each(&walk, mpz_init);
    span_init(&walk.span);
    visit_all(&walk);
    span_clear(&walk.span);
    walk_each(&walk, mpz_clear);
}

struct boxing {
    struct ratio bound[2][3]; /* [0] lower and [1] upper ends so far */
    bool bounded;
    struct ratio coordinate;
    mpz_t scratch[2];
};

static void boxing_each(struct boxing *boxing, void (*call)(mpz_ptr))
{
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            call(boxing->bound[side][axis].num);
            call(boxing->bound[side][axis].den);
        }
    call(boxing->coordinate.num);
    call(boxing->coordinate.den);
    call(boxing->scratch[0]);
    call(boxing->scratch[1]);
}

/* Widens the box by boxing->coordinate along an axis. */
static void include_coordinate(struct boxing *boxing, int axis)
{
    for (int side = 0; side < 2; side++) {
        struct ratio *bound = &boxing->bound[side][axis];
        int sign = boxing->bounded ? ratio_compare(&boxing->coordinate, bound, boxing->scratch) : 0;
        if (!boxing->bounded || (side == 0 ? sign < 0 : sign > 0))
            ratio_copy(bound, &boxing->coordinate);
    }
}

static void include_point(void *context, const struct exact_point *point)
{
    struct boxing *boxing = context;
    mpz_set(boxing->coordinate.den, point->den);
    for (int axis = 0; axis < 3; axis++) {
        mpz_set(boxing->coordinate.num, point->at[axis]);
        include_coordinate(boxing, axis);
    }
    boxing->bounded = true;
}

void exact_box(struct exact_pair *pair, double box[2][FMB_DIM_MAX])
{
    struct boxing boxing = {.bounded = false};
    boxing_each(&boxing, mpz_init);
    points_walk(pair, include_point, &boxing);
    assert(boxing.bounded);
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            const struct ratio *bound = &boxing.bound[side][axis];
            box[side][axis] = integer_ratio_round(bound->num, bound->den, pair->unit,
                                                  side ? ROUND_UP : ROUND_DOWN, boxing.scratch);
        }
    boxing_each(&boxing, mpz_clear);
}
