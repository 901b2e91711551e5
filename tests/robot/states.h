/* States of a robot among obstacles, at random poses with a few contacts: 30 links of 16 frames and
 * 100 boxes, or 8 links, hulls of 152 vertices, and 100 obstacles, hulls of 102. Or an arm of hulls
 * among boxes, whose poses the caller sets. Pairs of neighbouring links are ignored. */
#ifndef STATES_H
#define STATES_H

#include "fmb.h"
#include "rings.h"

enum {
    ROBOT_LINKS = 30,      /* at most */
    ROBOT_HULLS = 8,       /* at most, of links that are hulls */
    ROBOT_FRAMES = 16,     /* of each link */
    ROBOT_OBSTACLES = 100, /* at most */
    ROBOT_BODIES = ROBOT_LINKS + ROBOT_OBSTACLES,
    ROBOT_NEIGHBOURS = ROBOT_LINKS - 1,
    ROBOT_HULL_DOUBLES = 1 << 10, /* capacity for each hull */
    ROBOT_STATES = 200,
    ROBOT_CONTACTS_MAX = 8 /* pairs of bodies in contact in a state; at least 1 */
};

/* Bodies 0 to links - 1 are the links. The other bodies are obstacles, which do not move and are
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

/* Draw all states: links of frames among boxes, or hulls among hulls. The states are the same on
 * every machine up to the rounding of sin() and cos(). */
void robot_draw(struct robot *out);
void robot_draw_hulls(struct robot *out);

/* Draws an arm among boxes. Poses of links are not set.
 * In:  rings  index in robot_rings: the hull of each link
 *      links, boxes  how many */
void robot_draw_arm(int rings, int links, int boxes, struct robot *out);

/* Indices in robot_rings, the hulls of links and obstacles: see rings.h. */
enum { ROBOT_RINGS_LINK, ROBOT_RINGS_OBSTACLE, ROBOT_RINGS_SMALL, ROBOT_RINGS };
extern const struct rings robot_rings[ROBOT_RINGS];

/* Distance from joint to joint along z, in metres. */
extern const double robot_link_length;

/* Returns the scene of a state. */
struct fmb_scene robot_scene(const struct robot *robot, int state);

#endif
