/* Checks the separation of a pair that turns, by the definitions of fmb.h.
 *
 * Over an interval [lo, hi] of s = t / T let x = hi - s and y = s - lo: they are at least 0, and
 * not both 0. A polynomial in s of degree d, times (hi - lo)^d, is a sum of c_k x^(d-k) y^k. The
 * code stores its c_k as a row. The polynomial is positive on the whole interval if all c_k are
 * positive. The row of a number is the number itself; positions and quaternions are linear, and
 * their rows are their values at lo and hi. Rows are multiplied like polynomials in y. The factor
 * x + y, with the row 1, 1, raises the degree of a polynomial without changing its sign. All terms
 * of a sum have the same degree.
 *
 * Let N_A = |q_A|^2 R(q_A) and N_B be the matrices of the rotations, which have no denominator, and
 * n = N_A u, N_B u, or N_A u x N_B v: a polynomial of degree d = 2 or 4. For vertices a and b of
 * both frames, in body coordinates, and the positions p,
 *
 *     |q_A|^2 |q_B|^2 n . ((p_B + R_B b) - (p_A + R_A a))
 *         = |q_A|^2 |q_B|^2 n . (p_B - p_A) + |q_A|^2 (N_B^T n) . b - |q_B|^2 (N_A^T n) . a
 *
 * is a polynomial of degree d + 5 that is positive where n separates the two vertices. N^T is the
 * matrix of the conjugate quaternion. Each coefficient is least for some a and some b. If all these
 * least coefficients are positive, so is the polynomial of every pair of vertices. Then n . (b - a)
 * is positive for all points of the frames, which are convex, on the whole interval.
 *
 * Radii. Let f_k be these least coefficients, all positive, and f the polynomial with these
 * coefficients. f is at most the polynomial of every pair of vertices, so the distance of the cores
 * is at least f / (|q_A|^2 |q_B|^2 |n|). This exceeds R, the sum of the radii, where the polynomial
 * f^2 - R^2 (n . n) |q_A|^4 |q_B|^4, of degree 2 d + 10, is positive. */
#include "certificate_check.h"

#include <stdlib.h>
#include <string.h>

enum { TERMS = 19 };
typedef mpq_t row[TERMS];

/* All numbers of an interval. */
struct rows {
    row q[2][4], square[2], squares, up, offset[AXES];
    row own[2][AXES], n[AXES], of[2][AXES]; /* of: the factors of a and b */
    row scratch[AXES + 2], value;
    mpq_t term, least, greatest, coefficient[AXES], vertex[AXES];
};

/* out += factor x y */
static void add_product(struct rows *rows, row out, int factor, row x, row y)
{
    for (int i = 0; i < TERMS; i++)
        for (int j = 0; j < TERMS - i; j++) {
            if (mpq_sgn(x[i]) == 0 || mpq_sgn(y[j]) == 0)
                continue;
            mpq_mul(rows->term, x[i], y[j]);
            for (int k = 0; k < abs(factor); k++)
                (factor < 0 ? mpq_sub : mpq_add)(out[i + j], out[i + j], rows->term);
        }
}

static void clear(row *rows, int count)
{
    for (int i = 0; i < count * TERMS; i++)
        mpq_set_ui(rows[i / TERMS][i % TERMS], 0, 1);
}

/* x := x y */
static void multiply(struct rows *rows, row x, row y)
{
    row *scratch = &rows->scratch[AXES + 1];
    clear(scratch, 1);
    add_product(rows, *scratch, 1, x, y);
    for (int i = 0; i < TERMS; i++)
        mpq_swap(x[i], (*scratch)[i]);
}

static void add_dot(struct rows *rows, row out, int factor, row u[AXES], row v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        add_product(rows, out, factor, u[axis], v[axis]);
}

static void add_cross(struct rows *rows, row out[AXES], row u[AXES], row v[AXES])
{
    for (int i = 0; i < AXES; i++) {
        const int j = (i + 1) % AXES, k = (i + 2) % AXES;
        add_product(rows, out[i], 1, u[j], v[k]);
        add_product(rows, out[i], -1, u[k], v[j]);
    }
}

/* out := N v, or N^T v if back. With r = (x, y, z): N v = (ww - r.r) v + 2 (r.v) r + 2 w (r x v).
 */
static void turn(struct rows *rows, row q[4], bool back, row v[AXES], row out[AXES])
{
    row *scratch = rows->scratch;
    clear(out, AXES);
    clear(scratch, AXES + 1);
    add_cross(rows, scratch, q + 1, v);
    for (int axis = 0; axis < AXES; axis++)
        add_product(rows, out[axis], back ? -2 : 2, q[0], scratch[axis]);
    clear(scratch, 1);
    add_product(rows, scratch[0], 1, q[0], q[0]);
    add_dot(rows, scratch[0], -1, q + 1, q + 1);
    add_dot(rows, scratch[AXES], 2, q + 1, v);
    for (int axis = 0; axis < AXES; axis++) {
        add_product(rows, out[axis], 1, scratch[0], v[axis]);
        add_product(rows, out[axis], 1, scratch[AXES], q[1 + axis]);
    }
}

/* Sets the rows of both poses over an interval. */
static void set_poses(struct check_proof *proof, mpq_t end[2], struct rows *rows)
{
    mpq_t q[4];
    CHECK_SCOPE(q);
    CHECK_VECTOR(position);
    for (int e = 0; e < 2; e++) {
        mpq_set_ui(rows->up[e], 1, 1);
        for (int f = 0; f < 2; f++) {
            struct check_side *side = &proof->side[f];
            check_between(q, side->orientation, side->late_orientation, end[e], 4);
            check_between(position, side->position, side->late_position, end[e], AXES);
            for (int i = 0; i < 4; i++)
                mpq_set(rows->q[f][i][e], q[i]);
            for (int axis = 0; axis < AXES; axis++)
                (f ? mpq_add : mpq_sub)(rows->offset[axis][e], rows->offset[axis][e],
                                        position[axis]);
        }
    }
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < 4; i++)
            add_product(rows, rows->square[f], 1, rows->q[f][i], rows->q[f][i]);
    add_product(rows, rows->squares, 1, rows->square[0], rows->square[1]);
}

/* Sets n: fixed in frame `of`, or the product if of = 2. */
static void set_direction(struct check_proof *proof, int of, struct rows *rows)
{
    for (int i = 0; i < 2 * AXES; i++)
        mpq_set(rows->own[i / AXES][i % AXES][0], proof->normal[i / AXES][i % AXES]);
    if (of < 2) {
        turn(rows, rows->q[of], false, rows->own[0], rows->n);
        return;
    }
    for (int f = 0; f < 2; f++)
        turn(rows, rows->q[f], false, rows->own[f], rows->of[f]);
    add_cross(rows, rows->n, rows->of[0], rows->of[1]);
}

/* Adds the least value of coefficient k over the vertices of frame b, or subtracts the greatest
 * over the vertices of frame a. */
static void add_least(struct check_proof *proof, int f, int k, struct rows *rows)
{
    struct check_side *side = &proof->side[f];
    for (unsigned i = 0; i < check_vertex_count(side); i++) {
        check_vertex(side, i, rows->vertex);
        mpq_set_ui(rows->term, 0, 1);
        for (int axis = 0; axis < AXES; axis++) {
            mpq_mul(rows->coefficient[axis], rows->of[f][axis][k], rows->vertex[axis]);
            mpq_add(rows->term, rows->term, rows->coefficient[axis]);
        }
        if (i == 0 || mpq_cmp(rows->term, rows->least) < 0)
            mpq_set(rows->least, rows->term);
        if (i == 0 || mpq_cmp(rows->term, rows->greatest) > 0)
            mpq_set(rows->greatest, rows->term);
    }
    if (f == 1)
        mpq_add(rows->value[k], rows->value[k], rows->least);
    else
        mpq_sub(rows->value[k], rows->value[k], rows->greatest);
}

static bool are_positive(row value, int degree)
{
    bool positive = true;
    for (int k = 0; k <= degree; k++)
        positive = positive && mpq_sgn(value[k]) > 0;
    return positive;
}

/* Returns whether f exceeds R |q_A|^2 |q_B|^2 |n|. */
static bool exceeds_radius(struct check_proof *proof, int degree, struct rows *rows)
{
    row *square = &rows->scratch[0], *length = &rows->scratch[1];
    clear(square, 2);
    add_product(rows, *square, 1, rows->value, rows->value);
    add_dot(rows, *length, 1, rows->n, rows->n);
    for (int i = 0; i < 2; i++) {
        multiply(rows, *length, rows->squares);
        multiply(rows, *length, rows->up);
        for (int k = 0; k < TERMS; k++)
            mpq_mul((*length)[k], (*length)[k], proof->radius);
    }
    for (int k = 0; k < TERMS; k++)
        mpq_sub((*square)[k], (*square)[k], (*length)[k]);
    return are_positive(*square, 2 * degree);
}

/* Returns whether the direction separates the frames over an interval. */
static bool separates(struct check_proof *proof, mpq_t end[2], int of)
{
    struct rows rows;
    const int degree = of == 2 ? 9 : 7;
    check_each(&rows, sizeof rows, mpq_init);
    set_poses(proof, end, &rows);
    set_direction(proof, of, &rows);
    add_dot(&rows, rows.value, 1, rows.n, rows.offset);
    multiply(&rows, rows.value, rows.squares);
    for (int f = 0; f < 2; f++) {
        turn(&rows, rows.q[f], true, rows.n, rows.of[f]);
        for (int axis = 0; axis < AXES; axis++) {
            multiply(&rows, rows.of[f][axis], rows.square[!f]);
            multiply(&rows, rows.of[f][axis], rows.up);
        }
        for (int k = 0; k <= degree; k++)
            add_least(proof, f, k, &rows);
    }
    const bool apart = are_positive(rows.value, degree) &&
                       (!proof->rounded || exceeds_radius(proof, degree, &rows));
    check_each(&rows, sizeof rows, mpq_clear);
    return apart;
}

/* Takes a direction. Returns the frame in which it is fixed, 2 for a product, or -1. */
static int take_direction(const char **at, struct check_proof *proof)
{
    static const char *const word[2] = {" normal a ", " normal b "};
    for (int f = 0; f < 2; f++)
        if (strncmp(*at, word[f], strlen(word[f])) == 0)
            return check_take_vector(at, word[f], proof->dim, proof->normal[0]) ? f : -1;
    return proof->dim == 3 && check_take_vector(at, " product ", AXES, proof->normal[0]) &&
                   check_take_vector(at, " ", AXES, proof->normal[1])
               ? 2
               : -1;
}

const char *check_flaw_of_intervals(const char *at, struct check_proof *proof)
{
    const char *flaw = NULL;
    mpq_t end[2];
    CHECK_SCOPE(end);
    CHECK_NUMBER(covered);
    do {
        const bool good = check_take(&at, " from ") && check_take_number(&at, end[0]) &&
                          check_take(&at, " to ") && check_take_number(&at, end[1]);
        const int of = good ? take_direction(&at, proof) : -1;
        if (of < 0)
            flaw = "an interval with a direction of this pair is missing";
        else if (!mpq_equal(end[0], covered))
            flaw = "an interval does not begin where the previous interval ends";
        else if (mpq_cmp(end[0], end[1]) >= 0 || mpq_cmp_ui(end[1], 1, 1) > 0)
            flaw = "an interval ends before it begins, or after the window";
        else if (!separates(proof, end, of))
            flaw = "a direction does not separate the frames over its interval";
        mpq_set(covered, end[1]);
    } while (!flaw && *at != '\0');
    if (!flaw && mpq_cmp_ui(covered, 1, 1) != 0)
        flaw = "the intervals end before the window";
    return flaw;
}
