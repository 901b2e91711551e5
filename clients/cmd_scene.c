/* fmb scene: prints a robot of a URDF file as scenes. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "complain.h"
#include "enclosure.h"
#include "fmb_client.h"
#include "joints.h"
#include "robot_scene.h"
#include "scene_json.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: fmb scene [OPTIONS] ROBOT.urdf\n"
    "\n"
    "Prints a robot as a scene for 'fmb query': a body for each link, with its name,\n"
    "made of its <collision> elements. A link without any has no body. Boxes, spheres\n"
    "and capsules are exact. A mesh (STL, OBJ, PLY, COLLADA) becomes its convex\n"
    "hull. If that has more than 1024 vertices, or a body more than 63500 bytes, it\n"
    "has fewer vertices, and a radius with which it contains the mesh. With a table\n"
    "of joint values, prints a scene for each row:\n"
    "\n"
    "  fmb scene robot.urdf --joints-csv path.csv --with world.json |\n"
    "    fmb query --local --contacts --fail-if overlapping\n"
    "\n"
    "ROBOT.urdf may be '-', standard input. Paths of mesh files are relative to its\n"
    "folder, or with '-' to the current one.\n"
    "\n"
    "Poses:\n"
    "  --joints LIST        NAME=VALUE,...: values of joints, in radians, or lengths\n"
    "                       of prismatic joints. Without a value, a mimic joint\n"
    "                       follows the joint that it names; any other has 0\n"
    "  --joints-csv FILE    a table with a column for each joint that moves, named in\n"
    "                       its first line; columns for mimic joints, \"label\" and\n"
    "                       \"time\" are optional. With times, a row lasts until the\n"
    "                       time of the next row\n"
    "  --limit-slack D      how far values may be outside the limits of their joints,\n"
    "                       in radians or lengths, before they are refused (0.001;\n"
    "                       inf: any). They are used as they are, and reported\n"
    "\n"
    "Shapes:\n"
    "  --sides N            sides of the hulls that enclose cylinders, a multiple of\n"
    "                       4 up to 512 (16). A hull extends beyond a cylinder of\n"
    "                       radius r by at most r (1 / cos(pi/N) - 1): with 16 sides,\n"
    "                       0.02 r\n"
    "  --excess D           how far a hull may extend beyond its mesh (0), so that it\n"
    "                       has fewer vertices, as few as that takes. How far it does\n"
    "                       is reported, also of hulls that do not fit otherwise\n"
    "  --objects            a hull for each object (o) of an OBJ file, for convex\n"
    "                       decompositions\n"
    "  --package-path DIRS  folders to search for packages, separated by colons: a\n"
    "                       mesh file package://NAME/FILE is NAME/FILE in the first\n"
    "                       folder that has it\n"
    "\n"
    "Scenes:\n"
    "  --with SCENE.json    adds the bodies of a scene, with its ignored pairs,\n"
    "                       duration and margin. Links have the ids from 1 on; a body\n"
    "                       with one of these gets another id, which is reported\n"
    "  --ignore NAME,NAME   a pair of links or bodies that is not tested, by name;\n"
    "                       may be given several times\n"
    "  --margin M           the margin, in place of that of the scene\n"
    "  -h, --help\n"
    "\n"
    "A link is not tested against its parent, or, if that has no body, against the\n"
    "nearest link above that has one.\n"
    "\n"
    "Joints are revolute, continuous, prismatic or fixed. xacro, SRDF and SDF are not\n"
    "supported. Poses are rounded to doubles: give a margin where that matters.\n"
    "\n"
    "Exit codes: 0 printed; 2 wrong usage, or a file that cannot be read or is not\n"
    "valid: no scene is printed.\n";

struct scene_options {
    struct robot_body_options body;
    long sides;
    const char *joints, *table, *world;
    const char **ignored; /* owned, [ignored_count]: pairs of names */
    size_t ignored_count, ignored_capacity;
    double margin; /* negative: not given */
    double slack;
};

/* Takes a text that may be given once: the last of several would hide the others. */
static bool take_once(const struct args *args, void *out)
{
    const char **text = out;
    if (*text)
        return args_error(args, "--%s is given twice", args->option);
    *text = optarg;
    return true;
}

static bool take_ignored(const struct args *args, void *out)
{
    struct scene_options *options = out;
    (void) args;
    options->ignored = allocate_grow(options->ignored, &options->ignored_capacity,
                                     options->ignored_count + 1, sizeof *options->ignored);
    options->ignored[options->ignored_count++] = optarg;
    return true;
}

/* Places and prints the scenes of all rows; if print is false, only checks them. */
static bool print_rows(struct robot_scene *scene, struct joint_table *table, bool print)
{
    struct fmb_scene *out = &scene->owner.scene;
    const double duration = out->duration;
    enum joint_row row = joint_table_next(table);
    const double begin = table->time;
    bool good = row != JOINT_ROW_END;
    if (!good)
        complain("%s: expected a row of joint values, found none", table->place);
    while (good && row == JOINT_ROW) {
        const double time = table->time;
        char label[sizeof table->label];
        strcpy(label, table->label);
        good = table->joints->refused ||
               robot_scene_place(scene, table->joints->value, table->has_time ? time - begin : 0,
                                 table->place);
        row = joint_table_next(table);
        out->label = *label ? label : NULL;
        if (table->has_time)
            out->duration = row == JOINT_ROW ? table->time - time : 0;
        if (print)
            scene_json_write(stdout, &scene->owner);
        out->label = NULL;
        good = good && !ferror(stdout);
    }
    out->duration = duration;
    return good && row != JOINT_ROW_BAD;
}

static bool print_table(const struct scene_options *options, struct joints *joints,
                        struct robot_scene *scene)
{
    struct joint_table table;
    bool good = joint_table_open(options->table, joints, &table) &&
                print_rows(scene, &table, false) && joints_report(joints) &&
                joint_table_rewind(&table);
    if (good) {
        robot_scene_report(scene, options->world);
        good = print_rows(scene, &table, true);
    }
    joint_table_close(&table);
    return good;
}

static bool print_robot(const struct scene_options *options, const struct robot *robot,
                        struct robot_scene *scene)
{
    struct joints joints;
    bool good = joints_open(robot, options->joints, options->slack, &joints) &&
                robot_scene_make(robot, &options->body, scene) &&
                (!options->world || robot_scene_add_world(scene, options->world)) &&
                robot_scene_ignore(scene, options->ignored, options->ignored_count);
    if (options->margin >= 0)
        scene->owner.scene.margin = options->margin;
    if (good && options->table) {
        good = print_table(options, &joints, scene);
    } else if (good) {
        joints_check(&joints);
        joints_follow(&joints, robot->path, 0);
        good = joints_report(&joints) && robot_scene_place(scene, joints.value, 0, robot->path);
        if (good) {
            robot_scene_report(scene, options->world);
            scene_json_write(stdout, &scene->owner);
        }
    }
    joints_clear(&joints);
    return good;
}

static int print_file(const struct scene_options *options, const char *path)
{
    struct robot robot;
    struct robot_scene scene = {.robot_bodies = 0};
    bool good = robot_read(path, &robot) && print_robot(options, &robot, &scene);
    robot_scene_clear(&scene);
    robot_clear(&robot);
    good = output_flush() && good;
    return good ? ARGS_ANSWERED : ARGS_USAGE;
}

int cmd_scene(int argc, char **argv)
{
    struct scene_options options = {.sides = ENCLOSURE_SIDES, .margin = -1, .slack = 0.001};
    const struct args_option own[] = {
        {"joints", ARGS_OTHER, &options.joints, .take = take_once},
        {"joints-csv", ARGS_OTHER, &options.table, .take = take_once},
        {"limit-slack", ARGS_NUMBER, &options.slack, .high = INFINITY},
        {"sides", ARGS_INTEGER, &options.sides, .low = 4, .high = ENCLOSURE_SIDES_MAX},
        {"excess", ARGS_NUMBER, &options.body.excess, .high = DBL_MAX},
        {"objects", ARGS_FLAG, .out = &options.body.objects},
        {"package-path", ARGS_OTHER, &options.body.package_path, .take = take_once},
        {"with", ARGS_OTHER, &options.world, .take = take_once},
        {"ignore", ARGS_OTHER, &options, .take = take_ignored},
        {"margin", ARGS_NUMBER, &options.margin, .high = DBL_MAX},
        {.name = NULL},
    };
    struct args args = {"scene",          usage, own, .operand = "ROBOT.urdf", .operands_min = 1,
                        .operands_max = 1};
    int code = args_parse(&args, argc, argv);
    if (code == ARGS_RUN && options.sides % 4 != 0) {
        args_error(&args, "--sides: expected a multiple of 4, found %ld", options.sides);
        code = ARGS_USAGE;
    }
    options.body.sides = (int) options.sides;
    options.body.bytes_max = FMB_CLIENT_BODY_BYTES_MAX;
    if (code == ARGS_RUN)
        code = print_file(&options, args.operands[0]);
    free(options.ignored);
    return code;
}
