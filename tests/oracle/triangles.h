/* The oracle of triangles by their vertices: for faces whose edges are no doubles.
 *
 * A point of a triangle is a mean of its vertices. So nothing but the vertices is read, and none of
 * them is subtracted from another: a linear programme (lp.h) in the weights of both triangles and
 * the time. It shares nothing with the engine but the names of verdicts. */
#ifndef TRIANGLES_H
#define TRIANGLES_H

#include <gmp.h>
#include <stdbool.h>

#include "fmb.h"

struct triangle {
    double vertex[3][3]; /* [vertex][axis], finite */
    double velocity[3];  /* per second; not read where not moving */
    bool moving;
};

/* The truth; the numbers are there where the triangles meet. */
struct triangles_answer {
    enum fmb_verdict verdict;
    mpq_t contact[2]; /* seconds; 0 and 0 where neither is moving */
    mpq_t box[2][3];  /* [lower, upper][axis] of what both have in common over the window */
};

void triangles_init(struct triangles_answer *truth);
void triangles_clear(struct triangles_answer *truth);

/* On input: duration: seconds, >= 0; ends: whether the contact and the box are wanted too. */
void triangles_decide(const struct triangle pair[2], double duration, bool ends,
                      struct triangles_answer *truth);

#endif
