/* Families of bodies of which at least one turns within the window. */
#ifndef TURN_FAMILY_H
#define TURN_FAMILY_H

#include "family.h"

/* Returns a family of the table; NULL past the last. Of a cell only the dimension is read: a
 * family draws its shapes. */
const struct family *family_turning_at(size_t index);

/* out := a vertex of a body, in its coordinates, at a share of the window; rounded. */
void turn_point(const struct solid *solid, double share, const double *vertex, double *out);

#endif
