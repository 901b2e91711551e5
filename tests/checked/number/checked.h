/* In place of service/fmb/number/checked.h: what is checked where bounds are used. */
#ifndef FMB_CHECKED_H
#define FMB_CHECKED_H

#include "number.hpp"

#define CHECK_BOUND(constant, ignored, value, bound)        \
    do {                                                    \
        if (!(ignored))                                     \
            check_bound(#constant, constant, value, bound); \
    } while (0)
#define CHECK_QUOTIENT(constant, ignored, dividend, divisor, inverse, quotient, bound) \
    do {                                                                               \
        if (!(ignored))                                                                \
            check_quotient(#constant, dividend, divisor, inverse, quotient, bound);    \
    } while (0)
#define CHECK_SEGMENT(constant, values, slab, vertex, direction) \
    check_segment(#constant, values, slab, vertex, direction)
#define CHECK_GIVEN(x) given(x)
#define CHECK_SLIP(constant, n, longer, factor, slip) check_slip(#constant, n, longer, factor, slip)
#define CHECK_NORMAL(constant, normal, square, slip) check_normal(#constant, normal, square, slip)
#define CHECK_GIVEN_NORMAL(normal, square) give_normal(normal, square)

struct clip_values;

inline number given(number x)
{
    return x.value;
}

/* Where the macros of the engine lead (checked_bounds.cc). */
void check_bound(const char *name, plain_double constant, number value, number bound);
/* The length of the errors of a vector, against a bound on it: the constant times a length. */
void check_vector(const char *name, plain_double constant, const number *vector, int count,
                  number bound);
void check_slip(const char *constant, const number n[3], number longer, number factor, number slip);
void check_normal(const char *constant, const number normal[3], number &square, number slip);
void give_normal(const number normal[3], number &square);
void check_quotient(const char *constant, number dividend, number divisor, number inverse,
                    number quotient, number bound);
void check_segment(const char *constant, const struct clip_values *values, int slab, int vertex,
                   int direction);

#endif
