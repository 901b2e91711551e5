/* Uses of bounds on errors, for the program of tests/checked; nothing elsewhere. */
#ifndef FMB_CHECKED_H
#define FMB_CHECKED_H

/* A use of a bound: in the lanes that are not ignored, value is within bound of the exact value.
 * bound is the constant times some lengths. Checked in the program of tests/checked; nothing
 * elsewhere. */
#define CHECK_BOUND(constant, ignored, value, bound) ((void) 0)
/* The same of a quotient in [-1, 1], (dividend -+ bound) inverse. The true dividend is within bound
 * of dividend - quotient divisor, up to the constant times the divisor. */
#define CHECK_QUOTIENT(constant, ignored, dividend, divisor, inverse, quotient, bound) ((void) 0)
/* The same of a segment of a box: what is left to the bounds of a slab (filter/BOXES.md, 1). */
#define CHECK_SEGMENT(constant, values, slab, vertex, direction) ((void) 0)
/* From here on x counts as given: its error is accounted for elsewhere. */
#define CHECK_GIVEN(x) (x)
/* The direction of n, the cross product of two edges, is off by at most slip where the product of
 * their lengths is `longer` times that of n: factor times the error of n relative to its length. */
#define CHECK_SLIP(constant, n, longer, factor, slip) ((void) 0)
/* The direction of a normal is off by at most slip. From here on the normal counts as given, and
 * square, of its length, is computed from it. */
#define CHECK_NORMAL(constant, normal, square, slip) ((void) 0)
#define CHECK_GIVEN_NORMAL(normal, square) ((void) 0)

#endif
