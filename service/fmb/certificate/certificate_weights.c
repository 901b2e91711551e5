/* Weights of few digits.
 *
 * A proof gives positive weights w_j of vertices x_j of both frames, and the time as a fraction tau
 * of the window, such that
 *
 *     sum w_j = 1 over the vertices of A, and over those of B,
 *     sum w_j x_j over those of A - sum w_j x_j over those of B = tau drift.
 *
 * Gaussian elimination finds a maximal set of vertices whose columns in these equations are
 * linearly independent, those with large weights first. Their weights are continuous functions of
 * all other weights and tau. The other weights are rounded to multiples of 2^-bits, but not to 0,
 * and the time to a multiple of 2^-bits times a power of two above the window. bits is the least
 * number tried with which all dependent weights are positive. With sufficiently many bits they are,
 * since they are near the weights of the proof.
 *
 * If the equations leave a row without vertices in which the drift is not 0, tau follows from this
 * row, for example if two plates pass through each other's plane. The time is then not rounded.
 *
 * Frames with radii. The equations are only that the weights of each frame sum to 1, so that one
 * weight of each frame follows from the others. The two points are at most the sum of the radii
 * apart. If they are nearer than that, the frames overlap, and the weights are rounded to the least
 * number of bits tried that keeps the points that near. Otherwise the frames touch, and the weights
 * are stated as in the proof, unrounded.
 *
 * The elimination is that of Bareiss (Mathematics of Computation 22, 1968): the numbers remain
 * integers, minors of the matrix, and each step divides by the previous pivot without remainder. */
#include "certificate_weights.h"

#include "integer.h"

#include <math.h>

static void each(struct certificate_weights *w, void (*call)(mpz_ptr))
{
    for (int i = 0; i < WEIGHTS_MAX; i++)
        INTEGER_EACH_FROM(proven, &w->weight[i], call);
    INTEGER_EACH_FROM(row, w, call);
}

static struct certificate_weight *find(struct certificate_weights *w, int f, unsigned vertex)
{
    unsigned k = 0;
    while (k < w->count && (w->weight[k].f != f || w->weight[k].vertex != vertex))
        k++;
    if (k == w->count) {
        w->count++;
        w->weight[k].f = f;
        w->weight[k].row = -1;
        w->weight[k].vertex = vertex;
    }
    return &w->weight[k];
}

static void sort(struct certificate_weights *w)
{
    for (unsigned i = 1; i < w->count; i++)
        for (unsigned k = i; k > 0; k--) {
            struct certificate_weight *before = &w->weight[k - 1], *after = &w->weight[k];
            if (mpz_cmp(before->proven, after->proven) >= 0)
                break;
            const struct certificate_weight copy = *before;
            *before = *after;
            *after = copy;
        }
}

static void set_rows(struct certificate_weights *w)
{
    const struct support_integers *integers = w->proof->integers;
    mpz_t at[3];
    mpz_inits(at[0], at[1], at[2], NULL);
    for (unsigned j = 0; j < w->count; j++) {
        const int f = w->weight[j].f;
        support_integers_place(integers, f, w->weight[j].vertex, at);
        mpz_set_ui(w->row[f][j], 1);
        for (int i = 2; i < 2 + w->dim; i++)
            (f ? mpz_neg : mpz_set)(w->row[i][j], at[i - 2]);
    }
    for (int i = 0; i < 2 + w->dim; i++) {
        mpz_set_ui(w->row[i][w->count], i < 2);
        if (i >= 2)
            mpz_set(w->row[i][w->count + 1], integers->drift[i - 2]);
    }
    mpz_clears(at[0], at[1], at[2], NULL);
}

/* time := the time of the proof. */
static void set_time(struct certificate_weights *w)
{
    mpq_t window;
    mpq_init(window);
    for (unsigned c = 0; c < w->proof->count; c++)
        if (w->proof->column[c].end)
            mpz_add(mpq_numref(w->time), mpq_numref(w->time), w->proof->weight[c]);
    mpz_set(mpq_denref(w->time), w->proof->total);
    mpq_canonicalize(w->time);
    mpq_set_d(window, w->duration);
    mpq_mul(w->time, w->time, window);
    mpq_clear(window);
}

void certificate_weights_begin(const struct programs_proof *proof, int dim, double duration,
                               struct certificate_weights *out)
{
    out->proof = proof;
    out->duration = duration;
    out->count = out->next = 0;
    out->rounded = mpz_sgn(proof->integers->radius) != 0;
    out->unrounded = out->rounded && proof->verdict == FMB_TOUCHING;
    out->dim = dim;
    out->rows = out->rounded ? 2 : 2 + dim;
    out->rank = 0;
    each(out, mpz_init);
    mpq_init(out->time);
    mpz_set_ui(out->det, 1);
    for (unsigned c = 0; c < proof->count; c++)
        for (int f = 0; f < 2 && mpz_sgn(proof->weight[c]) > 0; f++) {
            struct certificate_weight *of = find(out, f, proof->column[c].vertex[f]);
            mpz_add(of->proven, of->proven, proof->weight[c]);
        }
    sort(out);
    set_rows(out);
    set_time(out);
}

void certificate_weights_end(struct certificate_weights *w)
{
    each(w, mpz_clear);
    mpq_clear(w->time);
}

/* Adds column j to the basis unless it depends on the columns there. Rows from rank on have no
 * column of the basis. Returns whether it was added. */
static bool eliminate(struct certificate_weights *w, unsigned j)
{
    const unsigned columns = w->count + 2;
    int p = w->rank;
    while (p < w->rows && mpz_sgn(w->row[p][j]) == 0)
        p++;
    if (p == w->rows)
        return false;
    mpz_t *pivot = w->row[w->rank];
    for (unsigned k = 0; k < columns && p > w->rank; k++)
        mpz_swap(pivot[k], w->row[p][k]);
    for (int i = 0; i < w->rows; i++) {
        mpz_t *row = w->row[i];
        if (row == pivot)
            continue;
        mpz_set(w->scratch, row[j]);
        for (unsigned k = 0; k < columns; k++) {
            mpz_mul(row[k], row[k], pivot[j]);
            mpz_submul(row[k], w->scratch, pivot[k]);
            mpz_divexact(row[k], row[k], w->det);
        }
    }
    mpz_set(w->det, pivot[j]);
    w->weight[j].row = w->rank++;
    return true;
}

/* Whether the equations hold at all times. */
static bool time_is_free(const struct certificate_weights *w)
{
    bool is_free = true;
    for (int i = w->rank; i < w->rows; i++)
        is_free = is_free && mpz_sgn(w->row[i][w->count + 1]) == 0;
    return is_free;
}

/* out := x 2^bits, rounded down. */
static void round_down(const mpq_t x, long bits, mpq_t out)
{
    (bits < 0 ? mpq_div_2exp : mpq_mul_2exp)(out, x, (mp_bitcnt_t) labs(bits));
    mpz_fdiv_q(mpq_numref(out), mpq_numref(out), mpq_denref(out));
    mpz_set_ui(mpq_denref(out), 1);
    (bits < 0 ? mpq_mul_2exp : mpq_div_2exp)(out, out, (mp_bitcnt_t) labs(bits));
}

static void round_weights(struct certificate_weights *w)
{
    for (unsigned j = 0; j < w->count; j++) {
        struct certificate_weight *of = &w->weight[j];
        mpz_mul_2exp(of->stated, of->proven, w->bits + 1);
        mpz_add(of->stated, of->stated, w->proof->total);
        mpz_fdiv_q(of->stated, of->stated, w->proof->total);
        mpz_fdiv_q_2exp(of->stated, of->stated, 1);
        if (mpz_sgn(of->stated) == 0)
            mpz_set_ui(of->stated, 1);
    }
}

/* Whether all dependent weights are positive at this fraction of the window. */
static bool follow_positive(struct certificate_weights *w, const mpq_t tau)
{
    for (int i = 0; i < w->rank; i++) {
        mpz_t *row = w->row[i];
        mpz_mul_2exp(w->sum, row[w->count], w->bits);
        for (unsigned j = 0; j < w->count; j++)
            if (w->weight[j].row < 0)
                mpz_submul(w->sum, row[j], w->weight[j].stated);
        mpz_mul(w->sum, w->sum, mpq_denref(tau));
        mpz_mul_2exp(w->scratch, row[w->count + 1], w->bits);
        mpz_addmul(w->sum, w->scratch, mpq_numref(tau));
        if (mpz_sgn(w->sum) != mpz_sgn(w->det))
            return false;
    }
    return true;
}

/* Sets the weights that follow from the others. Returns whether the points of frames with radii,
 * with these weights and at this fraction of the window, are nearer than the sum of the radii. */
static bool are_near(struct certificate_weights *w, const mpq_t tau)
{
    const struct support_integers *integers = w->proof->integers;
    mpz_t square;
    for (unsigned j = 0; j < w->count; j++) {
        struct certificate_weight *of = &w->weight[j];
        if (of->row < 0)
            continue;
        mpz_set_ui(of->stated, 1);
        mpz_mul_2exp(of->stated, of->stated, w->bits);
        for (unsigned k = 0; k < w->count; k++)
            if (k != j && w->weight[k].f == of->f)
                mpz_sub(of->stated, of->stated, w->weight[k].stated);
    }
    mpz_init(square);
    for (int i = 2; i < 2 + w->dim; i++) {
        mpz_set_ui(w->sum, 0);
        for (unsigned j = 0; j < w->count; j++)
            mpz_submul(w->sum, w->row[i][j], w->weight[j].stated);
        mpz_mul(w->sum, w->sum, mpq_denref(tau));
        mpz_mul_2exp(w->scratch, integers->drift[i - 2], w->bits);
        mpz_addmul(w->sum, w->scratch, mpq_numref(tau));
        mpz_addmul(square, w->sum, w->sum);
    }
    mpz_set(w->sum, integers->radius);
    mpz_mul(w->sum, w->sum, mpq_denref(tau));
    mpz_mul_2exp(w->sum, w->sum, w->bits);
    mpz_mul(w->sum, w->sum, w->sum);
    const bool near = mpz_cmp(square, w->sum) < 0;
    mpz_clear(square);
    return near;
}

static void choose(struct certificate_weights *w)
{
    const bool rounds_time = time_is_free(w) && mpq_sgn(w->time) > 0;
    bool good = false;
    int exponent;
    mpq_t window, tau, time;
    mpq_inits(window, tau, time, NULL);
    mpq_set_d(window, w->duration);
    mpq_set(time, w->time);
    frexp(w->duration, &exponent);
    for (w->bits = 3; !good; w->bits += good ? 0 : w->bits / 2) {
        if (rounds_time)
            round_down(w->time, (long) w->bits - exponent, time);
        if (mpq_sgn(time) > 0)
            mpq_div(tau, time, window);
        round_weights(w);
        good = follow_positive(w, tau) && (!w->rounded || are_near(w, tau));
    }
    mpq_swap(w->time, time);
    mpq_clears(window, tau, time, NULL);
}

bool certificate_weights_step(struct certificate_weights *w)
{
    while (w->next < w->count && w->rank < w->rows)
        if (eliminate(w, w->next++))
            return false;
    if (!w->unrounded)
        choose(w);
    return true;
}
