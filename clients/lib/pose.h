/* Poses: maps x -> R(q) x + p, with the rotation of q / |q| (fmb.h). Results are rounded, in a
 * fixed order of operations. */
#ifndef POSE_H
#define POSE_H

#include <stdbool.h>

struct pose {
    double p[3], q[4]; /* q: w, x, y, z; its length is from 2^-100 to 2^100 */
};

#define POSE_IDENTITY ((struct pose){{0, 0, 0}, {1, 0, 0, 0}})

/* Whether the pose is a translation: its rotation is the identity. */
bool pose_is_translation(const struct pose *pose);

/* Maps x in place. The error of a coordinate is at most POSE_ERROR times the sum of the magnitudes
 * of all coordinates of p and x, plus 2^-1000. */
#define POSE_ERROR 0x1p-48
void pose_apply(const struct pose *pose, double x[3]);

/* Returns the map x -> outer(inner(x)). */
struct pose pose_compose(const struct pose *outer, const struct pose *inner);

/* On output: the rotation by an angle about an axis of length 1. In: radians, of magnitude at most
 * TURN_RADIANS_MAX. */
void pose_turn(const double axis[3], double radians, double q[4]);

/* On output: the rotation by roll, pitch and yaw about the fixed axes x, y and z, in this order.
 * In: as of pose_turn(). */
void pose_turn_rpy(const double rpy[3], double q[4]);

#endif
