/* States of a robot among obstacles: 30 links of 16 frames, neighbours ignored, and 100 boxes, at
 * random poses with a few contacts. */
#ifndef STATES_H
#define STATES_H

#include "fmb.h"

enum {
    ROBOT_LINKS = 30,
    ROBOT_FRAMES = 16, /* of a link */
    ROBOT_OBSTACLES = 100,
    ROBOT_BODIES = ROBOT_LINKS + ROBOT_OBSTACLES,
    ROBOT_NEIGHBOURS = ROBOT_LINKS - 1,
    ROBOT_STATES = 200,
    ROBOT_CONTACTS_MAX = 8 /* pairs of bodies in contact; at least 1 */
};

/* The robot: bodies 0 to ROBOT_LINKS - 1 are links, the others obstacles. */
struct robot {
    struct fmb_frame frame[ROBOT_LINKS][ROBOT_FRAMES];
    struct fmb_body body[ROBOT_BODIES];
    unsigned neighbour[ROBOT_NEIGHBOURS][2];
    /* [state][body] */
    struct fmb_placement placement[ROBOT_STATES][ROBOT_BODIES];
};

/* Draws all states. The same on every machine up to the rounding of sin() and cos(). */
void robot_draw(struct robot *out);

/* The scene of a state. */
struct fmb_scene robot_scene(const struct robot *robot, int state);

#endif
