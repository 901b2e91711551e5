/* Families of shapes with a radius: balls, capsules and padded shapes. */
#ifndef ROUND_H
#define ROUND_H

#include "family.h"

/* Returns a family of the table of shapes with a radius; NULL past the last. Each has all cells of
 * its flags; family_draw() draws. */
const struct family *family_round_at(size_t index);

/* The families of all tables, these last; NULL past the last. */
const struct family *family_all_at(size_t index);

#endif
