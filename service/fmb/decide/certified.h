/* The certified method: doubles with bounds on their errors; exact arithmetic where these leave
 * something open.
 *
 *     verdict   the filter: axes and slabs in doubles (run.h, slabs.c); where unsure, its second
 *               pass (walk_exact.h), the open slabs in integers (limbs.c), or the exact method; of
 *               two faces in one plane, that of two triangles in 2D (faces.c)
 *     contact   the filter bounds the time in the same walk (walk_slab.h); where that is not near
 *               enough, or nothing rounds, the slabs one by one (contact.c)
 *     box       the least of a list of bounds for each end (walk_box.h)
 *     gap       from the verdict on, by steps of its own (gap.h)
 *
 * Contact and box are two-sided: the outer value surely contains the true one, the inner one is
 * surely contained in it. The answer is the outer one, given only where both are so close that it
 * is within the limits of fmb.h; else integers decide, or the exact method. */
#ifndef FMB_CERTIFIED_H
#define FMB_CERTIFIED_H

#include "integer.h"
#include "slabs.h"

/* The method. */
enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The widest integers of a quick decision, in limbs: 512 bits. A slab then takes at most 1,000
 * products of limbs, most 100 to 300, and a pair has at most SLABS_MAX slabs. */
enum { CERTIFIED_QUICK_LIMBS = 8 };

/* The same answer from prepared frames. quick: or CANNOT_DECIDE, and *answer is unspecified, where
 * it needs GMP or wider integers; takes tens of microseconds at most then, and allocates
 * nothing. */
enum fmb_status certified_decide_prepared(const struct fmb_prepared *a,
                                          const struct fmb_prepared *b, double duration,
                                          unsigned want, bool quick, struct fmb_answer *answer);

/* Which step decides the verdict of a pair: the filter; its second pass; the slabs left open, in
 * doubles with bounds of their own; integers of fixed width; GMP. For tests and reports. */
enum certified_path {
    CERTIFIED_FILTER,
    CERTIFIED_SECOND,
    CERTIFIED_REFINED,
    CERTIFIED_LIMBS,
    CERTIFIED_EXACT
};

/* The verdict of a checked pair, and who found it. */
enum fmb_verdict certified_verdict(const struct frame_pair *pair, enum certified_path *path);

/* The same of a prepared pair that one or both passes of the filter leave unsure. quick: 0 where it
 * needs GMP or wider integers. */
enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes, bool quick);

/* For a pair in contact that drifts: its contact. rounds: whether operations on these numbers
 * may round; span: of the pair; exact: where doubles do not give an end within its limit, integers
 * may. False if nothing that may be used does. */
bool contact_of(const struct frame_pair *pair, const struct slabs_pair *slabs, bool rounds,
                struct dyadic_span span, bool exact, double contact[2]);

/* For a pair in contact, prepared: the box. False, and NAN, if doubles do not give it within its
 * limit. */
bool certified_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   double box[2][FMB_DIM_MAX]);

#endif
