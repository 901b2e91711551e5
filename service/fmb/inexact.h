/* The two methods in plain doubles, there to be compared with: never wrong is not their aim.
 * Both say CANNOT_DECIDE of flat frames, and where a number leaves the range of doubles. */
#ifndef FMB_INEXACT_H
#define FMB_INEXACT_H

#include "fmb.h"

/* The article's algorithm, Listing 1 (eliminate.c). */
enum fmb_status eliminate_decide(const struct fmb_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The article's comparator, the separating axis theorem (sat.c). No box. */
enum fmb_status sat_decide(const struct fmb_pair *pair, unsigned want, struct fmb_answer *answer);

/* Times in windows (tau = t / T) at which two moving frames are in contact, as inequalities
 * come in one by one. Strict: of the interiors; such bounds are open. */
struct contact_times {
    double strict[2]; /* first and last, from strict inequalities */
    double window[2]; /* from the others */
    bool no_interior; /* a strict inequality holds only as an equation */
};

/* The verdict that the bounds mean: SEPARATED where they leave no time; OVERLAPPING where
 * they leave one strictly within all strict bounds. */
enum fmb_verdict contact_times_verdict(const struct contact_times *times);

/* For a moving pair in contact: answer->contact, in seconds. */
void contact_times_answer(const struct contact_times *times, double duration,
                          struct fmb_answer *answer);

#endif
