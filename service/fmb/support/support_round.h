/* Pairs of frames with radii. No shared state.
 *
 * Let r_A and r_B be the radii, R their sum, D the swept difference of the cores (support_pair.h),
 * and g its signed gap: the distance d of D from the origin, or minus its depth (gap.h). The
 * difference of the rounded frames is the set of points within R of D, and its gap is g - R, with
 * the same direction:
 *
 *   D does not contain the origin, d >= R   the nearest point of D is also the nearest point of D
 *                                           less R; so the distance is d - R.
 *   D does not contain it, d < R            a translation of R - d away from the nearest point
 *                                           suffices. No shorter one does: along it the distance
 * from D grows by at most its length. D contains it                           the depth is the
 * least value over unit vectors n of the support function of D plus R.
 *
 * So with R > 0 the frames are separated, touch or overlap as d > R, d = R or d < R, with d = 0
 * where the cores meet; the set of points within R of the cores is solid at every time.
 *
 *   verdict  in doubles from bounds on d; else from the nearest point of D in integers: its squared
 *            distance is rational (programs_compare_radius())
 *   contact  the distance d(t) of the cores at one time is convex in t, so that the times of
 * contact are an interval. In doubles an end is the root of a quadratic equation, proved by two
 *            verdicts, on both sides of it. What these leave open is bisected, with the exact sign
 * of d(t) - R at doubles t; so is everything by the method exact. Both give an end within the limit
 * of fmb.h box      the intersection of both frames' boxes over the contact: contains, and is not
 * tight gap      that of the cores, less R */
#ifndef FMB_SUPPORT_ROUND_H
#define FMB_SUPPORT_ROUND_H

#include "support_search.h"

struct programs;

/* Returns the verdict that bounds on d prove, or 0. In: cores, the verdict of support_search() and
 * nearest, its result, for any far greater than support_round_far(). */
enum fmb_verdict support_round_verdict(const struct support_pair *pair, enum fmb_verdict cores,
                                       const struct support_nearest *nearest);

/* Returns a distance: cores that are certainly farther apart are separated. */
double support_round_far(const struct support_pair *pair);

/* The ends of a contact, [first, last], in seconds. */
struct support_round_ends {
    double time[2];  /* NAN: not known */
    double guess[2]; /* near the end, if it is not known; or NAN */
    bool apart[2];   /* the frames are apart at this edge of the window */
};

/* Sets the ends of the contact of a pair that drifts, within the limit of fmb.h, that doubles give.
 * Returns whether they give both. */
bool support_round_contact(const struct support_pair *pair, struct support_round_ends *out);

/* A search for the other ends in exact numbers, in steps. It points into itself: not to be copied.
 */
struct support_round_times {
    const struct support_pair *pair;
    int end;          /* that is sought: 0 the first time, 1 the last */
    bool at_edge;     /* the edge of the window is tried */
    double out, in;   /* seconds: the end is between them */
    double near;      /* how near to the guess times are tried */
    double inside[2]; /* the end is not beyond these: a time of contact, rounded down and up */
    struct support_round_ends ends;
    struct frame_pair frames; /* over a window that ends at a time tried */
    struct support_pair sliced;
    struct programs *programs;
};

/* Begins a search for the ends that are not known. inside: a time of contact, rounded down and up.
 */
void support_round_times_begin(const struct support_pair *pair, const double inside[2],
                               const struct support_round_ends *ends,
                               struct support_round_times *out);

/* Performs a step. Returns whether the contact is known. */
bool support_round_times_step(struct support_round_times *times);

/* Frees the memory of a search, complete or not. */
void support_round_times_end(struct support_round_times *times);

/* box := the intersection of the boxes of both frames over the contact. */
void support_round_box(const struct support_pair *pair, const double contact[2],
                       double box[2][FMB_DIM_MAX]);

/* Turns the gap of the cores, lengths divided by 2^exponent, into that of the pair. In: frames in
 * the order of the gap; bounds that are tight (support_gap.h) */
void support_round_gap(const struct frame_pair *frames, int exponent, enum fmb_verdict verdict,
                       struct fmb_gap *gap);

#endif
