/* The gap of a pair that turns: the least signed distance at any one time. No shared state.
 *
 * Method: branch and bound over intervals of s. The enclosed gap at the middle of an interval
 * (support_gap.h) bounds the result from above; its direction bounds the gap over the interval from
 * below (turn_distance()). The interval with the least lower bound is divided until this bound is
 * within the limit of fmb.h of the least known gap. */
#ifndef FMB_TURN_GAP_H
#define FMB_TURN_GAP_H

#include "support_gap.h"
#include "turn_path.h"

enum { TURN_PIECES = 512 };

struct turn_piece {
    double lo, hi, least; /* least: a lower bound of the gap over it */
    bool looked;          /* its middle was examined */
};

/* A search in progress. */
struct turn_gap {
    struct turn_path *path;
    bool swapped, separated;
    struct turn_piece piece[TURN_PIECES];
    unsigned count, looks;
    double tight;    /* the greatest width */
    double travel;   /* bounds the movement of both frames within the error of a time */
    double farthest; /* a gap that is surely greater need not be enclosed */
    struct fmb_gap best;
    struct turn_direction good; /* the last that bounded the gap over a piece tightly */
    bool has_good;
    struct turn_piece next;        /* the piece being examined */
    struct support_gap_work *work; /* for the pose at its middle, or NULL */
    struct fmb_gap at;             /* its gap */
};

/* Begins the search for a pair that is separated or overlaps. path must outlive the search.
 * separated: the pair is separated. known: a time of overlap; any time for a separated pair. */
void turn_gap_begin(struct turn_path *path, bool swapped, bool separated, double known,
                    double farthest, struct turn_gap *out);

/* Performs a step. Returns GAP_UNSURE until the search is complete, then GAP_KNOWN, with *out set,
 * or GAP_FAR. The enclosure is wider than the limit only in the cases that fmb.h names. */
enum gap_outcome turn_gap_step(struct turn_gap *gap, struct fmb_gap *out);

/* Abandons the search, complete or not. */
void turn_gap_end(struct turn_gap *gap);

#endif
