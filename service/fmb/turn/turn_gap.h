/* The gap of a pair that turns: the least signed distance at any one time. No shared state.
 *
 * Method: branch and bound over intervals of s. The gap at the middle of an interval, an enclosure
 * (support_gap.h), bounds the result from above; the direction of that gap bounds it from below
 * over the interval (turn_distance()). The interval with the least bound is divided, until that
 * bound is within the limit of fmb.h of the least gap found. */
#ifndef FMB_TURN_GAP_H
#define FMB_TURN_GAP_H

#include "support_gap.h"
#include "turn_path.h"

enum { TURN_PIECES = 512 };

struct turn_piece {
    double lo, hi, least; /* least: bounds the gap over it */
    bool looked;          /* at its middle */
};

/* A search in progress. */
struct turn_gap {
    struct turn_path *path;
    bool swapped, separated;
    struct turn_piece piece[TURN_PIECES];
    unsigned count, looks;
    double tight;    /* the greatest width */
    double farthest; /* a gap that is surely greater need not be known */
    struct fmb_gap best;
    struct turn_direction good; /* one that bounded the gap over a piece tightly */
    bool has_good;
    struct turn_piece next;        /* the one that is looked at */
    struct support_gap_work *work; /* of the pose in its middle, or NULL */
    struct fmb_gap at;             /* its gap */
};

/* Begins the search. path must outlive it. separated: the verdict of the pair. */
void turn_gap_begin(struct turn_path *path, bool swapped, bool separated, double farthest,
                    struct turn_gap *out);

/* Performs a step. Returns GAP_UNSURE until it is complete, then GAP_KNOWN, with *out set, or
 * GAP_FAR. *failed: it is complete and the gap cannot be enclosed within the limit. */
enum gap_outcome turn_gap_step(struct turn_gap *gap, bool *failed, struct fmb_gap *out);

/* Abandons the search, complete or not. */
void turn_gap_end(struct turn_gap *gap);

#endif
