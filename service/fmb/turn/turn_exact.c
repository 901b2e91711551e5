/* The proof. Let p(a, b) be the polynomial of vertices a and b, which has the sign of n . (b - a),
 * with coefficients c_k(a, b). Each coefficient is least for some a and b. If all these least
 * coefficients are positive, the frames are apart on the closed interval. If none is negative,
 * n . (b - a) >= 0 at all times of the interval. If in addition one of them is positive, no p is
 * identically 0; then each p is positive inside the interval, where the frames are apart.
 *
 * If n . (b - a) >= 0 at some time, n is not 0 and n . x is not constant on one of the frames, then
 * the relative interior of that frame has no point with the greatest (least) n . x, and the two
 * relative interiors do not meet. n = N m is never 0. A product of edges is known not to be 0 if
 * all coefficients of one of its coordinates are of one sign. n . x is not constant on a solid
 * frame, nor on the frame in which n is fixed if m . x differs between two of its vertices.
 *
 * Radii: let R be their sum. The frames are apart where n . (b - a) > R |n|. If n = N m, the
 * factors of the polynomial make R |n| equal to R |m| |q_A|^2 |q_B|^2, whose coefficients are
 * subtracted. For a product of edges |n| is at most the polynomial whose coefficients are the
 * lengths of those of n; R times this polynomial is subtracted. R times a length that is not a
 * whole number of units is replaced by an upper bound that is too large by less than 2^-ROOT_BITS
 * of a unit. (Along a direction N m that needs one, the frames never rest on each other, since n .
 * (b - a) has rational coefficients.) Frames with a radius are solid. */
#include "turn_exact.h"

#include "integer.h"
#include "memory.h"
#include "programs.h"

#include <float.h>

enum { ROOT_BITS = 64 };

/* ---- Integers ---- */

void turn_exact_begin(const struct turn_path *path, struct turn_exact *out)
{
    const struct frame_pair *frames = path->pair.frames;
    const struct fmb_placement *const placed[2] = {frames->a.placement, frames->b.placement};
    mpz_t other[3];
    memset(out, 0, sizeof *out);
    out->path = path;
    support_integers_each(&out->integers, mpz_init);
    out->unit = support_integers_unit(frames);
    support_integers_bodies(frames, out->unit, &out->integers);
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
    integer_set_sum(out->radius, frames->a.frame->radius, frames->b.frame->radius, out->unit);
}

static void end_trial(struct turn_exact *exact);

void turn_exact_end(struct turn_exact *exact)
{
    if (exact->trial)
        end_trial(exact);
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
    vector difference[2], m[2], n[6], c[2][6], part, x, vertex;
    mpz_t norm[6], value[6], least, scratch, other;
};

/* A direction over an interval, in progress. */
struct turn_trial {
    struct work work;
    int of;               /* as in struct turn_corners */
    mp_bitcnt_t bits;     /* lengths are scaled by 2^bits */
    bool splits;          /* n . x is not constant on the frame of n, or a product is never 0 */
    unsigned scan, scans; /* the current scan; the number of scans, 0 if the direction is 0 */
    int f, way;           /* of the current scan: the frame; 1 to minimize, -1 to maximize */
    unsigned next, count; /* of the listed vertices: the next index; their number */
    bool constant;        /* x . v is the same for all vertices so far */
    uint16_t listed[FMB_HULL_VERTICES_MAX];
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

void turn_exact_take(struct turn_exact *exact, const struct programs_proof *proof)
{
    mpz_t divisor;
    mpz_init(divisor);
    for (int f = 0; f < 2; f++) {
        const struct support_turn *turn = &proof->integers->side[f].turn;
        mpz_t *m = exact->nearest[f];
        for (int j = 0; j < 3; j++) {
            mpz_set(m[j], proof->normal[j]);
            for (int i = 0; i < 3 && turn->turned; i++)
                (i == 0 ? mpz_mul : mpz_addmul)(m[j], turn->row[i][j], proof->normal[i]);
        }
        mpz_gcd(divisor, m[0], m[1]);
        mpz_gcd(divisor, divisor, m[2]);
        for (int j = 0; j < 3 && mpz_sgn(divisor) != 0; j++)
            mpz_divexact(m[j], m[j], divisor);
    }
    mpz_clear(divisor);
}

/* Sets m, or e and f. Returns false if one of them is 0. */
static bool set_direction(const struct turn_exact *exact, const struct turn_corners *corners,
                          int sign, struct work *work)
{
    const uint16_t *v = corners->vertex;
    if (v[0] >= TURN_ROUNDED) {
        size_t bits = DBL_MANT_DIG;
        for (int axis = 0; axis < 3; axis++) {
            mpz_set(work->m[0][axis], exact->nearest[corners->of][axis]);
            if (mpz_sizeinbase(work->m[0][axis], 2) > bits)
                bits = mpz_sizeinbase(work->m[0][axis], 2);
        }
        for (int axis = 0; axis < 3 && v[0] == TURN_ROUNDED; axis++)
            mpz_tdiv_q_2exp(work->m[0][axis], work->m[0][axis], bits - DBL_MANT_DIG);
    } else if (corners->of == 2) {
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

/* Sets the coefficients for a direction fixed in frame f, without the terms of the vertices. */
static void begin_fixed(struct turn_trial *trial, int f)
{
    struct work *work = &trial->work;
    struct quadratic *own = &work->of[f], *other = &work->of[!f];
    mpz_t o[4];
    integer_each(o, sizeof o, mpz_init);
    for (int i = 0; i < 3; i++) {
        apply(own->matrix[i], work->m[0], work->n[i]);
        for (int j = 0; j < 3; j++) {
            add_transposed(other->matrix[j], work->n[i], work->c[0][i + j]);
            mpz_addmul(work->norm[i + j], own->norm[i], other->norm[j]);
        }
        for (int j = 0; j < 2; j++)
            add_dot(work->n[i], work->difference[j], o[i + j]);
    }
    raise_degree(work->c[0]);
    for (int k = 5; k > 0; k--)
        mpz_add(work->norm[k], work->norm[k], work->norm[k - 1]);
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 4; i++)
            if (k >= i && k - i < 3)
                mpz_addmul(work->value[k], o[i], other->norm[k - i]);
    integer_each(o, sizeof o, mpz_clear);
}

/* The same for a product of edges. */
static void begin_product(struct turn_trial *trial)
{
    struct work *work = &trial->work;
    vector edge[2][3];
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
        trial->splits = trial->splits || signs == 5 || signs == -5;
    }
    for (int k = 0; k < 6; k++)
        for (int j = 0; j < 2; j++)
            if (k >= j && k - j < 5)
                add_dot(work->n[k - j], work->difference[j], work->value[k]);
    for (int f = 0; f < 2; f++)
        raise_degree(work->c[f]);
    integer_each(edge, sizeof edge, mpz_clear);
}

void turn_exact_try(struct turn_exact *exact, const struct turn_corners *corners, int sign,
                    double lo, double hi)
{
    struct turn_trial *trial = memory_allocate(sizeof *trial);
    struct work *work = &trial->work;
    integer_each(work, sizeof *work, mpz_init);
    exact->trial = trial;
    exact->lo = lo;
    exact->hi = hi;
    trial->of = corners->of;
    trial->splits = false;
    trial->scan = trial->scans = trial->next = 0;
    if (!set_direction(exact, corners, sign, work))
        return;
    trial->bits = set_interval(exact, lo, hi, work);
    trial->scans = corners->of < 2 ? 7 : 12;
    if (corners->of < 2)
        begin_fixed(trial, corners->of);
    else
        begin_product(trial);
}

/* ---- Supports ----
 *
 * The terms of the vertices are support values. Each is computed by a scan of one frame. For a
 * direction fixed in frame f, scan 0 computes the support of m over f, for all coefficients; scan
 * 1 + k computes the support of c_k over the other frame. For a product, scan k computes the
 * support of x_k x f over B, and scan 6 + k the support of y_k x e over A (turn_path.h). */

/* Returns the frame of the current scan. Sets x; the scan seeks the least x . v if *way > 0,
 * otherwise the greatest. */
static int begin_scan(struct turn_trial *trial, int *way)
{
    struct work *work = &trial->work;
    const int of = trial->of;
    const unsigned scan = trial->scan;
    *way = of == 2 || (of == 0) == (scan > 0) ? 1 : -1;
    if (of == 2) {
        integer_cross(work->x, work->c[scan / 6][scan % 6], work->m[scan < 6], work->scratch);
        return scan < 6;
    }
    for (int axis = 0; axis < 3; axis++)
        mpz_set(work->x[axis], scan == 0 ? work->m[0][axis] : work->c[0][scan - 1][axis]);
    return scan == 0 ? of : !of;
}

/* Lists the vertices that may have the least or greatest x . v. */
static void list_vertices(struct turn_trial *trial, const struct support_view *view)
{
    const unsigned count = view->vertices.count;
    double n[FMB_DIM_MAX];
    trial->count = count;
    if (count > SUPPORT_SMALL) {
        integer_round(trial->work.x, 3, n);
        for (int axis = 0; axis < FMB_DIM_MAX && trial->way > 0; axis++)
            n[axis] = -n[axis];
        trial->count = support_view_list(view, n, NULL, count, trial->listed);
    }
    for (unsigned i = 0; i < count && trial->count == count; i++)
        trial->listed[i] = (uint16_t) i;
    trial->constant = trial->count == count;
}

/* Adds the result of a scan to the coefficients. */
static void end_scan(struct turn_trial *trial)
{
    struct work *work = &trial->work;
    const bool fixed = trial->of < 2, all = fixed && trial->scan == 0;
    mpz_mul_2exp(work->least, work->least, trial->bits);
    for (unsigned k = 0; k < 6; k++) {
        if (!all && k != (trial->scan - fixed) % 6)
            continue;
        if (all)
            mpz_mul(work->scratch, work->least, work->norm[k]);
        else
            mpz_set(work->scratch, work->least);
        (trial->way > 0 ? mpz_add : mpz_sub)(work->value[k], work->value[k], work->scratch);
    }
    if (all)
        trial->splits = !trial->constant;
    trial->scan++;
    trial->next = 0;
}

/* Returns R |v| 2^(ROOT_BITS + bits), rounded up to a multiple of 2^bits. */
static mpz_srcptr radius_along(const struct turn_exact *exact, vector v)
{
    struct work *work = &exact->trial->work;
    mpz_ptr root = work->least, left = work->other;
    mpz_set_ui(root, 0);
    add_dot(v, v, root);
    mpz_mul(root, root, exact->radius);
    mpz_mul(root, root, exact->radius);
    mpz_mul_2exp(root, root, 2 * ROOT_BITS);
    mpz_sqrtrem(root, left, root);
    if (mpz_sgn(left) != 0)
        mpz_add_ui(root, root, 1);
    mpz_mul_2exp(root, root, exact->trial->bits);
    return root;
}

/* value := (value - R |n|) 2^ROOT_BITS, or less */
static void subtract_radius(const struct turn_exact *exact)
{
    struct work *work = &exact->trial->work;
    for (int k = 0; k < 6; k++)
        mpz_mul_2exp(work->value[k], work->value[k], ROOT_BITS);
    if (exact->trial->of < 2) {
        mpz_srcptr along = radius_along(exact, work->m[0]);
        for (int k = 0; k < 6; k++)
            mpz_submul(work->value[k], work->norm[k], along);
        return;
    }
    for (int k = 0; k < 5; k++) {
        mpz_srcptr along = radius_along(exact, work->n[k]);
        for (int raised = k; raised <= k + 1; raised++)
            mpz_sub(work->value[raised], work->value[raised], along);
    }
}

static enum turn_outcome outcome_of(const struct turn_exact *exact)
{
    const struct turn_trial *trial = exact->trial;
    const struct support_view *view = exact->path->pair.view;
    const bool rounded = mpz_sgn(exact->radius) != 0;
    const bool solid = view[0].solid || view[1].solid || rounded;
    const bool weak = trial->of < 2 ? trial->splits || solid : trial->splits && solid;
    int positive = 0, negative = 0;
    if (rounded && trial->scans > 0)
        subtract_radius(exact);
    for (int k = 0; k < 6; k++) {
        positive += mpz_sgn(trial->work.value[k]) > 0;
        negative += mpz_sgn(trial->work.value[k]) < 0;
    }
    if (positive == 6)
        return TURN_APART;
    if (trial->scans == 0 || negative > 0 || !weak)
        return TURN_OPEN;
    return positive > 0 ? TURN_CLEAN : TURN_REST;
}

static void end_trial(struct turn_exact *exact)
{
    integer_each(&exact->trial->work, sizeof exact->trial->work, mpz_clear);
    memory_release(exact->trial, sizeof *exact->trial);
    exact->trial = NULL;
}

/* The time to compute x . v, in nanoseconds: 300, plus 0.5 for each product of two limbs. */
static double cost_of(vector x, vector v)
{
    double products = 0;
    for (int axis = 0; axis < 3; axis++)
        products += (double) mpz_size(x[axis]) * (double) mpz_size(v[axis]);
    return 300 + 0.5 * products;
}

/* The limit on the cost of the values of a step, in nanoseconds. */
static const double step_cost = 3e5;

bool turn_exact_step(struct turn_exact *exact, enum turn_outcome *outcome)
{
    struct turn_trial *trial = exact->trial;
    struct work *work = &trial->work;
    double spent = 0;
    while (trial->scan < trial->scans) {
        if (trial->next == 0) {
            trial->f = begin_scan(trial, &trial->way);
            list_vertices(trial, &exact->path->pair.view[trial->f]);
        }
        for (; trial->next < trial->count; trial->next++) {
            support_integers_vertex(&exact->integers, trial->f, trial->listed[trial->next],
                                    work->vertex);
            mpz_set_ui(work->other, 0);
            add_dot(work->x, work->vertex, work->other);
            const int order =
                trial->next == 0 ? -1 : mpz_cmp(work->other, work->least) * trial->way;
            trial->constant = trial->constant && (trial->next == 0 || order == 0);
            if (order < 0)
                mpz_swap(work->least, work->other);
            spent += cost_of(work->x, work->vertex);
            if (spent > step_cost) {
                trial->next++;
                break;
            }
        }
        if (trial->next == trial->count)
            end_scan(trial);
        if (spent > step_cost)
            return false;
    }
    *outcome = outcome_of(exact);
    for (int k = 0; k < 6; k++)
        mpz_swap(exact->value[k], work->value[k]);
    end_trial(exact);
    return true;
}

/* The polynomial with the least coefficients is nowhere above the polynomial of any two vertices.
 * De Casteljau's subdivision at `at`, without divisions, gives its coefficients over the part. */
bool turn_exact_positive(const struct turn_exact *exact, double at, int late)
{
    static const unsigned long factor[6] = {10, 2, 1, 1, 2, 10}; /* 10 / C(5, k) */
    mpz_t b[6], weight[2];
    bool positive = true;
    integer_each(b, sizeof b, mpz_init);
    integer_each(weight, sizeof weight, mpz_init);
    integer_set_sum(weight[0], exact->hi, -at, -52);
    integer_set_sum(weight[1], at, -exact->lo, -52);
    for (int k = 0; k < 6; k++)
        mpz_mul_ui(b[k], exact->value[late ? 5 - k : k], factor[k]);
    for (int degree = 5; degree >= 0 && positive; degree--) {
        positive = mpz_sgn(b[0]) > 0;
        for (int k = 0; k < degree; k++) {
            mpz_mul(b[k], b[k], weight[late]);
            mpz_addmul(b[k], b[k + 1], weight[!late]);
        }
    }
    integer_each(b, sizeof b, mpz_clear);
    integer_each(weight, sizeof weight, mpz_clear);
    return positive;
}
