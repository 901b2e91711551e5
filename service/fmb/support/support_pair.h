/* Pairs of frames by their vertices: pairs with a hull or a radius, and what slabs do not give of
 * other pairs.
 *
 * A box, a cuboid, a tetrahedron or a face is the hull of its 3 to 8 vertices. With M = { b - a }
 * for points a and b of the frames at time 0 and w the velocity of b relative to a, the set that
 * decides everything is
 *
 *     D = M + [0, T] w,
 *
 * the swept difference. The closed sets meet at some time if and only if D contains the origin. Its
 * vertices are among v_j - v_i + t w for vertices v_i of A and v_j of B and t = 0 or T; none is
 * stored: D is known by its support function, the greatest n . x, which takes one scan of each
 * frame's vertices.
 *
 *   support_pair_set()        two placed frames as arrays of vertices, in body coordinates, and
 *                             bounds on the errors of everything computed below
 *   support_farthest()        the farthest point of D in a direction
 *   support_point()           a point of D
 *   support_decision_begin()  verdict, contact, box and gap, in steps (support_decision.h)
 *
 * Accuracy of doubles. Let u = 2^-53, r the reach of a frame: the distance of its vertices from
 * the origin of its body is at most r. Rounding a direction n to body coordinates, R^T n, or a
 * vertex to world coordinates, R v, is off by at most 18.3 u |n| or 18.3 u r (rotation.h; the
 * argument holds for the transposed matrix too). A product n . v is off by 3.01 u |n| r
 * (support.h). So the value of a vertex in a direction is off by less than 22 u |n| r, plus |n|
 * slack where the stored vertex is itself off by slack. The offset of the positions is rounded
 * once: with the product with n it is off by 4.1 u |n| |offset|; the drift w T twice: 5.1 u |n|
 * |drift|. The sums of these four terms add at most 3.1 u |n| of their lengths together. Each
 * coordinate of a point of D is a sum of the same four vectors. With
 *
 *     reach = r_A + r_B + |offset| + |drift|,
 *     error = 32 u reach + slack_A + slack_B + 2^-1000,
 *
 * where the lengths of offset and drift are bounded by their sums of magnitudes: a value computed
 * by support_farthest() is off by at most error |n|, and a point by at most error (2-norm). 2^-1000
 * covers underflow for |n| <= 2. The factor between 32 and 22 + 3.1 covers the rounding of the
 * bounds.
 *
 * Radii. Of frames with a radius, all of this is about their cores. Such a pair meets if and only
 * if the distance of D from the origin is at most the sum of the radii (support_round.h).
 *
 * A pair is usable if its reach is within (2^-200, 2^200): no product of four lengths overflows,
 * nor underflows to less than the bounds count. No shared state. */
#ifndef FMB_SUPPORT_PAIR_H
#define FMB_SUPPORT_PAIR_H

#include "gap.h"
#include "rotation.h"
#include "support.h"

enum { SUPPORT_SMALL = 8 }; /* the most vertices of a frame that is not a hull */

/* A placed frame as vertices. It points into itself: not to be copied. */
struct support_view {
    struct placed_frame placed;
    struct support_vertices vertices; /* body coordinates, rounded unless slack is 0 */
    struct rotation_matrix rotation;
    double reach; /* at least the distance of each vertex from the origin of the body */
    double slack; /* bounds the distance of a stored vertex from the exact one */
    bool solid;   /* certainly not flat */
    double centre[FMB_DIM_MAX]; /* a point of the frame, rounded, body coordinates */
    double small[FMB_DIM_MAX * SUPPORT_SMALL];
};

struct support_pair {
    const struct frame_pair *frames;
    struct support_view view[2];
    int dim;
    bool drifts;                /* the velocities differ, and the window is not empty */
    bool usable;                /* no double overflows */
    double offset[FMB_DIM_MAX]; /* position of b - position of a, rounded; beyond dim: 0 */
    double drift[FMB_DIM_MAX];  /* (velocity of b - velocity of a) T, rounded */
    double reach, error;        /* as above */
    /* A pair that turns is posed at a fraction `at` of the window, a multiple of 2^-53. */
    bool posed;
    double at;
    double position[2][FMB_DIM_MAX]; /* of both bodies; if posed, rounded three times */
    double path[2][FMB_DIM_MAX];     /* their displacement over the window, rounded; if posed, 0 */
    bool rounded;                    /* a frame has a radius */
    double radius[2];                /* lower and upper bound of the sum of both radii */
};

/* Sets a checked pair. It points to frames and into itself: not to be copied. */
void support_pair_set(const struct frame_pair *frames, struct support_pair *out);

/* A point of D by number: vertex of A, vertex of B, and the end of the window, 0 or 1. The end is 0
 * if the pair does not drift. */
struct support_column {
    unsigned vertex[2], end;
};

/* Sets *column to the point of D with the greatest n . x as computed; returns n . x, within
 * error |n| of the greatest of all. Ties: the lowest indices, end 0. In: a usable pair; |n| <= 2,
 * in world coordinates, 0 beyond dim. */
double support_farthest(const struct support_pair *pair, const double n[FMB_DIM_MAX],
                        struct support_column *column);

/* out := a point of D, within error of the exact one. Coordinates beyond dim are 0. */
void support_point(const struct support_pair *pair, struct support_column column,
                   double out[FMB_DIM_MAX]);

/* Returns the vertex of a view with the greatest n . R v as computed, and that value. It is off by
 * at most |n| (22 u reach + slack). */
struct support support_view_farthest(const struct support_view *view, const double n[FMB_DIM_MAX]);

/* Lists, in the order of the face, its vertices that may have the greatest n . v of the face.
 *
 * In:  n     body coordinates, |n| < 1/9, each off by at most 2^-52 of itself and 2^-1074
 *      face  [count] vertices of the view; if count is that of the view, all of them, ascending
 *
 * Returns their number. */
unsigned support_view_list(const struct support_view *view, const double n[FMB_DIM_MAX],
                           const uint16_t *face, unsigned count, uint16_t *out);

/* out := R v, a vertex without its position, in world coordinates. */
void support_place(const struct support_view *view, unsigned vertex, double out[FMB_DIM_MAX]);

/* out := the frames in an order that depends on the numbers of both placed frames only. What is
 * computed for them in this order has the same bits for the swapped pair. Returns whether they are
 * exchanged (gap_frames_swap()). */
bool support_order(const struct frame_pair *frames, struct frame_pair *out);

#endif
