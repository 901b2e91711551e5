/* A segment, s in [0,1], cut by inequalities c + s g >= 0 that are known within errors only.
 *
 * Where the true c and g lie within e of the ones at hand, the true inequality holds wherever
 * (c - e) + s (g - e) >= 0 does, and only where (c + e) + s (g + e) >= 0 does, for all s >= 0. So
 * the same cut, made once with the larger numbers and once with the smaller ones, gives an outer
 * and an inner part of the segment. Quotients round outward and inward accordingly.
 *
 * In a header to be inlined: it is the inner loop of contact and box. */
#ifndef FMB_CLIP_H
#define FMB_CLIP_H

#include <math.h>
#include <stdbool.h>

/* What is left: low <= s <= high; nothing where low > high. */
struct clip {
    double low, high;
};

/* With q = x / y rounded, 0 <= q <= 2: a number that is not larger (not smaller) than the true
 * quotient. It is moved by 2^-51 q, more than twice its error even after that is rounded again;
 * quotients below 2^-900, where underflow might tell, become 0 (2^-899). Where x and y are exact
 * (rounds = false) it is worth asking the remainder q y - x, a double itself, on which side q lies:
 * what is exact stays so. */
static inline double quotient_below(double x, double y, bool rounds)
{
    const double q = x / y;
    if (!rounds && q >= 0x1p-100)
        return fma(q, y, -x) > 0 ? nextafter(q, 0) : q;
    return q < 0x1p-900 ? 0 : q - q * 0x1p-51;
}

static inline double quotient_above(double x, double y, bool rounds)
{
    const double q = x / y;
    if (!rounds && (q == 0 || q >= 0x1p-100))
        return fma(q, y, -x) < 0 ? nextafter(q, 3) : q;
    return q < 0x1p-900 ? 0x1p-899 : q + q * 0x1p-51;
}

/* Cuts by c + s g >= 0, on the outer side (or on the inner one). Where a cut lies beyond the ends
 * of the segment it is not asked where, so that quotients lie in [0,1]. */
static inline void clip_cut(struct clip *clip, double c, double g, bool outer, bool rounds)
{
    if (c >= 0 && c + g >= 0)
        return;
    if (c < 0 && c + g < 0) {
        *clip = (struct clip){2, -1};
    } else if (c < 0) {
        const double low = outer ? quotient_below(-c, g, rounds) : quotient_above(-c, g, rounds);
        clip->low = low > clip->low ? low : clip->low;
    } else {
        const double high = outer ? quotient_above(c, -g, rounds) : quotient_below(c, -g, rounds);
        clip->high = high < clip->high ? high : clip->high;
    }
}

/* An inequality whose c is known within c_error, and its g within g_error. */
struct inequality {
    double c, g, c_error, g_error;
};

/* It holds nowhere on the segment, or everywhere: known without a cut, and so it is mostly. */
static inline bool never_holds(const struct inequality *x)
{
    const double c = x->c + x->c_error;
    return c < 0 && c + (x->g + x->g_error) < 0;
}

/* It holds strictly at some s of the segment. */
static inline bool surely_holds(const struct inequality *x)
{
    const double c = x->c - x->c_error;
    return c > 0 || c + (x->g - x->g_error) > 0;
}

static inline bool always_holds(const struct inequality *x)
{
    const double c = x->c - x->c_error;
    return c >= 0 && c + (x->g - x->g_error) >= 0;
}

/* Cuts both parts of a segment. */
static inline void clip_both(struct clip *outer, struct clip *inner, const struct inequality *x,
                             bool rounds)
{
    if (always_holds(x))
        return;
    clip_cut(outer, x->c + x->c_error, x->g + x->g_error, true, rounds);
    clip_cut(inner, x->c - x->c_error, x->g - x->g_error, false, rounds);
}

#endif
