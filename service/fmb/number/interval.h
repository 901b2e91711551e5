/* Interval arithmetic: a number known to lie in [low, high], with sums rounded outward.
 *
 * Exact results stay exact. The rounding error of a sum of two doubles is a double, and so is that
 * of a product (Knuth, The Art of Computer Programming, volume 2, 4.2.2, theorem B). Its sign says
 * on which side of the true value the rounded one lies.
 *
 * In: all numbers are far from overflow. Sums do not lose bits to underflow: a sum below the
 * smallest normal number is exact. */
#ifndef FMB_INTERVAL_H
#define FMB_INTERVAL_H

#include <math.h>
#include <stdbool.h>

struct interval {
    double low, high;
};

static inline struct interval interval_of(double x)
{
    return (struct interval){x, x};
}

static inline double interval_min(double x, double y)
{
    return x < y ? x : y;
}

static inline double interval_max(double x, double y)
{
    return x > y ? x : y;
}

/* Returns x + y - sum, exactly. In: sum is x + y, rounded. */
static inline double interval_sum_error(double x, double y, double sum)
{
    const double part = sum - x;
    return (x - (sum - part)) + (y - part);
}

/* Returns whether x y = z w exactly. In: the rounding errors of both products are doubles. */
static inline bool interval_same_products(double x, double y, double z, double w)
{
    const double xy = x * y, zw = z * w;
    return xy == zw && fma(x, y, -xy) == fma(z, w, -zw);
}

/* Returns the sum, rounded outward. An end that was rounded inward moves by 2^-52 of itself, one to
 * two units in the last place of a normal number. */
static inline struct interval interval_sum(struct interval x, struct interval y)
{
    struct interval sum = {x.low + y.low, x.high + y.high};
    if (interval_sum_error(x.low, y.low, sum.low) < 0)
        sum.low -= fabs(sum.low) * 0x1p-52;
    if (interval_sum_error(x.high, y.high, sum.high) > 0)
        sum.high += fabs(sum.high) * 0x1p-52;
    return sum;
}

#endif
