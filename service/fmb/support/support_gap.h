/* The gap of a pair by its vertices, in steps. D, reach and error: support_pair.h.
 *
 * Cores that are apart: the point of D nearest to the origin, first in doubles (gap_simplex.h),
 * then on a grid (integer_simplex.h). Cores that meet: the depth, from a polytope inside D
 * (polytope.h) and the direction in which D extends least. A gap that is not tight because the
 * positions cancel, or because numbers are too large or too small, is computed again with vertices
 * that are placed exactly and then rounded (support_placed.c). Radii are subtracted at the end
 * (support_round_gap()). */
#ifndef FMB_SUPPORT_GAP_H
#define FMB_SUPPORT_GAP_H

#include "polytope.h"
#include "support_integers.h"
#include "support_pair.h"
#include "support_search.h"

/* A pair in doubles, and what its bounds need. */
struct support_gap {
    const struct support_pair *pair;
    double far;   /* bounds the sum of both frames' coordinates over the window */
    double late;  /* bounds how far the frames move in the error of a time, relative to a window */
    double tight; /* the greatest width of an enclosure */
    double scale; /* the grid of a mesh: a power of two */
};

/* Returns an upper bound of the sum of the distances of the two witness points from their frames,
 * at their time. */
double support_witness_error(const struct support_gap *gap);

/* Sets the witness points, and their time, that the weights of a point of D give, and the upper
 * bound of the distance. */
void support_witness(const struct support_gap *gap, const struct support_nearest *nearest,
                     struct fmb_gap *out);

/* The depth of D, in steps. If D does not contain the origin, up to the width of an enclosure, the
 * depth is 0. It points to gap and into itself: not to be copied. */
struct support_depth {
    const struct support_gap *gap;
    double least; /* value of a direction */
    double direction[FMB_DIM_MAX];
    bool closed; /* the mesh has a closed boundary */
    bool zero;   /* the depth is 0, up to the width of an enclosure */
    struct polytope mesh;
};

/* nearest: the result of a search, or NULL. A tetrahedron of it begins the mesh; not so a triangle
 * in 2D, where all points of a mesh have to be vertices of D. Returns false if there are no steps
 * to be done. support_depth_end() frees what the others allocate. */
bool support_depth_begin(struct support_depth *depth, const struct support_gap *gap,
                         const struct support_nearest *nearest);

/* Performs some steps, each of one scan of the vertices. Returns whether the depth is known. */
bool support_depth_step(struct support_depth *depth, int count);

/* Sets bounds, which enclose it also if it is not known, and direction. Returns whether they are
 * tight. */
bool support_depth_end(struct support_depth *depth, struct fmb_gap *out);

/* A pair with its vertices in the world, lengths divided by 2^exponent. It points into itself. */
struct support_placed {
    struct support_pair pair;
    long exponent;
    double least; /* the largest coordinate, or half a displacement if that is larger */
    double *memory[2];
    bool measures; /* the first pass */
    unsigned next; /* vertex, of both frames */
    struct support_integers integers;
    mpz_t at[FMB_DIM_MAX], scratch[2];
};

/* Place a pair exactly, some vertices in each step, until that returns true. support_placed_end()
 * frees what they allocate. pair->frames must outlive it. */
void support_placed_begin(const struct support_pair *pair, struct support_placed *out);
bool support_placed_step(struct support_placed *placed, int count);
void support_placed_end(struct support_placed *placed);

/* Sets point, as fmb_answer.point, of a pair in contact. nearest: the result of a search. Returns
 * false if doubles do not prove it within the limits of fmb.h. */
bool support_common_point(const struct support_pair *pair, const struct support_nearest *nearest,
                          double point[1 + FMB_DIM_MAX]);

/* The gap of a pair in the order of support_order(), in steps of less than a millisecond.
 *
 * In:  pair      unchanged until the last step
 *      swapped   what support_order() returned
 *      nearest   the result of a search up to INFINITY, or NULL
 *      cores     the verdict of the frames without their radii; may be OVERLAPPING for cores that
 *                touch, if the frames have radii: the direction then proves the lower bound
 *      verdict   of the pair
 *      farthest  a gap of the cores: a greater one need not be computed
 *
 * support_gap_of_pair() returns GAP_KNOWN or, if the gap is surely greater than farthest, by more
 * than the width of an enclosure, GAP_FAR. It returns GAP_UNSURE if there are steps to be done,
 * with *work set unless work is NULL: support_gap_step() is then called until it returns something
 * else, or support_gap_end(), which abandons the work. Both allocate through GMP; nothing is left
 * at the end.
 */
struct support_gap_work;
enum gap_outcome support_gap_of_pair(const struct support_pair *pair, bool swapped,
                                     const struct support_nearest *nearest, enum fmb_verdict cores,
                                     enum fmb_verdict verdict, double farthest, struct fmb_gap *out,
                                     struct support_gap_work **work);
enum gap_outcome support_gap_step(struct support_gap_work *work, struct fmb_gap *out);
void support_gap_end(struct support_gap_work *work);

#endif
