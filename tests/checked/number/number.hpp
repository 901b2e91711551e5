/* Numbers that check the bounds on their own errors: what `lanes` are in this build.
 *
 * A number holds the double that the engine computes, bit for bit, and points to a derivation:
 *
 *     exact      the value without any rounding since the doubles that the computation began with.
 *                2,560 bits: sums and products of those are exact, quotients good to 2^-2500
 *     size       bounds the sum of the magnitudes of the monomials that the value is a sum of
 *     roundings  the most that any monomial of it has passed
 *     worst      bounds the error by size and roundings alone: what numbers of these sizes, but of
 *                any signs and digits, may be off by
 *     running    bounds the error by the values at hand, and by whether operations round
 *
 * So |double - exact| <= running and <= worst <= ((1 + u)^roundings - 1) size, u = 2^-53, each of
 * which checked_bounds.cc asserts. Only a number of doubles as they were given has no derivation:
 * it is exact. Numbers are compared by their doubles, so that control flow is that of the engine.
 * They are trivial, so that C code may copy and clear them. Derivations live until arena_clear().
 * Not thread safe. */
#ifndef NUMBER_HPP
#define NUMBER_HPP

#include <gmp.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include <math.h>

typedef double plain_double; /* where `double` is a number (checked_gaps.cc) */

struct derivation {
    mpf_t exact;
    long double size, worst, running;
    int roundings;
};

struct number {
    double value;
    const derivation *from; /* NULL: exact */

    number() = default;
    constexpr number(double x) : value(x), from(nullptr)
    {
    }
};

/* ---- Derivations ---- */

/* A new one, with exact unset and all else 0. */
derivation *arena_take();
void arena_clear();

constexpr long double unit_roundoff = 0x1p-53L;
/* What an operation whose result is not normal may be off by, in addition. */
constexpr long double underflow = 0x1p-1074L;

inline long double size_of(number x)
{
    return x.from ? x.from->size : std::fabs((long double) x.value);
}

inline long double worst_of(number x)
{
    return x.from ? x.from->worst : 0;
}

inline long double running_of(number x)
{
    return x.from ? x.from->running : 0;
}

inline int roundings_of(number x)
{
    return x.from ? x.from->roundings : 0;
}

/* The exact value of x; scratch is for one without a derivation. */
inline mpf_srcptr exact_of(number x, mpf_t scratch)
{
    if (x.from)
        return x.from->exact;
    mpf_set_d(scratch, std::isfinite(x.value) ? x.value : 0);
    return scratch;
}

/* Two for the operands of an operation. */
extern mpf_t scratch[2];

/* A number whose exact value and sizes the caller sets. */
inline number derived(double value, derivation *from)
{
    number out = value;
    from->worst *= 1 + 0x1p-60L; /* for their own rounding */
    from->running *= 1 + 0x1p-60L;
    from->size *= 1 + 0x1p-60L;
    if (!std::isfinite(value))
        from->worst = from->running = INFINITY;
    out.from = from;
    return out;
}

/* Adds the rounding of an operation whose result would be off by worst and by running without it.
 */
inline number rounded(double value, derivation *from, bool exact)
{
    from->worst += unit_roundoff * (from->size + from->worst);
    from->running += exact ? 0 : unit_roundoff * std::fabs((long double) value);
    if (std::fabs(value) < 0x1p-1000) {
        from->worst += underflow;
        from->running += exact ? 0 : underflow;
    }
    from->roundings++;
    return derived(value, from);
}

/* A number that may be off by anything. */
inline number unknown(double value)
{
    derivation *from = arena_take();
    mpf_set_d(from->exact, std::isfinite(value) ? value : 0);
    from->size = from->worst = from->running = INFINITY;
    return derived(value, from);
}

/* ---- Operations ---- */

inline bool is_zero(number x)
{
    return x.value == 0 && !x.from;
}

inline bool is_power_of_two(number x)
{
    int exponent;
    return !x.from && std::fabs(std::frexp(x.value, &exponent)) == 0.5;
}

inline number operator-(number x)
{
    if (!x.from)
        return -x.value;
    derivation *from = arena_take();
    mpf_neg(from->exact, x.from->exact);
    from->size = x.from->size;
    from->worst = x.from->worst;
    from->running = x.from->running;
    from->roundings = x.from->roundings;
    return derived(-x.value, from);
}

/* x, but for the sign of 0. */
inline number with_value(double value, number x)
{
    x.value = value;
    return x;
}

inline number sum(number x, number y, double value, bool minus)
{
    derivation *from = arena_take();
    (minus ? mpf_sub : mpf_add)(from->exact, exact_of(x, scratch[0]), exact_of(y, scratch[1]));
    /* The sum of two doubles as they were given is one monomial, rounded once. */
    const bool given = !x.from && !y.from;
    from->size =
        given ? std::fabs((long double) value) * (1 + 2 * unit_roundoff) : size_of(x) + size_of(y);
    from->worst = worst_of(x) + worst_of(y);
    from->running = running_of(x) + running_of(y);
    from->roundings = roundings_of(x) > roundings_of(y) ? roundings_of(x) : roundings_of(y);
    /* A number that is doubled is not rounded. */
    if (!minus && x.value == y.value && x.from == y.from)
        return derived(value, from);
    const double other = minus ? -y.value : y.value, part = value - x.value;
    const bool exact = (x.value - (value - part)) + (other - part) == 0;
    return rounded(value, from, exact);
}

inline number operator+(number x, number y)
{
    if (is_zero(x) || is_zero(y))
        return with_value(x.value + y.value, is_zero(x) ? y : x);
    return sum(x, y, x.value + y.value, false);
}

inline number operator-(number x, number y)
{
    if (is_zero(x) || is_zero(y))
        return with_value(x.value - y.value, is_zero(x) ? -y : x);
    return sum(x, y, x.value - y.value, true);
}

inline bool is_exact_product(double x, double y, double product)
{
    return product == 0 ? x == 0 || y == 0
                        : std::fabs(product) >= 0x1p-900 && std::fma(x, y, -product) == 0;
}

inline number operator*(number x, number y)
{
    const double value = x.value * y.value;
    const bool exact = (is_power_of_two(x) || is_power_of_two(y)) && std::fabs(value) >= 0x1p-1022;
    if (is_zero(x) || is_zero(y) || (exact && !x.from && !y.from))
        return value;
    derivation *from = arena_take();
    mpf_mul(from->exact, exact_of(x, scratch[0]), exact_of(y, scratch[1]));
    const long double wx = worst_of(x), wy = worst_of(y), rx = running_of(x), ry = running_of(y);
    from->size = size_of(x) * size_of(y);
    from->worst = wx * size_of(y) + wy * size_of(x) + wx * wy;
    from->running =
        rx * std::fabs((long double) y.value) + ry * std::fabs((long double) x.value) + rx * ry;
    from->roundings = roundings_of(x) + roundings_of(y);
    return exact ? derived(value, from)
                 : rounded(value, from, is_exact_product(x.value, y.value, value));
}

/* A quotient has the monomials of the dividend. It is unknown unless the divisor is farther from 0
 * than its error. */
inline number operator/(number x, number y)
{
    const double value = x.value / y.value;
    const long double least = std::fabs((long double) y.value) - running_of(y);
    if (!(least > 0))
        return y.from ? unknown(value) : value;
    if (is_zero(x) || !std::isfinite(value) || !std::isfinite(y.value))
        return value;
    derivation *from = arena_take();
    mpf_div(from->exact, exact_of(x, scratch[0]), exact_of(y, scratch[1]));
    from->size = size_of(x) / least;
    from->running = (running_of(x) + running_of(y) * std::fabs((long double) value)) / least;
    from->worst = (worst_of(x) + worst_of(y) * from->size) / least;
    from->roundings = roundings_of(x) + roundings_of(y);
    return rounded(value, from, is_exact_product(value, y.value, x.value));
}

inline number &operator+=(number &x, number y)
{
    return x = x + y;
}

inline number &operator-=(number &x, number y)
{
    return x = x - y;
}

inline number &operator*=(number &x, number y)
{
    return x = x * y;
}

inline number &operator/=(number &x, number y)
{
    return x = x / y;
}

#define NUMBER_COMPARISON(op)                   \
    inline bool operator op(number x, number y) \
    {                                           \
        return x.value op y.value;              \
    }
NUMBER_COMPARISON(<)
NUMBER_COMPARISON(>)
NUMBER_COMPARISON(<=)
NUMBER_COMPARISON(>=)
NUMBER_COMPARISON(==)
NUMBER_COMPARISON(!=)
#undef NUMBER_COMPARISON

/* The larger, or with less the smaller one: the larger double and the larger exact value
 * need not be of the same operand. It is off by no more than the operand that is off by more. */
inline number extreme(number x, number y, bool less)
{
    const bool first = less ? x.value < y.value : x.value > y.value;
    if ((!x.from && !y.from) || !std::isfinite(x.value) || !std::isfinite(y.value))
        return first ? x : y;
    derivation *from = arena_take();
    mpf_srcptr a = exact_of(x, scratch[0]), b = exact_of(y, scratch[1]);
    mpf_set(from->exact, (mpf_cmp(a, b) < 0) == less ? a : b);
    from->size = std::fmax(size_of(x), size_of(y));
    from->worst = std::fmax(worst_of(x), worst_of(y));
    from->running = std::fmax(running_of(x), running_of(y));
    from->roundings = roundings_of(x) > roundings_of(y) ? roundings_of(x) : roundings_of(y);
    return derived(first ? x.value : y.value, from);
}

inline number fmax(number x, number y)
{
    return extreme(x, y, false);
}

inline number fmin(number x, number y)
{
    return extreme(x, y, true);
}

inline bool signbit(number x)
{
    return std::signbit(x.value);
}

inline number fabs(number x)
{
    if (!x.from)
        return std::fabs(x.value);
    /* A rounding may have changed the sign. A derivation that others share is not changed. */
    number out = mpf_sgn(x.from->exact) < 0 ? -x : x;
    out.value = std::fabs(x.value);
    return out;
}

inline number copysign(number magnitude, number sign)
{
    const number size = fabs(magnitude);
    return signbit(sign) ? -size : size;
}

inline number fma(number x, number y, number z)
{
    const double value = std::fma(x.value, y.value, z.value);
    derivation *from = arena_take();
    mpf_mul(from->exact, exact_of(x, scratch[0]), exact_of(y, scratch[1]));
    mpf_add(from->exact, from->exact, exact_of(z, scratch[0]));
    const long double wx = worst_of(x), wy = worst_of(y), rx = running_of(x), ry = running_of(y);
    from->size = size_of(x) * size_of(y) + size_of(z);
    from->worst = wx * size_of(y) + wy * size_of(x) + wx * wy + worst_of(z);
    from->running = rx * std::fabs((long double) y.value) + ry * std::fabs((long double) x.value) +
                    rx * ry + running_of(z);
    const int product = roundings_of(x) + roundings_of(y);
    from->roundings = product > roundings_of(z) ? product : roundings_of(z);
    return rounded(value, from, false);
}

/* |sqrt(x) - sqrt(y)| = |x - y| / (sqrt(x) + sqrt(y)). Unknown unless x is farther from 0 than its
 * error. */
inline number sqrt(number x)
{
    const double value = std::sqrt(x.value);
    if (!(x.value - running_of(x) > 0) || !std::isfinite(value))
        return x.from ? unknown(value) : value;
    derivation *from = arena_take();
    mpf_sqrt(from->exact, exact_of(x, scratch[0]));
    from->size = std::sqrt(size_of(x));
    from->worst = worst_of(x) / value;
    from->running = running_of(x) / value;
    from->roundings = roundings_of(x);
    return rounded(value, from, false);
}

/* The result, a whole number, counts as given. */
inline number floor(number x)
{
    return std::floor(x.value);
}

inline number ceil(number x)
{
    return std::ceil(x.value);
}

inline bool isfinite(number x)
{
    return std::isfinite(x.value);
}

inline int ilogb(number x)
{
    return std::ilogb(x.value);
}

inline number ldexp(number x, int exponent)
{
    return x * std::ldexp(1.0, exponent);
}

inline bool isnan(number x)
{
    return std::isnan(x.value);
}

#endif
