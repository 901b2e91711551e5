/* States of a robot among obstacles, neighbours ignored: 30 links of 16 frames and 100 boxes, or 8
 * links and 100 obstacles, each a hull of 152 and 102 vertices, at random poses with a few
 * contacts; or an arm of hulls and boxes whose poses are set by others. */
#ifndef STATES_H
#define STATES_H

#include "fmb.h"
#include "rings.h"

enum {
    ROBOT_LINKS = 30,      /* at most: of frames */
    ROBOT_HULLS = 8,       /* links that are hulls */
    ROBOT_FRAMES = 16,     /* of a link */
    ROBOT_OBSTACLES = 100, /* at most */
    ROBOT_BODIES = ROBOT_LINKS + ROBOT_OBSTACLES,
    ROBOT_NEIGHBOURS = ROBOT_LINKS - 1,
    ROBOT_HULL_DOUBLES = 1 << 10, /* suffice for each */
    ROBOT_STATES = 200,
    ROBOT_CONTACTS_MAX = 8 /* pairs of bodies in contact; at least 1 */
};

/* The robot: bodies 0 to links - 1 are links, obstacles follow, which stand where they are, and are
 * not tested against each other. */
struct robot {
    int links, obstacles;
    double hull[ROBOT_HULLS + ROBOT_OBSTACLES][ROBOT_HULL_DOUBLES];
    struct fmb_frame frame[ROBOT_LINKS][ROBOT_FRAMES];
    struct fmb_body body[ROBOT_BODIES];
    unsigned neighbour[ROBOT_NEIGHBOURS][2];
    /* [state][body] */
    struct fmb_placement placement[ROBOT_STATES][ROBOT_BODIES];
};

/* Draws all states, of frames and boxes, or of hulls. The same on every machine up to the rounding
 * of sin() and cos(). */
void robot_draw(struct robot *out);
void robot_draw_hulls(struct robot *out);

/* An arm: links of so many, and hulls of these rings; boxes. Poses of links are not set. */
void robot_draw_arm(int rings, int links, int boxes, struct robot *out);

/* Hulls of links and of obstacles, see rings.h. */
enum { ROBOT_RINGS_LINK, ROBOT_RINGS_OBSTACLE, ROBOT_RINGS_SMALL, ROBOT_RINGS };
extern const struct rings robot_rings[ROBOT_RINGS];

/* From joint to joint, along z; metres. */
extern const double robot_link_length;

/* The scene of a state. */
struct fmb_scene robot_scene(const struct robot *robot, int state);

#endif
