/* Families of pairs that are hard for a reason. */
#ifndef FAMILY_H
#define FAMILY_H

#include <stddef.h>

#include "cell.h"
#include "draw.h"
#include "meeting.h"
#include "question.h"

/* Which cells a family has, where not all of the ordinary ones. */
enum {
    FAMILY_3D = 1,         /* only those in 3D */
    FAMILY_MOVING = 2,     /* only moving ones */
    FAMILY_FACES = 4,      /* faces too */
    FAMILY_A_FACE = 8,     /* and only cells with a face */
    FAMILY_POSED = 16,     /* all shapes but hulls */
    FAMILY_SIMPLICES = 32, /* only cells of tetrahedra and faces */
    FAMILY_A_HULL = 64     /* all cells with a hull, and no others */
};

struct family {
    const char *name;
    const char *summary; /* one line, for people */
    /* On input: a cell that the family has. On output: a question of the cell, all finite. */
    void (*draw)(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out);
    double amount;            /* what is made of it is the function's */
    struct features features; /* the same; slivers: so many axes are long */
    unsigned cells;           /* FAMILY_ values */
    int verdict;              /* that all pairs have by construction; 0: no promise */
};

/* One table holds them all; NULL past the last. */
const struct family *family_at(size_t index);
const struct family *family_by_name(const char *name); /* NULL: none of that name */

/* The cells it has. On input: capacity for CELL_WITH_FACES;
 * of a family of placed bodies, for CELL_OF_ALL_SHAPES. Returns how many. */
int family_cells(const struct family *family, struct cell *out);

/* Of a cell with shapes that the family may have, but perhaps a hull: whether it has that one. */
bool family_has_cell(const struct family *family, const struct cell *cell);

/* Draws a question. What was computed beyond the doubles is pulled back to the last one. */
void family_draw(const struct family *family, const struct cell *cell, struct draw *draw,
                 struct question *out);

/* The same for a question. */
void family_pull_back(struct question *question);

/* The article's distribution: all numbers uniform in [-100,100], T = 1, and no determinant of
 * components below 0.1. */
void family_draw_random(struct draw *draw, const struct cell *cell, struct question *out);

/* What the function of a family is; those of a theme share a file. */
typedef void family_function(struct draw *draw, const struct family *family,
                             const struct cell *cell, struct question *out);

/* contact.c: exact contacts, and what is close to one. */
family_function touching, sliding, grazing, arriving, leaving, receding, zero_window;
family_function apart, ulps_apart, slivers, parallel, far_out, of_size, of_two_sizes, no_drift;

/* scene.c: as scenes have them. */
family_function tilted_stack, integer_grid, decimal_grid, fast_and_thin;

/* odd.c: flat frames, and numbers of every size. */
family_function dependent, in_one_plane, points_and_segments, faces, exponents;

#endif
