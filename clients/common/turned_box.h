/* Converts a box that is turned within its body to a cuboid, whose numbers are rounded.
 * Each component is off by at most 12 2^-53 of its length, and is exact for quarter turns. */
#ifndef TURNED_BOX_H
#define TURNED_BOX_H

#include "fmb.h"

/* In:  dim, 2 or 3; orientation: one of dim (fmb.h), not all 0; origin and components: the centre
 *      and the size of the box, [dim], finite
 * Out: origin, [dim], and components, [component * dim + axis], of the cuboid; a number beyond the
 *      largest double is infinite */
void turned_box(int dim, const double *orientation, double *origin, double *components);

#endif
