/* The slabs of the Minkowski difference of two frames.
 *
 * This is the article's elimination done on paper. Fourier-Motzkin eliminates all parameters
 * x from the rows of the pair; what is left are inequalities in the offset of the frames
 * alone, and those that are not redundant are the facets of the Minkowski difference
 * D = A - B.
 *
 * D is the image of the parameters of both frames, a product of cubes and simplices, under a
 * linear map. A linear map takes relative interiors to relative interiors (Rockafellar,
 * Convex Analysis, theorem 6.6): the frames overlap just if the offset lies in the relative
 * interior of D, flat or not.
 *
 * A facet of D is the sum of a face of A and a face of -B that span a plane between them. A
 * face of a frame, flat or not, is the image of a face of its cube or simplex, and so is
 * spanned by images of that face's edges, which are directions of edges of the frame; where it
 * spans a plane, that plane is spanned by two components (cuboid) or by a triangle (simplex).
 * The plane of the facet contains two independent directions
 * of edges: two of one face of A, two of one face of B, or one of A and one of B. So, where D
 * is solid, its facets are among the planes
 *
 *     of the faces of A, of the faces of B, of each edge of A with each edge of B:
 *     3 + 3 + 9 (cuboids), 3 + 4 + 18 (mixed), 4 + 4 + 36 (tetrahedra)
 *
 * (a dependent pair of edges spans no plane and is left out; a plane that is no facet gives a
 * slab that is true all the same, since its bounds are those of D along its normal). Every
 * normal n gives both bounds at once: n . D = [min n.A - max n.B, max n.A - min n.B].
 *
 * Where D is flat it has a rank r < 3: it pins the offset to its affine hull, and within that
 *   r = 2: its facets are its edges, each along an edge of A or B. The projection along an axis
 * that is not parallel to the plane of D is one to one, and there the normal of the edge (e0, e1)
 * is (-e1, e0); r = 1: it is a segment, with its ends along any axis in which it has length; r = 0:
 * it is a point. A normal of these kinds is not constant on D, and so a point is in the relative
 * interior of D just if it lies strictly between the bounds of all slabs that do not pin. */
#include "exact.h"
#include "integer.h"

struct walk {
    const struct exact_frame *frame[2]; /* frame[1] may be NULL: the point 0 */
    struct slab slab;
    slab_visit visit;
    void *context;
    mpz_t *scratch; /* EXACT_SCRATCH */
};

static bool is_zero(mpz_t v[3])
{
    return mpz_sgn(v[0]) == 0 && mpz_sgn(v[1]) == 0 && mpz_sgn(v[2]) == 0;
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

/* [low, high] := the values of normal . x over the frame with its origin at 0. */
static void extent(const struct exact_frame *frame, mpz_t normal[3], mpz_t low, mpz_t high,
                   mpz_t scratch)
{
    mpz_set_ui(low, 0);
    mpz_set_ui(high, 0);
    for (int i = 0; i < frame->count; i++) {
        /* C17 knows no way from mpz_t * to const mpz_t *; nothing is written. */
        integer_dot(scratch, normal, (mpz_t *) frame->component[i]);
        add_component(frame, low, high, scratch);
    }
}

/* Visits the slab of the normal that walk->slab holds. */
static bool visit_slab(struct walk *walk, bool pins)
{
    struct slab *slab = &walk->slab;
    mpz_t *scratch = walk->scratch;
    extent(walk->frame[0], slab->normal, slab->low, slab->high, scratch[0]);
    if (walk->frame[1]) {
        extent(walk->frame[1], slab->normal, scratch[1], scratch[2], scratch[0]);
        mpz_sub(slab->low, slab->low, scratch[2]);
        mpz_sub(slab->high, slab->high, scratch[1]);
    }
    slab->pins = pins;
    return walk->visit(walk->context, slab);
}

/* Visits the slab of the plane of two directions, if they span one. */
static bool visit_plane(struct walk *walk, mpz_t u[3], mpz_t v[3])
{
    integer_cross(walk->slab.normal, u, v, walk->scratch[0]);
    return is_zero(walk->slab.normal) || visit_slab(walk, false);
}

/* Edges of a simplex of three components: c0, c1, c2, c1 - c0, c2 - c0, c2 - c1. */
static bool visit_faces(struct walk *walk, const struct exact_frame *frame)
{
    if (!visit_plane(walk, frame->edge[0], frame->edge[1]))
        return false;
    if (frame->count == 2)
        return true;
    return visit_plane(walk, frame->edge[1], frame->edge[2]) &&
           visit_plane(walk, frame->edge[2], frame->edge[0]) &&
           (!frame->simplex || visit_plane(walk, frame->edge[3], frame->edge[4]));
}

static bool visit_solid(struct walk *walk)
{
    const struct exact_frame *a = walk->frame[0], *b = walk->frame[1];
    if (!visit_faces(walk, a) || (b && !visit_faces(walk, b)))
        return false;
    for (int i = 0; b && i < a->edges; i++)
        for (int j = 0; j < b->edges; j++)
            if (!visit_plane(walk, a->edge[i], b->edge[j]))
                return false;
    return true;
}

static int edge_count(const struct walk *walk)
{
    return walk->frame[0]->edges + (walk->frame[1] ? walk->frame[1]->edges : 0);
}

static mpz_t *edge_at(const struct walk *walk, int i)
{
    int first = walk->frame[0]->edges;
    return i < first ? walk->frame[0]->edge[i] : walk->frame[1]->edge[i - first];
}

static int nonzero_axis(mpz_t v[3])
{
    return mpz_sgn(v[2]) ? 2 : mpz_sgn(v[1]) ? 1 : 0;
}

/* normal is that of the plane. */
static bool visit_flat(struct walk *walk, mpz_t normal[3])
{
    int k = nonzero_axis(normal), i = (k + 1) % 3, j = (k + 2) % 3;
    for (int axis = 0; axis < 3; axis++)
        mpz_set(walk->slab.normal[axis], normal[axis]);
    if (!visit_slab(walk, true))
        return false;
    for (int e = 0; e < edge_count(walk); e++) {
        mpz_t *edge = edge_at(walk, e);
        mpz_neg(walk->slab.normal[i], edge[j]);
        mpz_set(walk->slab.normal[j], edge[i]);
        mpz_set_ui(walk->slab.normal[k], 0);
        if (!is_zero(walk->slab.normal) && !visit_slab(walk, false))
            return false;
    }
    return true;
}

/* A segment along direction: w_j d_k - w_k d_j = 0 pins it in both other axes j. */
static bool visit_segment(struct walk *walk, mpz_t direction[3])
{
    int k = nonzero_axis(direction);
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(walk->slab.normal[axis], axis == k);
    if (!visit_slab(walk, false))
        return false;
    for (int step = 1; step < 3; step++) {
        int j = (k + step) % 3, other = (k + 3 - step) % 3;
        mpz_set(walk->slab.normal[j], direction[k]);
        mpz_neg(walk->slab.normal[k], direction[j]);
        mpz_set_ui(walk->slab.normal[other], 0);
        if (!visit_slab(walk, true))
            return false;
    }
    return true;
}

static bool visit_point(struct walk *walk)
{
    for (int k = 0; k < 3; k++) {
        for (int axis = 0; axis < 3; axis++)
            mpz_set_ui(walk->slab.normal[axis], axis == k);
        if (!visit_slab(walk, true))
            return false;
    }
    return true;
}

/* The rank of all edges together; where it is 1, *direction is one of them; where it is 2,
 * normal is that of their plane. */
static int rank_of(const struct walk *walk, mpz_t **direction, mpz_t normal[3])
{
    int rank = 0;
    for (int i = 0; i < edge_count(walk) && rank < 3; i++) {
        mpz_t *edge = edge_at(walk, i);
        if (rank == 0 && !is_zero(edge)) {
            *direction = edge;
            rank = 1;
        } else if (rank == 1) {
            integer_cross(normal, *direction, edge, walk->scratch[0]);
            rank = is_zero(normal) ? 1 : 2;
        } else if (rank == 2) {
            integer_dot(walk->scratch[0], normal, edge);
            rank = mpz_sgn(walk->scratch[0]) ? 3 : 2;
        }
    }
    return rank;
}

bool slabs_walk(const struct exact_frame *a, const struct exact_frame *b, slab_visit visit,
                void *context, mpz_t scratch[EXACT_SCRATCH])
{
    struct walk walk = {.frame = {a, b}, .visit = visit, .context = context, .scratch = scratch};
    mpz_t normal[3], *direction = NULL;
    mpz_inits(normal[0], normal[1], normal[2], walk.slab.low, walk.slab.high, NULL);
    mpz_inits(walk.slab.normal[0], walk.slab.normal[1], walk.slab.normal[2], NULL);

    bool whole = false;
    switch (rank_of(&walk, &direction, normal)) {
    case 3: whole = visit_solid(&walk); break;
    case 2: whole = visit_flat(&walk, normal); break;
    case 1: whole = visit_segment(&walk, direction); break;
    case 0: whole = visit_point(&walk); break;
    }

    mpz_clears(normal[0], normal[1], normal[2], walk.slab.low, walk.slab.high, NULL);
    mpz_clears(walk.slab.normal[0], walk.slab.normal[1], walk.slab.normal[2], NULL);
    return whole;
}
