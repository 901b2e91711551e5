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
 * of numbers with 0. The point of a pair with a hull comes with weights of vertices instead:
 * certificate_check_weights.c. */
#include "certificate_check.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gmp.h>

enum {
    UNKNOWNS = 3,
    COLUMNS = UNKNOWNS + 1,
    ROWS_MAX = 20 /* has_point() */
};

/* ---- Vectors ---- */

void check_each(void *numbers, size_t bytes, void (*call)(mpq_ptr))
{
    mpq_ptr number = numbers;
    for (size_t i = 0; i < bytes / sizeof *number; i++)
        call(&number[i]);
}

void check_copy(mpq_t out[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_set(out[axis], v[axis]);
}

static void add(mpq_t out[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_add(out[axis], out[axis], v[axis]);
}

void check_add_numbers(mpq_t out[AXES], int dim, const double *v)
{
    mpq_t number;
    mpq_init(number);
    for (int axis = 0; axis < dim; axis++)
        if (v[axis] != 0) {
            mpq_set_d(number, v[axis]);
            mpq_add(out[axis], out[axis], number);
        }
    mpq_clear(number);
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

static void dot(mpq_t out, mpq_t u[AXES], mpq_t v[AXES])
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

/* Calls one of mpq_init and mpq_clear for every number, those of spans only of hulls. */
static void proof_each(struct check_proof *proof, void (*call)(mpq_ptr))
{
    for (int f = 0; f < 2; f++) {
        struct check_side *side = &proof->side[f];
        if (proof->hulls)
            check_each(side->span.vector, sizeof side->span.vector, call);
        check_each(side->origin, sizeof *side - offsetof(struct check_side, origin), call);
    }
    check_each(&proof->duration, sizeof *proof - offsetof(struct check_proof, duration), call);
}

void check_turn(const struct fmb_placement *placement, bool back, mpq_t v[AXES])
{
    const int count = placement->orientation_count;
    mpq_t q[4], norm, along, product, cross_of_v[AXES], out[AXES];
    if (count == 0)
        return;
    mpq_inits(q[0], q[1], q[2], q[3], norm, along, product, NULL);
    check_each(cross_of_v, sizeof cross_of_v, mpq_init);
    check_each(out, sizeof out, mpq_init);
    mpq_set_d(q[0], placement->orientation[0]);
    for (int i = 1; i < count; i++)
        mpq_set_d(q[count == 2 ? 3 : i],
                  back ? -placement->orientation[i] : placement->orientation[i]);

    /* With r = (x, y, z): n R v = (ww - r.r) v + 2 (r.v) r + 2 w (r x v), n = ww + r.r. */
    dot(norm, q + 1, q + 1);
    dot(along, q + 1, v);
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

    check_each(out, sizeof out, mpq_clear);
    check_each(cross_of_v, sizeof cross_of_v, mpq_clear);
    mpq_clears(q[0], q[1], q[2], q[3], norm, along, product, NULL);
}

/* Sets origin and components of a frame that is not a hull, in body coordinates. The origin of a
 * box is its centre less half of each component; it may be infinite as a double. */
static void set_frame(struct check_side *side)
{
    const struct fmb_frame *frame = side->frame;
    mpq_t half;
    mpq_init(half);
    side->count = frame->count;
    side->simplex = frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
    for (int i = 0; i < side->count; i++) {
        check_add_numbers(side->edge[i], frame->dim, frame->component[i]);
        check_add_numbers(side->edge[i], frame->dim, frame->remainder[i]);
    }
    check_add_numbers(side->origin, frame->dim,
                      frame->shape == FMB_BOX ? frame->centre : frame->origin);
    for (int i = 0; frame->shape == FMB_BOX && i < side->count; i++) {
        mpq_div_2exp(half, side->edge[i][i], 1);
        mpq_sub(side->origin[i], side->origin[i], half);
    }
    mpq_clear(half);
}

/* Moves a frame from body coordinates into the world. */
static void place_frame(struct check_side *side)
{
    check_turn(side->placement, false, side->origin);
    check_add_numbers(side->origin, side->frame->dim, side->placement->position);
    for (int i = 0; i < side->count; i++)
        check_turn(side->placement, false, side->edge[i]);
}

static void set_side(struct check_side *side, const struct fmb_placement *placement, bool hulls)
{
    side->placement = placement;
    side->frame = fmb_body_frame(placement->body, 0);
    check_add_numbers(side->velocity, side->frame->dim, placement->velocity);
    if (side->frame->shape != FMB_HULL)
        set_frame(side);
    if (!hulls)
        place_frame(side);
    side->edges = side->count;
    for (int i = 0; side->simplex && i < side->count; i++)
        for (int j = i + 1; j < side->count; j++)
            check_subtract(side->edge[side->edges++], side->edge[j], side->edge[i]);
}

static bool is_zero_vector(mpq_t v[AXES])
{
    return mpq_sgn(v[0]) == 0 && mpq_sgn(v[1]) == 0 && mpq_sgn(v[2]) == 0;
}

static void set_pair(struct check_proof *proof, const struct fmb_placement *a,
                     const struct fmb_placement *b, double duration)
{
    proof->dim = a->body->dim;
    mpq_set_d(proof->duration, duration);
    set_side(&proof->side[0], a, proof->hulls);
    set_side(&proof->side[1], b, proof->hulls);
    proof->moving =
        !is_zero_vector(proof->side[0].velocity) || !is_zero_vector(proof->side[1].velocity);
    check_subtract(proof->v, proof->side[1].velocity, proof->side[0].velocity);
    check_subtract(proof->d, proof->side[1].origin, proof->side[0].origin);
    mpq_set_ui(proof->z[2], 1, 1);
}

unsigned check_vertex_count(const struct check_side *side)
{
    return side->frame->shape == FMB_HULL ? side->frame->vertex_count
           : side->simplex                ? (unsigned) side->count + 1
                                          : 1U << side->count;
}

static bool has_component(const struct check_side *side, unsigned k, int i)
{
    return side->simplex ? k == (unsigned) i + 1 : k >> i & 1;
}

void check_vertex(struct check_side *side, unsigned k, mpq_t out[AXES])
{
    const struct fmb_frame *frame = side->frame;
    check_copy(out, side->origin);
    for (int axis = 0; frame->shape == FMB_HULL && axis < frame->dim; axis++)
        mpq_set_d(out[axis], frame->vertices[(size_t) axis * frame->vertex_stride + k]);
    for (int i = 0; i < side->count; i++)
        if (has_component(side, k, i))
            add(out, side->edge[i]);
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

static bool take_point(const char **at, int dim, mpq_t out[AXES])
{
    for (int axis = 0; axis < dim; axis++)
        if (!check_take(at, axis == 0 ? " (" : " ") || !check_take_number(at, out[axis]))
            return false;
    return check_take(at, ")");
}

/* The vector that has this name in this pair; NULL: none has. */
static mpq_t *take_vector(const char **at, struct check_proof *proof)
{
    if (check_take(at, "v"))
        return proof->v;
    if (check_take(at, "d"))
        return proof->d;
    if (proof->dim == 2 && check_take(at, "z"))
        return proof->z;
    struct check_side *side = check_take(at, "a")   ? &proof->side[0]
                              : check_take(at, "b") ? &proof->side[1]
                                                    : NULL;
    if (!side || !check_is_digit(**at) || **at - '0' >= side->edges)
        return NULL;
    return side->edge[*(*at)++ - '0'];
}

/* "U x V": out := their product. */
static bool take_product(const char **at, struct check_proof *proof, mpq_t out[AXES])
{
    mpq_t *u = take_vector(at, proof);
    mpq_t *v = u && check_take(at, " x ") ? take_vector(at, proof) : NULL;
    if (!v)
        return false;
    cross(out, u, v);
    return true;
}

/* "(U x V) x W". */
static bool take_double_product(const char **at, struct check_proof *proof, mpq_t out[AXES])
{
    mpq_t product[AXES], *w = NULL;
    check_each(product, sizeof product, mpq_init);
    if (check_take(at, "(") && take_product(at, proof, product) && check_take(at, ") x "))
        w = take_vector(at, proof);
    if (w)
        cross(out, product, w);
    check_each(product, sizeof product, mpq_clear);
    return w;
}

static bool take_direction(const char **at, struct check_proof *proof, mpq_t out[AXES])
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

/* " + DIRECTION", " - DIRECTION"; of hulls " normal (X Y Z)". */
static bool take_normal(const char **at, struct check_proof *proof)
{
    if (proof->hulls)
        return check_take(at, " normal") && take_point(at, proof->dim, proof->normal);
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
static const char *flaw_of_text(struct check_proof *proof, enum fmb_verdict verdict,
                                const char *text)
{
    const char *at = text, *name = fmb_verdict_name(verdict);
    if (!name || !check_take(&at, name))
        return "the text does not begin with the verdict";
    if (verdict != FMB_OVERLAPPING && !take_normal(&at, proof))
        return "the verdict is not followed by a normal of this pair";
    if (verdict != FMB_SEPARATED) {
        if (!check_take(&at, " at ") || !check_take_number(&at, proof->time))
            return "there is no time in lowest terms where it is due";
        if (!take_point(&at, proof->dim, proof->point))
            return "the time is not followed by a point of this dimension in lowest terms";
        if (proof->hulls && !check_take_weights(&at, proof))
            return "the point is not followed by weights of vertices of both frames";
    }
    return *at == '\0' ? NULL : "something follows the certificate";
}

/* ---- The normal ---- */

/* Adds N . position to the values of the normal over a frame in body coordinates. */
static void add_position(struct check_proof *proof, struct check_side *side)
{
    mpq_t position[AXES], value;
    mpq_init(value);
    check_each(position, sizeof position, mpq_init);
    check_add_numbers(position, proof->dim, side->placement->position);
    dot(value, proof->normal, position);
    mpq_add(side->low, side->low, value);
    mpq_add(side->high, side->high, value);
    check_each(position, sizeof position, mpq_clear);
    mpq_clear(value);
}

/* Sets the least and the greatest value of the normal N over a frame. N . R v is (R^-1 N) . v. The
 * value at a vertex that is a sum of vectors is the sum of their values. */
static void set_range(struct check_proof *proof, struct check_side *side)
{
    mpq_t normal[AXES], vertex[AXES], of_edge[AXES], of_origin, value;
    mpq_inits(of_origin, value, NULL);
    check_each(normal, sizeof normal, mpq_init);
    check_each(vertex, sizeof vertex, mpq_init);
    check_each(of_edge, sizeof of_edge, mpq_init);
    check_copy(normal, proof->normal);
    if (proof->hulls)
        check_turn(side->placement, true, normal);
    dot(of_origin, normal, side->origin);
    for (int i = 0; i < side->count; i++)
        dot(of_edge[i], normal, side->edge[i]);
    for (unsigned k = 0; k < check_vertex_count(side); k++) {
        if (side->frame->shape == FMB_HULL) {
            check_vertex(side, k, vertex);
            dot(value, normal, vertex);
        } else {
            mpq_set(value, of_origin);
        }
        for (int i = 0; i < side->count; i++)
            if (has_component(side, k, i))
                mpq_add(value, value, of_edge[i]);
        if (k == 0 || mpq_cmp(value, side->low) < 0)
            mpq_set(side->low, value);
        if (k == 0 || mpq_cmp(value, side->high) > 0)
            mpq_set(side->high, value);
    }
    if (proof->hulls)
        add_position(proof, side);
    check_each(of_edge, sizeof of_edge, mpq_clear);
    check_each(vertex, sizeof vertex, mpq_clear);
    check_each(normal, sizeof normal, mpq_clear);
    mpq_clears(of_origin, value, NULL);
}

/* The least N . (b - a): low_b - high_a at the beginning of the window; N . v T is what it grows by
 * until its end. */
static const char *flaw_of_normal(struct check_proof *proof, enum fmb_verdict verdict)
{
    struct check_side *a = &proof->side[0], *b = &proof->side[1];
    mpq_t gap, growth;
    mpq_inits(gap, growth, NULL);
    set_range(proof, a);
    set_range(proof, b);
    mpq_sub(gap, b->low, a->high);
    dot(growth, proof->normal, proof->v);
    mpq_mul(growth, growth, proof->duration);
    if (mpq_sgn(growth) < 0)
        mpq_add(gap, gap, growth);
    const int sign = mpq_sgn(gap);
    mpq_clears(gap, growth, NULL);

    if (verdict == FMB_SEPARATED)
        return sign > 0 ? NULL : "the normal does not hold the frames apart all the time";
    if (sign < 0)
        return "the normal does not keep the frames on its two sides all the time";
    return mpq_equal(a->low, a->high) && mpq_equal(b->low, b->high)
               ? "the normal is constant on both frames"
               : NULL;
}

/* ---- The point ---- */

/* Rows stand for row[0..2] . x + row[3]: an equation for = 0, the others for > 0, or >= 0 if not
 * strict. */
struct rows {
    bool strict;
    int count;
    mpq_t equation[AXES][COLUMNS];
    mpq_t row[ROWS_MAX][COLUMNS];
    mpq_t next[ROWS_MAX][COLUMNS]; /* the list in the making */
};

/* x_i > 0; and 1 - x_i > 0, or once 1 - sum x_i > 0. */
static void set_bounds(struct rows *rows, const struct check_side *side)
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
static void set_equations(struct rows *rows, struct check_proof *proof, struct check_side *side)
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
static bool has_point(struct check_proof *proof, struct check_side *side, bool strict)
{
    struct rows rows = {.strict = strict};
    check_each(rows.equation, sizeof rows - offsetof(struct rows, equation), mpq_init);
    set_bounds(&rows, side);
    set_equations(&rows, proof, side);
    bool has = true;
    for (int axis = 0; has && axis < AXES; axis++)
        has = use_equation(&rows, axis);
    for (int k = 0; has && k < UNKNOWNS; k++)
        eliminate(&rows, k);
    has = has && all_hold(&rows);
    check_each(rows.equation, sizeof rows - offsetof(struct rows, equation), mpq_clear);
    return has;
}

static const char *flaw_of_point(struct check_proof *proof, enum fmb_verdict verdict)
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
    for (int f = 0; f < 2 && !proof->hulls; f++)
        if (!has_point(proof, &proof->side[f], strict))
            return flaws[strict][f];
    return proof->hulls ? check_flaw_of_weights(proof, verdict) : NULL;
}

static const char *flaw_of(struct check_proof *proof, enum fmb_verdict verdict, const char *text)
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
    if (!flaw) {
        struct check_proof proof;
        memset(&proof, 0, sizeof proof);
        proof.hulls = fmb_body_frame(a->body, 0)->shape == FMB_HULL ||
                      fmb_body_frame(b->body, 0)->shape == FMB_HULL;
        proof_each(&proof, mpq_init);
        set_pair(&proof, a, b, duration);
        flaw = flaw_of(&proof, verdict, text);
        proof_each(&proof, mpq_clear);
    }
    if (size > 0)
        snprintf(why, size, "%s", flaw ? flaw : "");
    return !flaw;
}
