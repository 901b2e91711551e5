/* Gaps: the distance of two frames, or the depth of their overlap.
 *
 * Let P = { b - a + t (v_b - v_a) } over all points a, b of the two frames and all times t of the
 * window. P is a polytope: the offset of the frames minus their swept difference (slabs.h). For a
 * direction n let
 *
 *     f(n) = min { n . p : p in P } / |n|.
 *
 * Every n proves that the gap is at least f(n), and the gap is the greatest f(n). If the frames are
 * separated, that is the distance of the origin from P. If they overlap, it is attained at the
 * normal of a facet of P and is minus the distance of the origin from the boundary; if P is flat it
 * is 0.
 *
 * Doubles give the gap of nearly all pairs: gap_axis_aligned.c that of axis-aligned cuboids;
 * gap_distance.c that of separated pairs, by the point of P closest to the origin; gap_depth.c that
 * of the others, by the normals of facets. If the enclosure is wider than the limit,
 * support_gap.h computes the gap from the vertices of both frames.
 *
 * The pair is put into an order that depends on its numbers only, so that the swapped pair has the
 * same bits. */
#ifndef FMB_GAP_H
#define FMB_GAP_H

#include "aabb.h"
#include "vector.h"

#include <math.h>

/* GAP_UNSURE: not known within the limit. GAP_FAR: surely greater than farthest; nothing else is
 * known. */
enum gap_outcome { GAP_UNSURE, GAP_KNOWN, GAP_FAR };

/* The vectors of P, by number: the components of a, negated; those of b; the drift; a zero vector.
 * P is the offset plus a cuboid or a simplex of each of the first two groups, plus a fraction in
 * [0,1] of the drift. */
enum { GAP_OF_B = 3, GAP_DRIFT = 6, GAP_VECTORS = 8, GAP_LANES = GAP_VECTORS / 2 };

/* An ordered pair of frames, in doubles. Axes beyond dim are 0. */
struct gap_pair {
    const struct fmb_prepared *frame[2];
    double duration;
    int dim, count[2]; /* of components */
    bool simplex[2], drifts;
    double offset[FMB_DIM_MAX];
    lanes vector[FMB_DIM_MAX][GAP_LANES]; /* [axis], two side by side */
    double error;                         /* of both frames */
    double reach;  /* at least the sum of the lengths of the offset and of all vectors */
    double far[2]; /* of each frame: bounds its coordinates over the window (gap_distance.c) */
    double least;  /* at most the largest coordinate of a vertex over the window */
};

/* Relative to "least": the greatest width of an enclosure in doubles, and the greatest error of a
 * deepest pair. fmb.h allows 1e-12. */
#define GAP_LIMIT 0.9e-12

/* Returns false if numbers are outside the range in which doubles can bound the gap. */
bool gap_pair_set(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                  struct gap_pair *out);

/* Returns a coordinate of vector k. */
INLINE double gap_vector(const struct gap_pair *pair, int k, int axis)
{
    return pair->vector[axis][k / 2][k % 2];
}

/* out := n . v for each vector v. */
INLINE void gap_dots(const struct gap_pair *pair, const double n[FMB_DIM_MAX], lanes out[GAP_LANES])
{
    UNROLL(4)
    for (int i = 0; i < GAP_LANES; i++)
        out[i] =
            (n[0] * pair->vector[0][i] + n[1] * pair->vector[1][i]) + n[2] * pair->vector[2][i];
}

/* Relative to the reach; tests define another value. */
#ifndef GAP_ROUNDING
#define GAP_ROUNDING 0x1p-48
#endif

/* Relative to coordinates, more than the error of a distance in doubles: one that exceeds a limit
 * by more than this is certainly beyond it. */
#define GAP_FAR_MARGIN 0x1p-38

/* A square of a length below this may have underflowed. */
#define GAP_LEAST_SQUARE 0x1p-950

/* Bounds the error of f(n), for a direction of unit length up to rounding, including the errors of
 * the frames (gap_distance.c). */
INLINE double gap_error(const struct gap_pair *pair)
{
    return GAP_ROUNDING * pair->reach + pair->error;
}

/* Returns whether the width of an enclosure is within the limit of fmb.h. */
bool gap_is_tight(const struct gap_pair *pair, const double bounds[2]);

/* The gap of two axis-aligned cuboids, as accurately as doubles allow. Returns GAP_UNSURE for other
 * pairs, and if it requires a square root. */
enum gap_outcome gap_axis_aligned(const struct gap_pair *pair, enum fmb_verdict verdict,
                                  struct fmb_gap *out);

/* The gap of a separated pair. Returns GAP_FAR if it is surely greater than farthest, by more than
 * the width of an enclosure. */
enum gap_outcome gap_distance(const struct gap_pair *pair, double farthest, struct fmb_gap *out);

/* The gap of a pair in contact. For a touching pair only the direction is computed; the bounds are
 * 0. */
enum gap_outcome gap_depth(const struct gap_pair *pair, enum fmb_verdict verdict,
                           struct fmb_gap *out);

/* Sets the witness points of an overlapping pair that does not drift, whose bounds and direction
 * are known: its deepest pair. Returns GAP_UNSURE if they are not within the limit of fmb.h. */
enum gap_outcome gap_deepest(const struct gap_pair *pair, struct fmb_gap *out);

/* Returns the error of the witness points of an overlapping pair, as a deepest pair:
 * |a - b + bounds[1] direction|, where -bounds[1] is the depth. */
INLINE double gap_stray(const struct fmb_gap *gap)
{
    double way[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        way[axis] =
            gap->witness[0][axis] - gap->witness[1][axis] + gap->bounds[1] * gap->direction[axis];
    return sqrt(vec3_dot(way, way));
}

/* Returns a distance: frames that are farther apart have a gap that is surely greater than
 * farthest, as computed in doubles. In: a usable pair. */
double gap_far_threshold(const struct fmb_prepared *a, const struct fmb_prepared *b,
                         double duration, double farthest);

/* The gap of a prepared pair with this verdict. Returns GAP_UNSURE if doubles do not give it. */
enum gap_outcome gap_of(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                        enum fmb_verdict verdict, double farthest, struct fmb_gap *out);

/* Returns whether the gap of these frames is computed for the swapped pair. */
bool gap_frames_swap(const struct placed_frame *a, const struct placed_frame *b);

/* Converts a gap to that of the swapped pair. No number becomes -0. */
void gap_turn_round(struct fmb_gap *gap);

/* ---- Bodies of several frames ---- */

/* Returns whether gaps of these placements are computed for the swapped pair. */
bool gap_swaps(const struct fmb_placement *a, const struct fmb_placement *b);

/* Returns no gap: bounds of NAN. It is the neutral element of gap_include(). */
struct fmb_gap gap_none(void);
bool gap_is_known(const struct fmb_gap *gap);

/* Combines two gaps of the same placements in all: the lesser lower bound, and the other fields
 * from the gap with the lesser upper bound, whose direction proves the lower bound too. The result
 * of many does not depend on their order. swaps: gap_swaps() of the placements. a, b: the boxes of
 * the frames of one.
 *
 * The lower bound of each gap is first raised to the distance of the boxes on an axis, if that is
 * greater; the axis then proves it. Frames whose boxes are farther apart than the least upper bound
 * therefore do not change the result, and can be skipped. */
void gap_include(struct fmb_gap *all, const struct fmb_gap *one, const struct aabb *a,
                 const struct aabb *b, bool swaps);

/* Completes a combined gap, given the verdict of the bodies: the gap of bodies that touch is 0,
 * although separated frames may contribute a lower bound below 0. */
void gap_end(enum fmb_verdict verdict, struct fmb_gap *gap);

/* Returns a distance for boxes of frames inside a and b, given bounds[1] of the least gap so far,
 * NAN if there is none:
 * frames whose boxes are farther apart on an axis do not change the gap, and do not meet. */
double gap_reach(double upper, const struct aabb *a, const struct aabb *b);

#endif
