/* Checks an enclosure of a gap in rational numbers, as fmb.h says it is proven. It shares fmb.h's
 * types with the engine, and no code. */
#ifndef GAP_CHECK_H
#define GAP_CHECK_H

#include <gmp.h>
#include <stdbool.h>
#include <stddef.h>

#include "fmb.h"
#include "placed_pair.h"

/* Whether the gap of a pair with this verdict, the true one, is proven:
 *
 *     the direction has unit length within 1e-15, and proves the lower bound, for some frame of
 *     each body; no other frames are nearer than that bound;
 *     separated: the witness points prove the upper bound, at a time within the window; where they
 *     are beyond the doubles, the square of the distance itself is compared with it;
 *     overlapping: for some frames, no normal of a facet of the swept difference has a smaller
 *     depth than the upper bound says;
 *     overlapping: witness points, if there are any, are a deepest pair, and there is no relative
 *     motion;
 *     touching: both are 0, and the direction proves 0 within the limit;
 *     the bounds are no farther apart than 1e-12 of the largest coordinate of a vertex, plus
 *     its radius, over the window, or than a few of the least doubles; no number is -0.
 *
 * Every direction bounds the gap from below. Every pair of points bounds the distance from above,
 * and the depth is the least over all facets. So a gap that passes encloses the true one, and no
 * number of the engine's is taken on trust.
 *
 * Bounds beyond the largest double are infinite. If not, why says in one line what is wrong. */
bool gap_check(const struct pair *pair, enum fmb_verdict verdict, const struct fmb_gap *gap,
               char *why, size_t size);

/* The width of the enclosure divided by that limit, rounded. */
double gap_check_width(const struct pair *pair, const struct fmb_gap *gap);

/* Whether two gaps are the same bits; and whether those of a pair in its two orders are, with the
 * direction negated and the points exchanged. symmetric: the placements are equal in all numbers,
 * so both orders are one pair. */
bool gap_check_same(const struct fmb_gap *x, const struct fmb_gap *y);
bool gap_check_swapped(bool symmetric, const struct fmb_gap *gap, const struct fmb_gap *swapped);

/* Whether the direction proves the lower bound for frame i of a and frame j of b, and whether the
 * witness points prove the upper one. */
bool gap_check_lower(const struct pair *pair, unsigned i, unsigned j, const struct fmb_gap *gap);
bool gap_check_upper(const struct pair *pair, unsigned i, unsigned j, const struct fmb_gap *gap);

/* The square of the distance of two frames of small numbers at rest: the least over all pairs of
 * faces, of whatever dimension, of the distance between their planes where that is attained inside
 * of both. Slow. */
void gap_check_distance(const struct pair *pair, mpq_t square);

#endif
