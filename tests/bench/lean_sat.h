/* The yardstick of the benchmark: separating axes in plain doubles, and the placing that goes with
 * it. */
#ifndef LEAN_SAT_H
#define LEAN_SAT_H

#include <stdbool.h>

#include "fmb.h"

/* In world coordinates, rounded; in two cache lines at a multiple of 64 bytes. */
enum { LEAN_MOVING = 1, LEAN_SIMPLEX = 2, LEAN_SPACE = 4 };
struct lean_frame {
    unsigned long long kind;                        /* a sum of these */
    double origin[3], component[3][3], velocity[3]; /* [component][axis] */
};

/* In: a cuboid, a box or a tetrahedron. */
void lean_place(const struct fmb_frame *frame, const struct fmb_placement *placement,
                struct lean_frame *out);

/* In: of one dimension; duration: seconds. Where numbers overflow the answer may be either. */
bool lean_meets(const struct lean_frame *a, const struct lean_frame *b, double duration);

#endif
