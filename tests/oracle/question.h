/* A pair as plain values: what tests draw, change, copy and print. A struct fmb_pair points to
 * its bodies; a question holds all of itself. */
#ifndef QUESTION_H
#define QUESTION_H

#include <stdbool.h>

#include "draw.h"
#include "fmb.h"

struct solid {
    int dim;
    enum fmb_shape shape;
    double component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis] */
    double origin[FMB_DIM_MAX];
    double velocity[FMB_DIM_MAX];
    bool moving;
};

struct question {
    struct solid a, b;
    double duration;
};

/* Components of a shape: 3 or 2. Written once more here, so that the oracle's tests need nothing
 * of the engine. */
int solid_count(const struct solid *solid);

/* On output: the pair, with bodies in body[0] and body[1], of which only dim, shape, count and
 * component are filled: enough for the oracle, not for the engine. */
void question_pair(const struct question *question, struct fmb_body body[2], struct fmb_pair *pair);

/* The same question with a and b in each other's place. */
struct question question_swapped(const struct question *question);

/* Any shape of the dimension. */
enum fmb_shape question_draw_shape(struct draw *draw, int dim);

/* Who carries a velocity: A, B or both; or, one time in four, none. */
void question_draw_movers(struct draw *draw, struct question *question);

/* Prints it to standard output as a C initialiser, in hexadecimal: a reproducer that can be
 * pasted into a test. */
void question_print(const struct question *question);

#endif
