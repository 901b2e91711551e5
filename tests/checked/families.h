/* Pairs of the campaign's families, for check_pair(). */
#ifndef FAMILIES_H
#define FAMILIES_H

#include "family.h"

#include <stdint.h>

/* Checks so many questions of each cell of a family: all pairs of their frames. */
void check_family(const struct family *family, long questions, uint64_t seed);

#endif
