/* How numbers >= 0 are spread over many powers of two: quantiles of any number of them in fixed
 * memory. */
#ifndef SPREAD_H
#define SPREAD_H

#include <stdint.h>

/* Eight buckets an octave, from 2^-80 to 2^48: a bucket's upper end is at most 1/8 above any value
 * in it. Zero, what is below and what is above have a bucket each. */
enum {
    SPREAD_STEPS = 8,
    SPREAD_LOWEST = -80,
    SPREAD_HIGHEST = 48,
    SPREAD_BUCKETS = SPREAD_STEPS * (SPREAD_HIGHEST - SPREAD_LOWEST) + 3
};

/* All 0 at the start. */
struct spread {
    uint32_t bucket[SPREAD_BUCKETS];
    uint64_t count;
    double max;
};

void spread_add(struct spread *spread, double value); /* >= 0, may be infinite */
void spread_merge(struct spread *into, const struct spread *from);

/* The upper end of the bucket that holds the quantile, at most the maximum; 0 if there are none. */
double spread_quantile(const struct spread *spread, double share);

#endif
