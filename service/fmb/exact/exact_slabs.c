/* The slabs of the Minkowski difference of two frames.
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
 * gives both bounds at once: n . D = [min n.A - max n.B, max n.A - min n.B].
 *
 * If D is flat, it has a rank r < 3. It pins the offset to its affine hull, and within that
 *
 *   r = 2: its facets are its edges, each along an edge of A or B. The projection along an axis
 * that is not parallel to the plane of D is one to one, and there the normal of the edge (e0, e1)
 * is (-e1, e0); r = 1: it is a segment, with its ends along any axis in which it has length; r = 0:
 * it is a point.
 *
 * A normal of these kinds is not constant on D. So a point is in the relative interior of D if and
 * only if it lies strictly between the bounds of all slabs that do not pin. */
#include "exact.h"
#include "integer.h"

struct slab_enumeration {
    struct exact_pair *pair;
    enum slabs_of of;
    struct slab slab;
    slab_visit visit;
    void *context;
};

void slab_set_normal(struct slab *slab, mpz_t scratch)
{
    if (slab->u)
        integer_cross(slab->normal, slab->u->vector, slab->v->vector, scratch);
    slab->u = NULL;
}

/* Widens [low, high], which bounds normal . x over a part of the frame, by one component. */
static void add_component(const struct exact_frame *frame, mpz_t low, mpz_t high, const mpz_t at)
{
    if (!frame->simplex) {
        mpz_ptr end = mpz_sgn(at) < 0 ? low : high;
        mpz_add(end, end, at);
    } else if (mpz_cmp(at, low) < 0) {
        mpz_set(low, at);
    } else if (mpz_cmp(at, high) > 0) {
        mpz_set(high, at);
    }
}

void exact_extent(const struct exact_pair *pair, int f, mpz_t value[EXACT_VECTORS], mpz_t low,
                  mpz_t high)
{
    const struct exact_frame *frame = &pair->frame[f];
    mpz_set_ui(low, 0);
    mpz_set_ui(high, 0);
    for (int i = 0; i < frame->count; i++)
        add_component(frame, low, high, value[f * EXACT_OF_B + i]);
}

void exact_range_each(struct exact_range *range, void (*call)(mpz_ptr))
{
    call(range->low);
    call(range->high);
}

void exact_ranges(const struct exact_pair *pair, mpz_t value[EXACT_VECTORS],
                  struct exact_range frame[2], struct exact_range *all)
{
    mpz_ptr late = mpz_sgn(value[EXACT_DRIFT]) < 0 ? all->low : all->high;
    for (int f = 0; f < 2; f++)
        exact_extent(pair, f, value, frame[f].low, frame[f].high);
    mpz_sub(all->low, frame[1].low, frame[0].high);
    mpz_add(all->low, all->low, value[EXACT_OFFSET]);
    mpz_sub(all->high, frame[1].high, frame[0].low);
    mpz_add(all->high, all->high, value[EXACT_OFFSET]);
    mpz_add(late, late, value[EXACT_DRIFT]);
}

/* Visits the slab whose values enumeration->slab holds. */
static bool visit_slab(struct slab_enumeration *enumeration, bool pins)
{
    struct slab *slab = &enumeration->slab;
    mpz_t *scratch = enumeration->pair->scratch;
    exact_extent(enumeration->pair, enumeration->of == SLABS_OF_B, slab->value, slab->low,
                 slab->high);
    if (enumeration->of >= SLABS_OF_DIFFERENCE) {
        exact_extent(enumeration->pair, 1, slab->value, scratch[1], scratch[2]);
        mpz_sub(slab->low, slab->low, scratch[2]);
        mpz_sub(slab->high, slab->high, scratch[1]);
    }
    slab->pins = pins;
    return enumeration->visit(enumeration->context, slab);
}

/* Visits the slab of the normal that enumeration->slab holds. */
static bool visit_normal(struct slab_enumeration *enumeration, bool pins)
{
    struct slab *slab = &enumeration->slab;
    slab->u = NULL;
    for (int k = 0; k < EXACT_VECTORS; k++)
        exact_dot(enumeration->pair, slab->value[k], slab->normal, k);
    return visit_slab(enumeration, pins);
}

/* Visits the slab of the plane of two directions, if it is not constant on all of a solid. */
static bool visit_plane(struct slab_enumeration *enumeration, const struct exact_edge *u,
                        const struct exact_edge *v)
{
    struct slab *slab = &enumeration->slab;
    bool varies = false;
    exact_cross_values(enumeration->pair, u, v, slab->value);
    for (int k = 0; k < EXACT_OFFSET; k++)
        varies = varies || mpz_sgn(slab->value[k]) != 0;
    slab->u = u;
    slab->v = v;
    return !varies || visit_slab(enumeration, false);
}

/* Edges of a simplex of three components: c0, c1, c2, c1 - c0, c2 - c0, c2 - c1. */
static bool visit_faces(struct slab_enumeration *enumeration, const struct exact_frame *frame)
{
    const struct exact_edge *edge = frame->edge;
    if (!visit_plane(enumeration, &edge[0], &edge[1]))
        return false;
    if (frame->count == 2)
        return true;
    return visit_plane(enumeration, &edge[1], &edge[2]) &&
           visit_plane(enumeration, &edge[2], &edge[0]) &&
           (!frame->simplex || visit_plane(enumeration, &edge[3], &edge[4]));
}

static int first_frame(enum slabs_of of)
{
    return of == SLABS_OF_B;
}

static int last_frame(enum slabs_of of)
{
    return of != SLABS_OF_A;
}

static bool visit_solid(struct slab_enumeration *enumeration)
{
    const struct exact_frame *a = &enumeration->pair->frame[0], *b = &enumeration->pair->frame[1];
    for (int f = first_frame(enumeration->of); f <= last_frame(enumeration->of); f++)
        if (!visit_faces(enumeration, &enumeration->pair->frame[f]))
            return false;
    for (int i = 0; enumeration->of == SLABS_OF_DIFFERENCE && i < a->edges; i++)
        for (int j = 0; j < b->edges; j++)
            if (!visit_plane(enumeration, &a->edge[i], &b->edge[j]))
                return false;
    return true;
}

/* The planes of each edge with the drift. */
static bool visit_swept(struct slab_enumeration *enumeration)
{
    const struct exact_edge drift = {EXACT_DRIFT, -1, enumeration->pair->drift};
    for (int f = 0; f < 2; f++)
        for (int e = 0; e < enumeration->pair->frame[f].edges; e++)
            if (!visit_plane(enumeration, &enumeration->pair->frame[f].edge[e], &drift))
                return false;
    return true;
}

/* ---- Flat ---- */

static int edge_count(const struct exact_pair *pair, enum slabs_of of)
{
    int count = 0;
    for (int f = first_frame(of); f <= last_frame(of); f++)
        count += pair->frame[f].edges;
    return count;
}

static mpz_t *edge_at(const struct exact_pair *pair, enum slabs_of of, int i)
{
    const struct exact_frame *frame = &pair->frame[first_frame(of)];
    return i < frame->edges ? frame->edge[i].vector : frame[1].edge[i - frame->edges].vector;
}

static int nonzero_axis(mpz_t v[3])
{
    return mpz_sgn(v[2]) ? 2 : mpz_sgn(v[1]) ? 1 : 0;
}

/* normal is that of the plane. */
static bool visit_flat(struct slab_enumeration *enumeration, mpz_t normal[3])
{
    int k = nonzero_axis(normal), i = (k + 1) % 3, j = (k + 2) % 3;
    for (int axis = 0; axis < 3; axis++)
        mpz_set(enumeration->slab.normal[axis], normal[axis]);
    if (!visit_normal(enumeration, true))
        return false;
    for (int e = 0; e < edge_count(enumeration->pair, enumeration->of); e++) {
        mpz_t *edge = edge_at(enumeration->pair, enumeration->of, e);
        mpz_neg(enumeration->slab.normal[i], edge[j]);
        mpz_set(enumeration->slab.normal[j], edge[i]);
        mpz_set_ui(enumeration->slab.normal[k], 0);
        if (!integer_is_zero(enumeration->slab.normal) && !visit_normal(enumeration, false))
            return false;
    }
    return true;
}

/* A segment along direction: w_j d_k - w_k d_j = 0 pins it in both other axes j. */
static bool visit_segment(struct slab_enumeration *enumeration, mpz_t direction[3])
{
    int k = nonzero_axis(direction);
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(enumeration->slab.normal[axis], axis == k);
    if (!visit_normal(enumeration, false))
        return false;
    for (int step = 1; step < 3; step++) {
        int j = (k + step) % 3, other = (k + 3 - step) % 3;
        mpz_set(enumeration->slab.normal[j], direction[k]);
        mpz_neg(enumeration->slab.normal[k], direction[j]);
        mpz_set_ui(enumeration->slab.normal[other], 0);
        if (!visit_normal(enumeration, true))
            return false;
    }
    return true;
}

static bool visit_point(struct slab_enumeration *enumeration)
{
    for (int k = 0; k < 3; k++) {
        for (int axis = 0; axis < 3; axis++)
            mpz_set_ui(enumeration->slab.normal[axis], axis == k);
        if (!visit_normal(enumeration, true))
            return false;
    }
    return true;
}

/* ---- Rank ---- */

/* Whether three of the components are independent. The triples of the components of both frames are
 * the first 20, those of frame 0 the first of these. */
static bool is_solid(const struct exact_pair *pair, enum slabs_of of)
{
    enum { OF_A = 0, OF_B = 19, OF_BOTH = 20 };
    if (of != SLABS_OF_DIFFERENCE)
        return mpz_sgn(pair->triple[of == SLABS_OF_A ? OF_A : OF_B]) != 0;
    for (int t = 0; t < OF_BOTH; t++)
        if (mpz_sgn(pair->triple[t]))
            return true;
    return false;
}

/* The rank where it is below 3; where it is 1, *direction is one of the edges; where it is 2,
 * normal is that of their plane. */
static int flat_rank(struct exact_pair *pair, enum slabs_of of, mpz_t **direction, mpz_t normal[3])
{
    int rank = 0;
    for (int i = 0; i < edge_count(pair, of) && rank < 2; i++) {
        mpz_t *edge = edge_at(pair, of, i);
        if (rank == 0 && !integer_is_zero(edge)) {
            *direction = edge;
            rank = 1;
        } else if (rank == 1) {
            integer_cross(normal, *direction, edge, pair->scratch[0]);
            rank = integer_is_zero(normal) ? 1 : 2;
        }
    }
    return rank;
}

bool slabs_solid(const struct exact_pair *pair)
{
    return is_solid(pair, SLABS_OF_DIFFERENCE);
}

static bool walk_flat(struct slab_enumeration *enumeration)
{
    mpz_t normal[3], *direction = NULL;
    bool whole = false;
    mpz_inits(normal[0], normal[1], normal[2], NULL);
    switch (flat_rank(enumeration->pair, enumeration->of, &direction, normal)) {
    case 2: whole = visit_flat(enumeration, normal); break;
    case 1: whole = visit_segment(enumeration, direction); break;
    case 0: whole = visit_point(enumeration); break;
    }
    mpz_clears(normal[0], normal[1], normal[2], NULL);
    return whole;
}

void slab_each(struct slab *slab, void (*call)(mpz_ptr))
{
    for (int k = 0; k < EXACT_VECTORS; k++)
        call(slab->value[k]);
    for (int axis = 0; axis < 3; axis++)
        call(slab->normal[axis]);
    call(slab->low);
    call(slab->high);
}

bool slabs_walk(struct exact_pair *pair, enum slabs_of of, slab_visit visit, void *context)
{
    struct slab_enumeration enumeration = {
        .pair = pair, .of = of, .visit = visit, .context = context};
    slab_each(&enumeration.slab, mpz_init);
    const bool whole = of == SLABS_OF_SWEPT ? visit_swept(&enumeration)
                       : is_solid(pair, of) ? visit_solid(&enumeration)
                                            : walk_flat(&enumeration);
    slab_each(&enumeration.slab, mpz_clear);
    return whole;
}
