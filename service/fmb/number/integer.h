/* Conversion of doubles to exact integers, and of exact ratios back to doubles.
 *
 * Every finite double is a dyadic number, mantissa * 2^exponent. A set of them is converted,
 * without rounding, to integers times one common power of two, 2^unit. Sums and products of the
 * integers are computed by GMP. No shared state. */
#ifndef FMB_INTEGER_H
#define FMB_INTEGER_H

#include <float.h>
#include <gmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Every error bound of the engine holds for operations on doubles that are each rounded once, to
 * nearest. */
#if defined __FAST_MATH__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__) || \
    defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ || FLT_EVAL_METHOD != 0
#error \
    "compile without -ffast-math and -Ofast, and for arithmetic in doubles (-mfpmath=sse): answers would be wrong"
#endif

/* value = mantissa * 2^exponent; the mantissa is odd, or 0 with exponent INTEGER_NO_EXPONENT. */
struct dyadic {
    long long mantissa; /* |mantissa| < 2^53 */
    long exponent;
};

/* The exponent of 0. Larger than every other exponent, so that 0 does not affect a minimum. */
#define INTEGER_NO_EXPONENT 1000000L

/* Returns a finite double as a dyadic number. This function and dyadic_span_add() are inline
 * because they are called for each number of each frame that is made.
 *
 * The bits of a double: sign 1, biased exponent e 11, fraction f 52. The value is
 * (2^52 + f) 2^(e - 1075), or f 2^-1074 if e = 0. */
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

/* The bits that a set of numbers spans: all are multiples of 2^unit and below 2^top in magnitude.
 */
struct dyadic_span {
    long unit, top;
};

/* Returns the span of the empty set: unit INTEGER_NO_EXPONENT, top -INTEGER_NO_EXPONENT. */
struct dyadic_span dyadic_span_begin(void);

/* Adds multiples of 2^unit below 2^top in magnitude to the set. */
static inline void dyadic_span_extend(struct dyadic_span *span, long unit, long top)
{
    span->unit = unit < span->unit ? unit : span->unit;
    span->top = top > span->top ? top : span->top;
}

/* Adds x to the set. */
static inline void dyadic_span_add(struct dyadic_span *span, struct dyadic x)
{
    if (x.mantissa == 0)
        return;
    const uint64_t magnitude = x.mantissa < 0 ? -(uint64_t) x.mantissa : (uint64_t) x.mantissa;
    dyadic_span_extend(span, x.exponent, x.exponent + 64 - __builtin_clzll(magnitude));
}

/* Calls one of mpz_init and mpz_clear for every number of an array, or of a struct of such arrays,
 * which holds nothing else. */
void integer_each(void *numbers, size_t bytes, void (*call)(mpz_ptr));

/* Calls mpz_init or mpz_clear for every number of a struct from the member `first` to its end,
 * where it holds nothing but numbers and arrays of them. */
#define INTEGER_EACH_FROM(first, object, call) \
    integer_each(&(object)->first, sizeof *(object) -offsetof(__typeof__(*(object)), first), call)

/* out := x / 2^unit. In: unit <= x.exponent. */
void integer_set(mpz_t out, struct dyadic x, long unit);

/* out := the numbers v, scaled by a power of two so that the largest magnitude is in [1/32, 1/16);
 * of a vector of three coordinates, |out| < 1/9. Each number is truncated to 53 bits. Its error is
 * at most 2^-52 of itself, plus 2^-1074 if it is far smaller than the largest. In: count is at most
 * INTEGER_ROUND_MAX. */
enum { INTEGER_ROUND_MAX = 6 };
void integer_round(mpz_t *v, int count, double *out);

/* out := (x + y) / 2^unit. In: both are multiples of 2^unit. */
void integer_set_sum(mpz_t out, double x, double y, long unit);

/* out := x y / 2^unit. In: unit <= x.exponent + y.exponent. */
void integer_set_product(mpz_t out, struct dyadic x, struct dyadic y, long unit);

/* Returns whether all three coordinates are 0. */
bool integer_is_zero(mpz_t v[3]);

/* out := x y. In: out is neither x nor y. Fast for integers that end in many zero bits, as doubles
 * with exponents far apart do in a common unit. */
void integer_multiply(mpz_t out, const mpz_t x, const mpz_t y);

/* out := out + sign x y. In: sign is +1 or -1; scratch, which is overwritten, is none of the other
 * arguments. */
void integer_add_product(mpz_t out, int sign, const mpz_t x, const mpz_t y, mpz_t scratch);

/* out := u x v, the cross product. In: out is neither u nor v. scratch is overwritten. */
void integer_cross(mpz_t out[3], mpz_t u[3], mpz_t v[3], mpz_t scratch);

/* out := u . v. In: out is none of the inputs. scratch is overwritten. */
void integer_dot(mpz_t out, mpz_t u[3], mpz_t v[3], mpz_t scratch);

/* Returns a number with the sign of x y - z w. Uses the leading bits if they decide it. scratch is
 * overwritten. */
int integer_compare_products(const mpz_t x, const mpz_t y, const mpz_t z, const mpz_t w,
                             mpz_t scratch[2]);

enum round_direction { ROUND_DOWN, ROUND_UP };

/* Returns num / den * 2^unit, rounded in the given direction: the value itself if it is a double,
 * else the next double on that side. If its magnitude is above the largest double, returns infinity
 * with its sign, in either direction. Never returns -0. In: den > 0. scratch is overwritten. */
double integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                           enum round_direction direction, mpz_t scratch[2]);

#endif
