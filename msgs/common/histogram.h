/* Histogram of non-negative integers with logarithmic buckets: quantiles in fixed memory. No shared
 * state. */
#ifndef HISTOGRAM_H
#define HISTOGRAM_H

#include <stdint.h>

/* Eight buckets for each power of two: a bucket's upper end is less than 13 % (1/8) above any
 * value in it. Values below 8 have a bucket each. */
enum { HISTOGRAM_STEPS = 8, HISTOGRAM_BUCKETS = 62 * HISTOGRAM_STEPS };

/* All 0 at the start. */
struct histogram {
    int64_t bucket[HISTOGRAM_BUCKETS];
    int64_t count, max;
};

/* A negative value counts as 0: times in results from the bus are untrusted. */
void histogram_add(struct histogram *histogram, int64_t value);

/* An upper bound of the quantile `share`, in (0,1]: the largest value of the bucket that contains
 * it, but at most the largest value added. 0 if the histogram is empty. */
int64_t histogram_quantile(const struct histogram *histogram, double share);

#endif
