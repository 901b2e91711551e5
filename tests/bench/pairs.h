/* Pairs to be timed: distinct ones, so that no branch is learnt by heart. */
#ifndef PAIRS_H
#define PAIRS_H

#include "cell.h"
#include "family.h"
#include "fmb.h"

#include <stddef.h>

struct pairs {
    size_t count;
    struct fmb_pair *pair;
    struct fmb_body *body;
};

/* So many pairs of a cell of a family; ends the program if there is no memory. pairs_free() frees
 * what they took. */
struct pairs pairs_draw(const struct family *family, const struct cell *cell, size_t count,
                        uint64_t seed);
/* All cubes of a grid with those of their 26 neighbours that come after them: origins are whole
 * multiples of the pitch as doubles give them, and so is the edge. side cubes along each axis. */
struct pairs pairs_of_grid(double pitch, int side);

/* Those of a verdict, in contact or not; they share bodies with the others. */
struct pairs pairs_in_contact(const struct pairs *pairs, bool in_contact);

void pairs_free(struct pairs *pairs);

#endif
