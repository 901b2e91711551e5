/* The certified filter: the slabs of a pair in doubles, each with a bound on its error.
 *
 * Two frames meet just if the offset of their origins lies in the Minkowski difference
 * D = A - B, and a moving pair does at some time of its window just if the offset at the start
 * lies in D swept back along the drift (over the whole window): S = D - [0,1] drift. D and S are
 * polytopes, the intersections of a fixed list of slabs: this is what is left of the article's
 * elimination when it is done on paper (exact_slabs.c derives the list; the drift is one more
 * edge, and adds the planes of each edge with the drift). The relative interior of S is the
 * interior of D swept in the same way, the ends of the window included: a union of open sets.
 * So a pair is
 *
 *     SEPARATED    where the offset is beyond a bound of some slab,
 *     OVERLAPPING  where it is strictly between the bounds of all,
 *     TOUCHING     else.
 *
 * A slab whose normal is zero (parallel edges) says nothing and does not count.
 *
 * All of this holds for a face too, a polytope with one plane of its own, and D has an interior
 * where the other frame is solid, or a face of another plane. Two faces in parallel planes have a
 * flat D. What separates them still does, and what lies strictly between the bounds of all slabs
 * still overlaps: S then is a prism, spanned by a drift that leaves the planes, whose interior is
 * that of D swept over the open window. But the rest may be anything, and is decided elsewhere
 * (faces.h).
 *
 * Placed frames. The filter works on rounded frames. Each is within an error e of the true
 * one (prepared.h), so that the true D and S are within e = e_a + e_b of the rounded ones: along
 * every unit vector, their bounds differ by at most e. An offset that is farther than e beyond a
 * bound of a slab of the rounded S is not in the true one. One that is farther than e inside the
 * bounds of all slabs of the rounded S is farther than e from its boundary, and so in the interior
 * of the true S. What a rounded pair of edges hides, being parallel, does not matter: the list is
 * complete for the rounded S. Where slabs are decided one by one, some in doubles and others
 * exactly, that is not enough: there the error of each slab also counts how far its own true normal
 * is from the rounded one (slabs_pair.placing).
 *
 * How far beyond a bound the offset is, times the length of the normal, is the gap of the slab.
 * Doubles give it with an error that slabs.c bounds; where that leaves its sign open the
 * filter is unsure. */
#ifndef FMB_SLABS_H
#define FMB_SLABS_H

#include "clip.h"
#include "fmb.h"
#include "relative.h"

/* Bounds on the error of a gap, and of all that it is made of, in 3D and in 2D,
 * relative to the scale of the slab; and along an axis, relative to the sum of all lengths.
 * Derived in slabs.c: a smaller one gives wrong answers, a larger one more that are unsure. */
#ifndef SLABS_ROUNDING
#define SLABS_ROUNDING (18 * 0x1p-53)
#endif
#define SLABS_ROUNDING_2D (SLABS_ROUNDING * 2 / 3)
#define SLABS_ROUNDING_AXES 0x1p-49

/* The ends of a contact, in a window from -1 to 1, are off by less than this, but for what the
 * errors of slabs have to spare: derived in slabs_lanes.h. */
#define SLABS_TIMES_SLACK 0x1p-49

/* The first of two passes (kernel.h) takes bounds that are so many times as wide. Two computations
 * of the same gap differ by at most two of these bounds, so that what any first pass decides is
 * decided by every second one: what stays open does not depend on the first, whose operations may
 * be fused. */
#define SLABS_ROUGH 4

/* A pair that doubles can decide. */
struct slabs_pair {
    struct world_frame a, b;
    bool inexact; /* a frame has an error */
    double error; /* of both */
    /* Bounds how far off the true gap of a slab is for the errors of the frames, that of a slab of
     * scale 1. */
    double placing;
    double duration;
    struct relative_motion motion; /* a pair that does not drift is decided as a static one */
    double reach; /* sum of the largest magnitudes of the offset, the drift and all components */
    double drift_size; /* the largest magnitude of the drift */
};

/* False if doubles cannot decide the pair: a frame is not usable, or numbers are out of range. */
bool slabs_prepare(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   struct slabs_pair *out);

/* The edges of a pair by number: of A; of B; the drift. A frame's edges are its components, then,
 * of a tetrahedron, c2 - c1, c0 - c2, c1 - c0 (a triangle in 2D: c1 - c0). A face has numbers 0, 1
 * and 5 of these. */
enum { SLABS_EDGES = 6, SLABS_EDGE_OF_B = SLABS_EDGES, SLABS_DRIFT = 2 * SLABS_EDGES };

/* In 3D the normal is u x v, in 2D it is u turned by a right angle, (-u_y, u_x). */
struct slab_normal {
    int u, v; /* edges; v is not used in 2D */
};

/* normal . w in [low, high] for w in D, seen from the reference points of the frames
 * (slabs_evaluate.h); along the way of the offset it goes from middle - swing to middle + swing.
 * Each of the four is within error of what it stands for, and so is the gap. Where the normal is
 * surely zero, error is 0, and so are the others. */
struct slab_value {
    struct slab_normal normal;
    double low, high, middle, swing;
    double error;
};

/* How far the offset stays beyond a bound over the window; < 0: it comes inside. */
static inline double slab_gap(const struct slab_value *slab)
{
    const double above = slab->middle - slab->high, below = slab->low - slab->middle;
    const double swing = slab->swing < 0 ? -slab->swing : slab->swing;
    return (above > below ? above : below) - swing;
}

/* Those that are verdicts have their numbers. */
enum slabs_outcome {
    SLABS_UNSURE = 0,
    SLABS_SEPARATED = FMB_SEPARATED,
    SLABS_TOUCHING = FMB_TOUCHING, /* of the second pass alone (kernel.h) */
    SLABS_OVERLAPPING = FMB_OVERLAPPING
};

enum { SLABS_MAX = 56 }; /* two tetrahedra, moving: 4 + 4 + 36 + 12 */

/* All slabs of the pair; returns how many. rounds: whether an operation on these numbers may round;
 * else every error is 0. Errors are those of slabs decided one by one. The true normal of a slab
 * without an error is surely zero only if the pair is not inexact. */
int slabs_list(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX]);

/* A slab as two inequalities of the time, tau in [0,1]: c + tau g >= 0 while the offset is not
 * below it ([0]), and while it is not above it ([1]). */
void slab_inequalities(const struct slab_value *slab, struct inequality out[2]);

/* The same of one slab alone, with bounds made for each of its numbers: they cost more, and are
 * small where the numbers are. */
void slabs_refine(const struct slabs_pair *pair, struct slab_normal normal,
                  struct inequality out[2]);

#endif
