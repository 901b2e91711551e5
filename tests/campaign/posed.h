/* Families of placed bodies: of all shapes, with orientations. */
#ifndef POSED_H
#define POSED_H

#include "family.h"

/* One table holds them all; NULL past the last. */
const struct family *family_posed_at(size_t index);

/* All numbers uniform in [-100,100], sizes of boxes in [0,100], quaternions in [-1,1], T = 1. */
void family_draw_posed(struct draw *draw, const struct cell *cell, struct question *out);

#endif
