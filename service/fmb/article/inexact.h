/* The two inexact methods, in plain doubles without error bounds, for comparison. Both return
 * CANNOT_DECIDE for flat frames and if numbers overflow. */
#ifndef FMB_INEXACT_H
#define FMB_INEXACT_H

#include "slabs.h"

/* A pair in doubles, without errors. */
struct inexact_pair {
    struct world_frame a, b;
    /* The inverse of a in world coordinates: the stored inverse times R(q) transposed;
     * [axis][component] as in fmb_frame. */
    double inverse[FMB_DIM_MAX][FMB_DIM_MAX];
    struct relative_motion motion;
    bool moving; /* a velocity is not 0 */
    double duration;
};

/* Returns false if a frame is flat or a number overflowed. */
bool inexact_pair_of(const struct frame_pair *pair, struct inexact_pair *out);

/* The article's algorithm, Listing 1 (eliminate.c). */
enum fmb_status eliminate_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The article's comparator, the separating axis theorem (sat.c). No box. */
enum fmb_status sat_decide(const struct frame_pair *pair, unsigned want, struct fmb_answer *answer);

/* Bounds of one variable, from inequalities that are added one by one: of the time of a moving
 * pair, in windows (tau = t / T), or of the last parameter of a static pair. [0] lower, [1] upper.
 */
struct bounds {
    double strict[2]; /* from strict inequalities, those of the interiors: open */
    double closed[2]; /* from the others: those of the window */
    bool no_interior; /* some strict inequality holds only as an equation */
};

/* Returns FMB_SEPARATED if the bounds leave nothing, FMB_OVERLAPPING if they leave a value strictly
 * within all strict bounds, otherwise FMB_TOUCHING. */
enum fmb_verdict bounds_verdict(const struct bounds *bounds);

/* Computes the closed interval that the bounds leave; range[0] > range[1] if it is empty. */
void bounds_range(const struct bounds *bounds, double range[2]);

/* In: a pair in contact. Sets answer->contact, in seconds, from bounds of tau. */
void bounds_answer_contact(const struct bounds *bounds, double duration, struct fmb_answer *answer);

#endif
