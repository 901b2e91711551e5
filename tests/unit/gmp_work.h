/* Counts what GMP is asked to do by the code under test: the link wraps its functions (tests.mk).
 */
#ifndef GMP_WORK_H
#define GMP_WORK_H

/* In products of limbs, about half a nanosecond each: n m for a product of n and m limbs, and for a
 * quotient of n limbs by m; n^2 for an operation on fractions of n limbs; n for a sum. Grows from
 * call to call. */
extern double gmp_work;

#endif
