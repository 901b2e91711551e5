/* In place of service/fmb/number/lanes.h: one lane, which holds a number of number.hpp. */
#ifndef FMB_LANES_H
#define FMB_LANES_H

#include "inlined.h"

#include "number.hpp"

#define LANES 1

#define CHECK_BOUND(constant, ignored, value, bound) \
    do {                                             \
        if (!(ignored))                              \
            check_bound(#constant, value, bound);    \
    } while (0)
#define CHECK_QUOTIENT(constant, ignored, dividend, divisor, inverse, quotient, bound) \
    do {                                                                               \
        if (!(ignored))                                                                \
            check_quotient(#constant, dividend, divisor, inverse, quotient, bound);    \
    } while (0)
#define CHECK_SEGMENT(constant, values, slab, vertex, direction) \
    check_segment(#constant, values, slab, vertex, direction)
#define CHECK_GIVEN(x) number((x).value)

struct clip_values;

/* Where the macros of the engine lead (checked_bounds.cc). */
void check_bound(const char *constant, number value, number bound);
void check_quotient(const char *constant, number dividend, number divisor, number inverse,
                    number quotient, number bound);
void check_segment(const char *constant, const struct clip_values *values, int slab, int vertex,
                   int direction);

typedef number lanes;
typedef uint64_t lanes_bits;
typedef int lanes_mask; /* 0 or 1 */

INLINE lanes lanes_max(lanes x, lanes y)
{
    return extreme(x, y, false);
}

INLINE lanes lanes_min(lanes x, lanes y)
{
    return extreme(x, y, true);
}

INLINE lanes lanes_load(const double *from)
{
    return *from;
}

INLINE lanes lanes_of(lanes x)
{
    return x;
}

INLINE lanes_bits lanes_as_bits(lanes x)
{
    lanes_bits out;
    memcpy(&out, &x.value, sizeof out);
    return out;
}

INLINE lanes lanes_from_bits(lanes_bits x)
{
    double out;
    memcpy(&out, &x, sizeof out);
    return out;
}

INLINE lanes lanes_abs(lanes x)
{
    return fabs(x);
}

INLINE lanes lanes_select(lanes_mask mask, lanes x, lanes y)
{
    return mask ? x : y;
}

INLINE lanes_bits lanes_bits_where(lanes_mask mask, lanes_bits x)
{
    return mask ? x : 0;
}

INLINE lanes lanes_copysign(lanes magnitude, lanes x)
{
    return signbit(x) ? -magnitude : magnitude;
}

INLINE unsigned lanes_mask_bits(lanes_mask mask)
{
    return (unsigned) mask;
}

INLINE bool lanes_all(lanes_mask mask)
{
    return mask;
}

INLINE unsigned lanes_greater_bits(lanes x, lanes y)
{
    return x > y;
}

#endif
