/* Checks the common point of a certificate, by the definitions of fmb.h. A frame is the convex hull
 * of its vertices, in body coordinates: v_0, v_1, ...
 *
 * With positive weights that sum to 1, the point position + R sum_i w_i v_i + t v, R the rotation
 * of the placement, is in the frame. It is in the relative interior of the hull of the named
 * vertices (Rockafellar, Convex Analysis, theorem 6.9), which is part of that of the frame if both
 * have the same affine hull.
 *
 * Of frames with radii, the points a and b of the two cores may differ: |b - a| is compared with
 * the sum of the radii. Then at most one weight of each frame may be left out, and follows from the
 * others.
 *
 * Weights that are not stated are unknowns of linear equations: the weights of each frame sum to 1,
 * and both frames have the same point. Gaussian elimination has to leave exactly one solution. */
#include "certificate_check.h"

/* Adds a vector, or nothing if it depends on those that there are. It is overwritten. */
static void span_add(struct check_span *span, mpq_t v[AXES])
{
    int pivot = 0;
    CHECK_NUMBER(factor);
    for (int i = 0; i < span->rank; i++) {
        mpq_div(factor, v[span->pivot[i]], span->vector[i][span->pivot[i]]);
        mpq_neg(factor, factor);
        check_add_multiple(v, factor, span->vector[i], AXES);
    }
    while (pivot < AXES && mpq_sgn(v[pivot]) == 0)
        pivot++;
    if (pivot == AXES)
        return;
    check_copy(span->vector[span->rank], v);
    span->pivot[span->rank++] = pivot;
}

/* Makes the weight of a vertex of side f an unknown. Returns false if there are too many. The
 * vertex is overwritten. */
static bool add_following(struct check_proof *proof, int f, mpq_t vertex[AXES])
{
    const int k = proof->following++;
    if (k == FOLLOWING_MAX)
        return false;
    check_turn(&proof->side[f], false, vertex);
    mpq_set_ui(proof->equation[f][k], 1, 1);
    for (int axis = 0; axis < AXES; axis++)
        (f ? mpq_neg : mpq_set)(proof->equation[2 + axis][k], vertex[axis]);
    return true;
}

/* Takes " LETTER" and one or more of " INDEX:WEIGHT" and " INDEX", indices ascending, weights
 * positive. Sets the sum, the total and the span of side f. */
static bool take_weights_of(const char **at, const char *letter, struct check_proof *proof, int f)
{
    struct check_side *side = &proof->side[f];
    unsigned next = 0;
    CHECK_NUMBER(weight);
    CHECK_VECTOR(first);
    CHECK_VECTOR(vertex);
    CHECK_VECTOR(edge);
    if (!check_take(at, letter))
        return false;
    while (**at == ' ' && check_is_digit((*at)[1])) {
        mpz_ptr index = mpq_numref(weight);
        ++*at;
        if (!check_take_digits(at, index) || mpz_cmp_ui(index, next) < 0 ||
            mpz_cmp_ui(index, check_vertex_count(side)) >= 0)
            return false;
        check_vertex(side, (unsigned) mpz_get_ui(index), vertex);
        if (next == 0)
            check_copy(first, vertex);
        check_subtract(edge, vertex, first);
        span_add(&side->span, edge);
        next = (unsigned) mpz_get_ui(index) + 1;
        if (!check_take(at, ":")) {
            if (!add_following(proof, f, vertex))
                return false;
            continue;
        }
        if (!check_take_number(at, weight) || mpq_sgn(weight) <= 0)
            return false;
        mpq_add(side->total, side->total, weight);
        check_add_multiple(side->sum, weight, vertex, AXES);
    }
    return next > 0;
}

bool check_take_weights(const char **at, struct check_proof *proof)
{
    return take_weights_of(at, " a", proof, 0) && take_weights_of(at, " b", proof, 1);
}

/* Completes the equations by their sums. */
static void set_sums(struct check_proof *proof)
{
    for (int f = 0; f < 2; f++) {
        struct check_side *side = &proof->side[f];
        mpq_set_ui(proof->equation[f][proof->following], 1, 1);
        mpq_sub(proof->equation[f][proof->following], proof->equation[f][proof->following],
                side->total);
        check_turn(side, false, side->sum);
        check_add_multiple(side->sum, proof->time, side->velocity, AXES);
        check_add(side->sum, side->position);
    }
    for (int axis = 0; axis < AXES; axis++)
        mpq_sub(proof->equation[2 + axis][proof->following], proof->side[1].sum[axis],
                proof->side[0].sum[axis]);
}

/* Eliminates unknown k from equation e: adds a multiple of equation k, from unknown k on. */
static void substitute(struct check_proof *proof, int k, int e)
{
    CHECK_NUMBER(factor);
    mpq_div(factor, proof->equation[e][k], proof->equation[k][k]);
    mpq_neg(factor, factor);
    check_add_multiple(proof->equation[e] + k, factor, proof->equation[k] + k,
                       proof->following + 1 - k);
}

/* Finds an equation among k, ..., count - 1 that contains unknown k, moves it to position k and
 * solves it for this unknown. Returns false if there is none. */
static bool eliminate(struct check_proof *proof, int k, int count)
{
    int from = k;
    while (from < count && mpq_sgn(proof->equation[from][k]) == 0)
        from++;
    if (from >= count)
        return false;
    for (int i = 0; i <= proof->following && from > k; i++)
        mpq_swap(proof->equation[k][i], proof->equation[from][i]);
    for (int e = 0; e < EQUATIONS; e++)
        if (e != k && mpq_sgn(proof->equation[e][k]) != 0)
            substitute(proof, k, e);
    return true;
}

/* Returns the sign of |b - a| minus the sum of the radii. After the elimination, the right-hand
 * sides of the equations of the axes are b - a, up to a common sign. */
static int compare_radius(struct check_proof *proof)
{
    CHECK_NUMBER(square);
    CHECK_NUMBER(of_axis);
    for (int axis = 0; axis < AXES; axis++) {
        const mpq_ptr apart = proof->equation[2 + axis][proof->following];
        mpq_mul(of_axis, apart, apart);
        mpq_add(square, square, of_axis);
    }
    mpq_mul(of_axis, proof->radius, proof->radius);
    return mpq_cmp(square, of_axis);
}

static const char *flaw_of_equations(struct check_proof *proof)
{
    const int sum = proof->following, equations = proof->rounded ? 2 : EQUATIONS;
    set_sums(proof);
    for (int k = 0; k < proof->following; k++)
        if (!eliminate(proof, k, equations))
            return "the weights that are not stated do not follow from the others";
    for (int e = proof->following; e < equations; e++)
        if (mpq_sgn(proof->equation[e][sum]) != 0)
            return "with these weights the frames have no common point";
    for (int k = 0; k < proof->following; k++)
        if (mpq_sgn(proof->equation[k][k]) != mpq_sgn(proof->equation[k][sum]))
            return "a weight that follows is not positive";
    return NULL;
}

/* Whether no vertex lies outside of the affine hull of the named ones. Adds one that does. */
static bool is_spanned(struct check_side *side)
{
    const int rank = side->span.rank;
    CHECK_VECTOR(first);
    CHECK_VECTOR(vertex);
    check_vertex(side, 0, first);
    for (unsigned k = 1;
         k < check_vertex_count(side) && rank < side->frame->dim && side->span.rank == rank; k++) {
        check_vertex(side, k, vertex);
        check_subtract(vertex, vertex, first);
        span_add(&side->span, vertex);
    }
    return side->span.rank == rank;
}

const char *check_flaw_of_weights(struct check_proof *proof, enum fmb_verdict verdict)
{
    const char *flaw = flaw_of_equations(proof);
    if (!flaw && proof->rounded && compare_radius(proof) >= (verdict == FMB_OVERLAPPING ? 0 : 1))
        return "with these weights the points are too far apart";
    if (flaw || proof->rounded || verdict != FMB_OVERLAPPING)
        return flaw;
    return !is_spanned(&proof->side[0])   ? "the named vertices do not span the first frame"
           : !is_spanned(&proof->side[1]) ? "the named vertices do not span the second frame"
                                          : NULL;
}
