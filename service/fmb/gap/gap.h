/* Gaps: how far apart two frames are, or how deep in each other.
 *
 * Let P = { b - a + t (v_b - v_a) } over all points a, b of the two frames and all times t of the
 * window: a polytope, that of the offset of the frames minus their swept difference (slabs.h). For
 * a direction n let
 *
 *     f(n) = min { n . p : p in P } / |n|.
 *
 * Every n proves that the gap is at least f(n), and the gap is the greatest f(n). Where the frames
 * are apart that is the distance of the origin from P. Where they overlap it is attained at the
 * normal of a facet of P, and minus the distance of the origin from the boundary; where P is flat
 * it is 0.
 *
 * Doubles give the gap of nearly all pairs: gap_upright.c that of cuboids along the axes,
 * gap_distance.c that of separated pairs, by the point of P next to the origin, gap_depth.c that of
 * others, by the normals of facets. Where the enclosure is wider than the limit, gap_exact.c gives
 * it, in integers.
 *
 * The pair is brought into an order that depends on its numbers alone, so that the pair the other
 * way round has the same bits. */
#ifndef FMB_GAP_H
#define FMB_GAP_H

#include "swept.h"

/* UNSURE: not known within the limit. FAR: greater than asked for; nothing else is known. */
enum gap_outcome { GAP_UNSURE, GAP_KNOWN, GAP_FAR };

/* The vectors of P: the components of a, negated, those of b, the drift, and one that is 0. P is
 * the offset plus a cuboid, or a simplex, of each of the first two, plus a part of the third. */
enum { GAP_OF_B = 3, GAP_DRIFT = 6, GAP_VECTORS = 8, GAP_LANES = GAP_VECTORS / 2 };

/* A pair of frames in its order, as doubles see it. Axes beyond dim hold 0. */
struct gap_pair {
    const struct fmb_prepared *frame[2];
    double duration;
    int dim, count[2]; /* of components */
    bool simplex[2], drifts;
    double offset[FMB_DIM_MAX];
    lanes vector[FMB_DIM_MAX][GAP_LANES]; /* [axis], two side by side */
    double error;                         /* of both frames */
    double reach;  /* the sum of the lengths of the offset and all vectors, or more */
    double far[2]; /* of each frame: bounds its coordinates over the window (gap_distance.c) */
    double least;  /* no larger than the largest coordinate of a vertex over the window */
};

/* False if numbers are out of the range of doubles. */
bool gap_pair_set(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                  struct gap_pair *out);

/* Vector k on an axis. */
INLINE double gap_vector(const struct gap_pair *pair, int k, int axis)
{
    return pair->vector[axis][k / 2][k % 2];
}

/* n . each vector. */
INLINE void gap_dots(const struct gap_pair *pair, const double n[FMB_DIM_MAX], lanes out[GAP_LANES])
{
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        out[i] =
            (n[0] * pair->vector[0][i] + n[1] * pair->vector[1][i]) + n[2] * pair->vector[2][i];
}

INLINE double gap_dot(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX])
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

INLINE void gap_cross(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX],
                      double out[FMB_DIM_MAX])
{
    out[0] = x[1] * y[2] - x[2] * y[1];
    out[1] = x[2] * y[0] - x[0] * y[2];
    out[2] = x[0] * y[1] - x[1] * y[0];
}

/* Of the reach; tests plant another. */
#ifndef GAP_ROUNDING
#define GAP_ROUNDING 0x1p-48
#endif

/* Bounds the error of f(n) for a direction of unit length but for rounding, and what the errors of
 * the frames add (gap_distance.c). */
INLINE double gap_error(const struct gap_pair *pair)
{
    return GAP_ROUNDING * pair->reach + pair->error;
}

/* Whether an enclosure is within the limit of fmb.h. */
bool gap_is_tight(const struct gap_pair *pair, const double bounds[2]);

/* The gap of two cuboids along the axes, as near as doubles go; UNSURE of others, and where it
 * takes a root. */
enum gap_outcome gap_upright(const struct gap_pair *pair, struct fmb_gap *out);

/* The gap of a separated pair. farthest: FAR where it is surely greater, by more than the width of
 * an enclosure. */
enum gap_outcome gap_distance(const struct gap_pair *pair, double farthest, struct fmb_gap *out);

/* The gap of a pair in contact; of one that touches the direction alone, bounds 0. */
enum gap_outcome gap_depth(const struct gap_pair *pair, enum fmb_verdict verdict,
                           struct fmb_gap *out);

/* The gap of a checked pair in its order, with this verdict, in integers. */
void gap_exact(const struct frame_pair *pair, enum fmb_verdict verdict, struct fmb_gap *out);

/* The same of a pair in any order. */
void gap_exactly(const struct frame_pair *pair, enum fmb_verdict verdict, struct fmb_gap *out);

/* Frames that are farther apart than this have a gap that is surely greater than farthest, as
 * doubles have it. In: a usable pair. */
double gap_surely(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                  double farthest);

/* The gap of a prepared pair with this verdict. quick: UNSURE where it needs GMP. */
enum gap_outcome gap_of(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                        enum fmb_verdict verdict, double farthest, bool quick, struct fmb_gap *out);

/* ---- Bodies of several frames ---- */

/* Whether gaps of the placements are found for the pair the other way round. */
bool gap_swaps(const struct fmb_placement *a, const struct fmb_placement *b);

/* The neutral element of gap_include(). */
struct fmb_gap gap_none(void);

/* The least of two gaps of the same placements: the lesser lower bound, and the rest from the one
 * with the lesser upper bound, whose direction proves the lower one too. The result of many does
 * not depend on their order. swaps: gap_swaps() of the placements; a, b: the boxes of the frames of
 * one.
 *
 * The lower bound of each is raised to the distance of the boxes on an axis where that is more; the
 * axis then proves it. So frames whose boxes are farther apart than the least upper bound do not
 * change the result, and can be skipped. */
void gap_include(struct fmb_gap *all, const struct fmb_gap *one, const struct swept *a,
                 const struct swept *b, bool swaps);

/* To be called when all are included, with the verdict of the bodies: the gap of bodies that touch
 * is 0, although that of other frames, which are separated, may have a lower bound below it. */
void gap_end(enum fmb_verdict verdict, struct fmb_gap *gap);

/* For boxes of frames within a and b, with bounds[1] of the least gap so far: those that are
 * farther apart on an axis do not change the gap, and do not meet. */
double gap_reach(double upper, const struct swept *a, const struct swept *b);

#endif
