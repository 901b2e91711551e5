#include "histogram.h"

#include <math.h>

/* If h >= 3 is the index of the highest bit that is set, the three bits below it choose one of the
 * eight buckets of this power of two. */
static int bucket_of(int64_t value)
{
    if (value < HISTOGRAM_STEPS)
        return (int) value;
    int shift = 63 - __builtin_clzll((unsigned long long) value) - 3;
    return shift * HISTOGRAM_STEPS + (int) (value >> shift);
}

/* The largest value of a bucket. */
static int64_t end_of(int bucket)
{
    if (bucket < 2 * HISTOGRAM_STEPS)
        return bucket;
    int shift = bucket / HISTOGRAM_STEPS - 1;
    uint64_t leading = (uint64_t) (bucket % HISTOGRAM_STEPS + HISTOGRAM_STEPS);
    return (int64_t) (((leading + 1) << shift) - 1);
}

void histogram_add(struct histogram *histogram, int64_t value)
{
    histogram->bucket[bucket_of(value > 0 ? value : 0)]++;
    histogram->count++;
    if (value > histogram->max)
        histogram->max = value;
}

int64_t histogram_quantile(const struct histogram *histogram, double share)
{
    int64_t rank = (int64_t) ceil(share * (double) histogram->count), seen = 0;
    for (int b = 0; b < HISTOGRAM_BUCKETS; b++) {
        seen += histogram->bucket[b];
        if (seen >= rank && seen > 0)
            return end_of(b) < histogram->max ? end_of(b) : histogram->max;
    }
    return 0;
}
