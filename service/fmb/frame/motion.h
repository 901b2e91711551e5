/* Placements with an end: the pose moves from the begin to the end of the window. With s = t / T,
 *
 *     p(s) = (1 - s) p0 + s p1,    q(s) = (1 - s) q0 + s c q1,    c the sign of q0 . q1.
 *
 * N(q) = |q|^2 R(q) is a quadratic form in q. Its polar form N(q, r) is bilinear and symmetric, and
 * N(q, q) = N(q). On an interval with the quaternions q and r at its ends, N(q(s)) has the
 * Bernstein coefficients N(q, q), N(q, r) and N(r, r), and |q(s)|^2 has q . q, q . r and r . r, all
 * positive. No shared state. */
#ifndef FMB_MOTION_H
#define FMB_MOTION_H

#include "aabb.h"
#include "rotation.h"

/* Returns whether the pose of a placement changes within a window of this duration other than by a
 * velocity. */
static inline bool motion_turns(const struct fmb_placement *placement, double duration)
{
    return placement->end_count != 0 && duration > 0;
}

/* Returns the status of fmb_placement_check() for a placement whose end_count is not 0. In: its
 * body has a frame. */
enum fmb_status motion_check(const struct fmb_placement *placement);

/* Sets both orientations of a checked placement: the given quaternions times one power of two, the
 * second also times c. The largest component of q0 is in [1, 2). Nothing is rounded. Without an end
 * both are equal. Without an orientation both are (1, 0, 0, 0). */
void motion_quaternions(const struct fmb_placement *placement, double q0[4], double q1[4]);

/* Sets the ends of a box that contains a frame or a body while its orientation is between q[0] and
 * q[1] and its position between position[0] and position[1]. q[0] and q[1] may each be off by at
 * most 3 u of their length.
 *
 * In: box, reach  as of motion_box() */
void motion_box_between(const double q[2][4], const double position[2][FMB_DIM_MAX], int dim,
                        const double box[2][FMB_DIM_MAX], double reach, double low[FMB_DIM_MAX],
                        double high[FMB_DIM_MAX]);

/* Returns the box over the window of a body, or of one of its frames, whose placement has an end.
 *
 * In:  box    [lower, upper][axis] of the body or the frame, in body coordinates
 *      reach  bounds the distance of its points from the origin of the body */
struct aabb motion_box(const struct fmb_placement *placement, const double box[2][FMB_DIM_MAX],
                       double reach);

/* box := the box of a frame, in body coordinates. */
void frame_box(const struct fmb_frame *frame, double box[2][FMB_DIM_MAX]);

/* The same as motion_box() for a prepared frame. */
struct aabb motion_box_of(const struct fmb_prepared *frame);

/* out := N(q, r), [row][column]. Each entry is a sum of four products whose magnitudes sum to at
 * most |q| |r|, by Cauchy and Schwarz. It is off by at most 4.01 u |q| |r|. */
INLINE void motion_polar(const double q[4], const double r[4], double out[FMB_DIM_MAX][FMB_DIM_MAX])
{
    const double w = q[0] * r[0], x = q[1] * r[1], y = q[2] * r[2], z = q[3] * r[3];
    const double xy = q[1] * r[2] + q[2] * r[1], wz = q[0] * r[3] + q[3] * r[0];
    const double xz = q[1] * r[3] + q[3] * r[1], wy = q[0] * r[2] + q[2] * r[0];
    const double yz = q[2] * r[3] + q[3] * r[2], wx = q[0] * r[1] + q[1] * r[0];
    out[0][0] = (w + x) - (y + z), out[1][1] = (w + y) - (x + z), out[2][2] = (w + z) - (x + y);
    out[0][1] = xy - wz, out[1][0] = xy + wz;
    out[0][2] = xz + wy, out[2][0] = xz - wy;
    out[1][2] = yz - wx, out[2][1] = yz + wx;
}

#endif
