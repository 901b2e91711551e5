/* Hulls for tests: of shapes by their vertices, and of few vertices with small whole numbers. */
#ifndef HULL_DRAW_H
#define HULL_DRAW_H

#include "draw.h"
#include "question.h"

enum { SHAPE_VERTICES = 8, SMALL_VERTICES = 8 };

/* A hull and its memory. */
struct shape_hull {
    double memory[FMB_DIM_MAX * SHAPE_VERTICES + SHAPE_VERTICES];
    struct fmb_body body;
};

/* Draws solids whose vertices in body coordinates are doubles: cuboids, boxes, tetrahedra and
 * faces, flat ones among them. */
struct question hull_draw_question(struct draw *draw);

/* Replaces bodies of a pair of the question by hulls of their vertices: bit 0, the first; bit 1,
 * the second. */
void hull_replace(const struct question *question, unsigned which, struct shape_hull hull[2],
                  struct pair *pair);

/* A pair of hulls of 1 to SMALL_VERTICES vertices, of small whole numbers, some moving. */
struct hull_pair_draw {
    struct shape_hull hull[2];
    double vertices[2][SMALL_VERTICES][FMB_DIM_MAX]; /* as given */
    int count[2];
    struct pair pair;
};

/* The bodies belong to *out, which must not be copied. */
void hull_draw_small(struct draw *draw, struct hull_pair_draw *out);

#endif
