/* Pairs of the campaign's families, for check_pair(). */
#ifndef FAMILIES_H
#define FAMILIES_H

#include "family.h"

#include <stdint.h>

/* Checks `questions` of each cell of a family, every pair of their frames. */
void check_family(const struct family *family, long questions, uint64_t seed);

#endif
