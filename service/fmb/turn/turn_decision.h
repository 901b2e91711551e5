/* Pairs of frames in which a placement has an end: verdict, contact, box and point.
 *
 * The window is divided into intervals of s = t / T whose ends are multiples of 2^-52. They are
 * examined in order of time (in reverse for the last end of the contact), each at its middle, or at
 * an estimated end of the contact inside it:
 *
 *   doubles   a search at the middle (turn_look()) proves an overlap, or gives a direction. The
 *             direction may prove that the frames are apart over the interval (turn_distance());
 *             otherwise the interval is divided. If the frames are apart over a part of it, times
 *             within the last few such parts are not examined again.
 *   integers  if the search is unsure, the bound of frames with a radius is close to 0, or an
 *             interval is shorter than 2^-41: the programs give the exact verdict at the middle.
 *             Over the interval, the exact polynomials (turn_exact.h) of several directions are
 *             tried. If neither frame has a radius, the directions are given by vertices: all
 *             normals of faces and all products of edges of frames with few vertices; for hulls,
 *             the normals and products near the nearest point. For frames with a radius, for hulls
 *             that these directions do not separate, and over the shortest intervals, the
 *             directions point towards the exact nearest point: they are fixed in either frame, or
 *             the product of the two edges that contain the nearest points.
 *
 * The verdict is OVERLAPPING if the frames overlap at an examined time. Otherwise the intervals
 * cover the window, and the frames do not overlap in any of them; the verdict is TOUCHING if they
 * touch at an examined time. A pair has no verdict if integers do not decide a shortest interval:
 * frames that touch at a single time that is not an end of an interval, frames that cross at such a
 * time and are not transversal, and frames with a radius that stay in contact in a direction that
 * is fixed in neither frame.
 *
 * The contact is enclosed from both sides: on each side, the frames are apart up to a time that is
 * at most 2^-41 from a time at which they meet. Near such an end, an interval is divided where the
 * polynomial of a direction crosses 0: shortly before, the direction separates the frames; shortly
 * after, they meet or another direction separates them.
 *
 * Box: the union, over pieces of the contact, of the intersections of the boxes of both frames.
 * Gap: turn_gap.h.
 *
 * Steps: a search in doubles takes microseconds; an exact direction takes tens of microseconds for
 * frames with few vertices. A step of a direction of large hulls, or of the programs, takes less
 * than a millisecond. No shared state. */
#ifndef FMB_TURN_DECISION_H
#define FMB_TURN_DECISION_H

#include "turn_exact.h"
#include "turn_gap.h"

struct programs;

/* TURN_STACK: an interval is halved at most 52 times, and the half that comes first is the next
 * one. Only an interval next to the known contact, which is the last one on the stack, is divided
 * elsewhere, and once one of those before it.
 *
 * TURN_CORNERS: both signs of the normals of all triples of 6 vertices of each frame, and of the
 * products of all pairs: 2 (20 + 20 + 15 * 15). */
enum { TURN_STACK = 54, TURN_KNOWN = 8, TURN_CORNERS = 530 };

struct turn_interval {
    double lo, hi;
};

/* A proof that the frames are apart over the window: intervals that cover it, in order, and a
 * direction for each. */
enum { TURN_PROOF = 256 };

struct turn_part {
    struct turn_interval interval;
    struct turn_direction direction;
    int sign; /* not 0: the exact direction is the direction of corners, or its opposite */
    struct turn_corners corners;
};

struct turn_proof {
    /* Above TURN_PROOF: there are more parts, or doubles do not represent a direction. */
    unsigned count;
    struct turn_part part[TURN_PROOF];
};

/* A decision in progress. It points into itself: not to be copied. */
struct turn_decision {
    struct frame_pair frames; /* in the order of support_order() */
    unsigned want;
    bool swapped, bounded, overlaps, undecided, exhausted;
    enum { TURN_VERDICT, TURN_FIRST, TURN_LAST, TURN_GAP, TURN_POINT, TURN_COMPLETE } phase;
    enum { TURN_LOOK, TURN_CORNER, TURN_EXACT, TURN_ENDS } stage;
    struct turn_path path;
    struct support_nearest nearest; /* of the last search in doubles */
    double looked, toward[FMB_DIM_MAX];
    bool sure;          /* the last search in doubles gave a verdict */
    unsigned looks;     /* the work so far */
    unsigned began;     /* the work before the last list of directions by vertices */
    unsigned fruitless; /* the work on lists that separated no part of an interval */
    struct turn_interval stack[TURN_STACK]; /* the next interval is the last element */
    int count;
    double in[2], out[2]; /* first and last: known times of contact, and bounds of all of them */
    double overlap;       /* a time of overlap */
    struct {
        double at;
        enum fmb_verdict verdict;
    } known[TURN_KNOWN]; /* verdicts at examined times */
    unsigned next_known;
    struct turn_interval apart[TURN_KNOWN]; /* intervals over which the frames are apart */
    unsigned apart_count;                   /* all ever added; the last TURN_KNOWN are kept */
    struct turn_exact exact;
    bool has_exact;
    double split;      /* a time at which to divide the interval that contains it, or -1 */
    double cleared;    /* a direction tried separates the frames up to this time, or NAN */
    double beyond;     /* the time at which to divide the remainder */
    double nearest_at; /* the time of the nearest point in `exact`, or -1 */
    enum fmb_verdict nearest_verdict;  /* at this time */
    struct turn_corners nearest_edges; /* the edges that this point is on, if nearest_are_edges */
    bool nearest_are_edges;
    double corners_at;         /* the time of the listed directions; -1: by vertices */
    struct programs *programs; /* of the pose of the path */
    struct turn_corners corners[TURN_CORNERS];
    signed char sign[TURN_CORNERS];
    struct turn_gap gap;
    double farthest;
    unsigned corner, corner_count;
    enum turn_outcome outcome; /* the strongest outcome of the corners tried */
    struct turn_proof *proof;  /* to be completed, or NULL */
};

/* Sets a decision that is complete. */
void turn_none(struct turn_decision *out);

/* Begins the decision of a checked pair. farthest: a gap that is surely greater has bounds of NAN.
 * bounded: performs only work that takes tens of microseconds, without allocation. proof: NULL, or
 * receives the proof of a decision that is not bounded: it is complete at the end if the frames are
 * separated; if they overlap, out->overlap is a time of overlap. Returns whether the decision is
 * complete and *answer set, without a verdict if the pair cannot be decided. If it is not complete,
 * a bounded decision has ended; for any other, call turn_step() until it returns true. In: *answer
 * is all 0. */
bool turn_begin(const struct frame_pair *frames, unsigned want, double farthest, bool bounded,
                struct turn_decision *out, struct turn_proof *proof, struct fmb_answer *answer);

/* Performs a step of less than a millisecond. Returns whether the decision is complete, with
 * *answer set; its memory is then freed. */
bool turn_step(struct turn_decision *decision, struct fmb_answer *answer);

/* Frees the memory of a decision, complete or not. */
void turn_end(struct turn_decision *decision);

#endif
