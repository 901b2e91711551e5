/* Hulls that enclose cylinders. */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "fmb.h"
#include "pose.h"

/* The number of sides of such a hull is a multiple of 4, up to ENCLOSURE_SIDES_MAX; the default is
 * ENCLOSURE_SIDES. The hull has two vertices for each side. */
enum { ENCLOSURE_SIDES = 16, ENCLOSURE_SIDES_MAX = FMB_HULL_VERTICES_MAX / 2 };

/* A cylinder about the z axis, centred at 0, and its pose in the body. */
struct cylinder {
    double radius, length;     /* 0 or more */
    const struct pose *placed; /* NULL: the identity */
};

/* Makes a hull that contains the placed cylinder exactly.
 *
 * Out: vertex  [2 * sides][axis]; not finite if the numbers of the cylinder are too large
 * Returns how far the hull extends beyond the cylinder at most, apart from rounding: for a radius
 * r, r (1 / cos(pi / sides) - 1). */
double enclose_cylinder(const struct cylinder *cylinder, int sides, double (*vertex)[3]);

#endif
