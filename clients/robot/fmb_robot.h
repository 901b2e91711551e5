/* libfmb-robot: robots of URDF files as scenes of fmb.h: a body for each link, its poses by forward
 * kinematics, and the pairs that are not tested.
 *
 *     struct fmb_robot *robot;
 *     struct fmb_robot_scene *scene;
 *     if (fmb_robot_read("robot.urdf", NULL, &robot) != 0)
 *         fail(fmb_robot_why(robot));
 *     if (fmb_robot_scene(robot, &world, 1, NULL, 0, &scene) != 0)
 *         fail(fmb_robot_scene_why(scene));
 *     fmb_robot_place(scene, q);
 *     fmb_scene_begin(fmb_robot_scene_get(scene), ...);
 *
 * Link with pkg-config's fmb-robot: libfmb, Expat and cJSON; no LCM. clients/robot/README.md says
 * which parts of URDF and SRDF are read, and what becomes of them.
 *
 * Angles are in radians, lengths in the units of the file. Texts are UTF-8. A pointer that a
 * function returns belongs to the robot or the scene, and is valid as long as that is.
 *
 * Threads: a robot is only read after fmb_robot_read(), so threads may share it. A scene may be
 * used by one thread at a time.
 *
 * This header is unstable: functions and structs may change, or be removed, in each minor version.
 * The form of path proofs is unstable too.
 *
 * The library prints nothing. What is wrong with the input is returned as text. If memory is
 * exhausted, it prints that, and the process ends with status 1. */
#ifndef FMB_ROBOT_H
#define FMB_ROBOT_H

#include "fmb.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- A robot ---- */

struct fmb_robot;

/* A field that is 0 or NULL has its default. */
struct fmb_robot_options {
    const char *srdf;         /* SRDF file; the pairs of links that it disables are ignored */
    const char *package_path; /* folders of packages, separated by colons: see the README */
    double base[6];           /* pose of the root: x, y, z, and roll, pitch, yaw, as in URDF */
    int sides;                /* of the hulls of cylinders, a multiple of 4 up to 512; 0: 16 */
    double excess; /* how far hulls may extend beyond meshes, so that they need fewer vertices */
    int objects;   /* not 0: a hull for each object of an OBJ file */
    int bus;       /* not 0: bodies have to fit into a query on the bus */
};

/* Reads a robot, with its meshes.
 * In:  path     of a URDF file; "-" is standard input
 *      options  NULL: all defaults
 * Out: *out     set in any case, for fmb_robot_why(); to be freed after its scenes
 * Returns 0; or -1 after errors. */
int fmb_robot_read(const char *path, const struct fmb_robot_options *options,
                   struct fmb_robot **out);
void fmb_robot_free(struct fmb_robot *robot); /* may be NULL */

/* Returns all errors of the files, as lines separated by line feeds, each with its place:
 * "robot.urdf: line 7: joint 'elbow': ...". "" if there are none. */
const char *fmb_robot_why(const struct fmb_robot *robot);

/* The functions below take a robot that was read without errors. */

/* Returns the number n of joints that move and follow no other, in the order of the file. It is the
 * length of q, their values. Out: *names: [n], their names; names may be NULL. */
size_t fmb_robot_joints(const struct fmb_robot *robot, const char *const **names);

/* Out: lower, upper: [n], the limits of q; infinite if there are none. */
void fmb_robot_limits(const struct fmb_robot *robot, double *lower, double *upper);

/* Out: q: [n], the home pose: 0, or the middle of the limits of a joint if 0 is outside. */
void fmb_robot_home(const struct fmb_robot *robot, double *q);

/* Returns the number of links that have a body, in the order of the file. Out: *names: [number],
 * their names; names may be NULL. */
size_t fmb_robot_links(const struct fmb_robot *robot, const char *const **names);

/* Whether the pair of links a and b, indices of fmb_robot_links(), is ignored: as neighbours or
 * parts of one rigid body, or by the SRDF file. Cost: O(log(number of such pairs)). */
int fmb_robot_ignores(const struct fmb_robot *robot, size_t a, size_t b);

/* Returns the largest distance by which bodies may extend beyond the cylinders and meshes of the
 * file. */
double fmb_robot_excess(const struct fmb_robot *robot);

/* ---- A robot among bodies ---- */

struct fmb_robot_scene;

/* Bodies around a robot. */
struct fmb_robot_world {
    /* All pairs, in 3D; with its ignored pairs. Bodies, names and this struct must outlive the
     * scene of the robot. */
    const struct fmb_scene *scene;
    /* [placement_count]: the link that carries a body, whose pose is then relative to that link,
     * and which is not tested against it; NULL: none. links itself may be NULL. */
    const char *const *links;
    const char *name; /* for messages, such as the name of a file; NULL: none */
};

/* A scene that was read from a file. */
struct fmb_robot_json;

/* Reads the only scene of a JSON file, whose bodies may have a "link".
 * Out: *out  set in any case, for fmb_robot_json_why(); to be freed after scenes of its bodies
 * Returns 0; or -1 after an error. */
int fmb_robot_json_read(const char *path, struct fmb_robot_json **out);
void fmb_robot_json_free(struct fmb_robot_json *json); /* may be NULL */
const char *fmb_robot_json_why(const struct fmb_robot_json *json);
const struct fmb_robot_world *fmb_robot_json_get(const struct fmb_robot_json *json);

/* Makes a scene: first the bodies of links, as placements 0 to number - 1 with ids from 1 on and
 * the names of the links; then carried bodies; then the others, each in the order of the worlds.
 * Bodies whose ids are taken get the lowest free ids. Links that fixed joints alone connect have
 * one group, unless there is an SRDF file. duration and margin are the largest of the worlds. The
 * robot is in its home pose.
 *
 * In:  worlds  [world_count]
 *      ignore  [ignore_count][2], names of links or bodies: pairs that are not tested
 * Out: *out    set in any case, for fmb_robot_scene_why(); to be freed
 * Returns 0; or -1 after errors. */
int fmb_robot_scene(const struct fmb_robot *robot, const struct fmb_robot_world *worlds,
                    size_t world_count, const char *const (*ignore)[2], size_t ignore_count,
                    struct fmb_robot_scene **out);
void fmb_robot_scene_free(struct fmb_robot_scene *scene); /* may be NULL */

/* Returns the errors of the last call that failed, as lines separated by line feeds. */
const char *fmb_robot_scene_why(struct fmb_robot_scene *scene);

/* Returns the scene, whose placements fmb_robot_place() changes. */
const struct fmb_scene *fmb_robot_scene_get(const struct fmb_robot_scene *scene);

/* Returns the number of placements that fmb_robot_place() changes: they are the first ones, as
 * fmb_scene_again() requires. */
size_t fmb_robot_moved(const struct fmb_robot_scene *scene);

/* Poses the links and the bodies that they carry. Limits are not checked.
 * In:  q  [n], finite; angles up to 2^20 in magnitude
 * Returns 0; or -1 after an error, and the poses are undefined.
 * Cost: O(links + joints). */
int fmb_robot_place(struct fmb_robot_scene *scene, const double *q);

/* ---- Paths ----
 *
 * A path is proven edge by edge: on an edge, joint values change linearly from one row to the next.
 *
 *     struct fmb_robot_path *path;
 *     struct fmb_robot_edge edge;
 *     if (fmb_robot_path_begin(scene, 0.005, &path) != 0)
 *         fail(fmb_robot_path_why(path));
 *     for (size_t k = 0; k + 1 < rows; k++) {
 *         if (fmb_robot_path_edge(path, q[k], q[k + 1]) != 0)
 *             fail(fmb_robot_path_why(path));
 *         while (!fmb_robot_path_step(path, &edge))
 *             ;
 *         ... edge.verdict ...
 *     }
 *
 * The motion is defined over the real numbers, by the given doubles. There is no verdict for
 * touching: pairs that come closer than the errors of doubles, some 1e-12 of the lengths, without
 * overlapping by more, are undecided. clients/robot/PATHS.md says what is proven.
 *
 * These functions may change in any version. */

/* Begins to prove paths of a robot among the bodies of its scene. All pairs are tested that are not
 * ignored. Bodies of the world are at rest. Pairs that do not move relative to each other are not
 * tested on edges: pairs of bodies of the world are not tested at all, others once, here, in the
 * home pose.
 * In:  scene      must outlive the path; not to be changed, or used by another thread, meanwhile
 *      clearance  to be proven; 0: none, and the clearance of an edge is found to within a tenth
 * Out: *out       set in any case, for fmb_robot_path_why(); to be freed
 * Returns 0; or -1 after an error.
 * Cost: O(pairs of frames). */
struct fmb_robot_path;
int fmb_robot_path_begin(struct fmb_robot_scene *scene, double clearance,
                         struct fmb_robot_path **out);
void fmb_robot_path_free(struct fmb_robot_path *path); /* may be NULL, or within an edge */

/* Returns the errors of the last call that failed, as lines separated by line feeds. */
const char *fmb_robot_path_why(struct fmb_robot_path *path);

/* Returns the number of pairs of placements that are tested on every edge. */
size_t fmb_robot_path_pairs(const struct fmb_robot_path *path);

/* Returns the number of pairs of placements that meet and do not move relative to each other. Those
 * that overlap are in contact on the whole path. Out: *touches: [number]. */
struct fmb_robot_touch {
    unsigned a, b;
    enum fmb_verdict verdict;
};
size_t fmb_robot_path_touches(const struct fmb_robot_path *path,
                              const struct fmb_robot_touch **touches);

/* Begins an edge; an earlier one that is not complete is abandoned.
 * In:  from, to  [n], as for fmb_robot_place(); a continuous joint may turn by at most pi
 * Returns 0; or -1 after an error.
 * Cost: O(frames times links). The search begins at the first step. */
int fmb_robot_path_edge(struct fmb_robot_path *path, const double *from, const double *to);

/* Returns an upper bound of how far two bodies move relative to each other if every joint is off by
 * 1, radian or length, on the edges so far. A clearance c covers errors of up to c divided by this
 * bound in all joints at once. */
double fmb_robot_path_lever(const struct fmb_robot_path *path);

enum fmb_robot_verdict {
    FMB_ROBOT_FREE = 1,     /* all pairs are at least `clearance` apart, at all times */
    FMB_ROBOT_NEAR = 2,     /* no contact, but the wanted clearance is not kept */
    FMB_ROBOT_CONTACT = 3,  /* the first contact is within `at`; at its end the pair overlaps */
    FMB_ROBOT_UNDECIDED = 4 /* free before `at`; within it neither could be proven */
};

struct fmb_robot_edge {
    enum fmb_robot_verdict verdict;
    /* Fractions of the edge. Free: all of it. Near: the time of `closest`. Undecided: at most 2^-30
     * long, unless the edge took half a million steps. */
    double at[2];
    /* A lower bound of the least gap; 0 unless free or near; infinite if there are no pairs. */
    double clearance;
    /* An upper bound of the least gap, from the times examined; infinite if there was none. */
    double closest;
    bool has_pair;
    size_t a, b; /* placements: of the contact, of the undecided interval, or else of `closest` */
};

/* Continues an edge.
 * Out: *out  the answer, if it returns 1
 * Returns 1 if the edge is complete, and again at each later call; 0 if it is not complete, or if
 * no edge was begun.
 * Cost: some 0.1 ms; O(pairs of frames) at the first step of an edge, and where the search for the
 * first contact begins. */
int fmb_robot_path_step(struct fmb_robot_path *path, struct fmb_robot_edge *out);

#ifdef __cplusplus
}
#endif
#endif
