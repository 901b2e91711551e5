/* Cosines and sines with the same bits on every machine: no function of the math library that
 * rounds is called. */
#ifndef TURN_H
#define TURN_H

/* Bounds the error of each number of turn_degrees(), for up to 360 degrees, and of turn_radians(),
 * for up to TURN_RADIANS_MAX. turn.c has the proof. */
#define TURN_ERROR 0x1p-50

/* On output: turn[0] is the cosine, turn[1] the sine. Multiples of 90 degrees are exact. In: a
 * finite angle. */
void turn_degrees(double degrees, double turn[2]);

/* The double nearest to a multiple of pi / 4, if it is below 4, stands for that multiple: the
 * numbers are 0 and +-1, or have equal magnitudes. In: at most TURN_RADIANS_MAX in magnitude. */
#define TURN_RADIANS_MAX 0x1p20
void turn_radians(double radians, double turn[2]);

/* Scales q, not all 0, by a power of two, so that its largest number is from 1/2 to 1: no square
 * overflows. */
void turn_scale(double q[4]);

/* Returns n = |q|^2, and n times the matrix of the rotation by q = (w, x, y, z). Each entry, and n,
 * is a sum of at most four products whose magnitudes add up to n: an error of at most 4 u n. */
double turn_matrix(const double q[4], double row[3][3]);

#endif
