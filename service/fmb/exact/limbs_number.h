/* Fixed-width integers of n limbs, modulo 2^(64 n). In inlined functions n is a constant for the
 * usual widths. */
#ifndef FMB_LIMBS_NUMBER_H
#define FMB_LIMBS_NUMBER_H

#include "inlined.h"
#include "integer.h"
#include "pair.h"

#include <stdint.h>
#include <string.h>

/* Above 8 to 12 limbs GMP is as fast on average, and far faster for the slowest pairs, since it
 * skips the zero limbs of numbers whose exponents are far apart: of the pairs that need 13 to 24
 * limbs, the slowest took 0.7 ms here and 0.2 ms in GMP. (test_engine_work.c bounds the
 * difference.) */
enum { LIMBS_MAX = 12 };

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

INLINE bool is_negative(const int n, const uint64_t *x)
{
    return n > 0 && x[n - 1] >> 63;
}

INLINE bool is_zero(const int n, const uint64_t *x)
{
    uint64_t bits = 0;
    for (int i = 0; i < n; i++)
        bits |= x[i];
    return bits == 0;
}

INLINE void add(const int n, uint64_t *x, const uint64_t *y)
{
    bool carry = false;
    UNROLL(6)
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_add_overflow(x[i], y[i], &x[i]);
        carry = __builtin_add_overflow(x[i], (uint64_t) carry, &x[i]) | first;
    }
}

INLINE void subtract(const int n, uint64_t *x, const uint64_t *y)
{
    bool borrow = false;
    UNROLL(6)
    for (int i = 0; i < n; i++) {
        const bool first = __builtin_sub_overflow(x[i], y[i], &x[i]);
        borrow = __builtin_sub_overflow(x[i], (uint64_t) borrow, &x[i]) | first;
    }
}

/* out := out + x y, or out - x y. Neither half of a sum of two limbs and a product overflows. */
INLINE void add_row(const int n, uint64_t *out, bool minus, const uint64_t *x, uint64_t y)
{
    uint64_t carry = 0;
    if (minus) {
        UNROLL(6)
        for (int i = 0; i < n; i++) {
            two_limbs sum = (two_limbs) out[i] - (two_limbs) x[i] * y - carry;
            out[i] = (uint64_t) sum;
            carry = -(uint64_t) (sum >> 64);
        }
        return;
    }
    UNROLL(6)
    for (int i = 0; i < n; i++) {
        two_limbs sum = (two_limbs) out[i] + (two_limbs) x[i] * y + carry;
        out[i] = (uint64_t) sum;
        carry = (uint64_t) (sum >> 64);
    }
}

/* The same for y of ny limbs, with a sign. */
INLINE void add_product(const int n, uint64_t *out, bool minus, const uint64_t *x, const int ny,
                        const uint64_t *y)
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

/* out := x . y */
INLINE void dot_limbs(const int n, const struct limbs_vector *x, const struct limbs_vector *y,
                      uint64_t *out)
{
    memset(out, 0, (size_t) n * sizeof *out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        if (y->other_than_0 >> axis & 1)
            add_product(n, out, false, x->at[axis], y->limbs, y->at[axis]);
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

/* ---- Not inlined ---- */

/* Returns the number of limbs that hold x with a sign; 0 for 0. */
int limbs_needed(int n, const uint64_t *x);

/* Sets limbs and other_than_0 of a vector. The functions below read them of y and v only. */
void limbs_trim(int n, struct limbs_vector *v);

/* out := x y 2^-unit. In: the result is an integer. */
void limbs_set_product(int n, uint64_t *out, struct dyadic x, struct dyadic y, long unit);

/* out := out + x y, or out - x y; y of ny limbs. */
void limbs_add_product(int n, uint64_t *out, bool minus, const uint64_t *x, int ny,
                       const uint64_t *y);

/* out := x x y, or y x x if swapped. */
void limbs_cross(int n, const struct limbs_vector *x, const struct limbs_vector *y, bool swapped,
                 struct limbs_vector *out);

/* out := row . v; returns out, or v itself if row is NULL (the identity). */
const struct limbs_vector *limbs_transform(int n, const struct limbs_vector *row,
                                           const struct limbs_vector *v, struct limbs_vector *out);

#endif
