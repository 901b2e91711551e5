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

/* Finds a point of both frames at a time of the window; if they overlap, of the relative interiors
 * of both.
 *
 * In: a pair that touches or overlaps, and its conversion to integers. */
void certificate_point_find(struct certificate_point *point, struct exact_pair *exact,
                            const struct frame_pair *pair);

#endif
