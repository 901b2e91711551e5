/* The model of a path, and the bounds of one of its edges: what path.c searches.
 *
 * Nodes are the links of the robot, and the world, node link_count. A part is a frame of a body, as
 * the hull of its vertices in coordinates of the node that carries it. Parts of links come first,
 * then those of the world, in the order of the placements. Pairs are those of two parts whose nodes
 * move relative to each other.
 *
 * The motion is that of the doubles given, over the reals: each joint turns by exactly its value
 * about the exact direction of its axis, and values run straight from one row to the next. Poses
 * in doubles are off by an error that is bounded (path_edge_begin()). */
#ifndef PATH_H
#define PATH_H

#include "robot_scene.h"

#include <stdint.h>

/* Factor of bounds: their own arithmetic, sums of up to 2^14 terms, rounds by less. */
#define PATH_OUTWARD (1 + 0x1p-36)

struct path_part {
    unsigned placement, frame, node;
    struct fmb_body body; /* hull of the vertices in the node, with the radius of the frame */
    struct pose origin;   /* of the placed body in the node */
    double centre[3];     /* in the node: of the sphere ... */
    double ball;          /* ... that contains the part */
    double reach;         /* bounds the distance of its points from the origin of the node */
    double error;         /* of its vertices in the node */
    double slack;         /* of the edge: its share of the error of a pair's values */
    double middle[3];     /* of the edge: the centre at 1/2, in the world */
};

/* The joints that move between two nodes, from a to b. Those whose value changes on the edge are
 * active. o_j, the origin of the child link of joint j, is a point on its axis. */
struct path_chain {
    unsigned *joint;              /* [joint_count], owned by the path */
    unsigned joint_count, rising; /* the first ones are on the way from a to the world */
    /* Of the edge, for each active joint, [active]: */
    unsigned active;
    struct path_joint {
        unsigned link; /* its child */
        bool turns;    /* else prismatic */
        double rate;   /* the change of its value */
        double along;  /* |o_2 - o_1| + ... + |o_j - o_(j-1)| at most */
    } * joints;
    double turns; /* S: the sum of the rates of joints that turn */
};

/* The pairs of part a and parts of one node, which have one chain. */
struct path_family {
    unsigned a;
    struct path_chain chain;
    size_t first, count; /* of path.partner: the second parts, ascending */
    double reach;        /* the greatest of these, of parts of links */
};

/* A directions is carried by the first part, by the second, or is the product of an edge of each.
 */
enum path_kind { PATH_SPHERES = 'S', PATH_MIDDLE = 'L', PATH_A = 'A', PATH_B = 'B', PATH_E = 'E' };

/* Bounds of a pair over the edge; times are fractions of the edge. */
struct path_bounds {
    unsigned a, b;
    const struct path_chain *chain;
    double speed;    /* v: of the change of the gap */
    double curve[3]; /* K of directions in a and in b; that of products less S^2 D */
    double slack;    /* error of a gap, and of a value along a direction of length 1 */
};

struct path_direction {
    enum path_kind kind;
    double n[2][3]; /* A: n[0] in a's node; B: n[0] in b's; L: n[0] in a's at the middle;
                       E: unit edges n[0] in a's node, n[1] in b's. From a to b. */
};

/* An interval of an edge at which a pair is proven apart. */
struct path_leaf {
    unsigned a, b;
    const struct path_chain *chain;
    int level; /* its length is 2^-level */
    double low;
    struct path_direction direction;
};

struct path_pose {
    double p[3], q[4], r[3][3]; /* r: the matrix of q, rounded */
};

struct path_slot {
    double time;            /* NAN: unused */
    struct path_pose *pose; /* [node_count] */
};

struct path_entry {
    double key, low;
    size_t bounds; /* index of live */
    int level;
};

enum { PATH_SLOTS = 256, PATH_SPARE = 8, PATH_LEVEL_MAX = 30 };

struct fmb_robot_path {
    struct fmb_robot_scene *scene;
    double wanted; /* the clearance to be proven; 0: none */
    struct robot_lines errors;
    struct owned_scene owner; /* of the arrays of the model */
    /* The model. */
    unsigned node_count;
    struct path_part *parts;
    size_t part_count, robot_parts;
    struct path_family *families;
    size_t family_count, family_capacity;
    unsigned *partner; /* [pair_count] */
    size_t pair_count, pair_capacity;
    /* Numbers of pairs of placements: pairs of these parts; pairs that do not move relative to each
     * other; ignored pairs with a link or a carried body. */
    size_t body_pairs, rigid_count, ignored_count;
    struct fmb_robot_touch *touches;
    size_t touch_count, touch_capacity;
    /* The edge: values of all joints of the tree. */
    double *value[2], *at; /* [joint_count] each */
    struct pose *place;    /* [link_count] */
    double *far, *error;   /* [node_count]: bounds of positions, and of their errors */
    double *turns;         /* [node_count]: error of its rotation, radians */
    double turn_error;     /* the greatest of them */
    double round;          /* bounds the error of a distance of origins */
    double lever;          /* of all edges so far: fmb_robot_path_lever() */
    struct path_slot slots[PATH_SLOTS + 1 + PATH_SPARE];
    unsigned spare;
    /* The search. */
    struct path_bounds *live;
    size_t live_count, live_capacity;
    struct path_entry *heap;
    size_t heap_count, heap_capacity;
    int phase;
    struct fmb_robot_edge answer; /* of an edge that is complete */
    double until;                 /* what is searched ends here: 1 but for path_prove_until() */
    size_t work;
    double proven, closest, closest_at, hit;
    unsigned closest_pair[2], hit_pair[2];
    bool recorded; /* whether leaves are kept */
    struct path_leaf *leaves;
    size_t leaf_count, leaf_capacity;
};

/* Makes the parts, pairs and chains. Returns false after an error. */
bool path_model_make(struct fmb_robot_path *path);

/* Returns the nearest joint above a node that can move, or ROBOT_ROOT. Two nodes move relative to
 * each other unless it is the same. */
unsigned path_mover(const struct fmb_robot_path *path, unsigned node);

/* Begins an edge: value is set. Returns false if numbers are too large. */
bool path_edge_begin(struct fmb_robot_path *path);

/* Returns the values of all joints of the tree at a time, valid until the next call of a function
 * of paths. */
const double *path_values(struct fmb_robot_path *path, double time);

/* Returns the poses of all nodes at a time, valid until PATH_SPARE more times are used. */
const struct path_pose *path_poses(struct fmb_robot_path *path, double time);

/* Computes the bounds of a pair. */
void path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                    unsigned b, struct path_bounds *out);

/* Returns K for a direction of kind A, B or E. */
double path_curve(const struct path_bounds *bounds, enum path_kind kind);

/* Returns a bound of the speed of all pairs of a family, not below those of path_bounds_of(). */
double path_family_speed(struct fmb_robot_path *path, const struct path_family *family);

/* Sets the centre of a part's sphere in the world. */
void path_centre(const struct path_pose *poses, const struct path_part *part, double out[3]);

/* Returns a distance, or -INFINITY, that the direction proves of the pair at all times from low to
 * low + 2^-level. */
double path_prove(struct fmb_robot_path *path, const struct path_bounds *bounds,
                  const struct path_direction *direction, double low, int level);

double path_length(const double v[3]);
void path_turn(const double r[3][3], const double v[3], double out[3]);      /* r v */
void path_turn_back(const double r[3][3], const double v[3], double out[3]); /* r transposed, v */

/* As fmb_robot_path_edge(), for values of all joints of the tree. */
int path_set_edge(struct fmb_robot_path *path, const double *from, const double *to);

/* Searches the edge again, up to a multiple of 2^-PATH_UNTIL_LEVEL. Returns the clearance that is
 * proven, or 0. */
enum { PATH_UNTIL_LEVEL = 4 };
double path_prove_until(struct fmb_robot_path *path, double until);

#endif
