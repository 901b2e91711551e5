/* A robot and the bodies around it as a scene, which can be posed any number of times. */
#ifndef ROBOT_SCENE_H
#define ROBOT_SCENE_H

#include "robot_body.h"

struct robot_scene {
    /* The bodies of links come first, in the order of the file; then those of the world. Neighbours
     * are ignored: a link with a body, and the nearest one above it that has a body. */
    struct owned_scene owner;
    /* Private. */
    const struct robot *robot;
    struct fmb_placement *placements; /* of the scene */
    unsigned *link;                   /* [robot_bodies] */
    struct pose *origin;              /* [robot_bodies], in the link */
    struct pose *pose;                /* [link_count] */
    size_t robot_bodies;
    struct robot_meshes meshes;
    struct owned_scene world; /* owned */
};

/* Makes a scene at rest of a robot; its bodies have the ids from 1 on. Links without collision
 * elements have no body. Returns false after an error, which was reported. The caller passes the
 * scene to robot_scene_clear() in either case. */
bool robot_scene_make(const struct robot *robot, const struct robot_body_options *options,
                      struct robot_scene *out);
void robot_scene_clear(struct robot_scene *scene);

/* Reports the links without a body, what was done to meshes, and how far hulls extend beyond the
 * cylinders of the robot and of the world, each in one line. In: world: its file, or NULL. */
void robot_scene_report(const struct robot_scene *scene, const char *world);

/* Adds the bodies, ignored pairs, duration and margin of a file of one scene in 3D. A body whose
 * id is that of a link gets another one, which is reported. To be called once at most. */
bool robot_scene_add_world(struct robot_scene *scene, const char *path);

/* Ignores pairs of bodies. In: pair: [count], "NAME,NAME", of links, with or without a body, or of
 * bodies of the world, which must have been added. Returns false after an error: a name is unknown
 * or ambiguous. */
bool robot_scene_ignore(struct robot_scene *scene, const char *const *pair, size_t count);

/* Sets the poses for values of the joints, as of robot_place(), and moves the bodies of the world
 * to where they are at this time, in seconds. place: where the values are given, for messages.
 * Returns false after an error: a pose exceeds the range of doubles. */
bool robot_scene_place(struct robot_scene *scene, const double *value, double time,
                       const char *place);

#endif
