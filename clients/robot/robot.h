/* A robot of rigid links and joints, as a URDF file describes it, and the poses of its links.
 * robot_read() makes one, robot_place() poses it for any values of its joints.
 * Not here: links as bodies of the engine (robot_body.c), scenes of them (robot_scene.h), values of
 * joints (joints.h).
 *
 * Errors are collected in a text, a line for each, which names the file, the line and the link or
 * joint: one run reports all errors of a robot. */
#ifndef ROBOT_H
#define ROBOT_H

#include "keyed_hash.h"
#include "pose.h"
#include "scene.h"

#include <stdio.h>

/* Lines of text: errors, or notes. All 0: none. */
struct robot_lines {
    FILE *out;  /* NULL: no line yet */
    char *text; /* owned, of the stream; valid after robot_lines_text() */
    size_t size;
};

/* Appends a line; control characters are escaped. */
__attribute__((format(printf, 2, 3))) void robot_say(struct robot_lines *lines, const char *format,
                                                     ...);

/* Returns the lines, separated by line feeds; "" if there are none. Valid until the next call of
 * these functions. */
const char *robot_lines_text(struct robot_lines *lines);
void robot_lines_clear(struct robot_lines *lines);

enum robot_shape { ROBOT_BOX, ROBOT_CYLINDER, ROBOT_CAPSULE, ROBOT_MESH };

/* A <collision>. */
struct robot_element {
    unsigned long line;
    struct pose origin; /* in its link */
    enum robot_shape shape;
    /* Of a box its full sizes; of a cylinder about z radius and length; of a capsule radius and the
     * length of its core along z, 0 for a sphere; of a mesh a factor for each axis. */
    double size[3];
    const char *file; /* of a mesh, as the URDF names it */
};

enum robot_joint_type { ROBOT_REVOLUTE, ROBOT_CONTINUOUS, ROBOT_PRISMATIC, ROBOT_FIXED };

/* An entry of the table of links or of joints, by name. */
struct robot_name {
    UT_hash_handle hh;
    const char *name;
    unsigned long line;
    unsigned index;
};

struct robot_joint {
    const struct robot_name *name;
    enum robot_joint_type type;
    struct pose origin;        /* in the parent; its q has any length */
    double rpy[3];             /* of the origin; rpy[0] is NAN: given as a quaternion */
    double axis[3];            /* unit length */
    double given_axis[3];      /* as the file has it, of any length */
    double limit[2];           /* lower, upper; radians, or lengths; infinite: none */
    const char *mimic_name;    /* of the joint that it follows, or NULL */
    unsigned mimic;            /* the same as an index */
    double multiplier, offset; /* it follows x at multiplier x + offset */
    const char *link_names[2]; /* of the parent and of the child */
    unsigned link[2];          /* the same as indices */
};

#define ROBOT_ROOT UINT32_MAX

struct robot_link {
    const struct robot_name *name;
    size_t element, element_count; /* its range of robot.elements */
    unsigned joint;                /* whose child it is; ROBOT_ROOT for the root */
};

/* Limits of a file: links, joints and collision elements, each; and bytes. */
enum { ROBOT_COUNT_MAX = 8192, ROBOT_BYTES_MAX = 1 << 23 };

struct robot {
    const char *title; /* its name; "": none */
    const char *path;  /* of the file */
    struct robot_link *links;
    struct robot_joint *joints;
    struct robot_element *elements;
    size_t link_count, joint_count, element_count; /* at least one link */
    unsigned *order;                               /* [link_count]: each after its parent */
    /* Private. */
    size_t link_capacity, joint_capacity, element_capacity;
    struct robot_name *link_names, *joint_names; /* tables */
    struct robot_lines errors;
    size_t error_count;
    struct owned_scene memory; /* of texts and entries of tables */
    /* What is being read: its file, and the link or joint, as "link" and its name, or NULL. Only
     * the first error of an element is reported: further errors are dropped until failed is set to
     * false, and results are not used. bad: there was an error. */
    const char *file, *kind, *within;
    bool failed, bad;
};

/* Reads a file; "-" is standard input. Returns false after errors. links and elements then hold
 * what could be read, so that errors of meshes can be found too; order is not set. The caller
 * passes the robot to robot_clear() in either case. */
bool robot_read(const char *path, struct robot *out);
void robot_clear(struct robot *robot);

/* Adds an error of what is being read, unless it has failed; errors beyond ROBOT_ERRORS_MAX are
 * only counted. Returns false. */
enum { ROBOT_ERRORS_MAX = 100, ROBOT_TEXT_MAX = 8192 };
__attribute__((format(printf, 3, 4))) bool robot_refuse(struct robot *robot, unsigned long line,
                                                        const char *format, ...);

/* Sets what is being read. */
void robot_begin(struct robot *robot, const char *kind, const char *name);

/* Connects links and joints by their names, and sets order; if the robot is bad, only checks names.
 * robot_read() calls it. Returns false after an error: they are not a tree. Cost: O(link_count *
 * depth of the tree). */
bool robot_connect(struct robot *robot);

/* Adds a copy of a name to a table. If the name is in the table already, returns NULL, and *first
 * is its entry. */
struct robot_name *robot_add_name(struct robot *robot, struct robot_name **table, const char *name,
                                  const struct robot_name **first);

/* Returns the joint of a name, or NULL. */
const struct robot_joint *robot_find_joint(const struct robot *robot, const char *name);

/* Returns the value of a joint for which none is given: 0, or the middle of its limits if 0 is
 * outside. */
double robot_home(const struct robot_joint *joint);

/* Returns the value of a mimic joint, from the value of the joint that it follows. value:
 * [joint_count]. */
double robot_mimic(const struct robot_joint *joint, const double *value);

/* Sets the values of all mimic joints. given: [joint_count], joints whose values are kept; NULL:
 * none. */
void robot_follow(const struct robot *robot, const bool *given, double *value);

/* Returns why a value cannot be used, "is not finite" or "is beyond 1048576 radians"; or NULL. */
const char *robot_refuse_value(const struct robot_joint *joint, double value);

/* Scales q by a power of two if it is so long or short that a product of many such quaternions
 * could overflow or underflow. */
void robot_limit_length(double q[4]);

/* Computes the pose of every link by forward kinematics. In: base: of the root; value:
 * [joint_count], radians, of magnitudes up to TURN_RADIANS_MAX, or lengths; not read of fixed
 * joints. Out: pose: [link_count]. */
void robot_place(const struct robot *robot, const struct pose *base, const double *value,
                 struct pose *pose);

/* Reads count finite numbers, separated by white space. Returns false for any other text. */
bool robot_numbers(const char *text, int count, double *out);

#endif
