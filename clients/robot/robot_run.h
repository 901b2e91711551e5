/* What fmb scene and fmb path have in common: their options, a robot among the bodies of files, and
 * messages about it. */
#ifndef ROBOT_RUN_H
#define ROBOT_RUN_H

#include "args.h"
#include "enclosure.h"
#include "joints.h"
#include "robot_scene.h"

#include <float.h>

struct robot_run_options {
    struct fmb_robot_options robot;
    long sides;
    bool objects, verbose;
    const char *joints, *table;
    const char **world; /* owned, [world_count]: files */
    size_t world_count, world_capacity;
    const char *(*ignored)[2]; /* owned, [ignored_count]: pairs of names */
    size_t ignored_count, ignored_capacity;
    double margin; /* negative: not given */
    double slack;
};

/* All defaults. */
#define ROBOT_RUN_DEFAULTS                                     \
    {                                                          \
        .sides = ENCLOSURE_SIDES, .margin = -1, .slack = 0.001 \
    }

/* The elements of a table of options that fill them in. */
#define ROBOT_RUN_OPTIONS(options)                                                                \
    {"joints", ARGS_OTHER, &(options).joints, .take = robot_run_take_once},                       \
        {"joints-csv", ARGS_OTHER, &(options).table, .take = robot_run_take_once},                \
        {"limit-slack", ARGS_NUMBER, &(options).slack, .high = INFINITY},                         \
        {"base", ARGS_OTHER, &(options), .take = robot_run_take_base},                            \
        {"sides", ARGS_INTEGER, &(options).sides, .low = 4, .high = ENCLOSURE_SIDES_MAX},         \
        {"excess", ARGS_NUMBER, &(options).robot.excess, .high = DBL_MAX},                        \
        {"objects", ARGS_FLAG, .out = &(options).objects},                                        \
        {"package-path", ARGS_OTHER, &(options).robot.package_path, .take = robot_run_take_once}, \
        {"with", ARGS_OTHER, &(options), .take = robot_run_take_world},                           \
        {"srdf", ARGS_OTHER, &(options).robot.srdf, .take = robot_run_take_once},                 \
        {"ignore", ARGS_OTHER, &(options), .take = robot_run_take_ignored},                       \
    {                                                                                             \
        "verbose", ARGS_FLAG, .out = &(options).verbose                                           \
    }

/* The part of --help about these options. */
#define ROBOT_RUN_USAGE                                                                  \
    "Poses:\n"                                                                           \
    "  --joints LIST        NAME=VALUE,...: values of joints without a column, in\n"     \
    "                       radians, or lengths of prismatic joints. Without a value,\n" \
    "                       a mimic joint follows the joint that it names; any other\n"  \
    "                       has 0, or the middle of its limits if 0 is outside\n"        \
    "  --joints-csv FILE    a table ('-': standard input) with a column for each\n"      \
    "                       joint that moves, named in its first line; columns for\n"    \
    "                       mimic joints, \"label\" and \"time\" are optional. Other\n"  \
    "                       columns are ignored\n"                                       \
    "  --base POSE          X,Y,Z or X,Y,Z,ROLL,PITCH,YAW: the pose of the root link,\n" \
    "                       as in an <origin>\n"                                         \
    "  --limit-slack D      how far values may be outside the limits of their joints,\n" \
    "                       in radians or lengths, before they are refused (0.001;\n"    \
    "                       inf: any). Such values are used unchanged, and reported\n"   \
    "\n"                                                                                 \
    "Bodies:\n"                                                                          \
    "  --with FILE          adds the bodies of a scene of JSON, with its ignored\n"      \
    "                       pairs, duration and margin; or the links of a URDF, as\n"    \
    "                       obstacles of one group. May be given several times. A\n"     \
    "                       body with \"link\": NAME is carried by that link, and has\n" \
    "                       its pose in the link. Links have ids from 1 on. A body\n"    \
    "                       whose id is taken gets the lowest free one\n"                \
    "  --srdf FILE          ignores the pairs that an SRDF file disables, and no\n"      \
    "                       other pairs of links\n"                                      \
    "  --ignore NAME,NAME   a pair of links or bodies that is not tested, by name;\n"    \
    "                       may be given several times\n"                                \
    "  --sides N            sides of the hulls that enclose cylinders, a multiple of\n"  \
    "                       4 up to 512 (16). A hull extends beyond a cylinder of\n"     \
    "                       radius r by at most r (1 / cos(pi/N) - 1): with 16 sides,\n" \
    "                       0.02 r\n"                                                    \
    "  --excess D           how far a hull may extend beyond its mesh (0), so that it\n" \
    "                       needs fewer vertices. The largest distance by which one\n"   \
    "                       does is reported\n"                                          \
    "  --objects            a hull for each object (o) of an OBJ file, for convex\n"     \
    "                       decompositions\n"                                            \
    "  --package-path DIRS  folders to search for packages, separated by colons: a\n"    \
    "                       mesh file package://NAME/FILE is NAME/FILE in the first\n"   \
    "                       folder that has it; else FILE in the nearest folder above\n" \
    "                       the robot that is called NAME, or whose package.xml has\n"   \
    "                       this name\n"

/* The last part. */
#define ROBOT_RUN_OUTPUT_USAGE                                                       \
    "  --verbose            lists the links, bodies and pairs that messages count\n" \
    "  -h, --help\n"

/* Takes a text that may be given once: the last of several would hide the others. */
bool robot_run_take_once(const struct args *args, void *out);
bool robot_run_take_world(const struct args *args, void *out);

/* Takes NAME,NAME, which is divided in place. */
bool robot_run_take_ignored(const struct args *args, void *out);

/* Takes X,Y,Z or X,Y,Z,ROLL,PITCH,YAW. */
bool robot_run_take_base(const struct args *args, void *out);

/* Bodies around a robot, from a file: a scene of JSON; or a robot of URDF, whose links are
 * obstacles of one group. */
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

/* A robot among the bodies of files. */
struct robot_run {
    const struct robot_run_options *options;
    struct fmb_robot *robot;
    struct fmb_robot_scene *scene;
    struct robot_world *worlds; /* [options->world_count] */
    struct joints joints;
    struct fmb_robot_path *path; /* of fmb path: has the pairs that are tested; else NULL */
    double size[3];              /* of the bodies of links in the first pose, along each axis */
};

/* Reads the robot and the worlds, and makes the scene. Returns false after errors, which were
 * printed. The caller passes the run to robot_run_end() in either case. */
bool robot_run_begin(const struct robot_run_options *options, const char *path,
                     struct robot_run *out);
void robot_run_end(struct robot_run *run);

/* Parses the arguments of a command whose options are these and others. Returns ARGS_RUN, or an
 * exit code. */
int robot_run_parse(struct args *args, int argc, char **argv, struct robot_run_options *options);

/* Prints lines, which are separated by line feeds, on stderr, each with "PATH: " before it unless
 * path is "". */
void robot_run_print(const char *path, const char *text);

/* As robot_scene_place(); errors are printed. */
bool robot_run_place(struct robot_run *run, const double *value, double time, const char *where);

/* Sets the size, in the current pose. */
void robot_run_measure(struct robot_run *run);

/* Prints on stderr what was read, in at most three lines; with --verbose, lists what they count.
 * table: NULL if there is none. */
void robot_run_report(const struct robot_run *run, const struct joint_table *table);

#endif
