/* Cosines and sines with the same bits on every machine: nothing of the math library rounds. */
#ifndef TURN_H
#define TURN_H

/* Bounds the distance of each number of turn_degrees() from the exact one, for up to 360 degrees,
 * and of turn_radians(), for up to TURN_RADIANS_MAX: turn.c. */
#define TURN_ERROR 0x1p-50

/* On output: turn[0] is the cosine, turn[1] the sine. Multiples of 90 degrees are exact. In:
 * finite.
 */
void turn_degrees(double degrees, double turn[2]);

/* In: at most TURN_RADIANS_MAX in magnitude. */
#define TURN_RADIANS_MAX 0x1p20
void turn_radians(double radians, double turn[2]);

#endif
