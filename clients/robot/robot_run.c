#include "robot_run.h"

#include "allocate.h"
#include "complain.h"
#include "escape.h"
#include "fmb_batch.h"
#include "number.h"
#include "path.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool robot_run_take_once(const struct args *args, void *out)
{
    const char **text = out;
    if (*text)
        return args_error(args, "--%s is given twice", args->option);
    *text = optarg;
    return true;
}

bool robot_run_take_world(const struct args *args, void *out)
{
    struct robot_run_options *options = out;
    (void) args;
    options->world = allocate_grow(options->world, &options->world_capacity,
                                   options->world_count + 1, sizeof *options->world);
    options->world[options->world_count++] = optarg;
    return true;
}

bool robot_run_take_ignored(const struct args *args, void *out)
{
    struct robot_run_options *options = out;
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

bool robot_run_take_base(const struct args *args, void *out)
{
    struct robot_run_options *options = out;
    const int count = args_numbers(optarg, 6, options->robot.base);
    return count == 3 || count == 6 ||
           args_error(args, "--base: expected X,Y,Z or X,Y,Z,ROLL,PITCH,YAW, found '%s'", optarg);
}

void robot_run_print(const char *path, const char *text)
{
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at == '\n')
        complain("%s%s%.*s", path, *path ? ": " : "", (int) strcspn(at, "\n"), at);
}

bool robot_run_place(struct robot_run *run, const double *value, double time, const char *where)
{
    const bool good = robot_scene_place(run->scene, value, time, where);
    if (!good)
        robot_run_print("", robot_lines_text(&run->scene->errors));
    return good;
}

/* ---- Messages on stderr: at most three lines, without --verbose ---- */

void robot_run_measure(struct robot_run *run)
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

static void report_robot(const struct robot_run *run, FILE *out)
{
    const struct fmb_robot *robot = run->robot;
    const struct robot_meshes *meshes = &robot->meshes;
    double excess = fmb_robot_excess(robot);
    char text[3][NUMBER_TEXT_MAX];
    for (size_t w = 0; w < run->options->world_count; w++) {
        const struct robot_world *world = &run->worlds[w];
        excess = fmax(excess,
                      world->robot ? fmb_robot_excess(world->robot) : world->json->owner.outside);
        if (meshes->scaled == 0 && world->robot)
            meshes = &world->robot->meshes;
    }
    escape_text(out, robot->tree.path);
    fprintf(out, ": links: %zu, with a body: %zu; size: %s x %s x %s%s", robot->tree.link_count,
            robot->body_count, number_short(run->size[0], text[0]),
            number_short(run->size[1], text[1]), number_short(run->size[2], text[2]),
            run->options->table ? " in the first pose" : "");
    if (excess > 0) /* rounded up */
        fprintf(out, "; hulls extend beyond what they enclose by at most %s",
                number_short(excess * (1 + 1e-5), text[0]));
    if (meshes->scaled > 0) {
        fprintf(
            out,
            "; the <unit> of COLLADA is applied, as in RViz and Gazebo, but not in MoveIt: %s m "
            "in ",
            number_short(meshes->first_unit, text[0]));
        escape_text(out, meshes->first_file);
        fprintf(out, ", files: %zu", meshes->scaled);
    }
    putc('\n', out);
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
    size_t i = 0;
    for (const struct robot_name *name = robot->unknown; name && i <= NAMED; name = name->hh.next) {
        if (i == 0)
            fprintf(out, "; links of the SRDF that the robot does not have: %u (",
                    HASH_COUNT(robot->unknown));
        fputs(i > 0 ? ", " : "", out);
        escape_text(out, i++ < NAMED ? name->name : "...");
    }
    fputs(i > 0 ? ")\n" : "\n", out);
}

static void report_pairs(const struct robot_run *run, FILE *out)
{
    struct fmb_robot_scene *scene = run->scene;
    const uint64_t n = scene->owner.scene.placement_count;
    const uint64_t still = run->path ? n - fmb_robot_moved(scene) : 0; /* bodies of the world */
    const uint64_t tested = run->path ? run->path->body_pairs + run->path->rigid_count
                                      : scene_count_pairs(&scene->owner);
    const uint64_t ignored = run->path ? run->path->ignored_count : n * (n - 1) / 2 - tested;
    uint64_t count[ROBOT_ORIGINS + 2] = {0};
    const char *before = ": ";
    for (size_t i = 0; i < scene->ignored.count; i++)
        count[scene->ignored.pair[i].origin] += scene->ignored.pair[i].a < n - still;
    for (unsigned i = 1; i < run->robot->body_count; i++)
        for (unsigned k = 0; k < i; k++)
            count[ROBOT_ORIGINS] += pair_is_within_group(&scene->owner.scene, k, i);
    count[ROBOT_ORIGINS + 1] = ignored;
    for (int origin = 0; origin <= ROBOT_ORIGINS; origin++)
        count[ROBOT_ORIGINS + 1] -= count[origin];
    fprintf(out, "pairs tested: %" PRIu64 ", ignored: %" PRIu64, tested, ignored);
    for (int origin = 0; origin < ROBOT_ORIGINS + 2; origin++)
        if (count[origin] > 0) {
            fprintf(out, "%s%" PRIu64 " %s", before, count[origin], origin_names[origin]);
            before = ", ";
        }
    if (run->path && run->path->rigid_count > 0)
        fprintf(out, "; decided once, as they do not move relative to each other: %zu",
                run->path->rigid_count);
    if (still > 1)
        fprintf(out, "; bodies of the world are not tested against each other");
    report_srdf(run->robot, out);
}

/* Lists what the other lines count. */
static void report_more(const struct robot_run *run)
{
    const struct fmb_robot *robot = run->robot;
    const struct robot *tree = &robot->tree;
    for (size_t i = 0; i < tree->link_count; i++)
        if (robot->body_of_link[i] == ROBOT_NO_BODY)
            complain("%s: link '%s' has no <collision> and no body", tree->path,
                     tree->links[i].name->name);
    robot_run_print("", robot_lines_text(&run->scene->notes));
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
    for (const struct robot_name *name = robot->unknown; name; name = name->hh.next)
        complain("the robot has no link: %s", name->name);
}

void robot_run_report(const struct robot_run *run, const struct joint_table *table)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        allocate_failed();
    report_robot(run, out);
    report_pairs(run, out);
    if (table)
        joint_table_describe(table, out);
    joints_describe(&run->joints, table ? "; " : "joints: ", out);
    fclose(out);
    robot_run_print("", text);
    free(text);
    if (run->options->verbose)
        report_more(run);
}

/* ---- Bodies around the robot ---- */

/* Whether a file is XML: it begins with <, after white space and a byte order mark. */
static bool is_xml(const char *path)
{
    int byte = EOF;
    FILE *file = fopen(path, "r");
    if (file)
        while ((byte = getc(file)) > 0 && strchr(" \t\r\n\xef\xbb\xbf", byte)) {
        }
    if (file)
        fclose(file);
    return byte == '<';
}

bool robot_world_read(const char *path, const struct fmb_robot_options *options,
                      struct robot_world *out)
{
    *out = (struct robot_world){.json = NULL};
    if (!is_xml(path)) {
        const bool good = fmb_robot_json_read(path, &out->json) == 0;
        const char *why = out->json->why;
        if (!good)
            complain("%s%s", why,
                     strstr(why, ": no body has the ") ? " (--ignore takes names of links)" : "");
        out->world = out->json->world;
        out->world.name = path;
        return good;
    }
    struct fmb_robot_options as_obstacle = *options;
    as_obstacle.srdf = NULL;
    memset(as_obstacle.base, 0, sizeof as_obstacle.base);
    if (fmb_robot_read(path, &as_obstacle, &out->robot) != 0) {
        robot_run_print("", fmb_robot_why(out->robot));
        return false;
    }
    if (fmb_robot_scene(out->robot, NULL, 0, NULL, 0, &out->scene) != 0) {
        robot_run_print(path, fmb_robot_scene_why(out->scene));
        return false;
    }
    out->scene->owner.scene.ignored_count = 0;
    out->world = (struct fmb_robot_world){.scene = &out->scene->owner.scene, .name = path};
    return true;
}

void robot_world_clear(struct robot_world *world)
{
    fmb_robot_json_free(world->json);
    fmb_robot_scene_free(world->scene);
    fmb_robot_free(world->robot);
}

/* Gives the links of all robots among the worlds one group, which no other body has. */
static void set_groups(struct robot_world *worlds, size_t count)
{
    int64_t most = 0;
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; worlds[w].json && i < worlds[w].world.scene->placement_count; i++) {
            const int64_t group = worlds[w].world.scene->placements[i].group;
            most = group > most ? group : most;
        }
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; worlds[w].scene && i < worlds[w].scene->owner.scene.placement_count; i++)
            worlds[w].scene->placements[i].group = most + 1;
}

/* ---- The scene ---- */

/* Reads the worlds, and makes the scene. */
static bool make_scene(struct robot_run *run)
{
    const struct robot_run_options *options = run->options;
    const size_t count = options->world_count;
    struct fmb_robot_world *world = allocate(count, sizeof *world);
    bool good = true;
    for (size_t w = 0; w < count; w++)
        good = robot_world_read(options->world[w], &options->robot, &run->worlds[w]) && good;
    set_groups(run->worlds, count);
    for (size_t w = 0; w < count; w++)
        world[w] = run->worlds[w].world;
    if (good &&
        fmb_robot_scene(run->robot, world, count, (const char *const(*)[2]) options->ignored,
                        options->ignored_count, &run->scene) != 0) {
        robot_run_print("", fmb_robot_scene_why(run->scene));
        good = false;
    }
    if (good && options->margin >= 0)
        run->scene->owner.scene.margin = options->margin;
    free(world);
    return good;
}

bool robot_run_begin(const struct robot_run_options *options, const char *path,
                     struct robot_run *out)
{
    *out = (struct robot_run){.options = options,
                              .worlds = allocate(options->world_count, sizeof *out->worlds)};
    if (fmb_robot_read(path, &options->robot, &out->robot) != 0) {
        robot_run_print("", fmb_robot_why(out->robot));
        return false;
    }
    return joints_open(&out->robot->tree, options->joints, options->slack, &out->joints) &&
           make_scene(out);
}

void robot_run_end(struct robot_run *run)
{
    joints_clear(&run->joints);
    for (size_t w = 0; w < run->options->world_count; w++)
        robot_world_clear(&run->worlds[w]);
    free(run->worlds);
    fmb_robot_path_free(run->path);
    fmb_robot_scene_free(run->scene);
    fmb_robot_free(run->robot);
}

int robot_run_parse(struct args *args, int argc, char **argv, struct robot_run_options *options)
{
    int code = args_parse(args, argc, argv);
    if (code == ARGS_RUN && options->sides % 4 != 0) {
        args_error(args, "--sides: expected a multiple of 4, found %ld", options->sides);
        code = ARGS_USAGE;
    }
    options->robot.sides = (int) options->sides;
    options->robot.objects = options->objects;
    return code;
}
