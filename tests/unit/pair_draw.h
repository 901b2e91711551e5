/* Pairs for tests of many at once: the hard families of the campaigns, and scenes of boxes as
 * people make them. */
#ifndef PAIR_DRAW_H
#define PAIR_DRAW_H

#include "cell.h"
#include "draw.h"
#include "question.h"

/* A pair of the cell, of any of these. */
void pair_draw(struct draw *draw, const struct cell *cell, struct question *out);

/* The same with a number that goes too far, or to the end of what doubles can say something of: far
 * out, far too fast, hardly moving. */
void pair_draw_stretched(struct draw *draw, const struct cell *cell, struct question *out);

/* Any cell, with faces. */
struct cell pair_draw_cell(struct draw *draw);

/* Makes its window so long: velocities change with it, so that a contact stays one but for
 * rounding; where they would come to be no numbers, they stay. */
void pair_set_duration(struct question *question, double duration);

#endif
