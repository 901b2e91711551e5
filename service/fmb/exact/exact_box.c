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
 * an inner point of a segment in Q. */
#include "exact.h"
#include "integer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct point_search {
    struct exact_pair *pair;
    point_visit visit;
    void *context;
    mpz_t weight[3];
    struct exact_point found;
};

/* Vertex v of a cuboid is the sum of the components whose bits are set in v; of a simplex, the
 * origin, then the end of each component. */
static bool has_component(const struct exact_frame *frame, int v, int i)
{
    return frame->simplex ? v == i + 1 : v >> i & 1;
}

/* Visits vertex v of frame f plus s / den of the way to vertex w, at the time tau / den. In units,
 * it is origin + sum weight_i component_i / den + tau displacement / den: products with the numbers
 * of the pair alone, which are short (exact.c). */
static void visit_point(void *context, int f, int v, int w, const mpz_t s, const mpz_t tau,
                        const mpz_t den)
{
    struct point_search *search = context;
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
        integer_add_product(*at, 1, tau, frame->displacement[axis], search->pair->scratch);
        for (int i = 0; i < frame->count; i++)
            integer_add_product(*at, 1, search->weight[i], frame->component[i][axis],
                                search->pair->scratch);
    }
    mpz_mul(found->at[0], tau, search->pair->scale);
    mpz_mul(found->den, den, search->pair->scale);
    search->visit(search->context, found);
}

void points_walk(struct exact_pair *pair, point_visit visit, void *context)
{
    struct point_search search = {.pair = pair, .visit = visit, .context = context};
    const struct limbs_visitor visitor = {visit_point, &search};
    INTEGER_EACH_FROM(weight, &search, mpz_init);
    limbs_functions_of(&pair->question)->points(&pair->question, &visitor);
    INTEGER_EACH_FROM(weight, &search, mpz_clear);
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

void exact_box(const struct frame_pair *pair, double box[2][FMB_DIM_MAX])
{
    struct exact_pair exact;
    exact_pair_init(&exact, pair);
    struct boxing boxing = {.unit = exact.unit};
    for (int axis = 0; axis < 3; axis++) {
        boxing.box[0][axis] = INFINITY;
        boxing.box[1][axis] = -INFINITY;
    }
    mpz_inits(boxing.scratch[0], boxing.scratch[1], NULL);
    points_walk(&exact, include_point, &boxing);
    mpz_clears(boxing.scratch[0], boxing.scratch[1], NULL);
    exact_pair_clear(&exact);
    assert(boxing.box[0][0] <= boxing.box[1][0]);
    memcpy(box, boxing.box, sizeof boxing.box);
}
