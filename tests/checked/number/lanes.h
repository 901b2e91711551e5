/* In place of service/fmb/number/lanes.h: one lane, or two, which hold numbers of number.hpp. */
#ifndef FMB_LANES_H
#define FMB_LANES_H

#include "inlined.h"

#include "checked.h"

#ifndef LANES
#define LANES 1
#endif

#if LANES == 1

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

#else

struct lanes {
    number at[2];

    number &operator[](int i)
    {
        return at[i];
    }
    const number &operator[](int i) const
    {
        return at[i];
    }
};

struct lanes_mask {
    int64_t at[2]; /* 0 or -1 */
};

#define LANES_OPERATION(op)                         \
    inline lanes operator op(lanes x, lanes y)      \
    {                                               \
        return {x[0] op y[0], x[1] op y[1]};        \
    }                                               \
    inline lanes operator op(number x, lanes y)     \
    {                                               \
        return {x op y[0], x op y[1]};              \
    }                                               \
    inline lanes operator op(lanes x, number y)     \
    {                                               \
        return {x[0] op y, x[1] op y};              \
    }                                               \
    inline lanes &operator op##=(lanes &x, lanes y) \
    {                                               \
        return x = x op y;                          \
    }
LANES_OPERATION(+)
LANES_OPERATION(-)
LANES_OPERATION(*)
LANES_OPERATION(/)
#undef LANES_OPERATION

#define LANES_COMPARISON(op)                         \
    inline lanes_mask operator op(lanes x, lanes y)  \
    {                                                \
        return {-(x[0] op y[0]), -(x[1] op y[1])};   \
    }                                                \
    inline lanes_mask operator op(lanes x, number y) \
    {                                                \
        return {-(x[0] op y), -(x[1] op y)};         \
    }
LANES_COMPARISON(<)
LANES_COMPARISON(<=)
LANES_COMPARISON(==)
#undef LANES_COMPARISON

INLINE lanes operator-(lanes x)
{
    return {-x[0], -x[1]};
}

INLINE lanes_mask operator&(lanes_mask x, lanes_mask y)
{
    return {x.at[0] & y.at[0], x.at[1] & y.at[1]};
}

INLINE lanes_mask &operator&=(lanes_mask &x, lanes_mask y)
{
    return x = x & y;
}

INLINE lanes lanes_max(lanes x, lanes y)
{
    return {extreme(x[0], y[0], false), extreme(x[1], y[1], false)};
}

INLINE lanes lanes_min(lanes x, lanes y)
{
    return {extreme(x[0], y[0], true), extreme(x[1], y[1], true)};
}

INLINE lanes lanes_of(number x)
{
    return {x, x};
}

INLINE lanes lanes_abs(lanes x)
{
    return {fabs(x[0]), fabs(x[1])};
}

INLINE lanes lanes_select(lanes_mask mask, lanes x, lanes y)
{
    return {mask.at[0] ? x[0] : y[0], mask.at[1] ? x[1] : y[1]};
}

INLINE unsigned lanes_mask_bits(lanes_mask mask)
{
    return (unsigned) (mask.at[0] & 1) | (unsigned) (mask.at[1] & 1) << 1;
}

INLINE bool lanes_all(lanes_mask mask)
{
    return lanes_mask_bits(mask) == 3;
}

INLINE lanes given(lanes x)
{
    return {given(x[0]), given(x[1])};
}

#endif

#endif
