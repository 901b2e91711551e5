/* The point of a certificate: a position and a time at which two frames meet. */
#ifndef FMB_CERTIFICATE_POINT_H
#define FMB_CERTIFICATE_POINT_H

#include "exact.h"

#include <gmp.h>

struct certificate_point {
    mpq_t time;     /* seconds, in [0, T]; 0 if the pair is static */
    mpq_t place[3]; /* world coordinates */
};

void certificate_point_init(struct certificate_point *point);
void certificate_point_clear(struct certificate_point *point);

/* x := x 2^exponent. */
void certificate_scale(mpq_t x, long exponent);

/* x := num / den 2^exponent, in lowest terms. */
void certificate_set_scaled(mpq_t x, const mpz_t num, const mpz_t den, long exponent);

/* out := the simplest number strictly between low and high > low: 0 if it is one; otherwise one of
 * the least denominator, and among these the closest to 0. low and high need not be in lowest
 * terms; they are overwritten. */
void simplest_between(mpq_t out, mpq_t low, mpq_t high);

/* Finds a point of both frames at a time of the window; if they overlap, of the relative interiors
 * of both.
 *
 * In: a pair that touches or overlaps, and its conversion to integers. */
void certificate_point_find(struct certificate_point *point, struct exact_pair *exact,
                            const struct frame_pair *pair, bool touching);

/* The same, for a pair whose numbers span many bits. */
void certificate_point_wide(struct certificate_point *point, struct exact_pair *exact,
                            const struct frame_pair *pair, bool touching);

#endif
