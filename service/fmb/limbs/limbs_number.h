/* Integers of n limbs, modulo 2^(64 n), in two's complement. In inlined functions n is a constant
 * for the usual widths. */
#ifndef FMB_LIMBS_NUMBER_H
#define FMB_LIMBS_NUMBER_H

#include "inlined.h"
#include "integer.h"
#include "limbs.h"

#include <stdint.h>
#include <string.h>

/* Sums and products of a few limbs are always inlined, except under AddressSanitizer (inlined.h).
 */
#ifdef INLINED_NEVER
#define LIMBS_INLINE static inline
#define LIMBS_UNROLL
#else
#define LIMBS_INLINE static inline __attribute__((always_inline))
#define LIMBS_UNROLL _Pragma("GCC unroll 6")
#endif

/* Not every file uses all functions. */
#define LIMBS_FUNCTION static __attribute__((unused))

/* A two's complement integer, least significant limb first. Only the first limbs, as many as the
 * pair has, are used. */
typedef uint64_t limbs_number[LIMBS_MAX];

/* A vector. limbs: the number of limbs that hold each coordinate with its sign. other_than_0: bit i
 * is set if coordinate i is not 0. */
struct limbs_vector {
    int limbs;
    unsigned other_than_0;
    limbs_number at[FMB_DIM_MAX];
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
    LIMBS_UNROLL
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_add_overflow(x[i], y[i], &x[i]);
        carry = __builtin_add_overflow(x[i], (uint64_t) carry, &x[i]) | first;
    }
}

LIMBS_INLINE void subtract(const int n, uint64_t *x, const uint64_t *y)
{
    bool borrow = false;
    LIMBS_UNROLL
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_sub_overflow(x[i], y[i], &x[i]);
        borrow = __builtin_sub_overflow(x[i], (uint64_t) borrow, &x[i]) | first;
    }
}

/* Returns the number of limbs that hold x with a sign; 0 for 0. */
LIMBS_FUNCTION int limbs_needed(int n, const uint64_t *x)
{
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

/* out := out + x y, or out - x y. y has ny limbs with its sign. */
LIMBS_INLINE void add_product(const int n, uint64_t *out, bool minus, const uint64_t *x,
                              const int ny, const uint64_t *y)
{
    const bool negative = is_negative(ny, y);
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
    add_product(n, out, minus, x->at[i], y->limbs, y->at[k]);
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
#define WITH_LIMBS(n, function, ...)          \
    switch (n) {                              \
    case 2: function(2, __VA_ARGS__); break;  \
    case 3: function(3, __VA_ARGS__); break;  \
    case 4: function(4, __VA_ARGS__); break;  \
    case 5: function(5, __VA_ARGS__); break;  \
    default: function(n, __VA_ARGS__); break; \
    }

/* -1, 0 or 1 */
LIMBS_INLINE int sign_of(const int n, const uint64_t *x)
{
    return is_negative(n, x) ? -1 : !is_zero(n, x);
}

LIMBS_INLINE bool is_less(const int n, const uint64_t *x, const uint64_t *y)
{
    limbs_number difference;
    memcpy(difference, x, (size_t) n * sizeof *x);
    subtract(n, difference, y);
    return is_negative(n, difference);
}

/* ---- Not inlined ---- */

/* Sets limbs and other_than_0 of a vector. Functions read these of the factors y and v only. */
LIMBS_FUNCTION void limbs_trim(int n, struct limbs_vector *v)
{
    v->limbs = 0;
    v->other_than_0 = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const int limbs = limbs_needed(n, v->at[axis]);
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
    WITH_LIMBS(n, add_product, out, minus, x, ny, y);
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
    return out;
}

#endif
