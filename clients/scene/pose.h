/* Poses: maps x -> R(q) x + p, with the rotation of q / |q| (fmb.h). Results are rounded, in a
 * fixed order of operations. */
#ifndef POSE_H
#define POSE_H

#include <stdbool.h>

/* The length of q is 1 but for rounding. */
struct pose {
    double p[3], q[4]; /* q: w, x, y, z */
};

#define POSE_NONE ((struct pose){{0, 0, 0}, {1, 0, 0, 0}})

/* Whether the pose does not turn. */
bool pose_is_straight(const struct pose *pose);

/* Maps x in place. A number is in error by at most POSE_ERROR times the sum of the magnitudes of
 * all numbers of p and x, and 2^-1000. */
#define POSE_ERROR 0x1p-48
void pose_apply(const struct pose *pose, double x[3]);

/* Returns the map x -> outer(inner(x)). */
struct pose pose_compose(const struct pose *outer, const struct pose *inner);

/* On output: the rotation by an angle about an axis of length 1. In: radians, at most
 * TURN_RADIANS_MAX. */
void pose_turn(const double axis[3], double radians, double q[4]);

/* On output: the rotation by roll, pitch and yaw about the axes x, y and z, which stay in place,
 * one after the other. In: as of pose_turn(). */
void pose_turn_rpy(const double rpy[3], double q[4]);

#endif
