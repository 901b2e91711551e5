/* Hulls that enclose cylinders. */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "fmb.h"
#include "pose.h"

/* The sides of such a hull: a multiple of 4. It has two vertices for each. */
enum { ENCLOSURE_SIDES = 16, ENCLOSURE_SIDES_MAX = FMB_HULL_VERTICES_MAX / 2 };

/* A cylinder about the z axis, centred at 0, and its pose in the body. */
struct cylinder {
    double radius, length;     /* 0 or more */
    const struct pose *placed; /* NULL: the identity */
};

/* Out: vertex  [2 * sides], of a hull that contains the placed cylinder, exactly; not finite if the
 *              numbers of the cylinder are too large
 * Returns how far the hull extends beyond the cylinder at most, apart from rounding: for a radius
 * r, r (1 / cos(pi / sides) - 1). */
double enclose_cylinder(const struct cylinder *cylinder, int sides, double (*vertex)[3]);

#endif
