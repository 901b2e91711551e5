/* Families of placed bodies: of all shapes, with orientations. */
#ifndef POSED_H
#define POSED_H

#include "family.h"

/* One table holds them all; NULL past the last. */
const struct family *family_posed_at(size_t index);

/* The families of both tables, these after the others; NULL past the last. */
const struct family *family_any_at(size_t index);

/* All numbers uniform in [-100,100], sizes of boxes in [0,100], quaternions in [-1,1], T = 1. */
void family_draw_posed(struct draw *draw, const struct cell *cell, struct question *out);

/* ---- What they are made of ---- */

/* Fills in the shapes of a cell, the window, and who moves. */
void posed_begin(const struct cell *cell, struct question *out);

/* Any orientation, and one of whole numbers up to most. */
void posed_draw_any(struct draw *draw, struct solid *solid);
void posed_draw_whole(struct draw *draw, int most, struct solid *solid);

/* Whole or any velocities, where the solids move, and a window. */
void posed_draw_velocities(struct draw *draw, bool whole, struct question *question);

/* Components, vertices, and the origin in body coordinates: uniform, or small whole multiples of
 * the unit. */
void posed_draw_shape(struct draw *draw, double most, struct solid *solid);
void posed_draw_whole_shape(struct draw *draw, int most, double unit, struct solid *solid);

/* Of solids that have all else, gives B a position in which they touch but for rounding, and moves
 * it by next to nothing. size: of the solids. */
void posed_meet_nearly(struct draw *draw, double size, struct question *question);

/* The squared length of its orientation; 1 without one. */
double posed_norm(const struct solid *solid);

/* Of solids of whole shapes and orientations: a whole normal of two edges, or any small vector; and
 * gives B a position in which a plane across the direction, from A to B, separates them, and both
 * touch it in one point, at a time of the window. Nothing rounds. */
void posed_draw_direction(struct draw *draw, const struct question *question, double *direction);
void posed_meet_exactly(struct draw *draw, const double *direction, struct question *question);

/* hulls.c */
family_function hull_of_shape, hull_equal, hull_in_plane, hull_parting, hull_cloud, hull_exponents;

#endif
