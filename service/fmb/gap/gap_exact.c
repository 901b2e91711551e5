/* Gaps in integers: for pairs whose enclosure in doubles is too wide, and for those that doubles
 * cannot represent. P and f: gap.h.
 *
 * Method. All lengths of the pair are rounded to multiples of one unit, such that the largest has
 * LENGTH_BITS bits, or one more. Everything after that is exact for the rounded pair, whose gap is
 * within UNITS_ERROR of the true one: so the numbers stay short whatever the exponents of the pair
 * are.
 *
 * Separated: the point of P next to the origin (gap_exact_simplex.h).
 *
 * In contact: the slabs of all pairs of edges, the drift being one. Each facet of P, where P has a
 * volume, is spanned by two of its edges; where P is flat, its plane is, and f is 0 there. Where
 * all edges are parallel, f is 0 for any direction across.
 *
 * Accuracy. A coordinate of an origin, a component or a displacement v T is off by less than one
 * unit; one of a point of P by less than 2 + 6 + 2 = 10, and the point by less than 10 sqrt(3)
 * < 18. A point of a frame is off by less than 5 units on an axis, and by less than 5 sqrt(3) < 9
 * in all. Integers of at most 620 bits are taken as doubles, cut off: a relative error below 2^-52;
 * quotients and roots of them are within 2^-49.
 *
 * Near the least doubles, L = 2^-1074, all of this is less than L. What is left are roundings: a
 * bound by below() or above() is off by L and by half of it in ldexp(). The upper bound of a
 * separated pair has 2 (2 L) for each of 6 coordinates of its witness points in addition, and 1.5 L
 * for the time: in all at most 1.5 + 1.5 + 24 + 1.5, less than 29 L. fmb.h states 32 L.
 */
#include "gap.h"

#include "exact.h"
#include "gap_exact_simplex.h"
#include "integer.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LENGTH_BITS = 100, DIRECTION_BITS = 160, UNITS_ERROR = 20, SCRATCH = 4 };

struct solver {
    struct exact_pair pair; /* rounded */
    int dim;
    struct exact_simplex simplex;
    mpz_t normal[3];
    mpz_t best[3];                    /* the normal with the greatest f */
    mpz_t value[EXACT_VECTORS];       /* a normal . each vector of the pair */
    struct exact_range range[2], all; /* of it over the frames, and over P */
    mpz_t t[SCRATCH];
};

/* ---- Rounding ---- */

/* All that follows from origins, components and displacements is set again. */
static void round_pair(struct exact_pair *pair, mpz_t largest)
{
    mpz_set_ui(largest, 0);
    for (int k = 0; k < EXACT_LENGTHS; k++)
        if (mpz_cmpabs(exact_length(pair, k), largest) > 0)
            mpz_abs(largest, exact_length(pair, k));
    const long shift =
        LENGTH_BITS - (long) mpz_sizeinbase(largest, 2) + (long) mpz_sizeinbase(pair->scale, 2);
    for (int k = 0; k < EXACT_LENGTHS; k++) {
        mpz_ptr x = exact_length(pair, k);
        if (shift >= 0)
            mpz_mul_2exp(x, x, (mp_bitcnt_t) shift);
        else
            mpz_tdiv_q_2exp(x, x, (mp_bitcnt_t) -shift);
        mpz_tdiv_q(x, x, pair->scale);
    }
    pair->unit -= shift;
    if (mpz_sgn(largest) == 0)
        pair->unit =
            -1200; /* all lengths are 0: so small a unit makes errors less than any double */
    mpz_set_ui(pair->scale, 1);
    exact_pair_complete(pair);
}

/* ---- P along a direction ---- */

/* Sets the corner of P where n . p is least. */
static void set_support(void *context, mpz_t n[3], struct exact_corner *out)
{
    struct solver *solver = context;
    struct exact_pair *pair = &solver->pair;
    mpz_t *at = &solver->t[0], *most = &solver->t[1], *scratch = &solver->t[2];
    for (int f = 0; f < 2; f++) {
        struct exact_frame *frame = &pair->frame[f];
        out->bits[f] = 0;
        mpz_set_ui(*most, 0);
        for (int i = 0; i < frame->count; i++) {
            integer_dot(*at, n, frame->component[i], *scratch);
            if (f == 0)
                mpz_neg(*at, *at);
            if (mpz_cmp(*at, *most) >= 0)
                continue;
            if (frame->simplex)
                mpz_set(*most, *at);
            out->bits[f] = (frame->simplex ? 0 : out->bits[f]) | 1U << i;
        }
    }
    integer_dot(*at, n, pair->drift, *scratch);
    out->late = mpz_sgn(*at) < 0;
    for (int axis = 0; axis < 3; axis++) {
        mpz_set(out->at[axis], pair->offset[axis]);
        if (out->late)
            mpz_add(out->at[axis], out->at[axis], pair->drift[axis]);
        for (int i = 0; i < 3; i++) {
            if (out->bits[0] >> i & 1)
                mpz_sub(out->at[axis], out->at[axis], pair->frame[0].component[i][axis]);
            if (out->bits[1] >> i & 1)
                mpz_add(out->at[axis], out->at[axis], pair->frame[1].component[i][axis]);
        }
    }
}

/* solver->all := the interval of n . p over P. */
static void set_extent(struct solver *solver, mpz_t n[3])
{
    struct exact_pair *pair = &solver->pair;
    exact_set_values(pair, n, solver->value);
    exact_ranges(pair, solver->value, solver->range, &solver->all);
}

/* ---- Slabs ---- */

/* x / |n| */
static double over_length(struct solver *solver, const mpz_t x, mpz_t n[3])
{
    integer_dot(solver->t[1], n, n, solver->t[0]);
    return mpz_get_d(x) / sqrt(mpz_get_d(solver->t[1]));
}

/* Keeps the slab of a normal where it is the best so far. */
static void add_normal(struct solver *solver, mpz_t n[3], double *greatest)
{
    if (integer_is_zero(n))
        return;
    set_extent(solver, n);
    mpz_neg(solver->all.high, solver->all.high);
    const bool above = mpz_cmp(solver->all.low, solver->all.high) >= 0;
    const double f = over_length(solver, above ? solver->all.low : solver->all.high, n);
    if (f <= *greatest)
        return;
    *greatest = f;
    for (int axis = 0; axis < 3; axis++)
        if (above)
            mpz_set(solver->best[axis], n[axis]);
        else
            mpz_neg(solver->best[axis], n[axis]);
}

static int list_edges(struct exact_pair *pair, mpz_t *edge[2 * EXACT_EDGES_MAX + 1])
{
    int count = 0;
    for (int f = 0; f < 2; f++)
        for (int e = 0; e < pair->frame[f].edges; e++)
            edge[count++] = pair->frame[f].edge[e];
    edge[count++] = pair->drift;
    return count;
}

/* Across one edge, or any direction: all edges are parallel, f is 0 or less by rounding alone. */
static void add_across(struct solver *solver, mpz_t *edge[], int count, double *greatest)
{
    mpz_t *n = solver->normal;
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(n[axis], axis == 0);
    for (int e = 0; e < count; e++) {
        if (integer_is_zero(edge[e]))
            continue;
        const int i = mpz_sgn(edge[e][0]) != 0 ? 0 : 1, j = i + 1;
        mpz_set_ui(n[0], 0);
        mpz_neg(n[i], edge[e][j]);
        mpz_set(n[j], edge[e][i]);
    }
    add_normal(solver, n, greatest);
}

/* Sets solver->best; returns its f, in units: the greatest of all slabs. */
static double best_slab(struct solver *solver)
{
    mpz_t *edge[2 * EXACT_EDGES_MAX + 1], *n = solver->normal;
    const int count = list_edges(&solver->pair, edge);
    double greatest = -INFINITY;
    for (int i = 0; i < count; i++) {
        if (solver->dim == 2) {
            mpz_neg(n[0], edge[i][1]);
            mpz_set(n[1], edge[i][0]);
            mpz_set_ui(n[2], 0);
            add_normal(solver, n, &greatest);
        }
        for (int j = 0; j < i && solver->dim == 3; j++) {
            integer_cross(n, edge[i], edge[j], solver->t[0]);
            add_normal(solver, n, &greatest);
        }
    }
    if (greatest == -INFINITY)
        add_across(solver, edge, count, &greatest);
    return greatest;
}

/* ---- Answers ---- */

/* A bound of so many units as a number; ldexp() rounds where it underflows. */
static double below(const struct solver *solver, double units)
{
    const double x = units - (fabs(units) * 0x1p-48 + UNITS_ERROR);
    return ldexp(x, (int) solver->pair.unit) - 0x1p-1074;
}

static double above(const struct solver *solver, double units)
{
    return -below(solver, -units);
}

/* f of a direction of unit length but for rounding, in units. */
static double value_of(struct solver *solver, const double direction[FMB_DIM_MAX])
{
    for (int axis = 0; axis < 3; axis++)
        mpz_set_d(solver->normal[axis], ldexp(direction[axis], DIRECTION_BITS));
    set_extent(solver, solver->normal);
    return ldexp(mpz_get_d(solver->all.low), -DIRECTION_BITS);
}

/* Coordinates, rounded, of a point of frame f: that of the simplex next to the origin. Returns a
 * bound on how far they are off. */
static double set_witness(struct solver *solver, int f, double out[FMB_DIM_MAX])
{
    const struct exact_frame *frame = &solver->pair.frame[f];
    mpz_t *at = &solver->t[0], *weight = &solver->t[1];
    double error = 0;
    for (int axis = 0; axis < solver->dim; axis++) {
        mpz_mul(*at, solver->simplex.total, frame->origin[axis]);
        for (int c = 0; c < solver->simplex.count; c++) {
            const struct exact_corner *corner = solver->simplex.corner[c];
            mpz_set_ui(*weight, 0);
            if (corner->late)
                mpz_set(*weight, frame->displacement[axis]);
            for (int i = 0; i < frame->count; i++)
                if (corner->bits[f] >> i & 1)
                    mpz_add(*weight, *weight, frame->component[i][axis]);
            mpz_addmul(*at, solver->simplex.weight[c], *weight);
        }
        out[axis] = integer_ratio_round(*at, solver->simplex.total, solver->pair.unit, ROUND_DOWN,
                                        solver->t + 2);
        error += fmin(fabs(out[axis]), DBL_MAX) * 0x1p-51 + 0x1p-1073;
    }
    return error;
}

/* Sets the time. Returns a bound on how far the frames move in the time by which it is off. */
static double set_time(struct solver *solver, double duration, struct fmb_gap *out)
{
    const struct dyadic window = dyadic_of(duration);
    double way = 0;
    mpz_set_ui(solver->t[0], 0);
    for (int c = 0; c < solver->simplex.count; c++)
        if (solver->simplex.corner[c]->late)
            mpz_add(solver->t[0], solver->t[0], solver->simplex.weight[c]);
    out->time = 0;
    if (mpz_sgn(solver->t[0]) == 0)
        return 0;
    mpz_mul_si(solver->t[0], solver->t[0], window.mantissa);
    out->time = integer_ratio_round(solver->t[0], solver->simplex.total, window.exponent,
                                    ROUND_DOWN, solver->t + 1);
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < 3; axis++)
            way += fabs(mpz_get_d(solver->pair.frame[f].displacement[axis]));
    const double share = 0x1p-51 + (duration < 0x1p-1000 ? 0x1p-1073 / duration : 0);
    return above(solver, way * fmin(share, 1));
}

/* Sets the upper bound: the sum of the distance of the true points of P, twice the rounding of each
 * witness point, and how far the frames move in the time by which out->time is off. */
static void set_upper(struct solver *solver, double distance, double duration, struct fmb_gap *out)
{
    double error = set_time(solver, duration, out);
    for (int f = 0; f < 2; f++)
        error += 2 * set_witness(solver, f, out->witness[f]);
    out->has_witness = true;
    out->bounds[1] = (above(solver, distance) + error) * (1 + 0x1p-51);
}

static void answer(struct solver *solver, enum fmb_verdict verdict, double duration,
                   struct fmb_gap *out)
{
    double greatest = 0;
    if (verdict == FMB_SEPARATED) {
        struct exact_simplex *simplex = &solver->simplex;
        exact_simplex_solve(simplex, solver->pair.offset, set_support, solver);
        integer_dot(solver->all.low, simplex->normal, simplex->corner[0]->at, solver->t[0]);
        set_upper(solver, simplex->zero ? 0 : over_length(solver, solver->all.low, simplex->normal),
                  duration, out);
        for (int axis = 0; axis < 3; axis++)
            mpz_set(solver->best[axis], simplex->normal[axis]);
    }
    if (verdict != FMB_SEPARATED || solver->simplex.zero)
        greatest = best_slab(solver);
    exact_direction(solver->best, out->direction);
    if (verdict == FMB_TOUCHING)
        return;
    out->bounds[0] = below(solver, value_of(solver, out->direction));
    const double upper = above(solver, greatest);
    if (verdict == FMB_OVERLAPPING)
        out->bounds[1] = upper < 0 ? upper : 0; /* never -0 */
}

void gap_exact(const struct frame_pair *pair, enum fmb_verdict verdict, struct fmb_gap *out)
{
    struct solver solver = {.dim = pair->a.frame->dim};
    memset(out, 0, sizeof *out);
    exact_pair_init(&solver.pair, pair);
    exact_simplex_each(&solver.simplex, mpz_init);
    INTEGER_EACH_FROM(normal, &solver, mpz_init);
    round_pair(&solver.pair, solver.t[0]);
    answer(&solver, verdict, pair->duration, out);
    INTEGER_EACH_FROM(normal, &solver, mpz_clear);
    exact_simplex_each(&solver.simplex, mpz_clear);
    exact_pair_clear(&solver.pair);
}
