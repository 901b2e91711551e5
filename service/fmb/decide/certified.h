/* The method certified: doubles with bounds on their errors, and exact arithmetic for what these
 * leave open.
 *
 * verdict: the filter, axes and slabs in doubles (kernel.h, slabs.c); if it is unsure, its second
 *   pass (slabs_exact.h), the open slabs in integers (limbs.h), or all slabs; of two faces in one
 *   plane, the verdict of two triangles in 2D (faces.c).
 * contact: the filter bounds the times in the same pass (slabs_lanes.h); if a bound is not tight
 *   enough, or nothing rounds, the slabs one by one (contact.c).
 * box: from what is left of the edges and where they cross, in doubles (box_clip.h) or in integers
 *   (limbs_box.h).
 * gap: given the verdict, in steps of its own (gap.h).
 *
 * Contact and box are computed as two enclosures: the outer one surely contains the exact value,
 * the inner one is surely contained in it. The answer is the outer one. It is given only if the two
 * are so close that it is within the limits of fmb.h; otherwise integers or the exact method
 * decide. */
#ifndef FMB_CERTIFIED_H
#define FMB_CERTIFIED_H

#include "integer.h"
#include "slabs.h"

/* The decide function of the method. */
enum fmb_status certified_decide(const struct frame_pair *pair, unsigned want,
                                 struct fmb_answer *answer);

/* The same answer from prepared frames; that of a pair with a hull has a contact only if want has
 * FMB_WANT_TIMES. quick: returns FMB_CANNOT_DECIDE, with *answer unspecified, if the answer needs
 * integers wider than LIMBS_NARROW, or GMP. A quick decision takes tens of microseconds at most and
 * allocates nothing: a slab takes at most 1,000 products of limbs (most take 100 to 300), and a
 * pair has at most SLABS_MAX slabs. */
enum fmb_status certified_decide_prepared(const struct fmb_prepared *a,
                                          const struct fmb_prepared *b, double duration,
                                          unsigned want, bool quick, struct fmb_answer *answer);

/* The rungs of the ladder for the verdict: the filter; its second pass; the slabs that these leave
 * open, in integers; all slabs, in integers. */
enum certified_path {
    CERTIFIED_FILTER,
    CERTIFIED_SECOND,
    CERTIFIED_LIMBS,
    CERTIFIED_EXACT,
    CERTIFIED_PATHS
};

/* Returns the verdict of a checked pair, and in *path the rung that decided it. For tests and
 * reports. */
enum fmb_verdict certified_verdict(const struct frame_pair *pair, enum certified_path *path);

/* Returns the verdict of a prepared pair that passes (1 or 2) passes of the filter leave unsure.
 * quick: returns 0 if it needs GMP or wider integers. */
enum fmb_verdict certified_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, int passes, bool quick);

/* Computes the contact of a pair in contact that drifts. rounds: operations on these numbers may
 * round. span: of the pair. exact: integers may be used for an end that doubles do not give within
 * its limit. Returns false if the permitted methods do not give the contact. */
bool contact_of(const struct frame_pair *pair, const struct slabs_pair *slabs, bool rounds,
                struct dyadic_span span, bool exact, double contact[2]);

/* Computes the box of a prepared pair in contact. Returns false, and NAN, if doubles do not give it
 * within its limit. */
bool certified_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   double box[2][FMB_DIM_MAX]);

/* The same where doubles do not give it.
 * quick: returns false if it needs GMP or wider integers. */
bool certified_box_unsure(const struct fmb_prepared *a, const struct fmb_prepared *b,
                          double duration, bool quick, double box[2][FMB_DIM_MAX]);

#endif
