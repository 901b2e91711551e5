/* The structs of fmb_robot.h: a robot with its bodies, and scenes of a robot and the bodies
 * around it, which can be posed any number of times. */
#ifndef ROBOT_SCENE_H
#define ROBOT_SCENE_H

#include "fmb_robot.h"
#include "robot.h"

/* Why a pair is ignored; of several reasons the first one counts. */
enum robot_origin {
    ROBOT_NEIGHBOURS, /* a link with a body, and the nearest one above it that has a body */
    ROBOT_SRDF,
    ROBOT_SRDF_DEFAULT,
    ROBOT_CARRIED, /* a body, and the link that carries it */
    ROBOT_WORLD,
    ROBOT_OPTION, /* of the caller */
    ROBOT_ORIGINS,
};

struct robot_pair {
    unsigned a, b; /* bodies, a < b */
    enum robot_origin origin;
};

struct robot_pairs {
    struct robot_pair *pair; /* owned; after robot_pairs_sort() in the order of (a, b), each once */
    size_t count, capacity;
};

/* In: a, b: different, in either order. */
void robot_pairs_add(struct robot_pairs *pairs, unsigned a, unsigned b, enum robot_origin origin);
void robot_pairs_sort(struct robot_pairs *pairs);
bool robot_pairs_has(const struct robot_pairs *pairs, unsigned a, unsigned b); /* once sorted */

/* What was done to the meshes of a robot. All 0: nothing. */
struct robot_meshes {
    size_t scaled;          /* number of COLLADA meshes whose unit is not 1 m */
    const char *first_file; /* the first of these, and its unit in metres */
    double first_unit;
    double excess; /* the largest radius of a hull */
};

#define ROBOT_NO_BODY UINT32_MAX

struct fmb_robot {
    struct robot tree;
    struct fmb_robot_options options;
    struct robot_meshes meshes;
    struct pose base; /* of the root */
    double base_rpy[3];
    bool bad; /* there were errors */
    /* Bodies of links. */
    size_t body_count;
    struct fmb_placement *bodies; /* [body_count]: body, id, name and group */
    unsigned *link;               /* [body_count] */
    unsigned *body_of_link;       /* [link_count]; or ROBOT_NO_BODY */
    struct pose *origin;          /* [body_count], in the link */
    const char **link_names;      /* [body_count] */
    unsigned *rigid; /* [body_count]: the first body that fixed joints connect to it, or itself */
    /* Ignored pairs, sorted. Without SRDF, pairs within a rigid body are ignored too, by groups. */
    struct robot_pairs ignored;
    const char *srdf;           /* its path; NULL: none */
    size_t unlisted;            /* pairs of neighbours that the SRDF does not list */
    bool *untested;             /* [body_count]: collisions are disabled by default; NULL: none */
    struct robot_pairs enabled; /* pairs that are tested in spite of that */
    struct robot_name *unknown; /* a table: links of the SRDF that the robot does not have */
    /* q. */
    size_t joint_count;
    unsigned *moving;         /* [joint_count], joints that move and follow no other */
    const char **joint_names; /* [joint_count] */
    struct owned_scene owner; /* of the bodies and of arrays */
};

/* Makes the body of a link that has at least one collision element. If it has only one, the body
 * has the origin of the element, and the numbers of the file. If it has several, the body has the
 * origin of the link, and the numbers of elements with an origin are rounded.
 *
 * In:     options  valid; sides is not 0
 * In/out: scene    of dim 3; owns the body; its `outside` is raised
 *         meshes   of the robot so far
 * Out:    *origin  of the body, in the link
 * Returns NULL after errors, which the robot has. */
const struct fmb_body *robot_body(struct robot *robot, const struct robot_link *link,
                                  const struct fmb_robot_options *options,
                                  struct owned_scene *scene, struct robot_meshes *meshes,
                                  struct pose *origin);

/* Reads the SRDF file of the options into a robot whose bodies are made (urdf.c). Returns false
 * after errors, which the robot has. */
bool robot_read_srdf(struct fmb_robot *robot);

/* A scene of JSON, whose bodies links may carry. */
struct fmb_robot_json {
    struct owned_scene owner;
    struct fmb_robot_world world;
    char why[4800];
};

struct robot_carried {
    const char *name; /* of the link */
    unsigned link;
    struct pose pose; /* in the link */
};

struct fmb_robot_scene {
    const struct fmb_robot *robot;
    struct owned_scene owner;         /* the scene; owns arrays, not bodies */
    struct fmb_placement *placements; /* of the scene: bodies of links, carried ones, others */
    struct fmb_placement *begin;      /* [placement_count], as they were given */
    size_t carried_count;
    struct robot_carried *carried; /* [carried_count] */
    double time;                   /* of the last robot_scene_place() */
    double *value;                 /* [joints of the tree], of the last fmb_robot_place() */
    struct pose *pose;             /* [links] */
    struct robot_pairs ignored;    /* sorted, without pairs of one group */
    struct robot_lines errors, notes;
};

/* Sets the poses for values of all joints of the tree, as in robot_place(), and moves the other
 * bodies to where they are at this time, in seconds. place: where the values are given, for
 * messages. Returns false after an error, which is added to the scene: the engine refuses a pose.
 */
bool robot_scene_place(struct fmb_robot_scene *scene, const double *value, double time,
                       const char *place);

#endif
