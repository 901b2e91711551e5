/* fmb scene: prints a robot of a URDF file as scenes. */
#include "commands.h"

#include "complain.h"
#include "robot_run.h"
#include "scene_json.h"

#include <inttypes.h>
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
    "hull. If a hull has more than 1024 vertices, or a body takes more than 63500\n"
    "bytes, hulls get fewer vertices, and a radius with which they contain their\n"
    "meshes. With a table of joint values, prints a scene for each row:\n"
    "\n"
    "  fmb scene robot.urdf --joints-csv path.csv --with world.json |\n"
    "    fmb query --local --contacts --fail-if overlapping\n"
    "\n"
    "ROBOT.urdf may be '-', standard input. Paths of mesh files are relative to its\n"
    "folder, or with '-' to the current one. Each scene is printed on one line.\n"
    "\n" ROBOT_RUN_USAGE
    "  --margin M           replaces the margin of the scenes\n"
    "\n"
    "Output:\n" ROBOT_RUN_OUTPUT_USAGE
    "\n"
    "A row with a time lasts until the time of the next row.\n"
    "\n"
    "Without --srdf, a link is not tested against its parent, or, if that has no\n"
    "body, against the nearest link above that has one; nor are links that fixed\n"
    "joints alone connect.\n"
    "\n"
    "Joints are revolute, continuous, prismatic or fixed. xacro and SDF are not\n"
    "supported. Poses are rounded to doubles: give a margin where that matters.\n"
    "\n"
    "Exit codes: 0 printed; 2 wrong usage, or a file that cannot be read or is not\n"
    "valid: no scene is printed.\n";

/* Refuses a table with times if a body of the world has an end: the end is stated for the window of
 * the world, not for the windows of the table. */
static bool check_ends(const struct robot_run *run, const struct joint_table *table)
{
    const struct fmb_scene *scene = &run->scene->owner.scene;
    for (size_t i = 0; i < scene->placement_count && table->has_time; i++)
        if (scene->placements[i].end_count != 0) {
            complain("%s: it has times, but body %" PRId64 " has an \"end\" of one window",
                     run->options->table, scene->placements[i].id);
            return false;
        }
    return true;
}

static bool place_row(struct robot_run *run, struct joint_table *table, size_t i)
{
    const struct joint_row *row = &table->rows[i];
    return robot_run_place(run, row->value, table->has_time ? row->time - table->rows[0].time : 0,
                           joint_table_place(table, row));
}

/* Prints the scenes of all rows, once all of them have been placed without an error. */
static bool print_rows(struct robot_run *run, struct joint_table *table)
{
    struct fmb_scene *out = &run->scene->owner.scene;
    for (size_t i = 0; i < table->row_count; i++) {
        if (!place_row(run, table, i))
            return false;
        if (i == 0)
            robot_run_measure(run);
    }
    robot_run_report(run, table);
    for (size_t i = 0; i < table->row_count && !ferror(stdout); i++) {
        const struct joint_row *row = &table->rows[i];
        place_row(run, table, i);
        out->label = row->label;
        if (table->has_time)
            out->duration = i + 1 < table->row_count ? row[1].time - row->time : 0;
        scene_json_write(stdout, &run->scene->owner);
    }
    return true;
}

static bool print_table(struct robot_run *run)
{
    struct joint_table table;
    const bool good = joint_table_read(run->options->table, &run->joints, &table) &&
                      check_ends(run, &table) && joints_check(&run->joints) &&
                      print_rows(run, &table);
    joint_table_clear(&table);
    return good;
}

static bool print_pose(struct robot_run *run)
{
    const char *path = run->robot->tree.path;
    joints_follow(&run->joints, path, 0);
    if (!joints_check(&run->joints) || !robot_run_place(run, run->joints.value, 0, path))
        return false;
    robot_run_measure(run);
    robot_run_report(run, NULL);
    scene_json_write(stdout, &run->scene->owner);
    return true;
}

static int print_file(const struct robot_run_options *options, const char *path)
{
    struct robot_run run;
    bool good = robot_run_begin(options, path, &run) &&
                (options->table ? print_table(&run) : print_pose(&run));
    robot_run_end(&run);
    good = output_flush() && good;
    return good ? ARGS_ANSWERED : ARGS_USAGE;
}

int cmd_scene(int argc, char **argv)
{
    struct robot_run_options options = ROBOT_RUN_DEFAULTS;
    const struct args_option own[] = {
        ROBOT_RUN_OPTIONS(options),
        {"margin", ARGS_NUMBER, &options.margin, .high = DBL_MAX},
        {.name = NULL},
    };
    struct args args = {"scene",          usage, own, .operand = "ROBOT.urdf", .operands_min = 1,
                        .operands_max = 1};
    options.robot.bus = 1;
    int code = robot_run_parse(&args, argc, argv, &options);
    if (code == ARGS_RUN)
        code = print_file(&options, args.operands[0]);
    free(options.world);
    free(options.ignored);
    return code;
}
