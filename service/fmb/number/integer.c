#include "integer.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdint.h>

static_assert(FLT_RADIX == 2 && DBL_MANT_DIG == 53 && DBL_MAX_EXP == 1024, "IEEE 754 binary64");
static_assert(sizeof(long) == 8, "GMP takes its numbers as longs: a mantissa must fit");

/* Exponents of the lowest bit of a subnormal double, and of the largest double. */
enum { LOWEST_UNIT = -1074, HIGHEST_UNIT = 971 };

struct dyadic_span dyadic_span_begin(void)
{
    return (struct dyadic_span){INTEGER_NO_EXPONENT, -INTEGER_NO_EXPONENT};
}

void integer_each(void *numbers, size_t bytes, void (*call)(mpz_ptr))
{
    mpz_ptr number = numbers;
    for (size_t i = 0; i < bytes / sizeof *number; i++)
        call(&number[i]);
}

void integer_set(mpz_t out, struct dyadic x, long unit)
{
    mpz_set_si(out, x.mantissa);
    if (x.mantissa)
        mpz_mul_2exp(out, out, (mp_bitcnt_t) (x.exponent - unit));
}

void integer_round(mpz_t *v, int count, double *out)
{
    long exponent[INTEGER_ROUND_MAX], largest = 0;
    bool any = false;
    for (int i = 0; i < count; i++) {
        out[i] = mpz_get_d_2exp(&exponent[i], v[i]);
        if (out[i] != 0 && (!any || exponent[i] > largest)) {
            largest = exponent[i];
            any = true;
        }
    }
    for (int i = 0; i < count; i++) {
        const long down = largest - exponent[i];
        out[i] = out[i] == 0 || down > 1100 ? 0 : ldexp(out[i], (int) -down - 4);
    }
}

void integer_set_sum(mpz_t out, double x, double y, long unit)
{
    mpz_t other;
    integer_set(out, dyadic_of(x), unit);
    if (y == 0)
        return;
    mpz_init(other);
    integer_set(other, dyadic_of(y), unit);
    mpz_add(out, out, other);
    mpz_clear(other);
}

void integer_set_product(mpz_t out, struct dyadic x, struct dyadic y, long unit)
{
    mpz_set_si(out, x.mantissa);
    mpz_mul_si(out, out, y.mantissa);
    if (mpz_sgn(out))
        mpz_mul_2exp(out, out, (mp_bitcnt_t) (x.exponent + y.exponent - unit));
}

/* out := x without its low zero limbs, as a read-only view of x; returns their number. In: x is not
 * 0. */
static mp_size_t strip(mpz_t out, const mpz_t x)
{
    const mp_limb_t *limbs = mpz_limbs_read(x);
    const mp_size_t size = (mp_size_t) mpz_size(x);
    mp_size_t zeros = 0;
    while (limbs[zeros] == 0)
        zeros++;
    mpz_roinit_n(out, limbs + zeros, mpz_sgn(x) < 0 ? zeros - size : size - zeros);
    return zeros;
}

bool integer_is_zero(mpz_t v[3])
{
    return mpz_sgn(v[0]) == 0 && mpz_sgn(v[1]) == 0 && mpz_sgn(v[2]) == 0;
}

/* Up to this total size of factors nothing is gained by stripping zeros, or by comparing leading
 * bits first. */
enum { FEW_LIMBS = 6 };

void integer_multiply(mpz_t out, const mpz_t x, const mpz_t y)
{
    mpz_t u, v;
    if (mpz_size(x) + mpz_size(y) <= FEW_LIMBS) {
        mpz_mul(out, x, y);
        return;
    }
    if (mpz_sgn(x) == 0 || mpz_sgn(y) == 0) {
        mpz_set_ui(out, 0);
        return;
    }
    const mp_size_t zeros = strip(u, x) + strip(v, y);
    mpz_mul(out, u, v);
    if (zeros)
        mpz_mul_2exp(out, out, (mp_bitcnt_t) zeros * GMP_NUMB_BITS);
}

void integer_add_product(mpz_t out, int sign, const mpz_t x, const mpz_t y, mpz_t scratch)
{
    if (mpz_size(x) + mpz_size(y) <= FEW_LIMBS) {
        (sign > 0 ? mpz_addmul : mpz_submul)(out, x, y);
        return;
    }
    integer_multiply(scratch, x, y);
    if (sign > 0)
        mpz_add(out, out, scratch);
    else
        mpz_sub(out, out, scratch);
}

void integer_cross(mpz_t out[3], mpz_t u[3], mpz_t v[3], mpz_t scratch)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        integer_multiply(out[i], u[j], v[k]);
        integer_add_product(out[i], -1, u[k], v[j], scratch);
    }
}

void integer_dot(mpz_t out, mpz_t u[3], mpz_t v[3], mpz_t scratch)
{
    integer_multiply(out, u[0], v[0]);
    integer_add_product(out, 1, u[1], v[1], scratch);
    integer_add_product(out, 1, u[2], v[2], scratch);
}

/* Returns a mantissa such that x y = mantissa 2^*exponent within a factor of 1 +- 2^-50: each
 * factor is truncated to 53 bits, and the product is rounded. */
static double leading_product(const mpz_t x, const mpz_t y, long *exponent)
{
    long of_x, of_y;
    const double mantissa = mpz_get_d_2exp(&of_x, x) * mpz_get_d_2exp(&of_y, y);
    *exponent = of_x + of_y;
    return mantissa;
}

/* Mantissas lie in [1/4, 1): a product scaled by 2^-4 or less is certainly the smaller one in
 * magnitude. */
int integer_compare_products(const mpz_t x, const mpz_t y, const mpz_t z, const mpz_t w,
                             mpz_t scratch[2])
{
    const int sign = mpz_sgn(x) * mpz_sgn(y), other = mpz_sgn(z) * mpz_sgn(w);
    if (sign != other || sign == 0)
        return sign > other ? 1 : sign < other ? -1 : 0;
    if (mpz_size(x) + mpz_size(y) + mpz_size(z) + mpz_size(w) > FEW_LIMBS) {
        long one, two;
        const double xy = leading_product(x, y, &one), zw = leading_product(z, w, &two);
        const long apart = one - two;
        const double scaled = ldexp(xy, apart > 4 ? 4 : apart < -4 ? -4 : (int) apart);
        if (fabs(scaled - zw) > 0x1p-48 * fabs(zw))
            return scaled > zw ? 1 : -1;
    }
    integer_multiply(scratch[0], x, y);
    integer_multiply(scratch[1], z, w);
    return mpz_cmp(scratch[0], scratch[1]);
}

/* Returns the largest q with q 2^step <= |num| / den * 2^unit. *exact: whether they are equal. */
static uint64_t floor_in_steps(const mpz_t num, const mpz_t den, long unit, long step,
                               mpz_t scratch[2], bool *exact)
{
    long shift = unit - step;
    mpz_abs(scratch[0], num);
    if (shift >= 0) {
        mpz_mul_2exp(scratch[0], scratch[0], (mp_bitcnt_t) shift);
        mpz_tdiv_qr(scratch[0], scratch[1], scratch[0], den);
    } else {
        mpz_mul_2exp(scratch[1], den, (mp_bitcnt_t) -shift);
        mpz_tdiv_qr(scratch[0], scratch[1], scratch[0], scratch[1]);
    }
    *exact = mpz_sgn(scratch[1]) == 0;
    return mpz_get_ui(scratch[0]);
}

/* Method: let n and m be the bit lengths of num and den. Then |num| / den lies in
 * (2^(n-m-1), 2^(n-m+1)). In steps of 2^(n-m-1-52+unit) its integer part has 53 or 54 bits; if it
 * has 54, steps twice as wide give 53. A step is never smaller than that of the subnormals.
 * Rounding away from zero adds one step if the quotient is not exact, else none. The sum, at most
 * 2^53 steps, is a double again. */
double integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                           enum round_direction direction, mpz_t scratch[2])
{
    if (mpz_sgn(num) == 0)
        return 0.0;
    bool negative = mpz_sgn(num) < 0;
    bool away = negative == (direction == ROUND_DOWN);
    long step = (long) mpz_sizeinbase(num, 2) - (long) mpz_sizeinbase(den, 2) - 53 + unit;
    if (step > HIGHEST_UNIT)
        return negative ? -INFINITY : INFINITY;
    if (step < LOWEST_UNIT)
        step = LOWEST_UNIT;

    bool exact;
    uint64_t steps = floor_in_steps(num, den, unit, step, scratch, &exact);
    if (steps >> 53) {
        step++;
        steps = floor_in_steps(num, den, unit, step, scratch, &exact);
    }
    bool beyond =
        step > HIGHEST_UNIT || (step == HIGHEST_UNIT && !exact && steps == (UINT64_C(1) << 53) - 1);
    if (beyond)
        return negative ? -INFINITY : INFINITY;

    if (!exact && away)
        steps++;
    double magnitude = ldexp((double) steps, (int) step);
    if (magnitude == 0)
        return 0.0;
    return negative ? -magnitude : magnitude;
}
