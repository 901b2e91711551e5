/* Converts a box that is turned within its body to a cuboid. Its numbers are computed exactly, as
 * rationals, and each is rounded once. */
#ifndef TURNED_BOX_H
#define TURNED_BOX_H

#include "fmb.h"

/* In: dim, 2 or 3; centre and size [dim], finite; an orientation of dim (fmb.h), not all 0.
 * Out: the numbers of a cuboid as fmb_frame_make() takes them, dim + dim * dim; one beyond the
 * largest double is infinite. */
void turned_box(int dim, const double *centre, const double *size, const double *orientation,
                double *numbers);

#endif
