/* What the oracle says of frame i of a and frame j of b. */
#ifndef FRAMES_H
#define FRAMES_H

#include "oracle.h"
#include "rational_solid.h"

enum fmb_verdict frames_verdict(const struct pair *pair, unsigned i, unsigned j);

/* What their cores have in common once they are moved, perhaps near a point only. */
struct frames_part {
    rational_vector shift[2]; /* of the core of a, of that of b */
    bool near;                /* within these times and this box only */
    mpq_t time[2];
    rational_vector box[2]; /* lower, upper */
};

/* All 0. */
void frames_part_init(struct frames_part *part);
void frames_part_clear(struct frames_part *part);

/* Whether there is such a point. If so, contact := the first and the last time, and box := that of
 * all of them over the window; of static frames the whole window. contact and box may be NULL, and
 * are where near. */
bool frames_meet(const struct pair *pair, unsigned i, unsigned j, struct frames_part *part,
                 mpq_t contact[2], mpq_t box[2][FMB_DIM_MAX]);

#endif
