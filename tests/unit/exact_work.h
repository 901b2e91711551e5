/* Counts the exact arithmetic that the code under test does by GMP, whose functions the linker
 * wraps (tests.mk). */
#ifndef EXACT_WORK_H
#define EXACT_WORK_H

/* The work so far, in products of limbs of about half a nanosecond each: n m for a product of n and
 * m limbs, and for a division of n + m - 1 limbs by m; n^2 for an operation on fractions of n
 * limbs; n for a sum or a shift. Integers of at most 512 bits are not counted: their work is
 * small. */
extern double exact_work;

/* Number of ends of contacts and boxes that were computed exactly. */
extern long exact_ends;

/* Number of products of an integer and a double, as in the value of a vertex in a direction. */
extern long exact_terms;

#endif
