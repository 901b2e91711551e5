/* SIMD vectors of doubles. The includer defines LANES, the number of doubles of a vector, before
 * this header: 1 (plain C), or 2, 4 or 8 (the vector types of gcc and clang).
 *
 * Each lane has the same bits as scalar code: sums, products and quotients are those of IEEE 754,
 * and the other operations do not round. This does not hold if the compiler may fuse operations
 * (-ffp-contract=fast); a file that promises exact bits is compiled without that option. */
#ifndef FMB_LANES_H
#define FMB_LANES_H

#include "checked.h"
#include "inlined.h"

#ifndef LANES /* the header is compiled by itself */
#define LANES 1
#endif

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if LANES == 1
typedef double lanes;
typedef uint64_t lanes_bits;
typedef int lanes_mask; /* 0 or 1 */
#else
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef uint64_t lanes_bits __attribute__((vector_size(8 * LANES)));
typedef int64_t lanes_mask __attribute__((vector_size(8 * LANES))); /* 0 or -1 */
#if defined(__x86_64__)
#include <immintrin.h>
#endif

/* The lanes of x and y with these indices. The lanes of y are numbered after the lanes of x. gcc 11
 * lacks __builtin_shufflevector(). */
#if defined(__clang__) || __GNUC__ >= 12
#define SHUFFLED(x, y, ...) __builtin_shufflevector(x, y, __VA_ARGS__)
#else
#define SHUFFLED(x, y, ...) __builtin_shuffle(x, y, (lanes_mask){__VA_ARGS__})
#endif
#endif

/* The intrinsics of a register of LANES doubles. */
#if LANES == 2 && defined(__SSE2__)
typedef __m128d lanes_register;
#define LANES_PD(name) _mm_##name##_pd
#elif LANES == 4 && defined(__AVX__)
typedef __m256d lanes_register;
#define LANES_PD(name) _mm256_##name##_pd
#elif LANES == 8 && defined(__AVX512F__)
typedef __m512d lanes_register;
#define LANES_PD(name) _mm512_##name##_pd
#endif

/* x > y ? x : y and x < y ? x : y, lane by lane. If x or y is a NaN, the result is y. */
INLINE lanes lanes_max(lanes x, lanes y)
{
#if LANES == 1
    return x > y ? x : y;
#elif defined(LANES_PD)
    return (lanes) LANES_PD(max)((lanes_register) x, (lanes_register) y);
#else
    const lanes_mask first = x > y;
    return (lanes) ((first & (lanes_mask) x) | (~first & (lanes_mask) y));
#endif
}

INLINE lanes lanes_min(lanes x, lanes y)
{
#if LANES == 1
    return x < y ? x : y;
#elif defined(LANES_PD)
    return (lanes) LANES_PD(min)((lanes_register) x, (lanes_register) y);
#else
    const lanes_mask first = x < y;
    return (lanes) ((first & (lanes_mask) x) | (~first & (lanes_mask) y));
#endif
}

/* x in all lanes. */
INLINE lanes lanes_of(double x)
{
    lanes out = {0};
    return out + x;
}

/* Reads [LANES]. */
INLINE lanes lanes_load(const double *from)
{
    lanes out;
    memcpy(&out, from, sizeof out);
    return out;
}

/* The representation of each lane. */
INLINE lanes_bits lanes_as_bits(lanes x)
{
    lanes_bits out;
    memcpy(&out, &x, sizeof out);
    return out;
}

INLINE lanes lanes_from_bits(lanes_bits x)
{
    lanes out;
    memcpy(&out, &x, sizeof out);
    return out;
}

/* |x| */
INLINE lanes lanes_abs(lanes x)
{
#if LANES == 1
    return fabs(x);
#else
    return (lanes) ((lanes_mask) x & INT64_MAX);
#endif
}

/* x in the lanes where the mask is set, y in the others. */
INLINE lanes lanes_select(lanes_mask mask, lanes x, lanes y)
{
#if LANES == 1
    return mask ? x : y;
#elif LANES == 4 && defined(__AVX__)
    return (lanes) _mm256_blendv_pd((__m256d) y, (__m256d) x, (__m256d) mask);
#else
    return (lanes) ((mask & (lanes_mask) x) | (~mask & (lanes_mask) y));
#endif
}

/* x in the lanes where the mask is set, 0 in the others. */
INLINE lanes_bits lanes_bits_where(lanes_mask mask, lanes_bits x)
{
#if LANES == 1
    return mask ? x : 0;
#else
    return (lanes_bits) mask & x;
#endif
}

/* magnitude with the sign of x. In: magnitude >= 0. */
INLINE lanes lanes_copysign(lanes magnitude, lanes x)
{
#if LANES == 1
    return copysign(magnitude, x);
#else
    return (lanes) ((lanes_mask) magnitude | ((lanes_mask) x & INT64_MIN));
#endif
}

/* Bit i is 1 if the mask is set in lane i. */
INLINE unsigned lanes_mask_bits(lanes_mask mask)
{
#if LANES == 1
    return (unsigned) mask;
#elif LANES == 8 && defined(__AVX512F__)
    return _mm512_test_epi64_mask((__m512i) mask, (__m512i) mask);
#elif defined(LANES_PD)
    return (unsigned) LANES_PD(movemask)((lanes_register) mask);
#else
    unsigned bits = 0;
    for (int i = 0; i < LANES; i++)
        bits |= (unsigned) (mask[i] & 1) << i;
    return bits;
#endif
}

/* Whether the mask is set in all lanes. */
INLINE bool lanes_all(lanes_mask mask)
{
    return lanes_mask_bits(mask) == (1u << LANES) - 1;
}

/* Bit i is 1 if x > y in lane i. Avoids the mask where comparisons give the bits directly. */
INLINE unsigned lanes_greater_bits(lanes x, lanes y)
{
#if LANES == 8 && defined(__AVX512F__)
    return _mm512_cmp_pd_mask((__m512d) x, (__m512d) y, _CMP_GT_OQ);
#else
    return lanes_mask_bits(x > y);
#endif
}

#if LANES <= 2

/* The two lanes in reverse order. */
INLINE lanes lanes_swap(lanes x)
{
#if LANES == 1
    return x;
#else
    return SHUFFLED(x, x, 1, 0);
#endif
}

#endif

#endif
