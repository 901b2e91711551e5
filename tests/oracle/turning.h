/* The oracle of turning bodies: verdict and contact of two bodies, at least one with an end, in
 * rational numbers. */
#ifndef TURNING_H
#define TURNING_H

#include <gmp.h>
#include <stdbool.h>

#include "fmb.h"
#include "placed_pair.h"

/* Times are shares of the window. */
struct turning_truth {
    enum fmb_verdict least, most;
    /* If least is not separated, the first time of contact is in [first[0], first[1]] and the last
     * one in [last[0], last[1]]. Otherwise only first[0] and last[1] have a meaning: any contact is
     * between them. */
    mpq_t first[2], last[2];
    bool whole; /* the whole window was decided, not only some times */
};

void turning_init(struct turning_truth *truth);
void turning_clear(struct turning_truth *truth);

/* Decides the whole window for each pair of frames. Leaves a pair open if one of its frames has a
 * radius or more than TURNING_VERTICES_MAX vertices. */
enum { TURNING_VERTICES_MAX = 10 };
void turning_decide(const struct pair *pair, struct turning_truth *truth);

/* Adds the verdict of the static oracle at one time. Returns this verdict. */
enum fmb_verdict turning_look(const struct pair *pair, const mpq_t time,
                              struct turning_truth *truth);

#endif
