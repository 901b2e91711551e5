#include "fcl.h"

#include <stddef.h>

struct fcl_robot *fcl_robot_create(const struct robot *robot)
{
    (void) robot;
    return NULL;
}

void fcl_robot_destroy(struct fcl_robot *robot)
{
    (void) robot;
}

int fcl_robot_decide(struct fcl_robot *robot, int state)
{
    (void) robot;
    (void) state;
    return 0;
}
