/* Pairs of frames with radii. No shared state.
 *
 * Let r_A and r_B be the radii, R their sum, D the swept difference of the cores (support_pair.h),
 * and g the signed gap of the cores: the distance d of D from the origin, or minus the depth
 * (gap.h). The swept difference of the frames is the set of points within R of D. Its gap is g - R,
 * with the same direction:
 *
 *   D does not contain the origin, d >= R
 *       The nearest point of D gives that of the larger set; so the distance is d - R.
 *   D does not contain the origin, d < R
 *       A translation by R - d away from the nearest point suffices. No shorter one does: a
 *       translation increases the distance from D by at most its own length.
 *   D contains the origin
 *       The depth is that of D plus R: the support function grows by R in every direction.
 *
 * So if R > 0, the frames are separated, touch or overlap as d > R, d = R or d < R, where d = 0 if
 * the cores meet. (The set of points within R of the cores' difference has an interior at every
 * time, even if both cores are flat.)
 *
 *   verdict
 *       In doubles from bounds on d. If these do not decide, from the nearest point of D in
 *       integers: its squared distance is rational (programs_begin_nearest()).
 *   contact
 *       The distance d(t) of the cores at one time is convex in t, so the times of contact are an
 *       interval. In doubles, an end is the root of a quadratic equation, and searches at a time
 *       on each side of it prove it. If doubles do not give an end, and always in the method
 *       exact, it is bisected by the exact sign of d(t) - R at times t that are doubles. Both give
 *       an end within the limit of fmb.h.
 *   box
 *       The intersection of the boxes of both frames over the contact. It contains the exact box
 *       and is not tight.
 *   gap
 *       That of the cores, less R. */
#ifndef FMB_SUPPORT_ROUND_H
#define FMB_SUPPORT_ROUND_H

#include "support_search.h"

struct programs;

/* Returns the verdict that bounds on d prove, or 0.
 *
 * In:  cores    the verdict of support_search(), called with far at least support_round_far()
 *      nearest  the result of that search */
enum fmb_verdict support_round_verdict(const struct support_pair *pair, enum fmb_verdict cores,
                                       const struct support_nearest *nearest);

/* Returns an upper bound of the distance of D from the origin: that of the point that a search
 * found. INFINITY if it found none. */
double support_distance_above(const struct support_pair *pair,
                              const struct support_nearest *nearest);

/* Returns a distance for support_search(): frames whose cores are certainly farther apart are
 * separated. */
double support_round_far(const struct support_pair *pair);

/* The ends of a contact, [first, last], in seconds. */
struct support_round_ends {
    double time[2];  /* NAN: not known */
    double guess[2]; /* of an end that is not known: a time near it, or NAN */
    bool apart[2];   /* the frames are certainly apart at this end of the window */
};

/* Sets those ends of the contact of a pair that drifts which doubles give within the limit of
 * fmb.h. Returns whether they give both. */
bool support_round_contact(const struct support_pair *pair, struct support_round_ends *out);

/* A search in exact numbers, in steps, for the ends that doubles do not give. It points into
 * itself: not to be copied. */
struct support_round_times {
    const struct support_pair *pair;
    int end;          /* the end sought: 0 the first time of contact, 1 the last */
    bool at_edge;     /* the end of the window is being tried */
    double out, in;   /* seconds; the end is between them: apart at out, in contact at in */
    double near;      /* seconds: distance from the guess at which times are tried */
    double inside[2]; /* seconds: a time of contact, rounded down and up */
    struct support_round_ends ends;
    struct frame_pair frames; /* over the window that ends at the time being tried */
    struct support_pair sliced;
    struct programs *programs;
};

/* Begins a search for the ends that are not known.
 *
 * In:  pair    in contact; must outlive the search
 *      inside  a time of contact in seconds, rounded down and up
 *      ends    what support_round_contact() gave */
void support_round_times_begin(const struct support_pair *pair, const double inside[2],
                               const struct support_round_ends *ends,
                               struct support_round_times *out);

/* Performs a step. Returns whether both ends are known: times->ends.time. */
bool support_round_times_step(struct support_round_times *times);

/* Frees the memory of a search, complete or not. */
void support_round_times_end(struct support_round_times *times);

/* box := the intersection of the boxes of both frames over the contact. */
void support_round_box(const struct support_pair *pair, const double contact[2],
                       double box[2][FMB_DIM_MAX]);

/* Turns the gap of the cores into that of the pair. All lengths are divided by 2^exponent.
 *
 * In:  frames   in the order of the gap
 *      verdict  of the pair
 *      deepest  the witness points of the cores become the deepest pair of the frames
 *      *gap     of the cores, with tight bounds (support_gap.h) */
void support_round_gap(const struct frame_pair *frames, int exponent, enum fmb_verdict verdict,
                       bool deepest, struct fmb_gap *gap);

#endif
