/* A cell of a campaign: dimension, motion and shapes. What it draws depends on the seed, on what it
 * is drawn for and on the cell, and on nothing else: not on the other cells, nor on how many work
 * at them. */
#ifndef CELL_H
#define CELL_H

#include <stdbool.h>
#include <stdint.h>

#include "draw.h"
#include "fmb.h"

struct cell {
    int dim;
    bool moving;
    enum fmb_shape shape[2]; /* of A, of B */
};

/* With faces, three shapes in 3D; with boxes too, three in 2D and four in 3D. Those with a hull
 * come on top. */
enum { CELL_ORDINARY = 16, CELL_WITH_FACES = 26, CELL_OF_ALL_SHAPES = 50, CELL_WITH_A_HULL = 32 };

/* The cells: 2D before 3D, static before moving, CC, CT, TC, TT. With faces: those with faces too.
 * On input: capacity for CELL_WITH_FACES. Returns how many. */
int cell_list(bool faces, struct cell *out);

/* Those of all shapes but hulls. On input: capacity for CELL_OF_ALL_SHAPES. */
int cell_list_all(struct cell *out);

/* Those with a hull or two. On input: capacity for CELL_WITH_A_HULL. */
int cell_list_hulls(struct cell *out);
bool cell_has_hull(const struct cell *cell);

/* "3D moving CT"; "CT". Returns text. */
enum { CELL_TEXT_MAX = 16 };
const char *cell_text(const struct cell *cell, char text[CELL_TEXT_MAX]);
const char *cell_shapes_text(const struct cell *cell, char text[CELL_TEXT_MAX]);

/* Where the cell starts to draw, for the what-for of this name; part counts the parts of a cell
 * that is drawn in several. */
struct draw cell_draw(uint64_t seed, const char *name, const struct cell *cell, int part);

#endif
