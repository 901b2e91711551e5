/* The point of a certificate where the numbers of a pair span so many bits that the points of
 * certificate_point.c would take too long to reduce.
 *
 * TOUCHING: the first point of Q that is found, as it is.
 *
 * OVERLAPPING, of two solid frames: Q has an interior in space, and either one in time too or lies
 * at one end of the window. The mean of points whose hull is Q is inside of Q, and so is all that
 * is near enough. Each coordinate is rounded to a multiple of 2^-bits units before the mean is
 * made; where the mean then is not strictly inside of all slabs, bits are added. From there the
 * point is moved along one axis after the other, each time to the simplest number inside of Q. All
 * of it is in integers with one denominator, without a greatest common divisor.
 *
 * Where a frame is flat, or Q is thinner than all these bits: the mean of points of Q that are
 * affinely independent, and as many as there are, as it is. That they are independent is seen
 * modulo a prime. */
#include "certificate_point.h"
#include "integer.h"

#include <stdint.h>

enum { COORDINATES = EXACT_COORDINATES };

/* ---- Points of Q as they are ---- */

/* The prime 2^61 - 1. */
static const uint64_t prime = (UINT64_C(1) << 61) - 1;

static uint64_t multiply(uint64_t x, uint64_t y)
{
    return (uint64_t) ((unsigned __int128) x * y % prime);
}

/* x^(prime - 2) = 1 / x */
static uint64_t inverse(uint64_t x)
{
    uint64_t result = 1;
    for (uint64_t bits = prime - 2; bits; bits >>= 1, x = multiply(x, x))
        if (bits & 1)
            result = multiply(result, x);
    return result;
}

/* Points that are affinely independent: (tau, place, den) are, which are the numbers of a point
 * here. */
enum { NUMBERS = COORDINATES + 1 };

struct sample {
    int most; /* points wanted */
    int count;
    mpz_t number[NUMBERS][NUMBERS]; /* [point][number] */
    uint64_t row[NUMBERS][NUMBERS]; /* modulo the prime: row i is 1 in column pivot[i], */
    int pivot[NUMBERS];             /* where those after it are 0 */
};

static void sample_each(struct sample *sample, void (*call)(mpz_ptr))
{
    for (int i = 0; i < NUMBERS; i++)
        for (int k = 0; k < NUMBERS; k++)
            call(sample->number[i][k]);
}

/* Reduces the numbers by the rows; false if nothing is left of them. */
static bool reduce(struct sample *sample, uint64_t x[NUMBERS])
{
    for (int i = 0; i < sample->count; i++) {
        const uint64_t factor = prime - x[sample->pivot[i]];
        for (int k = 0; k < NUMBERS; k++)
            x[k] = (x[k] + multiply(factor, sample->row[i][k])) % prime;
    }
    int pivot = 0;
    while (pivot < NUMBERS && x[pivot] == 0)
        pivot++;
    if (pivot == NUMBERS)
        return false;
    const uint64_t scale = inverse(x[pivot]);
    for (int k = 0; k < NUMBERS; k++)
        sample->row[sample->count][k] = multiply(x[k], scale);
    sample->pivot[sample->count] = pivot;
    return true;
}

static void take_independent(void *context, const struct exact_point *point)
{
    struct sample *sample = context;
    uint64_t x[NUMBERS];
    if (sample->count == sample->most)
        return;
    for (int k = 0; k < NUMBERS; k++)
        x[k] = mpz_fdiv_ui(k < COORDINATES ? point->at[k] : point->den, prime);
    if (!reduce(sample, x))
        return;
    for (int k = 0; k < NUMBERS; k++)
        mpz_set(sample->number[sample->count][k], k < COORDINATES ? point->at[k] : point->den);
    sample->count++;
}

/* The mean of the points, in the first of them. */
static void set_sample_mean(struct sample *sample, mpz_t scratch)
{
    mpz_t *sum = sample->number[0];
    for (int i = 1; i < sample->count; i++) {
        mpz_t *next = sample->number[i];
        for (int k = 0; k < COORDINATES; k++) {
            mpz_mul(scratch, sum[k], next[COORDINATES]);
            mpz_addmul(scratch, next[k], sum[COORDINATES]);
            mpz_swap(sum[k], scratch);
        }
        mpz_mul(sum[COORDINATES], sum[COORDINATES], next[COORDINATES]);
    }
    mpz_mul_si(sum[COORDINATES], sum[COORDINATES], sample->count);
}

/* The mean of so many independent points of Q, or as many as there are. */
static void find_mean(struct certificate_point *out, struct exact_pair *exact,
                      const struct frame_pair *pair, int most)
{
    struct sample sample = {.most = most};
    const struct dyadic window = dyadic_of(pair->duration);
    mpz_t *mean = sample.number[0];
    sample_each(&sample, mpz_init);
    points_walk(exact, take_independent, &sample);
    set_sample_mean(&sample, exact->scratch[0]);
    mpz_mul_si(mean[0], mean[0], window.mantissa);
    certificate_set_scaled(out->time, mean[0], mean[COORDINATES],
                           window.mantissa ? window.exponent : 0);
    for (int axis = 0; axis < 3; axis++)
        certificate_set_scaled(out->place[axis], mean[1 + axis], mean[COORDINATES], exact->unit);
    sample_each(&sample, mpz_clear);
}

/* ---- Inside ---- */

/* The point at / den, den > 0, and the chord through it along coordinate k. */
struct inside {
    struct exact_pair *exact;
    long bits, points;
    mpz_t at[COORDINATES], den;
    int k, frame;
    bool strict;     /* the point is strictly inside of all slabs so far */
    bool bounded[2]; /* whether the chord has ends, from end[0] to end[1], coordinates */
    struct ratio end[2], bound;
    mpz_t value, slope, product;
    mpq_t low, high;
};

static void inside_each(struct inside *inside, void (*call)(mpz_ptr))
{
    for (int k = 0; k < COORDINATES; k++)
        call(inside->at[k]);
    for (int side = 0; side < 2; side++)
        ratio_each(&inside->end[side], call);
    ratio_each(&inside->bound, call);
    call(inside->den);
    call(inside->value);
    call(inside->slope);
    call(inside->product);
}

static void add_rounded(void *context, const struct exact_point *point)
{
    struct inside *inside = context;
    inside->points++;
    for (int k = 0; k < COORDINATES; k++) {
        mpz_mul_2exp(inside->product, point->at[k], (mp_bitcnt_t) inside->bits);
        mpz_fdiv_q(inside->product, inside->product, point->den);
        mpz_add(inside->at[k], inside->at[k], inside->product);
    }
}

static void set_mean(struct inside *inside, long bits)
{
    for (int k = 0; k < COORDINATES; k++)
        mpz_set_ui(inside->at[k], 0);
    inside->bits = bits;
    inside->points = 0;
    points_walk(inside->exact, add_rounded, inside);
    mpz_set_si(inside->den, inside->points);
    mpz_mul_2exp(inside->den, inside->den, (mp_bitcnt_t) bits);
}

/* With value = den (normal . p) and slope = normal . axis k, and x the coordinate's numerator, the
 * chord meets the bound b in the coordinate (x slope + b den - value) / (den slope). */
static void shorten_to_slab(struct inside *inside, struct slab *slab)
{
    const int sign = mpz_sgn(inside->slope);
    for (int side = 0; side < 2; side++) {
        struct ratio *bound = &inside->bound;
        integer_multiply(bound->num, (side == 0) == (sign >= 0) ? slab->low : slab->high,
                         inside->den);
        const int beyond = mpz_cmp(inside->value, bound->num);
        inside->strict = inside->strict && ((side == 0) == (sign >= 0) ? beyond > 0 : beyond < 0);
        if (sign == 0)
            continue;
        mpz_sub(bound->num, bound->num, inside->value);
        integer_add_product(bound->num, 1, inside->at[inside->k], inside->slope, inside->product);
        integer_multiply(bound->den, inside->den, inside->slope);
        if (sign < 0) {
            mpz_neg(bound->num, bound->num);
            mpz_neg(bound->den, bound->den);
        }
        ratio_tighten(&inside->end[side], inside->bounded[side], side, bound,
                      inside->exact->scratch);
        inside->bounded[side] = true;
    }
}

/* p is the point seen from the frame, which is at origin + tau displacement. In 2D the slab that
 * pins is the plane. */
static bool apply_slab(void *context, struct slab *slab)
{
    struct inside *inside = context;
    struct exact_frame *frame = &inside->exact->frame[inside->frame];
    mpz_t *scratch = inside->exact->scratch;
    if (slab->pins)
        return true;
    slab_set_normal(slab, scratch[0]);
    integer_dot(inside->value, slab->normal, inside->at + 1, scratch[0]);
    integer_dot(inside->slope, slab->normal, frame->origin, scratch[0]);
    integer_add_product(inside->value, -1, inside->slope, inside->den, scratch[0]);
    integer_dot(inside->slope, slab->normal, frame->displacement, scratch[0]);
    integer_add_product(inside->value, -1, inside->slope, inside->at[0], scratch[0]);
    if (inside->k)
        mpz_set(inside->slope, slab->normal[inside->k - 1]);
    else
        mpz_neg(inside->slope, inside->slope);
    shorten_to_slab(inside, slab);
    return true;
}

/* Sets the ends of the chord along coordinate k; false if the point is not strictly inside. */
static bool set_chord(struct inside *inside, int k)
{
    inside->k = k;
    inside->strict = true;
    for (int side = 0; side < 2; side++) {
        inside->bounded[side] = k == 0;
        mpz_set_si(inside->end[side].num, side);
        mpz_set_si(inside->end[side].den, 1);
    }
    for (inside->frame = 0; inside->frame < 2 && inside->strict; inside->frame++)
        slabs_walk(inside->exact, inside->frame ? SLABS_OF_B : SLABS_OF_A, apply_slab, inside);
    return inside->strict;
}

/* Whether times around that of the point are in Q. */
static bool has_time(const struct inside *inside)
{
    return mpz_sgn(inside->at[0]) > 0 && mpz_cmp(inside->at[0], inside->den) < 0;
}

/* x := ratio factor 2^exponent; not in lowest terms. */
static void set_limit(mpq_t x, const struct ratio *ratio, long long factor, long exponent)
{
    mpz_mul_si(mpq_numref(x), ratio->num, factor);
    mpz_set(mpq_denref(x), ratio->den);
    mpz_ptr scaled = exponent < 0 ? mpq_denref(x) : mpq_numref(x);
    mpz_mul_2exp(scaled, scaled, (mp_bitcnt_t) (exponent < 0 ? -exponent : exponent));
}

/* Moves the point along the chord to where the coordinate, times factor 2^exponent, is the simplest
 * number. */
static void simplify(struct inside *inside, long long factor, long exponent, mpq_t out)
{
    struct ratio *to = &inside->bound;
    set_limit(inside->low, &inside->end[0], factor, exponent);
    set_limit(inside->high, &inside->end[1], factor, exponent);
    simplest_between(out, inside->low, inside->high);
    mpz_set(to->num, mpq_numref(out));
    mpz_mul_si(to->den, mpq_denref(out), factor);
    mpz_ptr scaled = exponent < 0 ? to->num : to->den;
    mpz_mul_2exp(scaled, scaled, (mp_bitcnt_t) (exponent < 0 ? -exponent : exponent));
    for (int k = 0; k < COORDINATES; k++) {
        mpz_t *x = &inside->at[k];
        if (k == inside->k)
            integer_multiply(inside->product, inside->den, to->num);
        else
            integer_multiply(inside->product, *x, to->den);
        mpz_swap(*x, inside->product);
    }
    integer_multiply(inside->product, inside->den, to->den);
    mpz_swap(inside->den, inside->product);
}

/* On input: the mean; false if it is not strictly inside of Q. */
static bool move_inside(struct inside *inside, const struct frame_pair *pair,
                        struct certificate_point *out)
{
    const struct dyadic window = dyadic_of(pair->duration);
    const bool time = has_time(inside) && window.mantissa;
    if (!set_chord(inside, 0))
        return false;
    if (time)
        simplify(inside, window.mantissa, window.exponent, out->time);
    else if (mpz_sgn(inside->at[0]))
        mpq_set_d(out->time, pair->duration);
    for (int k = 1; k <= pair->a.frame->dim; k++) {
        set_chord(inside, k);
        simplify(inside, 1, inside->exact->unit, out->place[k - 1]);
    }
    return true;
}

/* ---- The point ---- */

/* Bits below the unit of the pair: tried in turn. */
static const long bits_below[] = {64, 4096};

static bool find_inside(struct certificate_point *out, struct exact_pair *exact,
                        const struct frame_pair *pair)
{
    struct inside inside = {.exact = exact};
    bool found = false;
    inside_each(&inside, mpz_init);
    mpq_inits(inside.low, inside.high, NULL);
    for (size_t i = 0; i < sizeof bits_below / sizeof *bits_below && !found; i++) {
        set_mean(&inside, bits_below[i]);
        found = move_inside(&inside, pair, out);
    }
    mpq_clears(inside.low, inside.high, NULL);
    inside_each(&inside, mpz_clear);
    return found;
}

void certificate_point_wide(struct certificate_point *point, struct exact_pair *exact,
                            const struct frame_pair *pair, bool touching)
{
    const bool solid = !pair->a.frame->flat && !pair->b.frame->flat;
    const bool turned = mpz_cmp_ui(exact->scale, 1) != 0;
    if (touching || !solid || turned || !find_inside(point, exact, pair))
        find_mean(point, exact, pair, touching ? 1 : NUMBERS);
}
