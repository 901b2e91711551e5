/* fmb scene: prints a robot of a URDF file as scenes. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "complain.h"
#include "enclosure.h"
#include "fmb_batch.h"
#include "joints.h"
#include "number.h"
#include "robot_scene.h"
#include "scene_json.h"
#include "robot_world.h"

#include <float.h>
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
    "\n"
    "Poses:\n"
    "  --joints LIST        NAME=VALUE,...: values of joints, in radians, or lengths\n"
    "                       of prismatic joints. Without a value, a mimic joint\n"
    "                       follows the joint that it names; any other has 0, or the\n"
    "                       middle of its limits if 0 is outside\n"
    "  --joints-csv FILE    a table with a column for each joint that moves, named in\n"
    "                       its first line; columns for mimic joints, \"label\" and\n"
    "                       \"time\" are optional. With times, a row lasts until the\n"
    "                       time of the next row. Other columns are ignored\n"
    "  --base POSE          X,Y,Z or X,Y,Z,ROLL,PITCH,YAW: the pose of the root link,\n"
    "                       as in an <origin>\n"
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
    "                       needs fewer vertices. The largest distance by which one\n"
    "                       does is reported\n"
    "  --objects            a hull for each object (o) of an OBJ file, for convex\n"
    "                       decompositions\n"
    "  --package-path DIRS  folders to search for packages, separated by colons: a\n"
    "                       mesh file package://NAME/FILE is NAME/FILE in the first\n"
    "                       folder that has it; else FILE in the nearest folder above\n"
    "                       the robot that is called NAME, or whose package.xml has\n"
    "                       this name\n"
    "\n"
    "Scenes:\n"
    "  --with FILE          adds the bodies of a scene of JSON, with its ignored\n"
    "                       pairs, duration and margin; or the links of a URDF, as\n"
    "                       obstacles of one group. May be given several times. A\n"
    "                       body with \"link\": NAME is carried by that link, and has\n"
    "                       its pose in the link. Links have the ids from 1 on;\n"
    "                       bodies with one of these get others\n"
    "  --srdf FILE          ignores the pairs that an SRDF file disables, and no\n"
    "                       other pairs of links\n"
    "  --ignore NAME,NAME   a pair of links or bodies that is not tested, by name;\n"
    "                       may be given several times\n"
    "  --margin M           the margin, in place of that of the scenes\n"
    "  --verbose            lists the links, bodies and pairs that messages count\n"
    "  -h, --help\n"
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

struct scene_options {
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

/* Takes a text that may be given once: the last of several would hide the others. */
static bool take_once(const struct args *args, void *out)
{
    const char **text = out;
    if (*text)
        return args_error(args, "--%s is given twice", args->option);
    *text = optarg;
    return true;
}

static bool take_world(const struct args *args, void *out)
{
    struct scene_options *options = out;
    (void) args;
    options->world = allocate_grow(options->world, &options->world_capacity,
                                   options->world_count + 1, sizeof *options->world);
    options->world[options->world_count++] = optarg;
    return true;
}

/* Takes NAME,NAME, which is divided in place. */
static bool take_ignored(const struct args *args, void *out)
{
    struct scene_options *options = out;
    char *comma = strchr(optarg, ',');
    if (!comma)
        return args_error(args, "--ignore: expected two names, NAME,NAME, found '%s'", optarg);
    *comma = '\0';
    options->ignored = allocate_grow(options->ignored, &options->ignored_capacity,
                                     options->ignored_count + 1, sizeof *options->ignored);
    options->ignored[options->ignored_count][0] = optarg;
    options->ignored[options->ignored_count++][1] = comma + 1;
    return true;
}

/* Takes X,Y,Z or X,Y,Z,ROLL,PITCH,YAW. */
static bool take_base(const struct args *args, void *out)
{
    struct scene_options *options = out;
    char *end = optarg;
    int count = 0;
    for (bool more = true; more && count < 6; count++) {
        const char *at = end + (count > 0); /* after a comma */
        options->robot.base[count] = strtod(at, &end);
        if (end == at || !isfinite(options->robot.base[count]))
            return args_error(args, "--base: expected numbers, found '%s'", optarg);
        more = *end == ',';
    }
    if ((count != 3 && count != 6) || *end)
        return args_error(args, "--base: expected X,Y,Z or X,Y,Z,ROLL,PITCH,YAW, found '%s'",
                          optarg);
    return true;
}

struct run {
    const struct scene_options *options;
    struct fmb_robot *robot;
    struct fmb_robot_scene *scene;
    struct robot_world *worlds; /* [options->world_count] */
    struct joints joints;
    double size[3]; /* of the bodies of links in the first pose, along each axis */
};

/* ---- Messages on stderr: at most three lines, without --verbose ---- */

static FILE *begin_text(char **text, size_t *size)
{
    FILE *out = open_memstream(text, size);
    if (!out)
        allocate_failed();
    return out;
}

static void end_text(FILE *out, const char *place, char **text)
{
    fclose(out);
    complain("%s%s", place, *text);
    free(*text);
}

/* Sets the size, in the current pose. */
static void measure(struct run *run)
{
    double most[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < run->robot->body_count; i++) {
        const struct fmb_placement *link = &run->scene->placements[i];
        for (unsigned k = 0; k < link->body->frame_count; k++) {
            struct fmb_prepared frame;
            double box[2][FMB_DIM_MAX];
            fmb_prepare(link, k, 1, &frame);
            fmb_box_of(&frame, 0, box);
            for (int axis = 0; axis < 3; axis++) {
                most[0][axis] = fmin(most[0][axis], box[0][axis]);
                most[1][axis] = fmax(most[1][axis], box[1][axis]);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++)
        run->size[axis] = most[1][axis] - most[0][axis];
}

static double excess_of(const struct robot_world *world)
{
    return world->robot ? fmb_robot_excess(world->robot) : world->json.outside;
}

static void report_robot(const struct run *run)
{
    double excess = fmb_robot_excess(run->robot);
    char text[5][NUMBER_TEXT_MAX], more[128] = "", unit[4600] = "";
    for (int axis = 0; axis < 3; axis++)
        number_short(run->size[axis], text[axis]);
    const struct robot_meshes *meshes = &run->robot->meshes;
    for (size_t w = 0; w < run->options->world_count; w++) {
        excess = fmax(excess, excess_of(&run->worlds[w]));
        if (meshes->scaled == 0 && run->worlds[w].robot)
            meshes = &run->worlds[w].robot->meshes;
    }
    if (excess > 0) /* rounded up */
        snprintf(more, sizeof more, "; hulls extend beyond what they enclose by at most %s",
                 number_short(excess * (1 + 1e-5), text[3]));
    if (meshes->scaled > 0)
        snprintf(
            unit, sizeof unit,
            "; the <unit> of COLLADA is applied, as in RViz and Gazebo, but not in MoveIt: %s m "
            "in %s, files: %zu",
            number_short(meshes->first_unit, text[4]), meshes->first_file, meshes->scaled);
    complain("%s: links: %zu, with a body: %zu; size: %s x %s x %s%s%s%s", run->robot->tree.path,
             run->robot->tree.link_count, run->robot->body_count, text[0], text[1], text[2],
             run->options->table ? " in the first pose" : "", more, unit);
}

static const char *const origin_names[ROBOT_ORIGINS + 2] = {
    [ROBOT_NEIGHBOURS] = "neighbours",
    [ROBOT_SRDF] = "by the SRDF",
    [ROBOT_SRDF_DEFAULT] = "by its defaults",
    [ROBOT_CARRIED] = "carried",
    [ROBOT_WORLD] = "by scenes",
    [ROBOT_OPTION] = "by --ignore",
    [ROBOT_ORIGINS] = "joined rigidly",
    [ROBOT_ORIGINS + 1] = "within groups"};

static void report_srdf(const struct fmb_robot *robot, FILE *out)
{
    enum { NAMED = 8 };
    if (robot->unlisted > 0)
        fprintf(out, "; tested neighbours that the SRDF does not list: %zu", robot->unlisted);
    if (robot->unknown_count == 0)
        return;
    fprintf(out, "; links of the SRDF that the robot does not have: %zu (", robot->unknown_count);
    const char *at = robot->unknown.text;
    for (int i = 0; i < NAMED && *at; i++) {
        const int length = (int) strcspn(at, "\n");
        fprintf(out, "%s%.*s", i > 0 ? ", " : "", length, at);
        at += length + (at[length] == '\n');
    }
    fprintf(out, "%s)", *at ? ", ..." : "");
}

static void report_pairs(struct run *run)
{
    struct fmb_robot_scene *scene = run->scene;
    const uint64_t n = scene->owner.scene.placement_count;
    const uint64_t tested = scene_count_pairs(&scene->owner), ignored = n * (n - 1) / 2 - tested;
    uint64_t count[ROBOT_ORIGINS + 2] = {0};
    const char *before = ": ";
    char *text;
    size_t size;
    FILE *out = begin_text(&text, &size);
    for (size_t i = 0; i < scene->ignored.count; i++)
        count[scene->ignored.pair[i].origin]++;
    for (unsigned i = 1; i < run->robot->body_count; i++)
        for (unsigned k = 0; k < i; k++)
            count[ROBOT_ORIGINS] += pair_is_within_group(&scene->owner.scene, k, i);
    count[ROBOT_ORIGINS + 1] = ignored - scene->ignored.count - count[ROBOT_ORIGINS];
    fprintf(out, "pairs tested: %" PRIu64 ", ignored: %" PRIu64, tested, ignored);
    for (int origin = 0; origin < ROBOT_ORIGINS + 2; origin++)
        if (count[origin] > 0) {
            fprintf(out, "%s%" PRIu64 " %s", before, count[origin], origin_names[origin]);
            before = ", ";
        }
    report_srdf(run->robot, out);
    end_text(out, "", &text);
}

/* table: NULL if there is none. */
static void report_joints(const struct run *run, const struct joint_table *table)
{
    char *text;
    size_t size;
    FILE *out = begin_text(&text, &size);
    if (table)
        joint_table_describe(table, out);
    joints_describe(&run->joints, out);
    fclose(out);
    if (size > 0)
        complain("%s: %s", table ? run->options->table : "joints", text + (table ? 0 : 2));
    free(text);
}

/* Lists what the other lines count. */
static void report_more(const struct run *run)
{
    const struct fmb_robot *robot = run->robot;
    const struct robot *tree = &robot->tree;
    for (size_t i = 0; i < tree->link_count; i++)
        if (robot->body_of_link[i] == ROBOT_NO_BODY)
            complain("%s: link '%s' has no <collision> and no body", tree->path,
                     tree->links[i].name->name);
    robot_world_print("", robot_lines_text(&run->scene->notes));
    for (size_t i = 0; i < run->scene->ignored.count; i++) {
        const struct robot_pair *pair = &run->scene->ignored.pair[i];
        const struct fmb_placement *a = &run->scene->placements[pair->a];
        const struct fmb_placement *b = &run->scene->placements[pair->b];
        complain("ignored: %" PRId64 " %s and %" PRId64 " %s: %s", a->id, a->name ? a->name : "",
                 b->id, b->name ? b->name : "", origin_names[pair->origin]);
    }
    for (size_t i = 0; i < robot->body_count && !robot->srdf; i++)
        if (robot->rigid[i] != i)
            complain("joined rigidly: %s and %s", robot->link_names[robot->rigid[i]],
                     robot->link_names[i]);
    if (robot->unknown_count > 0)
        robot_world_print("the robot has no link", robot->unknown.text);
}

static void report(struct run *run, const struct joint_table *table)
{
    report_robot(run);
    report_pairs(run);
    report_joints(run, table);
    if (run->options->verbose)
        report_more(run);
}

/* ---- Scenes ---- */

static bool place(struct run *run, double time, const char *where)
{
    const bool good = robot_scene_place(run->scene, run->joints.value, time, where);
    if (!good)
        robot_world_print("", robot_lines_text(&run->scene->errors));
    return good;
}

/* Places and prints the scenes of all rows; if print is false, only checks them. */
static bool print_rows(struct run *run, struct joint_table *table, bool print)
{
    struct fmb_scene *out = &run->scene->owner.scene;
    const double duration = out->duration;
    enum joint_row row = joint_table_next(table);
    const double begin = table->time;
    bool good = row != JOINT_ROW_END;
    if (!good)
        complain("%s: expected a row of joint values, found none", table->place);
    while (good && row == JOINT_ROW) {
        const double time = table->time;
        const bool first = table->rows == 1;
        char label[sizeof table->label];
        strcpy(label, table->label);
        good = run->joints.refused || place(run, table->has_time ? time - begin : 0, table->place);
        if (first && !print)
            measure(run);
        row = joint_table_next(table);
        out->label = *label ? label : NULL;
        if (table->has_time)
            out->duration = row == JOINT_ROW ? table->time - time : 0;
        if (print)
            scene_json_write(stdout, &run->scene->owner);
        out->label = NULL;
        good = good && !ferror(stdout);
    }
    out->duration = duration;
    return good && row != JOINT_ROW_BAD;
}

static bool print_table(struct run *run)
{
    struct joint_table table;
    bool good = joint_table_open(run->options->table, &run->joints, &table) &&
                print_rows(run, &table, false) && joints_check(&run->joints);
    if (good) {
        report(run, &table);
        good = joint_table_rewind(&table) && print_rows(run, &table, true);
    }
    joint_table_close(&table);
    return good;
}

static bool print_pose(struct run *run)
{
    joints_follow(&run->joints, run->robot->tree.path, 0);
    if (!joints_check(&run->joints) || !place(run, 0, run->robot->tree.path))
        return false;
    measure(run);
    report(run, NULL);
    scene_json_write(stdout, &run->scene->owner);
    return true;
}

/* Reads the worlds, and makes the scene. */
static bool make_scene(struct run *run)
{
    const struct scene_options *options = run->options;
    const size_t count = options->world_count;
    struct fmb_robot_world *world = allocate(count, sizeof *world);
    bool good = true;
    for (size_t w = 0; w < count; w++)
        good = robot_world_read(options->world[w], &options->robot, &run->worlds[w]) && good;
    robot_world_set_groups(run->worlds, count);
    for (size_t w = 0; w < count; w++)
        world[w] = run->worlds[w].world;
    if (good &&
        fmb_robot_scene(run->robot, world, count, (const char *const(*)[2]) options->ignored,
                        options->ignored_count, &run->scene) != 0) {
        robot_world_print("", fmb_robot_scene_why(run->scene));
        good = false;
    }
    if (good && options->margin >= 0)
        run->scene->owner.scene.margin = options->margin;
    free(world);
    return good;
}

static int print_file(const struct scene_options *options, const char *path)
{
    struct run run = {.options = options,
                      .worlds = allocate(options->world_count, sizeof *run.worlds)};
    bool good = fmb_robot_read(path, &options->robot, &run.robot) == 0;
    if (!good)
        robot_world_print("", fmb_robot_why(run.robot));
    if (good) {
        good = joints_open(&run.robot->tree, options->joints, options->slack, &run.joints) &&
               make_scene(&run) && (options->table ? print_table(&run) : print_pose(&run));
        joints_clear(&run.joints);
    }
    for (size_t w = 0; w < options->world_count; w++)
        robot_world_clear(&run.worlds[w]);
    free(run.worlds);
    fmb_robot_scene_free(run.scene);
    fmb_robot_free(run.robot);
    good = output_flush() && good;
    return good ? ARGS_ANSWERED : ARGS_USAGE;
}

int cmd_scene(int argc, char **argv)
{
    struct scene_options options = {
        .robot = {.bus = 1}, .sides = ENCLOSURE_SIDES, .margin = -1, .slack = 0.001};
    const struct args_option own[] = {
        {"joints", ARGS_OTHER, &options.joints, .take = take_once},
        {"joints-csv", ARGS_OTHER, &options.table, .take = take_once},
        {"limit-slack", ARGS_NUMBER, &options.slack, .high = INFINITY},
        {"base", ARGS_OTHER, &options, .take = take_base},
        {"sides", ARGS_INTEGER, &options.sides, .low = 4, .high = ENCLOSURE_SIDES_MAX},
        {"excess", ARGS_NUMBER, &options.robot.excess, .high = DBL_MAX},
        {"objects", ARGS_FLAG, .out = &options.objects},
        {"package-path", ARGS_OTHER, &options.robot.package_path, .take = take_once},
        {"with", ARGS_OTHER, &options, .take = take_world},
        {"srdf", ARGS_OTHER, &options.robot.srdf, .take = take_once},
        {"ignore", ARGS_OTHER, &options, .take = take_ignored},
        {"margin", ARGS_NUMBER, &options.margin, .high = DBL_MAX},
        {"verbose", ARGS_FLAG, .out = &options.verbose},
        {.name = NULL},
    };
    struct args args = {"scene",          usage, own, .operand = "ROBOT.urdf", .operands_min = 1,
                        .operands_max = 1};
    int code = args_parse(&args, argc, argv);
    if (code == ARGS_RUN && options.sides % 4 != 0) {
        args_error(&args, "--sides: expected a multiple of 4, found %ld", options.sides);
        code = ARGS_USAGE;
    }
    options.robot.sides = (int) options.sides;
    options.robot.objects = options.objects;
    if (code == ARGS_RUN)
        code = print_file(&options, args.operands[0]);
    free(options.world);
    free(options.ignored);
    return code;
}
