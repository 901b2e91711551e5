#include "spread.h"

#include <math.h>

enum { ZERO, BELOW, FIRST, ABOVE = SPREAD_BUCKETS - 1 };

/* A number is f 2^e with f in [1,2); within its octave the buckets are equally wide. */
static int bucket_of(double value)
{
    if (value == 0)
        return ZERO;
    if (value < ldexp(1, SPREAD_LOWEST))
        return BELOW;
    if (value >= ldexp(1, SPREAD_HIGHEST))
        return ABOVE;
    int exponent;
    double half = frexp(value, &exponent); /* in [1/2,1), times 2^exponent */
    return FIRST + (exponent - 1 - SPREAD_LOWEST) * SPREAD_STEPS +
           (int) ((2 * half - 1) * SPREAD_STEPS);
}

static double upper_end(int bucket)
{
    if (bucket == ZERO)
        return 0;
    if (bucket == ABOVE)
        return HUGE_VAL;
    int steps = bucket - FIRST + 1;
    if (bucket == BELOW)
        steps = 0;
    return ldexp(1 + (double) (steps % SPREAD_STEPS) / SPREAD_STEPS,
                 SPREAD_LOWEST + steps / SPREAD_STEPS);
}

void spread_add(struct spread *spread, double value)
{
    spread->bucket[bucket_of(value)]++;
    spread->count++;
    spread->max = fmax(spread->max, value);
}

void spread_merge(struct spread *into, const struct spread *from)
{
    for (int i = 0; i < SPREAD_BUCKETS; i++)
        into->bucket[i] += from->bucket[i];
    into->count += from->count;
    into->max = fmax(into->max, from->max);
}

double spread_quantile(const struct spread *spread, double share)
{
    const double wanted = share * (double) spread->count;
    double seen = 0;
    for (int i = 0; i < SPREAD_BUCKETS; i++) {
        seen += spread->bucket[i];
        if (seen >= wanted && seen > 0)
            return fmin(upper_end(i), spread->max);
    }
    return spread->max;
}
