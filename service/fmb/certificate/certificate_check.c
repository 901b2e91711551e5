/* Checks certificates. It uses the definitions of fmb.h and rational numbers only. It shares no
 * code and no method with what it checks: no integers times a unit, no slabs, no polytope of the
 * intersection.
 *
 * A normal N. N . (b - a) is affine in the time and in each of the points a and b. Over the window
 * its least value is therefore at an end of the window, at a vertex of each frame. Call that value
 * g.
 *
 *   g > 0: the frames are separated at all times. SEPARATED.
 *   g >= 0, and N not constant on, say, the first frame: no point is ever in both relative
 *   interiors. For N . a is linear and not constant there, so at a point a of the relative interior
 *   it is less than its greatest value N . a'. Hence N . b >= N . a' > N . a for all b of the
 *   second frame at that time, so that no b equals a. Together with a point that both frames have
 *   in common at a time of the window: TOUCHING.
 *
 * A point p. The frame is the image of its parameters under the map x -> o + t v + sum x_i c_i. Its
 * relative interior is the image of those strictly inside their bounds (Rockafellar, Convex
 * Analysis, theorem 6.6; a frame may be flat). The check is therefore whether
 *
 *     sum_i x_i c_i = p - o - t v,   0 < x_i < 1   or   0 < x_i, sum x_i < 1
 *
 * has a solution, with <= in place of < for the closed frame. Gaussian elimination removes one
 * unknown for each independent equation, Fourier's method the others; what remains are comparisons
 * of numbers with 0. */
#include "certificate_check.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gmp.h>

enum {
    UNKNOWNS = 3,
    COLUMNS = UNKNOWNS + 1,
    EDGES_MAX = 6,
    ROWS_MAX = 20 /* has_point() */
};

struct side {
    int count; /* of components */
    bool simplex;
    int edges;
    mpq_t edge[EDGES_MAX][AXES]; /* components, then their differences, in the order of fmb.h */
    mpq_t origin[AXES], velocity[AXES];
};

/* The pair, and the contents of the text. */
struct proof {
    int dim;
    bool moving;
    mpq_t duration;
    struct side side[2];
    mpq_t v[AXES], d[AXES], z[AXES];
    mpq_t normal[AXES];
    mpq_t time, point[AXES];
};

/* ---- Vectors ---- */

void check_each_axis(mpq_t vector[AXES], void (*call)(mpq_ptr))
{
    for (int axis = 0; axis < AXES; axis++)
        call(vector[axis]);
}

void check_copy(mpq_t out[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_set(out[axis], v[axis]);
}

void check_set(mpq_t out[AXES], int dim, const double *v)
{
    for (int axis = 0; axis < dim; axis++)
        mpq_set_d(out[axis], v[axis]);
}

void check_subtract(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_sub(out[axis], u[axis], v[axis]);
}

void check_add_multiple(mpq_t *out, const mpq_t factor, mpq_t *v, int numbers)
{
    mpq_t product;
    mpq_init(product);
    for (int i = 0; i < numbers; i++) {
        mpq_mul(product, factor, v[i]);
        mpq_add(out[i], out[i], product);
    }
    mpq_clear(product);
}

void check_dot(mpq_t out, mpq_t u[AXES], mpq_t v[AXES])
{
    mpq_t product;
    mpq_init(product);
    mpq_set_ui(out, 0, 1);
    for (int axis = 0; axis < AXES; axis++) {
        mpq_mul(product, u[axis], v[axis]);
        mpq_add(out, out, product);
    }
    mpq_clear(product);
}

/* out is neither u nor v. */
static void cross(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES])
{
    mpq_t product;
    mpq_init(product);
    for (int i = 0; i < AXES; i++) {
        int j = (i + 1) % AXES, k = (i + 2) % AXES;
        mpq_mul(out[i], u[j], v[k]);
        mpq_mul(product, u[k], v[j]);
        mpq_sub(out[i], out[i], product);
    }
    mpq_clear(product);
}

/* ---- The pair ---- */

/* Calls one of mpq_init and mpq_clear for every number. */
static void proof_each(struct proof *proof, void (*call)(mpq_ptr))
{
    for (int f = 0; f < 2; f++) {
        for (int e = 0; e < EDGES_MAX; e++)
            check_each_axis(proof->side[f].edge[e], call);
        check_each_axis(proof->side[f].origin, call);
        check_each_axis(proof->side[f].velocity, call);
    }
    check_each_axis(proof->v, call);
    check_each_axis(proof->d, call);
    check_each_axis(proof->z, call);
    check_each_axis(proof->normal, call);
    check_each_axis(proof->point, call);
    call(proof->time);
    call(proof->duration);
}

/* v := R(q) v, as fmb.h defines it, with the plane of 2D in space. */
void check_turn(const struct fmb_placement *placement, mpq_t v[AXES])
{
    mpq_t q[4], norm, along, product, cross_of_v[AXES], out[AXES];
    mpq_inits(q[0], q[1], q[2], q[3], norm, along, product, NULL);
    check_each_axis(cross_of_v, mpq_init);
    check_each_axis(out, mpq_init);
    mpq_set_d(q[0], placement->orientation[0]);
    for (int i = 1; i < placement->orientation_count; i++)
        mpq_set_d(q[placement->orientation_count == 2 ? 3 : i], placement->orientation[i]);

    /* With r = (x, y, z): n R v = (ww - r.r) v + 2 (r.v) r + 2 w (r x v), n = ww + r.r. */
    check_dot(norm, q + 1, q + 1);
    check_dot(along, q + 1, v);
    cross(cross_of_v, q + 1, v);
    mpq_mul(product, q[0], q[0]);
    mpq_sub(product, product, norm);
    check_add_multiple(out, product, v, AXES);
    mpq_add(along, along, along);
    check_add_multiple(out, along, q + 1, AXES);
    mpq_add(along, q[0], q[0]);
    check_add_multiple(out, along, cross_of_v, AXES);
    mpq_mul(product, q[0], q[0]);
    mpq_add(norm, norm, product);
    for (int axis = 0; axis < AXES; axis++)
        mpq_div(v[axis], out[axis], norm);

    check_each_axis(out, mpq_clear);
    check_each_axis(cross_of_v, mpq_clear);
    mpq_clears(q[0], q[1], q[2], q[3], norm, along, product, NULL);
}

/* Components and origin, in body coordinates. */
static void set_frame(struct side *side, const struct fmb_frame *frame)
{
    mpq_t number;
    mpq_init(number);
    side->count = frame->count;
    side->simplex = frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
    for (int axis = 0; axis < frame->dim; axis++) {
        for (int i = 0; i < frame->count; i++) {
            mpq_set_d(side->edge[i][axis], frame->component[i][axis]);
            mpq_set_d(number, frame->remainder[i][axis]);
            mpq_add(side->edge[i][axis], side->edge[i][axis], number);
        }
        if (frame->shape != FMB_BOX) {
            mpq_set_d(side->origin[axis], frame->origin[axis]);
            continue;
        }
        mpq_div_2exp(number, side->edge[axis][axis],
                     1); /* the origin may be infinite as a double */
        mpq_set_d(side->origin[axis], frame->centre[axis]);
        mpq_sub(side->origin[axis], side->origin[axis], number);
    }
    mpq_clear(number);
}

static void set_side(struct side *side, const struct fmb_placement *placement)
{
    mpq_t position;
    mpq_init(position);
    set_frame(side, fmb_body_frame(placement->body, 0));
    if (placement->orientation_count > 0) {
        check_turn(placement, side->origin);
        for (int i = 0; i < side->count; i++)
            check_turn(placement, side->edge[i]);
    }
    for (int axis = 0; axis < placement->body->dim; axis++) {
        mpq_set_d(position, placement->position[axis]);
        mpq_add(side->origin[axis], side->origin[axis], position);
        mpq_set_d(side->velocity[axis], placement->velocity[axis]);
    }
    side->edges = side->count;
    for (int i = 0; side->simplex && i < side->count; i++)
        for (int j = i + 1; j < side->count; j++)
            check_subtract(side->edge[side->edges++], side->edge[j], side->edge[i]);
    mpq_clear(position);
}

static bool is_zero_vector(mpq_t v[AXES])
{
    return mpq_sgn(v[0]) == 0 && mpq_sgn(v[1]) == 0 && mpq_sgn(v[2]) == 0;
}

static void set_pair(struct proof *proof, const struct fmb_placement *a,
                     const struct fmb_placement *b, double duration)
{
    proof->dim = a->body->dim;
    mpq_set_d(proof->duration, duration);
    set_side(&proof->side[0], a);
    set_side(&proof->side[1], b);
    proof->moving =
        !is_zero_vector(proof->side[0].velocity) || !is_zero_vector(proof->side[1].velocity);
    check_subtract(proof->v, proof->side[1].velocity, proof->side[0].velocity);
    check_subtract(proof->d, proof->side[1].origin, proof->side[0].origin);
    mpq_set_ui(proof->z[2], 1, 1);
}

/* ---- The text ----
 *
 * Each of these takes something from the beginning of *at, and returns false if that does not
 * begin so; *at is then somewhere within the text. */

bool check_take(const char **at, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(*at, word, length) != 0)
        return false;
    *at += length;
    return true;
}

bool check_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* A natural number without leading zeros. */
bool check_take_digits(const char **at, mpz_t out)
{
    enum { DIGITS_AT_ONCE = 18 }; /* 10^18 < 2^63 */
    mpz_set_ui(out, 0);
    if (check_take(at, "0")) /* a digit after it is nothing that can follow a number */
        return true;
    if (!check_is_digit(**at))
        return false;
    while (check_is_digit(**at)) {
        unsigned long digits = 0, power = 1;
        for (int i = 0; i < DIGITS_AT_ONCE && check_is_digit(**at); i++) {
            digits = digits * 10 + (unsigned long) (*(*at)++ - '0');
            power *= 10;
        }
        mpz_mul_ui(out, out, power);
        mpz_add_ui(out, out, digits);
    }
    return true;
}

/* "/DEN", or nothing for 1. */
static bool take_denominator(const char **at, mpz_t out)
{
    mpz_set_ui(out, 1);
    return !check_take(at, "/") || (check_take_digits(at, out) && mpz_cmp_ui(out, 1) > 0);
}

static bool in_lowest_terms(const mpq_t x)
{
    mpz_t divisor;
    mpz_init(divisor);
    mpz_gcd(divisor, mpq_numref(x), mpq_denref(x));
    bool lowest = mpz_cmp_ui(divisor, 1) == 0;
    mpz_clear(divisor);
    return lowest;
}

bool check_take_number(const char **at, mpq_t out)
{
    bool negative = check_take(at, "-");
    if (!check_take_digits(at, mpq_numref(out)) || (negative && mpq_sgn(out) == 0))
        return false;
    if (negative)
        mpq_neg(out, out);
    return take_denominator(at, mpq_denref(out)) && in_lowest_terms(out);
}

bool check_take_point(const char **at, int dim, mpq_t out[AXES])
{
    for (int axis = 0; axis < dim; axis++)
        if (!check_take(at, axis == 0 ? " (" : " ") || !check_take_number(at, out[axis]))
            return false;
    return check_take(at, ")");
}

/* The vector that has this name in this pair; NULL: none has. */
static mpq_t *take_vector(const char **at, struct proof *proof)
{
    if (check_take(at, "v"))
        return proof->v;
    if (check_take(at, "d"))
        return proof->d;
    if (proof->dim == 2 && check_take(at, "z"))
        return proof->z;
    struct side *side = check_take(at, "a")   ? &proof->side[0]
                        : check_take(at, "b") ? &proof->side[1]
                                              : NULL;
    if (!side || !check_is_digit(**at) || **at - '0' >= side->edges)
        return NULL;
    return side->edge[*(*at)++ - '0'];
}

/* "U x V": out := their product. */
static bool take_product(const char **at, struct proof *proof, mpq_t out[AXES])
{
    mpq_t *u = take_vector(at, proof);
    mpq_t *v = u && check_take(at, " x ") ? take_vector(at, proof) : NULL;
    if (!v)
        return false;
    cross(out, u, v);
    return true;
}

/* "(U x V) x W". */
static bool take_double_product(const char **at, struct proof *proof, mpq_t out[AXES])
{
    mpq_t product[AXES], *w = NULL;
    check_each_axis(product, mpq_init);
    if (check_take(at, "(") && take_product(at, proof, product) && check_take(at, ") x "))
        w = take_vector(at, proof);
    if (w)
        cross(out, product, w);
    check_each_axis(product, mpq_clear);
    return w;
}

static bool take_direction(const char **at, struct proof *proof, mpq_t out[AXES])
{
    if (**at == '(')
        return take_double_product(at, proof, out);
    const char *ahead = *at;
    mpq_t *u = take_vector(&ahead, proof);
    if (!u)
        return false;
    if (*ahead == ' ' && ahead[1] == 'x')
        return take_product(at, proof, out);
    check_copy(out, u);
    *at = ahead;
    return true;
}

static bool take_normal(const char **at, struct proof *proof)
{
    bool negative = check_take(at, " - ");
    if (!negative && !check_take(at, " + "))
        return false;
    if (!take_direction(at, proof, proof->normal))
        return false;
    for (int axis = 0; negative && axis < AXES; axis++)
        mpq_neg(proof->normal[axis], proof->normal[axis]);
    return true;
}

/* The functions that find flaws return what is wrong, or NULL. */
static const char *flaw_of_text(struct proof *proof, enum fmb_verdict verdict, const char *text)
{
    const char *at = text, *name = fmb_verdict_name(verdict);
    if (!name || !check_take(&at, name))
        return "the text does not begin with the verdict";
    if (verdict != FMB_OVERLAPPING && !take_normal(&at, proof))
        return "the verdict is not followed by a normal of this pair";
    if (verdict != FMB_SEPARATED) {
        if (!check_take(&at, " at ") || !check_take_number(&at, proof->time))
            return "there is no time in lowest terms where it is due";
        if (!check_take_point(&at, proof->dim, proof->point))
            return "the time is not followed by a point of this dimension in lowest terms";
    }
    return *at == '\0' ? NULL : "something follows the certificate";
}

/* ---- The normal ---- */

/* [low, high] := the values of the normal over the frame with its origin at 0. A vertex of a
 * cuboid is the sum of the components whose bits are set in its number; of a simplex, the origin
 * or the end of a component. */
static void set_range(struct side *side, mpq_t normal[AXES], mpq_t low, mpq_t high)
{
    int vertices = side->simplex ? side->count + 1 : 1 << side->count;
    mpq_t value, part;
    mpq_inits(value, part, NULL);
    mpq_set_ui(low, 0, 1); /* vertex 0 */
    mpq_set_ui(high, 0, 1);
    for (int vertex = 1; vertex < vertices; vertex++) {
        mpq_set_ui(value, 0, 1);
        for (int i = 0; i < side->count; i++)
            if (side->simplex ? vertex == i + 1 : vertex >> i & 1) {
                check_dot(part, normal, side->edge[i]);
                mpq_add(value, value, part);
            }
        if (mpq_cmp(value, low) < 0)
            mpq_set(low, value);
        if (mpq_cmp(value, high) > 0)
            mpq_set(high, value);
    }
    mpq_clears(value, part, NULL);
}

/* The least N . (b - a): at the beginning of the window it is low_b - high_a + N . d, and N . v T
 * is what it grows by until its end. */
static void set_gap(struct proof *proof, const mpq_t low_b, const mpq_t high_a, mpq_t gap)
{
    mpq_t part;
    mpq_init(part);
    mpq_sub(gap, low_b, high_a);
    check_dot(part, proof->normal, proof->d);
    mpq_add(gap, gap, part);
    check_dot(part, proof->normal, proof->v);
    mpq_mul(part, part, proof->duration);
    if (mpq_sgn(part) < 0)
        mpq_add(gap, gap, part);
    mpq_clear(part);
}

static const char *flaw_of_normal(struct proof *proof, enum fmb_verdict verdict)
{
    mpq_t low[2], high[2], gap;
    mpq_inits(low[0], low[1], high[0], high[1], gap, NULL);
    for (int f = 0; f < 2; f++)
        set_range(&proof->side[f], proof->normal, low[f], high[f]);
    bool constant = mpq_equal(low[0], high[0]) && mpq_equal(low[1], high[1]);
    set_gap(proof, low[1], high[0], gap);
    int sign = mpq_sgn(gap);
    mpq_clears(low[0], low[1], high[0], high[1], gap, NULL);

    if (verdict == FMB_SEPARATED)
        return sign > 0 ? NULL : "the normal does not hold the frames apart all the time";
    if (sign < 0)
        return "the normal does not keep the frames on its two sides all the time";
    return constant ? "the normal is constant on both frames" : NULL;
}

/* ---- The point ---- */

/* Rows stand for row[0..2] . x + row[3]: an equation for = 0, the others for > 0, or >= 0 if not
 * strict. */
struct rows {
    bool strict;
    mpq_t equation[AXES][COLUMNS];
    int count;
    mpq_t row[ROWS_MAX][COLUMNS];
    mpq_t next[ROWS_MAX][COLUMNS]; /* the list in the making */
};

static void row_each(mpq_t row[COLUMNS], void (*call)(mpq_ptr))
{
    for (int i = 0; i < COLUMNS; i++)
        call(row[i]);
}

static void rows_each(struct rows *rows, void (*call)(mpq_ptr))
{
    for (int axis = 0; axis < AXES; axis++)
        row_each(rows->equation[axis], call);
    for (int r = 0; r < ROWS_MAX; r++) {
        row_each(rows->row[r], call);
        row_each(rows->next[r], call);
    }
}

/* x_i > 0; and 1 - x_i > 0, or once 1 - sum x_i > 0. */
static void set_bounds(struct rows *rows, const struct side *side)
{
    for (int i = 0; i < side->count; i++)
        mpq_set_ui(rows->row[rows->count++][i], 1, 1);
    int upper = side->simplex ? 1 : side->count;
    for (int r = 0; r < upper; r++, rows->count++) {
        mpq_set_ui(rows->row[rows->count][UNKNOWNS], 1, 1);
        for (int i = 0; i < side->count; i++)
            if (side->simplex || i == r)
                mpq_set_si(rows->row[rows->count][i], -1, 1);
    }
}

/* sum x_i c_i + o + t v - p = 0 along each axis. */
static void set_equations(struct rows *rows, struct proof *proof, struct side *side)
{
    for (int axis = 0; axis < AXES; axis++) {
        mpq_t *equation = rows->equation[axis];
        for (int i = 0; i < side->count; i++)
            mpq_set(equation[i], side->edge[i][axis]);
        mpq_mul(equation[UNKNOWNS], proof->time, side->velocity[axis]);
        mpq_add(equation[UNKNOWNS], equation[UNKNOWNS], side->origin[axis]);
        mpq_sub(equation[UNKNOWNS], equation[UNKNOWNS], proof->point[axis]);
    }
}

/* row := row + the multiple of the equation that takes unknown k away. */
static void substitute(mpq_t row[COLUMNS], mpq_t equation[COLUMNS], int k)
{
    mpq_t factor;
    mpq_init(factor);
    if (mpq_sgn(row[k]) != 0) {
        mpq_div(factor, row[k], equation[k]);
        mpq_neg(factor, factor);
        check_add_multiple(row, factor, equation, COLUMNS);
    }
    mpq_clear(factor);
}

/* Solves equation e for an unknown, which leaves all that come after it. An equation without
 * unknowns has to hold as it is. */
static bool use_equation(struct rows *rows, int e)
{
    int k = 0;
    while (k < UNKNOWNS && mpq_sgn(rows->equation[e][k]) == 0)
        k++;
    if (k == UNKNOWNS)
        return mpq_sgn(rows->equation[e][UNKNOWNS]) == 0;
    for (int other = e + 1; other < AXES; other++)
        substitute(rows->equation[other], rows->equation[e], k);
    for (int r = 0; r < rows->count; r++)
        substitute(rows->row[r], rows->equation[e], k);
    return true;
}

/* The sum of a row with a positive and one with a negative coefficient of unknown k, each times
 * the size of the other's: the unknown is gone. */
static void combine(mpq_t out[COLUMNS], mpq_t positive[COLUMNS], mpq_t negative[COLUMNS], int k)
{
    mpq_t size;
    mpq_init(size);
    mpq_neg(size, negative[k]);
    for (int i = 0; i < COLUMNS; i++)
        mpq_set_ui(out[i], 0, 1);
    check_add_multiple(out, size, positive, COLUMNS);
    check_add_multiple(out, positive[k], negative, COLUMNS);
    mpq_clear(size);
}

static mpq_t *next_row(struct rows *rows, int *count)
{
    assert(*count < ROWS_MAX);
    return rows->next[(*count)++];
}

/* Fourier: there is an x_k for the other unknowns if and only if each lower bound of it is below
 * each upper one. */
static void eliminate(struct rows *rows, int k)
{
    int count = 0;
    for (int p = 0; p < rows->count; p++) {
        int sign = mpq_sgn(rows->row[p][k]);
        if (sign == 0) {
            mpq_t *kept = next_row(rows, &count);
            for (int i = 0; i < COLUMNS; i++)
                mpq_set(kept[i], rows->row[p][i]);
        }
        for (int n = 0; sign > 0 && n < rows->count; n++)
            if (mpq_sgn(rows->row[n][k]) < 0)
                combine(next_row(rows, &count), rows->row[p], rows->row[n], k);
    }
    for (int r = 0; r < count; r++)
        for (int i = 0; i < COLUMNS; i++)
            mpq_swap(rows->row[r][i], rows->next[r][i]);
    rows->count = count;
}

static bool all_hold(const struct rows *rows)
{
    for (int r = 0; r < rows->count; r++) {
        int sign = mpq_sgn(rows->row[r][UNKNOWNS]);
        if (sign < 0 || (rows->strict && sign == 0))
            return false;
    }
    return true;
}

/* Whether the frame has the point at the time; if strict, its relative interior.
 *
 * There are at most 6 rows to begin with. Eliminating one unknown makes at most 3 x 3 = 9 of them,
 * a second one at most 4 x 5 = 20. A third one is left only if all components are 0; then the rows
 * are still the bounds, and get fewer each time. */
static bool has_point(struct proof *proof, struct side *side, bool strict)
{
    struct rows rows = {.strict = strict};
    rows_each(&rows, mpq_init);
    set_bounds(&rows, side);
    set_equations(&rows, proof, side);
    bool has = true;
    for (int axis = 0; has && axis < AXES; axis++)
        has = use_equation(&rows, axis);
    for (int k = 0; has && k < UNKNOWNS; k++)
        eliminate(&rows, k);
    has = has && all_hold(&rows);
    rows_each(&rows, mpq_clear);
    return has;
}

static const char *flaw_of_point(struct proof *proof, enum fmb_verdict verdict)
{
    static const char *const flaws[2][2] = {
        {"the point is not in the first frame", "the point is not in the second frame"},
        {"the point is not in the relative interior of the first frame",
         "the point is not in the relative interior of the second frame"}};
    const bool strict = verdict == FMB_OVERLAPPING;
    if (mpq_sgn(proof->time) < 0 || mpq_cmp(proof->time, proof->duration) > 0)
        return "the time is not in the window";
    if (!proof->moving && mpq_sgn(proof->time) != 0)
        return "the time of a static pair is not 0";
    for (int f = 0; f < 2; f++)
        if (!has_point(proof, &proof->side[f], strict))
            return flaws[strict][f];
    return NULL;
}

static const char *flaw_of(struct proof *proof, enum fmb_verdict verdict, const char *text)
{
    const char *flaw = flaw_of_text(proof, verdict, text);
    if (!flaw && verdict != FMB_OVERLAPPING)
        flaw = flaw_of_normal(proof, verdict);
    if (!flaw && verdict != FMB_SEPARATED)
        flaw = flaw_of_point(proof, verdict);
    return flaw;
}

/* Returns NULL, or the reason why there can be no certificate. */
static const char *flaw_of_placements(const struct fmb_placement *a, const struct fmb_placement *b,
                                      double duration)
{
    enum fmb_status status = fmb_placement_check(a);
    if (status == FMB_OK)
        status = fmb_placement_check(b);
    if (status != FMB_OK)
        return fmb_status_text(status);
    if (a->body->dim != b->body->dim)
        return fmb_status_text(FMB_DIMENSIONS_DIFFER);
    if (!(duration >= 0 && isfinite(duration)))
        return fmb_status_text(FMB_BAD_DURATION);
    if (a->body->frame_count > 1 || b->body->frame_count > 1)
        return "a body of several frames has no certificate";
    return NULL;
}

bool fmb_certificate_holds(const struct fmb_placement *a, const struct fmb_placement *b,
                           double duration, enum fmb_verdict verdict, const char *text, char *why,
                           size_t size)
{
    const char *flaw = flaw_of_placements(a, b, duration);
    if (!flaw && (fmb_body_frame(a->body, 0)->shape == FMB_HULL ||
                  fmb_body_frame(b->body, 0)->shape == FMB_HULL)) {
        flaw = check_hulls(a, b, duration, verdict, text);
    } else if (!flaw) {
        struct proof proof;
        proof_each(&proof, mpq_init);
        set_pair(&proof, a, b, duration);
        flaw = flaw_of(&proof, verdict, text);
        proof_each(&proof, mpq_clear);
    }
    if (size > 0)
        snprintf(why, size, "%s", flaw ? flaw : "");
    return !flaw;
}
