/* A robot of rigid links and joints, as a URDF file describes it, and the poses of its links.
 * robot_read() makes one, robot_place() poses it for any values of its joints.
 * Not here: links as bodies of the engine (robot_body.h), values of joints (joints.h).
 *
 * Errors are reported on stderr, in one line that names the file, the line and the link or joint.
 */
#ifndef ROBOT_H
#define ROBOT_H

#include "keyed_hash.h"
#include "pose.h"
#include "scene.h"

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
    struct pose origin;        /* in the parent */
    double axis[3];            /* unit length */
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
    const char *path; /* of the file */
    struct robot_link *links;
    struct robot_joint *joints;
    struct robot_element *elements;
    size_t link_count, joint_count, element_count; /* at least one link */
    unsigned *order;                               /* [link_count]: each after its parent */
    /* Private. */
    size_t link_capacity, joint_capacity, element_capacity;
    struct robot_name *link_names, *joint_names; /* tables */
    struct owned_scene memory;                   /* of texts and entries of tables */
};

/* Reads a file; "-" is standard input. Returns false after an error. The caller passes the robot to
 * robot_clear() in either case. */
bool robot_read(const char *path, struct robot *out);
void robot_clear(struct robot *robot);

/* Connects links and joints by their names, and sets order. Returns false after an error: they are
 * not a tree. Called by robot_read(). Cost: O(link_count * depth of the tree). */
bool robot_connect(struct robot *robot);

/* Adds a copy of a name to a table. If the name is in the table already, returns NULL, and *first
 * is its entry. */
struct robot_name *robot_add_name(struct robot *robot, struct robot_name **table, const char *name,
                                  const struct robot_name **first);

/* Returns the joint of a name, or NULL. */
const struct robot_joint *robot_find_joint(const struct robot *robot, const char *name);

/* Computes the pose of every link in the coordinates of the root, by forward kinematics. In: value:
 * [joint_count], radians, of magnitudes up to TURN_RADIANS_MAX, or lengths; not read of fixed
 * joints. Out: pose: [link_count]. */
void robot_place(const struct robot *robot, const double *value, struct pose *pose);

/* Reads count finite numbers, separated by white space. Returns false if the text is not that. */
bool robot_numbers(const char *text, int count, double *out);

#endif
