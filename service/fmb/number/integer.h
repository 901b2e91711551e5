/* Doubles as exact integers, and exact ratios back to doubles.
 *
 * Every finite double is mantissa * 2^exponent. A set of them becomes a set of integers, all
 * times the same power of two (the unit), without rounding; sums and products of integers
 * are GMP's. */
#ifndef FMB_INTEGER_H
#define FMB_INTEGER_H

#include <gmp.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* value = mantissa * 2^exponent; the mantissa is odd, or 0 with exponent INTEGER_NO_EXPONENT. */
struct dyadic {
    long long mantissa; /* |mantissa| < 2^53 */
    long exponent;
};

/* Larger than every exponent: the exponent of 0, so that minima come out right. */
#define INTEGER_NO_EXPONENT 1000000L

/* x must be finite. This and dyadic_span_add() are inline: they are called for each number of each
 * frame that is made.
 *
 * Bits of a double: sign 1, biased exponent e 11, fraction f 52. The value is
 * (2^52 + f) 2^(e - 1075), or f 2^-1074 for e = 0. */
static inline struct dyadic dyadic_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    uint64_t fraction = bits & ((UINT64_C(1) << 52) - 1);
    int biased = (int) (bits >> 52 & 0x7ff);
    uint64_t mantissa = biased ? fraction | UINT64_C(1) << 52 : fraction;
    if (mantissa == 0)
        return (struct dyadic){0, INTEGER_NO_EXPONENT};
    int trailing = __builtin_ctzll(mantissa);
    long long odd = (long long) (mantissa >> trailing);
    return (struct dyadic){bits >> 63 ? -odd : odd, (biased ? biased : 1) - 1075 + trailing};
}

/* All numbers of a set are multiples of 2^unit and below 2^top in magnitude. */
struct dyadic_span {
    long unit, top;
};

struct dyadic_span dyadic_span_begin(void); /* of no number: unit INTEGER_NO_EXPONENT, top less */

static inline void dyadic_span_add(struct dyadic_span *span, struct dyadic x)
{
    if (x.mantissa == 0)
        return;
    const uint64_t magnitude = x.mantissa < 0 ? -(uint64_t) x.mantissa : (uint64_t) x.mantissa;
    const long top = x.exponent + 64 - __builtin_clzll(magnitude);
    span->unit = x.exponent < span->unit ? x.exponent : span->unit;
    span->top = top > span->top ? top : span->top;
}

/* The smaller of two units, or exponents. */
long integer_lower_unit(long unit, long exponent);

/* The largest unit, at most the given one, of which all dim numbers are multiples. */
long integer_vector_unit(long unit, const double *v, int dim);

/* out := x / 2^unit. unit <= x.exponent. */
void integer_set(mpz_t out, struct dyadic x, long unit);

/* out := x y / 2^unit. unit <= x.exponent + y.exponent. */
void integer_set_product(mpz_t out, struct dyadic x, struct dyadic y, long unit);

bool integer_is_zero(mpz_t v[3]);

/* out := x y; out is none of the inputs. Numbers whose exponents are far apart end in many zero
 * bits once they share a unit; those take no time here. */
void integer_multiply(mpz_t out, const mpz_t x, const mpz_t y);

/* out := out + sign x y, sign +1 or -1; scratch is overwritten, and is none of the others. */
void integer_add_product(mpz_t out, int sign, const mpz_t x, const mpz_t y, mpz_t scratch);

/* out := u x v, the cross product of vectors of three; out is none of the inputs; scratch is
 * overwritten. */
void integer_cross(mpz_t out[3], mpz_t u[3], mpz_t v[3], mpz_t scratch);

/* out := u . v; out is none of the inputs; scratch is overwritten. */
void integer_dot(mpz_t out, mpz_t u[3], mpz_t v[3], mpz_t scratch);

/* The sign of x y - z w. Decided from the leading bits where these differ. */
int integer_compare_products(const mpz_t x, const mpz_t y, const mpz_t z, const mpz_t w,
                             mpz_t scratch[2]);

enum round_direction { ROUND_DOWN, ROUND_UP };

/* The double next to num / den * 2^unit on the side that direction names, or the value itself
 * where it is a double; den > 0. Infinite, with its sign, where the value lies beyond the
 * largest double, whatever the direction. Zero is never -0. scratch is overwritten. */
double integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                           enum round_direction direction, mpz_t scratch[2]);

#endif
