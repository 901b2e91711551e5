/* What is certain of two bodies of which at least one has an end, in rational numbers. */
#ifndef TURNING_H
#define TURNING_H

#include <gmp.h>
#include <stdbool.h>

#include "fmb.h"
#include "placed_pair.h"

/* Times are shares of the window. */
struct turning_truth {
    enum fmb_verdict least, most;
    /* If least is not separated, the first time of contact is in [first[0], first[1]], the last one
     * in [last[0], last[1]]. Otherwise only first[0] and last[1] have a meaning: all contact there
     * may be is between them. */
    mpq_t first[2], last[2];
    bool whole; /* all of the window was decided, not only some times */
};

void turning_init(struct turning_truth *truth);
void turning_clear(struct turning_truth *truth);

/* Decides the whole window, unless a frame has a radius or more than TURNING_VERTICES_MAX vertices;
 * of those, nothing. */
enum { TURNING_VERTICES_MAX = 10 };
void turning_decide(const struct pair *pair, struct turning_truth *truth);

/* Adds what the static oracle says of one time. Returns the verdict. */
enum fmb_verdict turning_look(const struct pair *pair, const mpq_t time,
                              struct turning_truth *truth);

#endif
