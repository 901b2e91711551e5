/* Checks the point of a certificate of a pair with a hull, by the definitions of fmb.h. A frame is
 * the convex hull of its vertices, in body coordinates: v_0, v_1, ...
 *
 * With positive weights that sum to 1, and position + R sum_i w_i v_i + t v = p, R the rotation of
 * the placement, the point p is in the frame. It is in the relative interior of the hull of the
 * named vertices (Rockafellar, Convex Analysis, theorem 6.9), which is part of that of the frame if
 * both have the same affine hull. */
#include "certificate_check.h"

/* Adds a vector, or nothing if it depends on those that there are. It is overwritten. */
static void span_add(struct check_span *span, mpq_t v[AXES])
{
    int pivot = 0;
    mpq_t factor;
    mpq_init(factor);
    for (int i = 0; i < span->rank; i++) {
        mpq_div(factor, v[span->pivot[i]], span->vector[i][span->pivot[i]]);
        mpq_neg(factor, factor);
        check_add_multiple(v, factor, span->vector[i], AXES);
    }
    mpq_clear(factor);
    while (pivot < AXES && mpq_sgn(v[pivot]) == 0)
        pivot++;
    if (pivot == AXES)
        return;
    check_copy(span->vector[span->rank], v);
    span->pivot[span->rank++] = pivot;
}

/* Takes " LETTER INDEX:WEIGHT INDEX:WEIGHT ...", indices ascending, weights positive. Sets the sum,
 * the total and the span of a side. */
static bool take_weights_of(const char **at, const char *letter, struct check_side *side)
{
    unsigned next = 0;
    mpz_t index;
    mpq_t weight, first[AXES], vertex[AXES];
    mpz_init(index);
    mpq_init(weight);
    check_each(first, sizeof first, mpq_init);
    check_each(vertex, sizeof vertex, mpq_init);
    bool good = check_take(at, letter);
    while (good && **at == ' ' && check_is_digit((*at)[1])) {
        ++*at;
        good = check_take_digits(at, index) && mpz_cmp_ui(index, next) >= 0 &&
               mpz_cmp_ui(index, check_vertex_count(side)) < 0 && check_take(at, ":") &&
               check_take_number(at, weight) && mpq_sgn(weight) > 0;
        if (!good)
            break;
        check_vertex(side, (unsigned) mpz_get_ui(index), vertex);
        mpq_add(side->total, side->total, weight);
        check_add_multiple(side->sum, weight, vertex, AXES);
        if (next == 0)
            check_copy(first, vertex);
        check_subtract(vertex, vertex, first);
        span_add(&side->span, vertex);
        next = (unsigned) mpz_get_ui(index) + 1;
    }
    check_each(vertex, sizeof vertex, mpq_clear);
    check_each(first, sizeof first, mpq_clear);
    mpq_clear(weight);
    mpz_clear(index);
    return good;
}

bool check_take_weights(const char **at, struct check_proof *proof)
{
    return take_weights_of(at, " a", &proof->side[0]) && take_weights_of(at, " b", &proof->side[1]);
}

/* Whether the weighted vertices of the frame are the point at the time. */
static bool has_point(struct check_proof *proof, struct check_side *side)
{
    check_turn(side->placement, false, side->sum);
    check_add_multiple(side->sum, proof->time, side->velocity, AXES);
    check_add_numbers(side->sum, proof->dim, side->placement->position);
    return mpq_equal(side->sum[0], proof->point[0]) && mpq_equal(side->sum[1], proof->point[1]) &&
           mpq_equal(side->sum[2], proof->point[2]);
}

/* Whether no vertex lies outside of the affine hull of the named ones. Adds one that does. */
static bool is_spanned(struct check_side *side)
{
    const int rank = side->span.rank;
    mpq_t first[AXES], vertex[AXES];
    check_each(first, sizeof first, mpq_init);
    check_each(vertex, sizeof vertex, mpq_init);
    check_vertex(side, 0, first);
    for (unsigned k = 1;
         k < check_vertex_count(side) && rank < side->frame->dim && side->span.rank == rank; k++) {
        check_vertex(side, k, vertex);
        check_subtract(vertex, vertex, first);
        span_add(&side->span, vertex);
    }
    check_each(vertex, sizeof vertex, mpq_clear);
    check_each(first, sizeof first, mpq_clear);
    return side->span.rank == rank;
}

const char *check_flaw_of_weights(struct check_proof *proof, enum fmb_verdict verdict)
{
    static const char *const of_place[2] = {
        "the point is not that of the weights in the first frame",
        "the point is not that of the weights in the second frame"};
    static const char *const of_span[2] = {"the named vertices do not span the first frame",
                                           "the named vertices do not span the second frame"};
    for (int f = 0; f < 2; f++) {
        struct check_side *side = &proof->side[f];
        if (mpq_cmp_ui(side->total, 1, 1) != 0)
            return "the weights do not sum to 1";
        if (!has_point(proof, side))
            return of_place[f];
        if (verdict == FMB_OVERLAPPING && !is_spanned(side))
            return of_span[f];
    }
    return NULL;
}
