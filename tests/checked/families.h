/* Pairs of the campaigns' families, for check_pair() and check_turning_pair(). */
#ifndef FAMILIES_H
#define FAMILIES_H

#include "family.h"

#include <stdint.h>

/* The families of all campaigns, with turning families last; NULL past the last. */
const struct family *family_checked_at(size_t index);

/* Checks `questions` of each cell of a family, every pair of their frames. */
void check_family(const struct family *family, long questions, uint64_t seed);

#endif
