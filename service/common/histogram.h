/* Times, counted in buckets: quantiles of any number of them in fixed memory. */
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

/* value >= 0. */
void histogram_add(struct histogram *histogram, int64_t value);

/* The least upper end of a bucket that share (in (0,1]) of the values are not above, at most the
 * maximum; 0 if there are none. */
int64_t histogram_quantile(const struct histogram *histogram, double share);

#endif
