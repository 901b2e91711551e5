/* Counts the exact arithmetic of the code under test, in GMP and in integers of fixed width: the
 * link wraps the functions (tests.mk). */
#ifndef EXACT_WORK_H
#define EXACT_WORK_H

/* In products of limbs, about half a nanosecond each: n m for a product of n and m limbs, and for a
 * quotient of n limbs by m; n^2 for an operation on fractions of n limbs; n for a sum; and the most
 * that a slab in integers of fixed width takes. Grows from call to call. */
extern double exact_work;

/* How many slabs of contacts were computed in integers of fixed width. */
extern long exact_slabs;

#endif
