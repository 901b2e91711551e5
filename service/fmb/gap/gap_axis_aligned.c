/* The gap of two axis-aligned cuboids that do not drift, if it requires no square root.
 *
 * Method. The frames are boxes, given by their ends. On each side of each axis their distance is
 * the difference of an end of each, negative if they overlap there. P is a box with these
 * distances, so that the greatest of them is minus the depth. If exactly one of them is positive,
 * it is the distance of the frames. The witness points differ only on the axis of the greatest
 * distance.
 *
 * Accuracy. Ends do not round: if one would, or a frame has an error, the pair is left to the other
 * steps. A difference is rounded outward if it rounds. */
#include "gap.h"

#include "interval.h"

/* [lower, upper][axis]; false if the frame is not along the axes, or an end rounds. */
static bool set_ends(const struct gap_pair *pair, int f, double ends[2][FMB_DIM_MAX])
{
    const double *number = pair->frame[f]->number;
    const int dim = pair->dim;
    for (int axis = 0; axis < dim; axis++)
        ends[0][axis] = ends[1][axis] = number[axis];
    for (int i = 1; i <= dim; i++) {
        int axes = 0;
        for (int axis = 0; axis < dim; axis++) {
            const double at = number[i * dim + axis];
            double *end = &ends[at > 0][axis];
            const double sum = *end + at;
            if (at == 0)
                continue;
            if (axes++ > 0 || !prepared_exact_sum(*end, at, sum))
                return false;
            *end = sum;
        }
    }
    return true;
}

enum gap_outcome gap_axis_aligned(const struct gap_pair *pair, enum fmb_verdict verdict,
                                  struct fmb_gap *out)
{
    double ends[2][2][FMB_DIM_MAX]; /* [frame] */
    struct interval best = {-INFINITY, -INFINITY};
    int apart = 0;
    if (pair->error != 0 || pair->drifts || pair->simplex[0] || pair->simplex[1] ||
        !set_ends(pair, 0, ends[0]) || !set_ends(pair, 1, ends[1]))
        return GAP_UNSURE;
    for (int axis = 0; axis < pair->dim; axis++) {
        out->witness[0][axis] = out->witness[1][axis] =
            interval_max(ends[0][0][axis], ends[1][0][axis]) + 0.0;
        for (int side = 0; side < 2; side++) {
            const double low = ends[!side][0][axis], high = ends[side][1][axis];
            const struct interval by = interval_sum(interval_of(low), interval_of(-high));
            best.high = interval_max(best.high, by.high);
            apart += by.high > 0;
            if (by.low <= best.low)
                continue;
            best.low = by.low;
            memset(out->direction, 0, sizeof out->direction);
            out->direction[axis] = side ? -1 : 1;
        }
    }
    if (apart > 1)
        return GAP_UNSURE;
    out->bounds[0] = best.low;
    out->bounds[1] = best.high;
    out->has_witness = verdict != FMB_TOUCHING;
    if (!out->has_witness)
        memset(out->witness, 0, sizeof out->witness);
    for (int axis = 0; axis < pair->dim && out->has_witness; axis++)
        for (int side = 0; side < 2 && out->direction[axis] != 0; side++) {
            const bool upper = side == (out->direction[axis] < 0);
            out->witness[side][axis] = ends[side][upper][axis] + 0.0;
        }
    return GAP_KNOWN;
}
