/* The test of oriented boxes in plain doubles: Ericson, Real-Time Collision Detection, 4.4.1. */
#ifndef ORIENTED_H
#define ORIENTED_H

#include <stdbool.h>

#include "fmb.h"

/* What a program keeps of a box, in two cache lines at a multiple of 64 bytes. */
struct oriented {
    double centre[3], axis[3][3], half[3]; /* axis[i]: of unit length */
    double padding;
};

/* In: a box in 3D. */
void oriented_place(const struct fmb_frame *frame, const struct fmb_placement *placement,
                    struct oriented *out);

/* At rest. */
bool oriented_meet(const struct oriented *a, const struct oriented *b);

#endif
