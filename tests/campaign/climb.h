/* A search for the legal pair that costs most: hill climbing over exponents, mantissas, shapes,
 * motions and poses. */
#ifndef CLIMB_H
#define CLIMB_H

#include "draw.h"
#include "question.h"

/* What a call on the pair costs, in any unit. */
typedef double climb_cost(const struct question *question);

struct climber {
    struct draw *draw;
    climb_cost *cost;
    int least, most; /* exponents, as far as steps do not lead out of them; -1074 and 1023: all */
    bool posed;      /* with orientations, origins in body coordinates, boxes, and vertices */
};

/* Starts afresh `climbs` times, each with so many steps, and puts the question that cost most into
 * *out. Returns its cost. All questions are legal. */
double climb(struct climber *climber, int climbs, int steps, struct question *out);

#endif
