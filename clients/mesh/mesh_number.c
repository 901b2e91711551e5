/* Method. Let w be the digits as an integer, and w * 10^e the value. If w <= 2^53 and |e| <= 22,
 * both w and 10^|e| = 2^|e| 5^|e| are doubles, since 5^22 < 2^53. Then w * 10^e or w / 10^-e is one
 * operation on two doubles, which IEEE 754 rounds to the double nearest to the exact product or
 * quotient, ties to even. This is the correctly rounded value, as no other rounding takes place.
 * The result is 0 or between 1e-22 and 2^53 * 1e22, so it is neither subnormal nor infinite. All
 * other numbers are passed to strtod(), which also rounds correctly.
 *
 * w is exact for up to 19 digits, as 10^19 < 2^64. With more digits w is not used. */
#include "mesh_source.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The operation is rounded once only if doubles are not evaluated in a wider type. */
enum { IS_ROUNDED_ONCE = FLT_EVAL_METHOD == 0, DIGITS_MAX = 19, POWER_MAX = 22 };

/* A larger exponent than any double has. The digits that are used cannot compensate for it. */
enum { EXPONENT_MAX = 100000 };

static const double ten_to[POWER_MAX + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

/* A parsed number: digits, and a decimal exponent. */
struct decimal {
    uint64_t digits; /* as an integer, modulo 2^64 */
    ptrdiff_t count; /* number of digits, leading zeros included */
    ptrdiff_t decimals;
    int exponent;
};

static inline bool is_digit(unsigned char byte)
{
    return byte >= '0' && byte <= '9';
}

static inline const unsigned char *read_digits(const unsigned char *at, uint64_t *digits)
{
    for (; is_digit(*at); at++)
        *digits = 10 * *digits + (unsigned) (*at - '0');
    return at;
}

/* In: e: the letter e. Returns the position after the exponent. An e without digits after it is not
 * part of the number. */
static const unsigned char *read_exponent(const unsigned char *e, int *exponent)
{
    const unsigned char *at = e + 1;
    const bool negative = *at == '-';
    int value = 0;
    at += *at == '-' || *at == '+';
    if (!is_digit(*at))
        return e;
    for (; is_digit(*at); at++)
        value = value < EXPONENT_MAX ? 10 * value + (*at - '0') : value;
    *exponent = negative ? -value : value;
    return at;
}

/* In: at: the position after the sign. Returns NULL if there are no digits. */
static inline const unsigned char *read_decimal(const unsigned char *at, struct decimal *out)
{
    const unsigned char *begin = at;
    at = read_digits(at, &out->digits);
    out->count = at - begin;
    if (*at == '.') {
        const unsigned char *point = at;
        at = read_digits(at + 1, &out->digits);
        out->decimals = at - point - 1;
        out->count += out->decimals;
    }
    if (out->count == 0)
        return NULL;
    return *at == 'e' || *at == 'E' ? read_exponent(at, &out->exponent) : at;
}

static const unsigned char *read_word(const unsigned char *at, double *value)
{
    static const struct {
        const char *text;
        double value;
    } words[] = {{"nan", NAN}, {"infinity", INFINITY}, {"inf", INFINITY}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const size_t length = strlen(words[i].text);
        if (strncasecmp((const char *) at, words[i].text, length) == 0) {
            *value = words[i].value;
            return at + length;
        }
    }
    return NULL;
}

static inline bool is_exact_in_doubles(const struct decimal *decimal, ptrdiff_t power)
{
    return IS_ROUNDED_ONCE && decimal->count <= DIGITS_MAX &&
           decimal->digits <= UINT64_C(1) << DBL_MANT_DIG && power >= -POWER_MAX &&
           power <= POWER_MAX;
}

const unsigned char *mesh_number(const unsigned char *at, double *value)
{
    struct decimal decimal = {0};
    const bool negative = *at == '-';
    const unsigned char *begin = at + (negative || *at == '+');
    const unsigned char *end = read_decimal(begin, &decimal);
    if (!end) {
        end = read_word(begin, value);
    } else {
        const ptrdiff_t power = decimal.exponent - decimal.decimals;
        if (!is_exact_in_doubles(&decimal, power))
            *value = strtod((const char *) begin, NULL);
        else if (power < 0)
            *value = (double) decimal.digits / ten_to[-power];
        else
            *value = (double) decimal.digits * ten_to[power];
    }
    if (end && negative)
        *value = -*value;
    return end;
}
