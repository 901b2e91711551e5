#include "fmb_robot.h"

#include "allocate.h"
#include "enclosure.h"
#include "number.h"
#include "robot_scene.h"
#include "turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Bodies of links ---- */

static bool make_bodies(struct fmb_robot *robot)
{
    struct robot *tree = &robot->tree;
    struct owned_scene *owner = &robot->owner;
    bool good = true;
    owner->dim = 3;
    robot->bodies = scene_alloc(owner, tree->link_count, sizeof *robot->bodies);
    robot->link = scene_alloc(owner, tree->link_count, sizeof *robot->link);
    robot->origin = scene_alloc(owner, tree->link_count, sizeof *robot->origin);
    robot->link_names = scene_alloc(owner, tree->link_count, sizeof *robot->link_names);
    robot->body_of_link = scene_alloc(owner, tree->link_count, sizeof *robot->body_of_link);
    for (unsigned i = 0; i < tree->link_count; i++) {
        const struct robot_link *link = &tree->links[i];
        const size_t n = robot->body_count;
        robot->body_of_link[i] = link->element_count > 0 ? (unsigned) n : ROBOT_NO_BODY;
        if (link->element_count == 0)
            continue;
        const struct fmb_body *body =
            robot_body(tree, link, &robot->options, owner, &robot->meshes, &robot->origin[n]);
        robot->bodies[n] =
            (struct fmb_placement){.body = body, .name = link->name->name, .id = (int64_t) n + 1};
        robot->link[n] = i;
        robot->link_names[n] = link->name->name;
        robot->body_count++;
        good = body && good;
    }
    return good;
}

/* ---- Ignored pairs ---- */

/* Finds which bodies are parts of one rigid body, and the pairs of a link's body and the body of
 * the nearest link above it that has one. In: `order` of the tree. */
static void find_neighbours(struct fmb_robot *robot)
{
    const struct robot *tree = &robot->tree;
    /* Of each link: its own body, or the body of the nearest link above it that has one; and the
     * topmost link of the rigid body that it is part of. */
    unsigned *body = allocate(tree->link_count, sizeof *body);
    unsigned *rigid = allocate(tree->link_count, sizeof *rigid);
    robot->rigid = scene_alloc(&robot->owner, robot->body_count, sizeof *robot->rigid);
    for (size_t i = 0; i < tree->link_count; i++) {
        const unsigned link = tree->order[i], own = robot->body_of_link[link],
                       j = tree->links[link].joint;
        const unsigned parent = j == ROBOT_ROOT ? 0 : tree->joints[j].link[0];
        const unsigned above = j == ROBOT_ROOT ? ROBOT_NO_BODY : body[parent];
        const bool fixed = j != ROBOT_ROOT && tree->joints[j].type == ROBOT_FIXED;
        rigid[link] = fixed ? rigid[parent] : link;
        body[link] = own != ROBOT_NO_BODY ? own : above;
        if (own != ROBOT_NO_BODY && above != ROBOT_NO_BODY)
            robot_pairs_add(&robot->ignored, above, own, ROBOT_NEIGHBOURS);
    }
    unsigned *first = body; /* [topmost link]: the first body of its rigid body */
    memset(first, 0xff, tree->link_count * sizeof *first);
    for (unsigned i = 0; i < robot->body_count; i++) {
        const unsigned top = rigid[robot->link[i]];
        first[top] = first[top] < i ? first[top] : i;
        robot->rigid[i] = first[top];
    }
    free(body);
    free(rigid);
    robot_pairs_sort(&robot->ignored);
}

/* ---- Joints ---- */

static void find_joints(struct fmb_robot *robot)
{
    const struct robot *tree = &robot->tree;
    robot->moving = scene_alloc(&robot->owner, tree->joint_count, sizeof *robot->moving);
    robot->joint_names = scene_alloc(&robot->owner, tree->joint_count, sizeof *robot->joint_names);
    for (unsigned j = 0; j < tree->joint_count; j++) {
        const struct robot_joint *joint = &tree->joints[j];
        if (joint->type == ROBOT_FIXED || joint->mimic_name)
            continue;
        robot->moving[robot->joint_count] = j;
        robot->joint_names[robot->joint_count++] = joint->name->name;
    }
}

/* ---- Functions of the header ---- */

static bool take_options(struct fmb_robot *robot, const struct fmb_robot_options *options)
{
    struct robot_lines *errors = &robot->tree.errors;
    robot->options = *options;
    robot->options.sides = options->sides ? options->sides : ENCLOSURE_SIDES;
    robot->srdf = options->srdf;
    robot->base = POSE_IDENTITY;
    bool good = true;
    for (int i = 0; i < 6; i++)
        good = good && isfinite(options->base[i]) &&
               (i < 3 || fabs(options->base[i]) <= TURN_RADIANS_MAX);
    if (good) {
        memcpy(robot->base.p, options->base, sizeof robot->base.p);
        memcpy(robot->base_rpy, options->base + 3, sizeof robot->base_rpy);
        pose_turn_rpy(options->base + 3, robot->base.q);
    } else {
        robot_say(errors, "base: expected finite numbers, angles up to %.0f radians",
                  TURN_RADIANS_MAX);
    }
    const int sides = robot->options.sides;
    if (sides < 4 || sides > ENCLOSURE_SIDES_MAX || sides % 4 != 0) {
        robot_say(errors, "sides: expected a multiple of 4 up to %d", (int) ENCLOSURE_SIDES_MAX);
        robot->options.sides = ENCLOSURE_SIDES;
        good = false;
    }
    if (!(options->excess >= 0 && options->excess < INFINITY)) {
        robot_say(errors, "excess: expected a finite number, 0 or more");
        robot->options.excess = 0;
        good = false;
    }
    return good;
}

int fmb_robot_read(const char *path, const struct fmb_robot_options *options,
                   struct fmb_robot **out)
{
    static const struct fmb_robot_options defaults;
    const locale_t locale = number_begin();
    struct fmb_robot *robot = *out = allocate(1, sizeof *robot);
    struct robot *tree = &robot->tree;
    bool good = robot_read(path, tree);
    good = take_options(robot, options ? options : &defaults) && good;
    good = make_bodies(robot) && good;
    if (good && robot->body_count == 0) {
        robot_say(&tree->errors, "%s: no link has a <collision> (<visual> is not read)",
                  tree->path);
        good = false;
    }
    if (good)
        find_neighbours(robot);
    if (robot->srdf && robot->body_count > 0)
        good = robot_read_srdf(robot) && good;
    if (good)
        find_joints(robot);
    if (tree->error_count > ROBOT_ERRORS_MAX)
        robot_say(&tree->errors, "%s: and %zu more errors", tree->path,
                  tree->error_count - ROBOT_ERRORS_MAX);
    robot_lines_text(&tree->errors);
    robot->bad = !good;
    number_end(locale);
    return good ? 0 : -1;
}

void fmb_robot_free(struct fmb_robot *robot)
{
    if (!robot)
        return;
    HASH_CLEAR(hh, robot->unknown);
    robot_clear(&robot->tree);
    scene_clear(&robot->owner);
    free(robot->ignored.pair);
    free(robot->enabled.pair);
    free(robot);
}

const char *fmb_robot_why(const struct fmb_robot *robot)
{
    return robot->tree.errors.out ? robot->tree.errors.text : "";
}

size_t fmb_robot_joints(const struct fmb_robot *robot, const char *const **names)
{
    if (names)
        *names = robot->joint_names;
    return robot->joint_count;
}

void fmb_robot_limits(const struct fmb_robot *robot, double *lower, double *upper)
{
    for (size_t i = 0; i < robot->joint_count; i++) {
        lower[i] = robot->tree.joints[robot->moving[i]].limit[0];
        upper[i] = robot->tree.joints[robot->moving[i]].limit[1];
    }
}

void fmb_robot_home(const struct fmb_robot *robot, double *q)
{
    for (size_t i = 0; i < robot->joint_count; i++)
        q[i] = robot_home(&robot->tree.joints[robot->moving[i]]);
}

size_t fmb_robot_links(const struct fmb_robot *robot, const char *const **names)
{
    if (names)
        *names = robot->link_names;
    return robot->body_count;
}

int fmb_robot_ignores(const struct fmb_robot *robot, size_t a, size_t b)
{
    return robot_pairs_has(&robot->ignored, (unsigned) a, (unsigned) b) ||
           (!robot->srdf && robot->rigid[a] == robot->rigid[b]);
}

double fmb_robot_excess(const struct fmb_robot *robot)
{
    return fmax(robot->owner.outside, robot->meshes.excess);
}
