/* What the oracle finds for frame i of body a and frame j of body b. */
#ifndef FRAMES_H
#define FRAMES_H

#include "oracle.h"
#include "rational_solid.h"

enum fmb_verdict frames_verdict(const struct pair *pair, unsigned i, unsigned j);

/* The common points of both cores after a shift, or only the common points near a point. */
struct frames_part {
    rational_vector shift[2]; /* of the core of a, of that of b */
    bool near;                /* only points within these times and this box */
    mpq_t time[2];
    rational_vector box[2]; /* lower, upper */
};

/* Sets everything to 0. */
void frames_part_init(struct frames_part *part);
void frames_part_clear(struct frames_part *part);

/* Returns whether there is such a point. If so, contact := the first and the last time of these
 * points (of static frames, the whole window), and box := the box of all of them over the window.
 * contact and box may be NULL; they must be if part->near. */
bool frames_meet(const struct pair *pair, unsigned i, unsigned j, struct frames_part *part,
                 mpq_t contact[2], mpq_t box[2][FMB_DIM_MAX]);

#endif
