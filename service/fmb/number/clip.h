/* Clips the segment s in [0,1] by inequalities c + s g >= 0 whose coefficients have errors.
 *
 * Let the true c and g lie within e of the given ones. For every s >= 0 the true inequality then
 * holds if (c - e) + s (g - e) >= 0, and it holds only if (c + e) + s (g + e) >= 0. Clipping with
 * the larger coefficients gives an outer part, which contains the true part of the segment;
 * clipping with the smaller ones gives an inner part, which the true part contains. Quotients round
 * outward for the outer part and inward for the inner one.
 *
 * The functions are inline because they are the inner loop of contacts. */
#ifndef FMB_CLIP_H
#define FMB_CLIP_H

#include <math.h>
#include <stdbool.h>

/* The remaining part: low <= s <= high; empty if low > high. */
struct clip {
    double low, high;
};

/* Returns an upper or a lower bound of x / y. In: the rounded quotient q lies in [0,2].
 *
 * The bound is q moved by 2^-51 q, which is more than twice the error of q, even after the sum is
 * rounded. Quotients below 2^-900, where underflow may matter, become 0 in the lower bound and
 * 2^-899 in the upper one. If x and y are exact (rounds = false), the bound is tight: the
 * remainder q y - x is a double, and its sign says on which side of x / y the quotient q lies. An
 * exact quotient is returned unchanged. */
static inline double quotient_bound(double x, double y, bool upper, bool rounds)
{
    const double q = x / y, sign = upper ? 1 : -1;
    if (!rounds && (q >= 0x1p-100 || (upper && q == 0)))
        return sign * fma(q, y, -x) < 0 ? nextafter(q, upper ? 3 : 0) : q;
    if (q < 0x1p-900)
        return upper ? 0x1p-899 : 0;
    return q + sign * (q * 0x1p-51);
}

/* Clips by c + s g >= 0, rounding outward if outer, else inward. A cut beyond the ends of the
 * segment is not computed, so that all quotients lie in [0,1]. */
static inline void clip_cut(struct clip *clip, double c, double g, bool outer, bool rounds)
{
    if (c >= 0 && c + g >= 0)
        return;
    if (c < 0 && c + g < 0) {
        *clip = (struct clip){2, -1};
    } else if (c < 0) {
        const double low = quotient_bound(-c, g, !outer, rounds);
        clip->low = low > clip->low ? low : clip->low;
    } else {
        const double high = quotient_bound(c, -g, outer, rounds);
        clip->high = high < clip->high ? high : clip->high;
    }
}

/* The inequality c + s g >= 0. The true c lies within error of c, the true g within error of g. */
struct inequality {
    double c, g, error;
};

/* Whether the true inequality certainly holds everywhere on [0,1]. Most inequalities are decided by
 * this, without a division. */
static inline bool always_holds(const struct inequality *x)
{
    const double c = x->c - x->error;
    return c >= 0 && c + (x->g - x->error) >= 0;
}

/* Clips the outer and the inner part of a segment. rounds: false if c and g are exact. */
static inline void clip_both(struct clip *outer, struct clip *inner, const struct inequality *x,
                             bool rounds)
{
    if (always_holds(x))
        return;
    clip_cut(outer, x->c + x->error, x->g + x->error, true, rounds);
    clip_cut(inner, x->c - x->error, x->g - x->error, false, rounds);
}

#endif
