/* The two methods in plain doubles, there to be compared with: never wrong is not their aim.
 * Both say CANNOT_DECIDE of flat frames, and where numbers overflow. */
#ifndef FMB_INEXACT_H
#define FMB_INEXACT_H

#include "relative.h"

/* A pair as doubles have it, errors left aside. */
struct inexact_pair {
    struct world_frame a, b;
    /* Of a, in the world: the kept inverse times R(q) transposed; [axis][component] as in
     * fmb_frame. */
    double inverse[FMB_DIM_MAX][FMB_DIM_MAX];
    struct relative_motion motion;
    bool moving; /* a velocity is not 0 */
    double duration;
};

/* False if a frame is flat, or a number overflowed. */
bool inexact_pair_of(const struct frame_pair *pair, struct inexact_pair *out);

/* The article's algorithm, Listing 1 (eliminate.c). */
enum fmb_status eliminate_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The article's comparator, the separating axis theorem (sat.c). No box. */
enum fmb_status sat_decide(const struct frame_pair *pair, unsigned want, struct fmb_answer *answer);

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

/* For a pair in contact: answer->contact, in seconds, from bounds of tau. */
void bounds_answer_contact(const struct bounds *bounds, double duration, struct fmb_answer *answer);

#endif
