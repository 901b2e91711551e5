/* The two methods in plain doubles, there to be compared with: never wrong is not their aim.
 * Both say CANNOT_DECIDE of flat frames, and where numbers overflow. */
#ifndef FMB_INEXACT_H
#define FMB_INEXACT_H

#include "relative.h"

/* The article's algorithm, Listing 1 (eliminate.c). */
enum fmb_status eliminate_decide(const struct fmb_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The article's comparator, the separating axis theorem (sat.c). No box. */
enum fmb_status sat_decide(const struct fmb_pair *pair, unsigned want, struct fmb_answer *answer);

/* The same, told no more than whether they meet: the yardstick of the benchmark.
 * On input: of one dimension, both usable (PREPARED_USABLE) and neither a face, and the duration is
 * legal. Where numbers overflow the answer may be either. */
bool sat_meets(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration);

/* Bounds of one variable, from inequalities that come in one by one: of the time of a moving
 * pair in windows (tau = t / T), or of the last parameter of a static one. [0] lower, [1]
 * upper. */
struct bounds {
    double strict[2]; /* from strict inequalities, which the interiors obey: open */
    double closed[2]; /* from the others: those of the window */
    bool no_interior; /* some strict inequality holds only as an equation */
};

/* SEPARATED where the bounds leave nothing; OVERLAPPING where they leave something strictly
 * within all that are strict. */
enum fmb_verdict bounds_verdict(const struct bounds *bounds);

/* What the bounds leave, ends included; range[0] > range[1] where that is nothing. */
void bounds_range(const struct bounds *bounds, double range[2]);

/* For a moving pair in contact: answer->contact, in seconds, from bounds of tau. */
void bounds_answer_contact(const struct bounds *bounds, double duration, struct fmb_answer *answer);

#endif
