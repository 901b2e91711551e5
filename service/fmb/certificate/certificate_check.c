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
 * A common point is given by weights of vertices: certificate_check_weights.c. The separation of a
 * pair that turns: certificate_check_turn.c; its overlap at one time is checked as at rest.
 *
 * Frames with radii, R > 0 their sum. For points a and b of the cores, let N . (b - a) >= g > 0 at
 * all times of the window; then the distance of the cores is at least g / |N|. SEPARATED: g > R
 * |N|. TOUCHING: g >= R |N|, and two points of the cores are at most R apart at some time.
 * OVERLAPPING: two points of the cores are less than R apart at some time.
 */
#include "certificate_check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gmp.h>

/* ---- Vectors ---- */

void check_each(void *numbers, size_t bytes, void (*call)(mpq_ptr))
{
    mpq_ptr number = numbers;
    for (size_t i = 0; i < bytes / sizeof *number; i++)
        call(&number[i]);
}

struct check_scope check_enter(void *numbers, size_t bytes)
{
    check_each(numbers, bytes, mpq_init);
    return (struct check_scope){numbers, bytes};
}

void check_leave(struct check_scope *scope)
{
    check_each(scope->numbers, scope->bytes, mpq_clear);
}

void check_copy(mpq_t out[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_set(out[axis], v[axis]);
}

void check_add(mpq_t out[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_add(out[axis], out[axis], v[axis]);
}

void check_add_numbers(mpq_t out[AXES], int dim, const double *v)
{
    CHECK_NUMBER(number);
    for (int axis = 0; axis < dim; axis++)
        if (v[axis] != 0) {
            mpq_set_d(number, v[axis]);
            mpq_add(out[axis], out[axis], number);
        }
}

void check_subtract(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES])
{
    for (int axis = 0; axis < AXES; axis++)
        mpq_sub(out[axis], u[axis], v[axis]);
}

void check_add_multiple(mpq_t *out, const mpq_t factor, mpq_t *v, int numbers)
{
    CHECK_NUMBER(product);
    for (int i = 0; i < numbers; i++) {
        mpq_mul(product, factor, v[i]);
        mpq_add(out[i], out[i], product);
    }
}

static void dot(mpq_t out, mpq_t u[AXES], mpq_t v[AXES])
{
    CHECK_NUMBER(product);
    mpq_set_ui(out, 0, 1);
    for (int axis = 0; axis < AXES; axis++) {
        mpq_mul(product, u[axis], v[axis]);
        mpq_add(out, out, product);
    }
}

/* out is neither u nor v. */
static void cross(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES])
{
    CHECK_NUMBER(product);
    for (int i = 0; i < AXES; i++) {
        int j = (i + 1) % AXES, k = (i + 2) % AXES;
        mpq_mul(out[i], u[j], v[k]);
        mpq_mul(product, u[k], v[j]);
        mpq_sub(out[i], out[i], product);
    }
}

/* ---- The pair ---- */

/* Calls one of mpq_init and mpq_clear for every number. */
static void proof_each(struct check_proof *proof, void (*call)(mpq_ptr))
{
    for (int f = 0; f < 2; f++) {
        struct check_side *side = &proof->side[f];
        check_each(side->span.vector, sizeof side->span.vector, call);
        check_each(side->origin, sizeof *side - offsetof(struct check_side, origin), call);
    }
    check_each(&proof->duration, sizeof *proof - offsetof(struct check_proof, duration), call);
}

void check_turn(struct check_side *side, bool back, mpq_t v[AXES])
{
    mpq_t *const q = side->orientation;
    if (side->placement->orientation_count == 0)
        return;
    CHECK_NUMBER(norm);
    CHECK_NUMBER(along);
    CHECK_NUMBER(product);
    CHECK_VECTOR(cross_of_v);
    CHECK_VECTOR(out);

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
    if (back)
        mpq_neg(along, along);
    check_add_multiple(out, along, cross_of_v, AXES);
    mpq_mul(product, q[0], q[0]);
    mpq_add(norm, norm, product);
    for (int axis = 0; axis < AXES; axis++)
        mpq_div(v[axis], out[axis], norm);
}

/* Sets origin and components of a frame that is not a hull, in body coordinates. The origin of a
 * box is its centre less half of each component; it may be infinite as a double. */
static void set_frame(struct check_side *side)
{
    const struct fmb_frame *frame = side->frame;
    CHECK_NUMBER(half);
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
}

/* Sets the quaternion of an orientation; without one, (1, 0, 0, 0). */
static void set_orientation(mpq_t out[4], const double *q, int count)
{
    mpq_set_d(out[0], count == 0 ? 1 : q[0]);
    for (int i = 1; i < count; i++)
        mpq_set_d(out[count == 2 ? 3 : i], q[i]);
}

/* Sets the pose at the end of the window. The sign of its quaternion gives a turn of less than 180
 * degrees. */
static void set_late(struct check_side *side, const mpq_t duration)
{
    const struct fmb_placement *placement = side->placement;
    const bool ends = placement->end_count != 0;
    CHECK_NUMBER(product);
    CHECK_NUMBER(sum);
    check_add_numbers(side->late_position, side->frame->dim,
                      ends ? placement->end_position : placement->position);
    check_add_multiple(side->late_position, duration, side->velocity, AXES);
    set_orientation(side->late_orientation,
                    ends ? placement->end_orientation : placement->orientation,
                    placement->orientation_count);
    for (int i = 0; i < 4; i++) {
        mpq_mul(product, side->orientation[i], side->late_orientation[i]);
        mpq_add(sum, sum, product);
    }
    for (int i = 0; i < 4 && mpq_sgn(sum) < 0; i++)
        mpq_neg(side->late_orientation[i], side->late_orientation[i]);
}

static void set_side(struct check_side *side, const struct fmb_placement *placement)
{
    side->placement = placement;
    side->frame = fmb_body_frame(placement->body, 0);
    check_add_numbers(side->velocity, side->frame->dim, placement->velocity);
    check_add_numbers(side->position, side->frame->dim, placement->position);
    set_orientation(side->orientation, placement->orientation, placement->orientation_count);
    if (side->frame->shape != FMB_HULL)
        set_frame(side);
}

void check_between(mpq_t *out, mpq_t *x, mpq_t *y, const mpq_t s, int count)
{
    CHECK_NUMBER(product);
    for (int i = 0; i < count; i++) {
        mpq_sub(product, y[i], x[i]);
        mpq_mul(product, product, s);
        mpq_add(out[i], x[i], product);
    }
}

/* Sets the poses of a pair that turns at the time of the proof, which is in the window. A frame
 * without an end keeps its pose and velocity. */
static void set_pose(struct check_proof *proof)
{
    CHECK_NUMBER(s);
    mpq_div(s, proof->time, proof->duration);
    for (int f = 0; f < 2; f++) {
        struct check_side *side = &proof->side[f];
        if (side->placement->end_count == 0)
            continue;
        check_between(side->orientation, side->orientation, side->late_orientation, s, 4);
        check_between(side->position, side->position, side->late_position, s, AXES);
    }
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
    set_side(&proof->side[0], a);
    set_side(&proof->side[1], b);
    proof->turning = a->end_count != 0 || b->end_count != 0;
    proof->moving = proof->turning || !is_zero_vector(proof->side[0].velocity) ||
                    !is_zero_vector(proof->side[1].velocity);
    for (int f = 0; f < 2 && proof->turning; f++)
        set_late(&proof->side[f], proof->duration);
    check_subtract(proof->v, proof->side[1].velocity, proof->side[0].velocity);
    CHECK_NUMBER(other);
    mpq_set_d(proof->radius, proof->side[0].frame->radius);
    mpq_set_d(other, proof->side[1].frame->radius);
    mpq_add(proof->radius, proof->radius, other);
    proof->rounded = mpq_sgn(proof->radius) != 0;
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
            check_add(out, side->edge[i]);
}

/* ---- The text ---- */

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
    CHECK_NUMBER(divisor);
    mpz_gcd(mpq_numref(divisor), mpq_numref(x), mpq_denref(x));
    return mpz_cmp_ui(mpq_numref(divisor), 1) == 0;
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

bool check_take_vector(const char **at, const char *word, int dim, mpq_t out[AXES])
{
    bool good = check_take(at, word) && check_take(at, "(");
    for (int axis = 0; good && axis < dim; axis++)
        good = (axis == 0 || check_take(at, " ")) && check_take_number(at, out[axis]);
    return good && check_take(at, ")");
}

/* The functions that find flaws return what is wrong, or NULL. */
static const char *flaw_of_text(struct check_proof *proof, enum fmb_verdict verdict,
                                const char *text)
{
    const char *at = text, *name = fmb_verdict_name(verdict);
    if (!name || !check_take(&at, name))
        return "the text does not begin with the verdict";
    if (proof->turning && verdict == FMB_SEPARATED)
        return check_flaw_of_intervals(at, proof);
    if (proof->turning && verdict == FMB_TOUCHING)
        return "a pair that turns and touches has no certificate";
    if (verdict != FMB_OVERLAPPING &&
        !check_take_vector(&at, " normal ", proof->dim, proof->normal[0]))
        return "the verdict is not followed by a normal of this pair";
    if (verdict != FMB_SEPARATED) {
        if (!check_take(&at, " at ") || !check_take_number(&at, proof->time))
            return "there is no time in lowest terms where it is due";
        if (mpq_sgn(proof->time) < 0 || mpq_cmp(proof->time, proof->duration) > 0)
            return "the time is not in the window";
        if (proof->turning)
            set_pose(proof);
        if (!check_take_weights(&at, proof))
            return "the time is not followed by weights of vertices of both frames";
    }
    return *at == '\0' ? NULL : "something follows the certificate";
}

/* ---- The normal ---- */

/* Sets the least and the greatest value of the normal N over a frame. N . R v is (R^-1 N) . v. The
 * value at a vertex that is a sum of vectors is the sum of their values. */
static void set_range(struct check_proof *proof, struct check_side *side)
{
    CHECK_NUMBER(of_origin);
    CHECK_NUMBER(value);
    CHECK_VECTOR(normal);
    CHECK_VECTOR(vertex);
    CHECK_VECTOR(of_edge);
    check_copy(normal, proof->normal[0]);
    check_turn(side, true, normal);
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
    dot(value, proof->normal[0], side->position);
    mpq_add(side->low, side->low, value);
    mpq_add(side->high, side->high, value);
}

/* The least N . (b - a): low_b - high_a at the beginning of the window; N . v T is what it grows by
 * until its end. */
static const char *flaw_of_normal(struct check_proof *proof, enum fmb_verdict verdict)
{
    struct check_side *a = &proof->side[0], *b = &proof->side[1];
    CHECK_NUMBER(gap);
    CHECK_NUMBER(growth);
    set_range(proof, a);
    set_range(proof, b);
    mpq_sub(gap, b->low, a->high);
    dot(growth, proof->normal[0], proof->v);
    mpq_mul(growth, growth, proof->duration);
    if (mpq_sgn(growth) < 0)
        mpq_add(gap, gap, growth);
    int sign = mpq_sgn(gap);
    if (proof->rounded && sign > 0) { /* g^2 against |N|^2 R^2 */
        dot(growth, proof->normal[0], proof->normal[0]);
        mpq_mul(growth, growth, proof->radius);
        mpq_mul(growth, growth, proof->radius);
        mpq_mul(gap, gap, gap);
        sign = mpq_cmp(gap, growth);
    } else if (proof->rounded) {
        sign = -1;
    }
    if (verdict == FMB_SEPARATED)
        return sign > 0 ? NULL : "the normal does not hold the frames apart all the time";
    if (sign < 0)
        return "the normal does not keep the frames on its two sides all the time";
    return !proof->rounded && mpq_equal(a->low, a->high) && mpq_equal(b->low, b->high)
               ? "the normal is constant on both frames"
               : NULL;
}

static const char *flaw_of(struct check_proof *proof, enum fmb_verdict verdict, const char *text)
{
    const char *flaw = flaw_of_text(proof, verdict, text);
    if (!flaw && verdict != FMB_OVERLAPPING && !proof->turning)
        flaw = flaw_of_normal(proof, verdict);
    if (!flaw && verdict != FMB_SEPARATED)
        flaw = !proof->moving && mpq_sgn(proof->time) != 0 ? "the time of a static pair is not 0"
                                                           : check_flaw_of_weights(proof, verdict);
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
    if ((a->end_count != 0 || b->end_count != 0) && duration == 0)
        return fmb_status_text(FMB_BAD_DURATION);
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
        proof_each(&proof, mpq_init);
        set_pair(&proof, a, b, duration);
        flaw = flaw_of(&proof, verdict, text);
        proof_each(&proof, mpq_clear);
    }
    if (size > 0)
        snprintf(why, size, "%s", flaw ? flaw : "");
    return !flaw;
}
