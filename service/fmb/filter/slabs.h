/* The certified filter: the slabs of a pair in doubles, each with a bound on its error.
 *
 * Two frames meet if and only if the offset of their origins lies in the Minkowski difference D = A
 * - B. A moving pair meets if and only if this holds at some time of its window, that is, if the
 * offset at the start lies in D swept back along the drift (over the whole window): S = D - [0,1]
 * drift. D and S are polytopes, the intersections of a fixed list of slabs: the result of the
 * article's elimination done on paper (limbs_decide.h derives the list; the drift is one more edge,
 * and adds the planes of each edge with the drift). The relative interior of S is the interior of D
 * swept in the same way, the ends of the window included: a union of open sets. So a pair is
 *
 *     SEPARATED    if the offset is beyond a bound of some slab,
 *     OVERLAPPING  if it is strictly between the bounds of all,
 *     TOUCHING     otherwise.
 *
 * A slab whose normal is zero (parallel edges) does not count.
 *
 * All of this also holds for a face, a polytope with one plane of its own. D has an interior if the
 * other frame is solid, or a face in a plane that is not parallel. Two faces in parallel planes
 * have a flat D. A slab that separates them is still a proof, and an offset strictly between the
 * bounds of all slabs still means that they overlap: S then is a prism, spanned by a drift that
 * leaves the planes, whose interior is that of D swept over the open window. All other such pairs
 * may have any verdict, and are decided elsewhere (faces.h).
 *
 * Placed frames. The filter works on rounded frames. Each is within an error e of the true one
 * (prepared.h), so that the true D and S are within e = e_a + e_b of the rounded ones: along every
 * unit vector, their bounds differ by at most e. An offset that is farther than e beyond a bound of
 * a slab of the rounded S is not in the true one. One that is farther than e inside the bounds of
 * all slabs of the rounded S is farther than e from its boundary, and so in the interior of the
 * true S. A slab that is missing because two edges are parallel only after rounding does not
 * matter: the list is complete for the rounded S. If slabs are decided one by one, some in doubles
 * and others exactly, this is not enough: there the error of each slab also includes how far its
 * own true normal is from the rounded one (slabs_pair.placing).
 *
 * The gap of a slab is the distance of the offset beyond a bound, times the length of the normal.
 * Doubles give it with an error that slabs.c bounds; if that leaves its sign open, the filter is
 * unsure. No function here has shared state, and inputs are not changed. */
#ifndef FMB_SLABS_H
#define FMB_SLABS_H

#include "clip.h"
#include "fmb_batch.h"
#include "inlined.h"
#include "prepared.h"

/* Bounds on the error of a gap, and of all numbers that it is made of, relative to the scale of the
 * slab: in 3D and in 2D; and of a gap along an axis, relative to the sum of all lengths. Derived in
 * slabs.c. A smaller bound gives wrong answers, a larger one more that are unsure. */
#ifndef SLABS_ROUNDING
#define SLABS_ROUNDING (18 * 0x1p-53)
#endif
#define SLABS_ROUNDING_2D (SLABS_ROUNDING * 2 / 3)
#define SLABS_ROUNDING_AXES 0x1p-49

/* The ends of a contact, in a window from -1 to 1, are off by less than this, apart from what the
 * unused part of the errors of slabs covers: derived in slabs_lanes.h. */
#define SLABS_TIMES_SLACK 0x1p-49

/* The first of two passes (kernel.h) uses bounds that are this many times as wide. Two computations
 * of the same gap differ by at most two of these bounds, so that every second pass decides what any
 * first pass decides. So the pairs that stay open do not depend on the first pass, whose operations
 * may be fused. */
#define SLABS_ROUGH 4

/* Frame b relative to a. Axes beyond the dimension hold 0.
 *
 * Accuracy: each coordinate of offset is rounded once, each of drift twice. If the product
 * underflows, drift may be off by another 2^-1075. Equal velocities give a drift of exactly 0, but
 * a drift of 0 along an axis does not imply equal velocities along it (slabs.c, underflow). */
struct relative_motion {
    bool drifts;                /* the velocities differ, and the window is not empty */
    double offset[FMB_DIM_MAX]; /* origin of b - origin of a, at t = 0 */
    double drift[FMB_DIM_MAX];  /* (velocity of b - velocity of a) T, over the whole window */
};

/* Sets *out. duration: T, seconds. Returns false if a number overflowed. No shared state. */
bool relative_motion_of(const struct world_frame *a, const struct world_frame *b, double duration,
                        struct relative_motion *out);

/* A pair that doubles can decide, as slabs_prepare() sets it. Lengths are not doubled. */
struct slabs_pair {
    struct world_frame a, b;
    bool inexact; /* a frame has an error */
    double error; /* sum of the errors of both frames */
    /* Bound on the error of the true gap of a slab of scale 1 that the errors of the frames cause.
     */
    double placing;
    double duration;               /* of the window, in seconds */
    struct relative_motion motion; /* a pair without drift is decided as a static one */
    double reach; /* sum of the largest magnitudes of the offset, the drift and all components */
    double drift_size; /* the largest magnitude of the drift */
};

/* Sets *out; duration in seconds. Returns false if doubles cannot decide the pair: a frame is not
 * usable, or numbers are out of range. */
bool slabs_prepare(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   struct slabs_pair *out);

/* The edges of a pair by number: of A; of B; the drift. The edges of a frame are its components,
 * followed, for a tetrahedron, by c2 - c1, c0 - c2, c1 - c0 (for a triangle in 2D, by c1 - c0). A
 * face has numbers 0, 1 and 5 of these. */
enum { SLABS_EDGES = 6, SLABS_EDGE_OF_B = SLABS_EDGES, SLABS_DRIFT = 2 * SLABS_EDGES };

/* The constants of a kernel: the kind of its pairs, and its job. */
struct kernel_traits {
    int dim;
    bool simplex[2]; /* [a, b]: a tetrahedron, a triangle in 2D, or a face; else a cuboid */
    bool face[2];    /* [a, b]: in 3D, a simplex of two components */
    bool drifts;
    bool axis_aligned; /* 3D: edges may be parallel to the same axis; zero normals are looked for */
    bool swap_invariant; /* every number has the same bits for the pair with its frames swapped */
    /* Two frames of the same shape; of two lanes, the second holds the pair with its frames
     * swapped. The slabs of b in one lane are those of a in the other, and those of edges i of a
     * and j of b are those of j and i. */
    bool mirrored;
    bool times;  /* times of contact are computed; requires swap_invariant */
    bool box;    /* the box is computed, also of frames that move with equal velocities */
    bool rough;  /* the first of two passes: bounds are SLABS_ROUGH times as wide */
    bool second; /* the second pass: in some lanes nothing rounds, and signs along axes are known */
};

INLINE int component_count(const struct kernel_traits traits, int which)
{
    return traits.face[which] ? 2 : traits.dim;
}

INLINE int edge_count(const struct kernel_traits traits, int which)
{
    return !traits.simplex[which] ? traits.dim : component_count(traits, which) == 2 ? 3 : 6;
}

/* The number of the edge at an index in [0, edge_count): a face has c_0, c_1 and c_1 - c_0. */
INLINE int edge_at(const struct kernel_traits traits, int which, int index)
{
    return traits.face[which] && index == 2 ? 5 : index;
}

/* In 3D the normal is u x v; in 2D it is u rotated by a right angle, (-u_y, u_x). */
struct slab_normal {
    int u, v; /* edges; v is not used in 2D */
};

/* normal . w is in [low, high] for w in D, seen from the reference points of the frames
 * (pair_lanes.h). Over the window, normal . offset goes from middle - swing to middle + swing. Each
 * of the four numbers is within error of its true value, and so is the gap. If the normal is surely
 * zero, error is 0, and so are the others. */
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

/* Verdicts have the numbers of enum fmb_verdict. */
enum slabs_outcome {
    SLABS_UNSURE = 0,
    SLABS_SEPARATED = FMB_SEPARATED,
    SLABS_TOUCHING = FMB_TOUCHING, /* of the second pass only (kernel.h) */
    SLABS_OVERLAPPING = FMB_OVERLAPPING
};

enum { SLABS_MAX = 56 }; /* two tetrahedra, moving: 4 + 4 + 36 + 12 */

/* Lists all slabs of the pair in out; returns their number. rounds: whether an operation on these
 * numbers may round; if not, every error is 0. Errors are those of slabs decided one by one. The
 * true normal of a slab without an error is surely zero only if the pair is not inexact. */
int slabs_list(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX]);

/* A slab as two inequalities in the time, tau in [0,1]: c + tau g >= 0 while the offset is not
 * below its lower bound ([0]), and while it is not above its upper bound ([1]). */
void slab_inequalities(const struct slab_value *slab, struct inequality out[2]);

#endif
