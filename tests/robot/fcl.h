/* FCL's broad-phase managers on the same states, one of the links and one of the obstacles, which
 * does not change: each frame an object of its own, as its users have it; pairs of one body and of
 * neighbours are filtered by the callback. */
#ifndef FCL_H
#define FCL_H

#include "states.h"

#ifdef __cplusplus
extern "C" {
#endif

struct fcl_robot;

/* NULL: the program was built without FCL. */
struct fcl_robot *fcl_robot_create(const struct robot *robot);
void fcl_robot_destroy(struct fcl_robot *robot);

/* Moves the links to a state, and returns how many pairs of bodies collide. */
int fcl_robot_decide(struct fcl_robot *robot, int state);

#ifdef __cplusplus
}
#endif
#endif
