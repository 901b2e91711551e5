/* Bodies around a robot, from a file: a scene of JSON, or a robot of URDF, whose links are
 * obstacles of one group. */
#ifndef ROBOT_WORLD_H
#define ROBOT_WORLD_H

#include "fmb_robot.h"
#include "scene.h"

struct fmb_robot_json {
    struct owned_scene owner;
    struct fmb_robot_world world;
    char why[4800];
};

struct robot_world {
    struct fmb_robot_json *json;   /* NULL: URDF */
    struct fmb_robot *robot;       /* NULL: JSON */
    struct fmb_robot_scene *scene; /* of the robot, at home */
    struct fmb_robot_world world;  /* for fmb_robot_scene() */
};

/* Reads a file. options: of a robot. Returns false after errors, which were printed on stderr. The
 * caller passes the world to robot_world_clear() in either case. */
bool robot_world_read(const char *path, const struct fmb_robot_options *options,
                      struct robot_world *out);
void robot_world_clear(struct robot_world *world);

/* Prints lines, which are separated by line feeds, on stderr, each with "PATH: " before it unless
 * path is "". */
void robot_world_print(const char *path, const char *text);

/* Gives the links of all robots among the worlds one group, which no other body has. */
void robot_world_set_groups(struct robot_world *worlds, size_t count);

#endif
