/* Directions that separate a pair that turns over an interval, in integers: the polynomials of
 * turn_path.h, for directions given by vertices or towards the nearest point. No shared state. */
#ifndef FMB_TURN_EXACT_H
#define FMB_TURN_EXACT_H

#include "support_integers.h"
#include "turn_path.h"

/* What a direction proves of an interval. */
enum turn_outcome {
    TURN_OPEN,  /* nothing */
    TURN_APART, /* the frames are apart */
    TURN_CLEAN, /* apart inside the interval; they may touch at its ends, and do not overlap there
                 */
    TURN_REST   /* they may touch, and do not overlap */
};

/* Values of turn_corners.vertex[0] for a direction that is fixed in a frame, and points towards the
 * nearest point at one time: the exact direction, or the direction rounded to doubles. */
enum { TURN_NEAREST = UINT16_MAX, TURN_ROUNDED = UINT16_MAX - 1 };

struct turn_trial;

struct turn_exact {
    const struct turn_path *path;
    struct turn_trial *trial; /* the direction in progress, or NULL */
    struct support_integers integers;
    long unit;     /* of lengths */
    double lo, hi; /* the interval of the last direction */
    mpz_t q[2][2][4], offset[3], drift[3], radius, nearest[2][3];
    mpz_t value[6]; /* its least coefficients, times a positive factor; all 0 if it is 0 */
};

/* Sets the integers of a pair, which allocates through GMP until turn_exact_end(). */
void turn_exact_begin(const struct turn_path *path, struct turn_exact *out);
void turn_exact_end(struct turn_exact *exact);

/* Sets the direction towards the nearest point, in the coordinates of each frame. proof: the proof
 * of a complete decision by the nearest point (programs_begin_nearest()); or the direction that
 * proves a touch, of a decision of the verdict. */
struct programs_proof;
void turn_exact_take(struct turn_exact *exact, const struct programs_proof *proof);

/* m := integer multiples of the vectors of a direction by vertices, or of its opposite if sign is
 * -1: m, or e and f (turn_path.h). In: all are 0. */
void turn_exact_direction(const struct turn_exact *exact, const struct turn_corners *corners,
                          int sign, mpz_t m[2][3]);

/* Begins to determine what a direction, or its opposite if sign is -1, proves about the closed
 * interval [lo, hi]. Memory is allocated through GMP until this is complete. In: lo and hi are
 * multiples of 2^-52. */
void turn_exact_try(struct turn_exact *exact, const struct turn_corners *corners, int sign,
                    double lo, double hi);

/* Performs a step of less than a millisecond. Returns whether the outcome is complete. */
bool turn_exact_step(struct turn_exact *exact, enum turn_outcome *outcome);

/* Returns whether the least coefficients of the last direction, over its interval [lo, hi], prove
 * that the frames are apart on [lo, at], or on [at, hi] if late is 1. In: lo < at < hi, a multiple
 * of 2^-52. */
bool turn_exact_positive(const struct turn_exact *exact, double at, int late);

#endif
