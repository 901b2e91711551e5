/* Reads SRDF: which pairs of links are not tested. All else (<group>, <end_effector>, ...) is
 * ignored. As in MoveIt, <disable_collisions> has precedence over <enable_collisions>, and both
 * over <disable_default_collisions>, which disables all pairs of a link. */
#include "robot_scene.h"
#include "urdf_reader.h"

#include "allocate.h"
#include "utf8.h"

#include <stdlib.h>
#include <string.h>

struct srdf {
    struct fmb_robot *robot;
    size_t known;                /* names of links that the robot has */
    struct robot_pairs disabled; /* pairs, sorted at the end */
};

/* Returns the body of the link that an attribute names; ROBOT_NO_BODY if it has none, or after an
 * error, or if the robot has no such link, which is counted. */
static unsigned read_body(struct srdf *srdf, const struct xml_element *node, const char *attribute)
{
    struct robot *tree = &srdf->robot->tree;
    const char *name = urdf_attribute(tree, node, attribute, true);
    const struct robot_name *found, *first;
    if (!name)
        return ROBOT_NO_BODY;
    HASH_FIND(hh, tree->link_names, name, strlen(name), found);
    srdf->known += found != NULL;
    if (found)
        return srdf->robot->body_of_link[found->index];
    robot_add_name(tree, &srdf->robot->unknown, name, &first);
    return ROBOT_NO_BODY;
}

static void read_pair(struct srdf *srdf, const struct xml_element *node, struct robot_pairs *out)
{
    const unsigned a = read_body(srdf, node, "link1"), b = read_body(srdf, node, "link2");
    if (a != ROBOT_NO_BODY && b != ROBOT_NO_BODY && a != b)
        robot_pairs_add(out, a, b, ROBOT_SRDF);
}

static void read_default(struct srdf *srdf, const struct xml_element *node)
{
    struct fmb_robot *robot = srdf->robot;
    const unsigned body = read_body(srdf, node, "link");
    if (body == ROBOT_NO_BODY)
        return;
    if (!robot->untested)
        robot->untested = scene_alloc(&robot->owner, robot->body_count, sizeof *robot->untested);
    robot->untested[body] = true;
}

static void read_elements(struct srdf *srdf, const struct xml_element *root)
{
    struct robot *tree = &srdf->robot->tree;
    if (!xml_is(root, "robot"))
        robot_refuse(tree, root->line, "expected <robot>, found <%.64s>: give a file of SRDF",
                     root->name);
    for (const struct xml_element *node = root->child; node && !tree->failed; node = node->next) {
        if (xml_is(node, "link") || xml_is(node, "joint")) {
            robot_refuse(tree, node->line, "<%s>: this is URDF: --srdf takes a file of SRDF",
                         node->name);
            return;
        }
        if (xml_is(node, "disable_collisions"))
            read_pair(srdf, node, &srdf->disabled);
        else if (xml_is(node, "enable_collisions"))
            read_pair(srdf, node, &srdf->robot->enabled);
        else if (xml_is(node, "disable_default_collisions"))
            read_default(srdf, node);
        tree->failed = false; /* the others are read too */
    }
}

/* Adds the pairs of links whose collisions are disabled by default. */
static bool add_defaults(struct srdf *srdf)
{
    enum { PAIRS_MAX = 1 << 20 };
    const struct fmb_robot *robot = srdf->robot;
    for (unsigned a = 0; robot->untested && a < robot->body_count; a++)
        for (unsigned b = 0; robot->untested[a] && b < robot->body_count; b++) {
            if (a == b || (b < a && robot->untested[b]) || robot_pairs_has(&robot->enabled, a, b))
                continue;
            if (srdf->disabled.count == PAIRS_MAX) {
                robot_say(&srdf->robot->tree.errors,
                          "%s: <disable_default_collisions>: more than %d pairs", srdf->robot->srdf,
                          (int) PAIRS_MAX);
                return false;
            }
            robot_pairs_add(&srdf->disabled, a, b, ROBOT_SRDF_DEFAULT);
        }
    return true;
}

/* Counts the neighbours that are tested, since the file does not disable them. */
static size_t count_unlisted(const struct fmb_robot *robot, const struct robot_pairs *disabled)
{
    size_t count = 0;
    for (size_t i = 0; i < robot->ignored.count; i++)
        count += !robot_pairs_has(disabled, robot->ignored.pair[i].a, robot->ignored.pair[i].b);
    return count;
}

bool robot_read_srdf(struct fmb_robot *robot)
{
    struct srdf srdf = {.robot = robot};
    struct robot *tree = &robot->tree;
    const struct xml_element *root = urdf_open(tree, robot->srdf);
    if (root)
        read_elements(&srdf, root);
    bool good = !tree->bad;
    if (good && srdf.known == 0 && robot->unknown) {
        robot_say(&robot->tree.errors,
                  "%s: no link that it names is one of %s: is it of another robot?", robot->srdf,
                  robot->tree.path);
        good = false;
    }
    robot_pairs_sort(&robot->enabled);
    good = good && add_defaults(&srdf);
    robot_pairs_sort(&srdf.disabled);
    robot->unlisted = count_unlisted(robot, &srdf.disabled);
    free(robot->ignored.pair);
    robot->ignored = srdf.disabled;
    return good;
}
