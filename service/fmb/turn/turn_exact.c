/* The proof. Let p(a, b) be the polynomial of vertices a and b, which has the sign of n . (b - a),
 * with coefficients c_k(a, b). Each coefficient is least for some a and b. If all these least
 * coefficients are positive, the frames are apart on the closed interval. If none is negative,
 * n . (b - a) >= 0 at all times of the interval. If in addition one of them is positive, no p is
 * identically 0; then each p is positive inside the interval, where the frames are apart.
 *
 * If n . (b - a) >= 0 at some time, n is not 0 and n . x is not constant on one of the frames, then
 * the relative interior of that frame has no point with the greatest (least) n . x, and the two
 * relative interiors do not meet. n = N m is never 0. A product of edges is known not to be 0 if
 * all coefficients of one of its coordinates are of one sign. n . x is not constant on a frame that
 * is solid, nor on the frame in which n is fixed if m . x differs between two of its vertices. */
#include "turn_exact.h"

#include "integer.h"

/* ---- Integers ---- */

void turn_exact_begin(const struct turn_path *path, struct turn_exact *out)
{
    const struct frame_pair *frames = path->pair.frames;
    const struct fmb_placement *const placed[2] = {frames->a.placement, frames->b.placement};
    mpz_t other[3];
    memset(out, 0, sizeof *out);
    out->path = path;
    support_integers_each(&out->integers, mpz_init);
    support_integers_set(frames, true, 0, &out->integers);
    out->unit = out->integers.unit;
    INTEGER_EACH_FROM(q, out, mpz_init);
    for (int f = 0; f < 2; f++) {
        struct dyadic_span span = dyadic_span_begin();
        for (int i = 0; i < 8; i++)
            dyadic_span_add(&span, dyadic_of(path->q[f][i / 4][i % 4]));
        for (int i = 0; i < 8; i++)
            integer_set(out->q[f][i / 4][i % 4], dyadic_of(path->q[f][i / 4][i % 4]), span.unit);
    }
    mpz_inits(other[0], other[1], other[2], NULL);
    support_integers_path(placed[0], frames->duration, out->unit, other);
    support_integers_path(placed[1], frames->duration, out->unit, out->drift);
    for (int axis = 0; axis < path->pair.dim; axis++) {
        mpz_sub(out->drift[axis], out->drift[axis], other[axis]);
        integer_set_sum(out->offset[axis], placed[1]->position[axis], -placed[0]->position[axis],
                        out->unit);
    }
    mpz_clears(other[0], other[1], other[2], NULL);
}

void turn_exact_end(struct turn_exact *exact)
{
    support_integers_each(&exact->integers, mpz_clear);
    INTEGER_EACH_FROM(q, exact, mpz_clear);
}

/* ---- Polynomials ---- */

typedef mpz_t vector[3];

/* For one frame over an interval: the coefficients of N(q), [row][column], and of |q|^2. */
struct quadratic {
    vector matrix[3][3];
    mpz_t norm[3];
};

/* All numbers of one direction over one interval. */
struct work {
    struct quadratic of[2];
    vector difference[2], m[2], n[6], c[2][6], part, vertex;
    mpz_t own, value[6], least, scratch, other;
};

/* out := (2^bits - i) x + i y */
static void between(const mpz_t x, const mpz_t y, const mpz_t i, mp_bitcnt_t bits, mpz_t out,
                    mpz_t scratch)
{
    mpz_sub(scratch, y, x);
    mpz_mul(scratch, scratch, i);
    mpz_mul_2exp(out, x, bits);
    mpz_add(out, out, scratch);
}

/* Sets the quadratics of both frames and the difference of the positions, at the ends of the
 * interval. Returns the bits by which lengths are scaled. */
static mp_bitcnt_t set_interval(const struct turn_exact *exact, double lo, double hi,
                                struct work *work)
{
    const struct dyadic end[2] = {dyadic_of(lo), dyadic_of(hi)};
    const long least = end[0].exponent < end[1].exponent ? end[0].exponent : end[1].exponent;
    const mp_bitcnt_t bits = least < 0 ? (mp_bitcnt_t) -least : 0;
    mpz_t index[2], q[2][4];
    mpz_inits(index[0], index[1], NULL);
    for (int e = 0; e < 2; e++)
        integer_set(index[e], end[e], -(long) bits);
    integer_each(q, sizeof q, mpz_init);
    for (int f = 0; f < 2; f++) {
        struct quadratic *of = &work->of[f];
        for (int i = 0; i < 8; i++)
            between(exact->q[f][0][i % 4], exact->q[f][1][i % 4], index[i / 4], bits,
                    q[i / 4][i % 4], work->scratch);
        for (int k = 0; k < 3; k++)
            support_integers_polar(q[k == 2], q[k > 0], k == 1 ? 2 : 1, of->matrix[k], of->norm[k],
                                   work->scratch);
    }
    for (int e = 0; e < 2; e++)
        for (int axis = 0; axis < 3; axis++) {
            mpz_mul_2exp(work->difference[e][axis], exact->offset[axis], bits);
            mpz_addmul(work->difference[e][axis], exact->drift[axis], index[e]);
        }
    integer_each(q, sizeof q, mpz_clear);
    mpz_clears(index[0], index[1], NULL);
    return bits;
}

static void apply(vector matrix[3], vector v, vector out)
{
    for (int i = 0; i < 3; i++) {
        mpz_mul(out[i], matrix[i][0], v[0]);
        mpz_addmul(out[i], matrix[i][1], v[1]);
        mpz_addmul(out[i], matrix[i][2], v[2]);
    }
}

static void add_transposed(vector matrix[3], vector v, vector out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            mpz_addmul(out[j], matrix[i][j], v[i]);
}

static void add_dot(vector x, vector y, mpz_t out)
{
    for (int axis = 0; axis < 3; axis++)
        mpz_addmul(out, x[axis], y[axis]);
}

static void raise_degree(vector x[6])
{
    for (int k = 5; k > 0; k--)
        for (int axis = 0; axis < 3; axis++)
            mpz_add(x[k][axis], x[k][axis], x[k - 1][axis]);
}

static void get_difference(const struct turn_exact *exact, int f, unsigned from, unsigned to,
                           vector scratch, vector out)
{
    support_integers_vertex(&exact->integers, f, to, out);
    support_integers_vertex(&exact->integers, f, from, scratch);
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out[axis], out[axis], scratch[axis]);
}

/* Sets m, or e and f. Returns false if one of them is 0. */
static bool set_direction(const struct turn_exact *exact, const struct turn_corners *corners,
                          int sign, struct work *work)
{
    const uint16_t *v = corners->vertex;
    if (corners->of == 2) {
        for (int f = 0; f < 2; f++)
            get_difference(exact, f, v[2 * f], v[2 * f + 1], work->part, work->m[f]);
    } else if (exact->path->pair.dim == 2) {
        get_difference(exact, corners->of, v[0], v[1], work->part, work->m[0]);
        mpz_swap(work->m[0][0], work->m[0][1]);
        mpz_neg(work->m[0][0], work->m[0][0]);
    } else {
        for (int i = 0; i < 2; i++)
            get_difference(exact, corners->of, v[0], v[i + 1], work->part, work->n[i]);
        integer_cross(work->m[0], work->n[0], work->n[1], work->scratch);
        for (int i = 0; i < 6; i++)
            mpz_set_ui(work->n[i / 3][i % 3], 0);
    }
    for (int axis = 0; axis < 3 && sign < 0; axis++)
        mpz_neg(work->m[0][axis], work->m[0][axis]);
    return !integer_is_zero(work->m[0]) && (corners->of < 2 || !integer_is_zero(work->m[1]));
}

void turn_exact_direction(const struct turn_exact *exact, const struct turn_corners *corners,
                          int sign, mpz_t m[2][3])
{
    struct work work;
    integer_each(&work, sizeof work, mpz_init);
    set_direction(exact, corners, sign, &work);
    for (int i = 0; i < 6; i++)
        mpz_swap(m[i / 3][i % 3], work.m[i / 3][i % 3]);
    integer_each(&work, sizeof work, mpz_clear);
}

/* value += factor times 2^bits times the least (way > 0) or minus the greatest x . v over the
 * vertices of a frame. Returns whether x . v is constant. */
static bool add_least(const struct turn_exact *exact, int f, vector x, int way, const mpz_t factor,
                      mp_bitcnt_t bits, struct work *work, mpz_t value)
{
    const unsigned count = exact->path->pair.view[f].vertices.count;
    bool constant = true;
    for (unsigned i = 0; i < count; i++) {
        support_integers_vertex(&exact->integers, f, i, work->vertex);
        mpz_set_ui(work->other, 0);
        add_dot(x, work->vertex, work->other);
        if (i > 0)
            constant = constant && mpz_cmp(work->other, work->least) == 0;
        if (i == 0 || (way > 0 ? mpz_cmp(work->other, work->least) < 0
                               : mpz_cmp(work->other, work->least) > 0))
            mpz_set(work->least, work->other);
    }
    mpz_mul_2exp(work->least, work->least, bits);
    if (factor)
        mpz_mul(work->least, work->least, factor);
    (way > 0 ? mpz_add : mpz_sub)(value, value, work->least);
    return constant;
}

/* Sets the polynomial of a direction fixed in a frame. Returns whether n . x is not constant on
 * that frame. */
static bool set_fixed(const struct turn_exact *exact, int f, mp_bitcnt_t bits, struct work *work)
{
    struct quadratic *own = &work->of[f], *other = &work->of[!f];
    mpz_t norm[6], o[4];
    bool constant = true;
    integer_each(norm, sizeof norm, mpz_init);
    integer_each(o, sizeof o, mpz_init);
    for (int i = 0; i < 3; i++) {
        apply(own->matrix[i], work->m[0], work->n[i]);
        for (int j = 0; j < 3; j++) {
            add_transposed(other->matrix[j], work->n[i], work->c[0][i + j]);
            mpz_addmul(norm[i + j], own->norm[i], other->norm[j]);
        }
        for (int j = 0; j < 2; j++)
            add_dot(work->n[i], work->difference[j], o[i + j]);
    }
    raise_degree(work->c[0]);
    for (int k = 5; k > 0; k--)
        mpz_add(norm[k], norm[k], norm[k - 1]);
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 4; i++)
            if (k >= i && k - i < 3)
                mpz_addmul(work->value[k], o[i], other->norm[k - i]);
    for (int k = 0; k < 6; k++) {
        constant =
            add_least(exact, f, work->m[0], f == 0 ? -1 : 1, norm[k], bits, work, work->value[k]);
        add_least(exact, !f, work->c[0][k], f == 0 ? 1 : -1, NULL, bits, work, work->value[k]);
    }
    integer_each(norm, sizeof norm, mpz_clear);
    integer_each(o, sizeof o, mpz_clear);
    return !constant;
}

/* Sets the polynomial of a product of edges. Returns whether the product is certainly never 0. */
static bool set_product(const struct turn_exact *exact, mp_bitcnt_t bits, struct work *work)
{
    vector edge[2][3];
    bool never_zero = false;
    integer_each(edge, sizeof edge, mpz_init);
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < 3; i++)
            apply(work->of[f].matrix[i], work->m[f], edge[f][i]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            integer_cross(work->part, edge[0][i], edge[1][j], work->scratch);
            for (int axis = 0; axis < 3; axis++)
                mpz_add(work->n[i + j][axis], work->n[i + j][axis], work->part[axis]);
            add_transposed(work->of[1].matrix[j], edge[0][i], work->c[0][i + j]);
            add_transposed(work->of[0].matrix[i], edge[1][j], work->c[1][i + j]);
        }
    for (int axis = 0; axis < 3; axis++) {
        int signs = 0;
        for (int k = 0; k < 5; k++)
            signs += mpz_sgn(work->n[k][axis]);
        never_zero = never_zero || signs == 5 || signs == -5;
    }
    for (int k = 0; k < 6; k++)
        for (int j = 0; j < 2; j++)
            if (k >= j && k - j < 5)
                add_dot(work->n[k - j], work->difference[j], work->value[k]);
    for (int f = 0; f < 2; f++) {
        raise_degree(work->c[f]);
        for (int k = 0; k < 6; k++) {
            integer_cross(work->part, work->c[f][k], work->m[!f], work->scratch);
            add_least(exact, !f, work->part, 1, NULL, bits, work, work->value[k]);
        }
    }
    integer_each(edge, sizeof edge, mpz_clear);
    return never_zero;
}

enum turn_outcome turn_exact_outcome(const struct turn_exact *exact,
                                     const struct turn_corners *corners, int sign, double lo,
                                     double hi)
{
    const struct support_view *view = exact->path->pair.view;
    struct work work;
    enum turn_outcome outcome = TURN_OPEN;
    integer_each(&work, sizeof work, mpz_init);
    if (set_direction(exact, corners, sign, &work)) {
        const mp_bitcnt_t bits = set_interval(exact, lo, hi, &work);
        const bool fixed = corners->of < 2;
        const bool splits =
            fixed ? set_fixed(exact, corners->of, bits, &work) : set_product(exact, bits, &work);
        const bool solid = view[0].solid || view[1].solid;
        int positive = 0, negative = 0;
        for (int k = 0; k < 6; k++) {
            positive += mpz_sgn(work.value[k]) > 0;
            negative += mpz_sgn(work.value[k]) < 0;
        }
        const bool weak = negative == 0 && (fixed ? splits || solid : splits && solid);
        if (positive == 6)
            outcome = TURN_APART;
        else if (weak)
            outcome = positive > 0 ? TURN_CLEAN : TURN_REST;
    }
    integer_each(&work, sizeof work, mpz_clear);
    return outcome;
}
