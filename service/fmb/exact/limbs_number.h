/* Integers of n limbs, modulo 2^(64 n), in two's complement. A file that includes this header and
 * those that include it sets LIMBS_MAX, the capacity of its numbers: limbs_narrow.c and
 * limbs_wide.c. In inlined functions n is a constant for the usual widths. */
#ifndef FMB_LIMBS_NUMBER_H
#define FMB_LIMBS_NUMBER_H

#include "integer.h"
#include "limbs.h"

#include <stdint.h>
#include <string.h>

#ifndef LIMBS_MAX
#define LIMBS_MAX LIMBS_NARROW
#endif

/* Always inlined: sums and products of a few limbs. */
#define LIMBS_INLINE static inline __attribute__((always_inline))
#define LIMBS_UNROLL _Pragma("GCC unroll 6")

/* Not every file uses all functions. */
#define LIMBS_FUNCTION static __attribute__((unused))

/* A two's complement integer, least significant limb first. Only the first limbs, as many as the
 * pair has, are used. */
typedef uint64_t limbs_number[LIMBS_MAX];

/* Digits. An integer in two's complement is the sum of its limbs as signed integers, each increased
 * by 1 where the limb below it is negative: limb i is a digit of magnitude at most 2^63, times
 * 2^(64 i). The digit of a limb that only repeats the sign of the limb below it is 0. Since
 * exponents are far apart, most digits of wide numbers are 0. */
enum {
    DIGITS_APART = 4,                                            /* so many zeros end a run */
    DIGIT_RUNS = (LIMBS_MAX + DIGITS_APART) / (1 + DIGITS_APART) /* the most runs of a number */
};

/* The digits of a number: its runs, which contain few zeros, and how many digits are not 0. */
struct digit_runs {
    unsigned char digits, count;
    struct {
        unsigned char first, end;
    } run[DIGIT_RUNS];
};

/* A vector. limbs: the number of limbs that hold each coordinate with its sign. other_than_0: bit i
 * is set if coordinate i is not 0. digits: set for wide numbers only. */
struct limbs_vector {
    int limbs;
    unsigned other_than_0;
    limbs_number at[FMB_DIM_MAX];
    struct digit_runs digits[FMB_DIM_MAX];
};

/* ---- Inlined ---- */

typedef unsigned __int128 two_limbs;

LIMBS_INLINE bool is_negative(const int n, const uint64_t *x)
{
    return n > 0 && x[n - 1] >> 63;
}

LIMBS_INLINE bool is_zero(const int n, const uint64_t *x)
{
    uint64_t bits = 0;
    for (int i = 0; i < n; i++)
        bits |= x[i];
    return bits == 0;
}

LIMBS_INLINE void add(const int n, uint64_t *x, const uint64_t *y)
{
    bool carry = false;
    if (LIMBS_MAX > LIMBS_NARROW) {
        mpn_add_n(x, x, y, n);
        return;
    }
    LIMBS_UNROLL
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_add_overflow(x[i], y[i], &x[i]);
        carry = __builtin_add_overflow(x[i], (uint64_t) carry, &x[i]) | first;
    }
}

LIMBS_INLINE void subtract(const int n, uint64_t *x, const uint64_t *y)
{
    bool borrow = false;
    if (LIMBS_MAX > LIMBS_NARROW) {
        mpn_sub_n(x, x, y, n);
        return;
    }
    LIMBS_UNROLL
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_sub_overflow(x[i], y[i], &x[i]);
        borrow = __builtin_sub_overflow(x[i], (uint64_t) borrow, &x[i]) | first;
    }
}

/* Returns the number of limbs that hold x with a sign; 0 for 0. */
LIMBS_FUNCTION int limbs_needed(int n, const uint64_t *x)
{
    const uint64_t sign = is_negative(n, x) ? UINT64_MAX : 0;
    while (LIMBS_MAX > LIMBS_NARROW && n > 4 &&
           ((x[n - 1] ^ sign) | (x[n - 2] ^ sign) | (x[n - 3] ^ sign) | (x[n - 4] ^ sign) |
            ((x[n - 5] ^ sign) >> 63)) == 0)
        n -= 4;
    while (n > 0 && x[n - 1] == (n > 1 && is_negative(n - 1, x) ? UINT64_MAX : 0))
        n--;
    return n;
}

/* out := out + x y, or out - x y. Neither half of a sum of two limbs and a product overflows. */
LIMBS_INLINE void add_row(const int n, uint64_t *out, bool minus, const uint64_t *x, uint64_t y)
{
    uint64_t carry = 0;
    if (minus) {
        LIMBS_UNROLL
        for (int i = 0; i < n; i++) {
            two_limbs sum = (two_limbs) out[i] - (two_limbs) x[i] * y - carry;
            out[i] = (uint64_t) sum;
            carry = -(uint64_t) (sum >> 64);
        }
        return;
    }
    LIMBS_UNROLL
    for (int i = 0; i < n; i++) {
        two_limbs sum = (two_limbs) out[i] + (two_limbs) x[i] * y + carry;
        out[i] = (uint64_t) sum;
        carry = (uint64_t) (sum >> 64);
    }
}

static inline bool is_negative_below(const uint64_t *x, int i)
{
    return i > 0 && x[i - 1] >> 63;
}

/* Sets the digits of x. Returns the number of limbs that hold x with its sign; 0 for 0. */
static inline int find_digits(const uint64_t *x, int limbs, struct digit_runs *out)
{
    uint64_t sign = 0; /* of the limb below, in all bits */
    out->digits = out->count = 0;
    for (int i = 0; i < limbs; i++) {
        while (i + 4 <= limbs && x[i] == sign && x[i + 1] == sign && x[i + 2] == sign &&
               x[i + 3] == sign)
            i += 4;
        if (i == limbs || x[i] == sign)
            continue;
        sign = -(x[i] >> 63);
        if (out->count == 0 || i - out->run[out->count - 1].end >= DIGITS_APART)
            out->run[out->count++].first = (unsigned char) i;
        out->run[out->count - 1].end = (unsigned char) (i + 1);
        out->digits++;
    }
    return out->count > 0 ? out->run[out->count - 1].end : 0;
}

/* out := out + x 2^(64 i), or out - x 2^(64 i). */
static inline void add_limb(int n, uint64_t *out, bool minus, uint64_t x, int i)
{
    if (x == 0 || i >= n)
        return;
    if (minus)
        mpn_sub_1(out + i, out + i, n - i, x);
    else
        mpn_add_1(out + i, out + i, n - i, x);
}

/* out := out + x y, or out - x y. The value of a run of x is that of its limbs as unsigned
 * integers, minus 2^(64 end) if the last of them is negative, plus 2^(64 first) if the limb below
 * the run is negative. */
LIMBS_FUNCTION void add_digits(int n, uint64_t *out, bool minus, const uint64_t *x,
                               const struct digit_runs *of_x, const uint64_t *y,
                               const struct digit_runs *of_y)
{
    if (of_x->digits < of_y->digits) {
        add_digits(n, out, minus, y, of_y, x, of_x);
        return;
    }
    for (int k = 0; k < of_y->count; k++)
        for (int j = of_y->run[k].first; j < of_y->run[k].end; j++) {
            const uint64_t limb = y[j] + is_negative_below(y, j);
            const bool subtracted = minus != (y[j] >> 63);
            const uint64_t digit = y[j] >> 63 ? -limb : limb;
            for (int r = 0; r < of_x->count && digit > 0; r++) {
                const int from = of_x->run[r].first, to = of_x->run[r].end;
                const int first = j + from, end = j + to < n ? j + to : n;
                if (first >= n)
                    break;
                const uint64_t high = is_negative_below(x, to) ? digit : 0;
                const uint64_t rest = (subtracted ? mpn_submul_1 : mpn_addmul_1)(
                    out + first, x + from, end - first, digit);
                add_limb(n, out, subtracted != (rest < high),
                         rest < high ? high - rest : rest - high, end);
                add_limb(n, out, subtracted, is_negative_below(x, from) ? digit : 0, first);
            }
        }
}

/* out := out + x y, or out - x y. y has ny limbs with its sign. of_x, of_y: the digits; read for
 * wide numbers only. */
LIMBS_INLINE void add_product(const int n, uint64_t *out, bool minus, const uint64_t *x,
                              const struct digit_runs *of_x, const int ny, const uint64_t *y,
                              const struct digit_runs *of_y)
{
    const bool negative = is_negative(ny, y);
    if (LIMBS_MAX > LIMBS_NARROW) {
        add_digits(n, out, minus, x, of_x, y, of_y);
        return;
    }
    add_row(n, out, minus != negative, x, negative ? -y[0] : y[0]);
    bool carry = y[0] == 0; /* -y = ~y + 1 */
    for (int j = 1; j < ny; j++) {
        const uint64_t limb = negative ? ~y[j] + carry : y[j];
        carry = carry && limb == 0;
        add_row(n - j, out + j, minus != negative, x, limb);
    }
}

/* The same for coordinates i and k of vectors. */
LIMBS_INLINE void add_product_of(const int n, uint64_t *out, bool minus,
                                 const struct limbs_vector *x, int i, const struct limbs_vector *y,
                                 int k)
{
    add_product(n, out, minus, x->at[i], &x->digits[i], y->limbs, y->at[k], &y->digits[k]);
}

/* out := x . y */
LIMBS_INLINE void dot_limbs(const int n, const struct limbs_vector *x, const struct limbs_vector *y,
                            uint64_t *out)
{
    memset(out, 0, (size_t) n * sizeof *out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        if (y->other_than_0 >> axis & 1)
            add_product_of(n, out, false, x, axis, y, axis);
}

/* Calls function with n as a constant if it is one of these. */
#define WITH_LIMBS(n, function, ...)              \
    switch (LIMBS_MAX > LIMBS_NARROW ? 0 : (n)) { \
    case 2: function(2, __VA_ARGS__); break;      \
    case 3: function(3, __VA_ARGS__); break;      \
    case 4: function(4, __VA_ARGS__); break;      \
    case 5: function(5, __VA_ARGS__); break;      \
    default: function(n, __VA_ARGS__); break;     \
    }

/* -1, 0 or 1 */
LIMBS_INLINE int sign_of(const int n, const uint64_t *x)
{
    return is_negative(n, x) ? -1 : !is_zero(n, x);
}

LIMBS_INLINE bool is_less(const int n, const uint64_t *x, const uint64_t *y)
{
    limbs_number difference;
    if (LIMBS_MAX > LIMBS_NARROW)
        return is_negative(n, x) != is_negative(n, y) ? is_negative(n, x) : mpn_cmp(x, y, n) < 0;
    memcpy(difference, x, (size_t) n * sizeof *x);
    subtract(n, difference, y);
    return is_negative(n, difference);
}

/* ---- Not inlined ---- */

/* Sets limbs and other_than_0 of a vector, and digits if numbers are wide. Functions read limbs and
 * other_than_0 of the factors y and v only, digits of all factors. */
LIMBS_FUNCTION void limbs_trim(int n, struct limbs_vector *v)
{
    v->limbs = 0;
    v->other_than_0 = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const int limbs = LIMBS_MAX > LIMBS_NARROW ? find_digits(v->at[axis], n, &v->digits[axis])
                                                   : limbs_needed(n, v->at[axis]);
        v->limbs = limbs > v->limbs ? limbs : v->limbs;
        v->other_than_0 |= (unsigned) (limbs > 0) << axis;
    }
}

/* out := x y 2^-unit. In: the result is an integer. */
LIMBS_FUNCTION void limbs_set_product(int n, uint64_t *out, struct dyadic x, struct dyadic y,
                                      long unit)
{
    const __int128 product = (__int128) x.mantissa * y.mantissa;
    const long shift = x.exponent + y.exponent - unit;
    memset(out, 0, (size_t) n * sizeof *out);
    if (product == 0)
        return;
    const two_limbs magnitude = (two_limbs) (product < 0 ? -product : product);
    const int word = (int) (shift / 64), bit = (int) (shift % 64);
    const uint64_t part[3] = {(uint64_t) magnitude << bit, (uint64_t) (magnitude >> (64 - bit)),
                              bit ? (uint64_t) (magnitude >> 64) >> (64 - bit) : 0};
    for (int i = 0; i < 3 && word + i < n; i++)
        out[word + i] = part[i];
    if (product < 0) {
        limbs_number negative = {0};
        subtract(n, negative, out);
        memcpy(out, negative, (size_t) n * sizeof *out);
    }
}

/* out := out + x y, or out - x y; y of ny limbs. */
LIMBS_FUNCTION void limbs_add_product(int n, uint64_t *out, bool minus, const uint64_t *x, int ny,
                                      const uint64_t *y)
{
    struct digit_runs of_x, of_y;
    if (LIMBS_MAX > LIMBS_NARROW) {
        find_digits(x, n, &of_x);
        find_digits(y, ny, &of_y);
    }
    WITH_LIMBS(n, add_product, out, minus, x, &of_x, ny, y, &of_y);
}

/* out := x x y, or y x x where swapped. */
LIMBS_INLINE void cross_limbs(const int n, const struct limbs_vector *x,
                              const struct limbs_vector *y, bool swapped, struct limbs_vector *out)
{
    for (int i = 0; i < 3; i++)
        memset(out->at[i], 0, (size_t) n * sizeof *out->at[i]);
    for (int k = 0; k < 3; k++) {
        const int i = k == 2 ? 0 : k + 1, j = 3 - i - k;
        if (!(y->other_than_0 >> k & 1))
            continue;
        add_product_of(n, out->at[j], !swapped, x, i, y, k);
        add_product_of(n, out->at[i], swapped, x, j, y, k);
    }
}

LIMBS_FUNCTION void limbs_cross(int n, const struct limbs_vector *x, const struct limbs_vector *y,
                                bool swapped, struct limbs_vector *out)
{
    WITH_LIMBS(n, cross_limbs, x, y, swapped, out);
    if (LIMBS_MAX > LIMBS_NARROW)
        limbs_trim(n, out);
}

LIMBS_INLINE void transform_limbs(const int n, const struct limbs_vector row[FMB_DIM_MAX],
                                  const struct limbs_vector *v, struct limbs_vector *out)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const bool shorter = row[axis].limbs < v->limbs;
        dot_limbs(n, shorter ? v : &row[axis], shorter ? &row[axis] : v, out->at[axis]);
    }
}

/* out := row . v; returns out, or v itself if row is NULL (the identity). */
LIMBS_FUNCTION const struct limbs_vector *limbs_transform(int n, const struct limbs_vector *row,
                                                          const struct limbs_vector *v,
                                                          struct limbs_vector *out)
{
    if (!row)
        return v;
    WITH_LIMBS(n, transform_limbs, row, v, out);
    if (LIMBS_MAX > LIMBS_NARROW)
        limbs_trim(n, out);
    return out;
}

#endif
