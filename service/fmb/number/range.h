/* A number known to lie in [low, high], with sums and products rounded outward. What is exact stays
 * exact: the error of a sum of two doubles is a double, and so is that of a product (Knuth, The Art
 * of Computer Programming, volume 2, 4.2.2, theorem B), and its sign says on which side the
 * rounded value lies.
 *
 * All numbers here are far from overflow. Sums do not underflow: what is below the smallest
 * normal number is exact. */
#ifndef FMB_RANGE_H
#define FMB_RANGE_H

#include <math.h>

struct range {
    double low, high;
};

static inline struct range range_of(double x)
{
    return (struct range){x, x};
}

static inline double range_least(double x, double y)
{
    return x < y ? x : y;
}

static inline double range_greatest(double x, double y)
{
    return x > y ? x : y;
}

static inline double range_sum_error(double x, double y, double sum)
{
    const double part = sum - x;
    return (x - (sum - part)) + (y - part);
}

/* One or two doubles further: 2^-52 |x| is between one and two units in the last place of a normal
 * number. */
static inline double range_step_below(double x)
{
    return x - fabs(x) * 0x1p-52;
}

static inline double range_step_above(double x)
{
    return x + fabs(x) * 0x1p-52;
}

static inline struct range range_sum(struct range x, struct range y)
{
    struct range sum = {x.low + y.low, x.high + y.high};
    if (range_sum_error(x.low, y.low, sum.low) < 0)
        sum.low = range_step_below(sum.low);
    if (range_sum_error(x.high, y.high, sum.high) > 0)
        sum.high = range_step_above(sum.high);
    return sum;
}

/* Below 2^-900 the error of a product may not be a double; there it is at most 2^-953. */
static inline struct range range_product(double x, double y)
{
    const double product = x * y;
    if (product == 0 && (x == 0 || y == 0))
        return range_of(0);
    if (fabs(product) < 0x1p-900)
        return (struct range){product - 0x1p-953, product + 0x1p-953};
    const double error = fma(x, y, -product);
    return (struct range){error < 0 ? range_step_below(product) : product,
                          error > 0 ? range_step_above(product) : product};
}

#endif
