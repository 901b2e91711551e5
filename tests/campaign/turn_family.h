/* Families of pairs in which at least one body turns within the window. */
#ifndef TURN_FAMILY_H
#define TURN_FAMILY_H

#include "family.h"

/* Returns a family of the table; NULL past the last. A family reads only the dimension of a cell,
 * and draws the shapes itself. */
const struct family *family_turning_at(size_t index);

/* out := the world position of a vertex, given in body coordinates, at a share of the window;
 * rounded. */
void turn_point(const struct solid *solid, double share, const double *vertex, double *out);

#endif
