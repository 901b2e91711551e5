/* Reads robots: URDF (links and joints; <visual>, <inertial>, <gazebo> and others are ignored), and
 * SRDF (pairs of links that are not tested; <group>, <end_effector> and others are ignored).
 *
 * Links, joints and elements are bounded (robot.h). As in MoveIt, <disable_collisions> has
 * precedence over <enable_collisions>, and both over <disable_default_collisions>, which disables
 * all pairs of a link. */
#include "robot_scene.h"
#include "xml.h"

#include "allocate.h"
#include "query.h"
#include "turn.h"
#include "utf8.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Files and their elements ---- */

/* Reads a file, or its first bytes if it has more than ROBOT_BYTES_MAX. Check ferror(). */
static unsigned char *read_bytes(FILE *file, struct owned_scene *memory, size_t *size)
{
    unsigned char *bytes = NULL;
    size_t capacity = 0;
    *size = 0;
    while (!feof(file) && !ferror(file) && *size <= ROBOT_BYTES_MAX) {
        bytes = allocate_grow(bytes, &capacity, *size + BUFSIZ, 1);
        *size += fread(bytes + *size, 1, capacity - *size, file);
    }
    unsigned char *out = scene_alloc(memory, *size, 1);
    if (*size > 0)
        memcpy(out, bytes, *size);
    free(bytes);
    return out;
}

/* Reads a file of at most ROBOT_BYTES_MAX; "-" is standard input. Returns the outermost element,
 * which belongs to the robot; NULL after an error: the file cannot be read, is not XML, or is
 * xacro. */
static const struct xml_element *open_file(struct robot *robot, const char *path)
{
    const bool named = strcmp(path, "-") != 0;
    FILE *file = named ? fopen(path, "r") : stdin;
    size_t size = 0;
    unsigned char *bytes = file ? read_bytes(file, &robot->memory, &size) : NULL;
    const char *why = !file || ferror(file)    ? strerror(errno)
                      : size > ROBOT_BYTES_MAX ? "more than 8 MB"
                                               : NULL;
    struct xml_error error;
    robot->file = named ? path : "standard input";
    robot_begin(robot, NULL, NULL);
    if (named && file)
        fclose(file);
    if (why) {
        robot_say(&robot->errors, "%s: %s", robot->file, why);
        robot->bad = true;
        return NULL;
    }
    const struct xml_element *root = xml_parse(bytes, size, &robot->memory, &error);
    if (!root)
        robot_refuse(robot, error.line, "%s", error.text);
    for (const struct xml_element *at = root; at; at = xml_next(at))
        if (strncmp(at->name, "xacro:", 6) == 0)
            robot_refuse(robot, at->line, "<%.64s>: expand the file with xacro first", at->name);
    return robot->failed ? NULL : root;
}

/* Returns the only element of this name in a parent, or NULL. */
static const struct xml_element *only_child(struct robot *robot, const struct xml_element *parent,
                                            const char *name)
{
    const struct xml_element *found = xml_child(parent, name);
    for (const struct xml_element *other = found ? found->next : NULL; other; other = other->next)
        if (xml_is(other, name))
            robot_refuse(robot, other->line, "there is a second <%s>", name);
    return found;
}

/* Returns the value of an attribute; NULL if it is missing, which is an error if it is required. An
 * empty value and an expression of xacro are errors. */
static const char *attribute(struct robot *robot, const struct xml_element *element,
                             const char *name, bool required)
{
    const char *value = xml_attribute(element, name);
    if (!value && required)
        robot_refuse(robot, element->line, "<%s> has no %s", element->name, name);
    else if (value && !*value)
        robot_refuse(robot, element->line, "<%s>: %s is empty", element->name, name);
    else if (value && (strstr(value, "${") || strstr(value, "$(")))
        robot_refuse(robot, element->line, "<%s>: %s is '%.64s': expand the file with xacro first",
                     element->name, name, value);
    return value && *value ? value : NULL;
}

/* ---- Attributes of URDF ---- */

/* Reads count numbers. A missing attribute leaves out unchanged. */
static void read_numbers(struct robot *robot, const struct xml_element *node, const char *name,
                         bool required, int count, double *out)
{
    const char *value = attribute(robot, node, name, required);
    if (value && !robot_numbers(value, count, out))
        robot_refuse(robot, node->line, "<%s>: %s is '%.64s', expected %d finite number%s",
                     node->name, name, value, count, count > 1 ? "s, separated by spaces" : "");
}

static void read_sizes(struct robot *robot, const struct xml_element *node, const char *name,
                       int count, double *out)
{
    read_numbers(robot, node, name, true, count, out);
    for (int i = 0; i < count; i++)
        if (out[i] < 0)
            robot_refuse(robot, node->line, "<%s>: %s is negative", node->name, name);
}

/* Reads a pose: xyz, and rpy or, in URDF 1.1, quat_xyzw, which may have any length. rpy: receives
 * the angles, or NAN if there is a quaternion. */
static void read_origin(struct robot *robot, const struct xml_element *parent, struct pose *out,
                        double rpy[3])
{
    const struct xml_element *node = only_child(robot, parent, "origin");
    double q[4] = {0};
    *out = POSE_IDENTITY;
    memset(rpy, 0, 3 * sizeof *rpy);
    if (!node)
        return;
    const bool has_rpy = xml_attribute(node, "rpy"), has_q = xml_attribute(node, "quat_xyzw");
    for (const char **at = node->attributes; *at; at += 2)
        if (strcmp(at[0], "xyz") != 0 && strcmp(at[0], "rpy") != 0 &&
            strcmp(at[0], "quat_xyzw") != 0)
            robot_refuse(robot, node->line,
                         "<origin>: %.64s is not supported: give xyz, and rpy or "
                         "quat_xyzw",
                         at[0]);
    read_numbers(robot, node, "xyz", false, 3, out->p);
    read_numbers(robot, node, "rpy", false, 3, rpy);
    read_numbers(robot, node, "quat_xyzw", false, 4, q);
    for (int i = 0; i < 3; i++)
        if (fabs(rpy[i]) > TURN_RADIANS_MAX)
            robot_refuse(robot, node->line, "<origin>: rpy is beyond %.0f radians",
                         TURN_RADIANS_MAX);
    if (has_q && has_rpy)
        robot_refuse(robot, node->line, "<origin> has both rpy and quat_xyzw");
    else if (has_q && q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
        robot_refuse(robot, node->line, "<origin>: quat_xyzw is 0, which is no rotation");
    if (robot->failed)
        return;
    if (has_q) {
        memcpy(out->q, (const double[]){q[3], q[0], q[1], q[2]}, sizeof out->q);
        robot_limit_length(out->q);
        rpy[0] = NAN;
    } else {
        pose_turn_rpy(rpy, out->q);
    }
}

/* Begins to read a link or a joint: adds its name to the table. Returns NULL after an error. */
static const struct robot_name *begin(struct robot *robot, const struct xml_element *node,
                                      struct robot_name **table)
{
    const char *name = attribute(robot, node, "name", true);
    const struct robot_name *first;
    struct robot_name *added = NULL;
    if (!name)
        return NULL;
    if (HASH_COUNT(*table) == ROBOT_COUNT_MAX)
        robot_refuse(robot, node->line, "more than %d <%s> elements", (int) ROBOT_COUNT_MAX,
                     node->name);
    else if (!query_name_ok(name))
        robot_refuse(robot, node->line,
                     "<%s>: the name '%.80s' has more than %d bytes, or is not UTF-8 without "
                     "control characters",
                     node->name, name, (int) QUERY_NAME_MAX);
    else if (!(added = robot_add_name(robot, table, name, &first)))
        robot_refuse(robot, node->line, "there is already a %s '%s', in line %lu", node->name, name,
                     first->line);
    if (!added)
        return NULL;
    added->line = node->line;
    robot_begin(robot, node->name, added->name);
    return added;
}

/* ---- Links ---- */

static void read_shape(struct robot *robot, const struct xml_element *node,
                       struct robot_element *out)
{
    if (xml_is(node, "box")) {
        out->shape = ROBOT_BOX;
        read_sizes(robot, node, "size", 3, out->size);
    } else if (xml_is(node, "cylinder") || xml_is(node, "capsule")) {
        out->shape = xml_is(node, "cylinder") ? ROBOT_CYLINDER : ROBOT_CAPSULE;
        read_sizes(robot, node, "radius", 1, &out->size[0]);
        read_sizes(robot, node, "length", 1, &out->size[1]);
    } else if (xml_is(node, "sphere")) {
        out->shape = ROBOT_CAPSULE;
        read_sizes(robot, node, "radius", 1, out->size);
    } else if (xml_is(node, "mesh")) {
        out->shape = ROBOT_MESH;
        out->file = attribute(robot, node, "filename", true);
        out->size[0] = out->size[1] = out->size[2] = 1;
        read_numbers(robot, node, "scale", false, 3, out->size);
    } else {
        robot_refuse(robot, node->line,
                     "<%.64s>: expected a box, cylinder, sphere, capsule or mesh", node->name);
    }
}

/* Returns the first of a list of elements whose name has no prefix of another namespace, or NULL.
 */
static const struct xml_element *skip_foreign(const struct xml_element *node)
{
    while (node && strchr(node->name, ':'))
        node = node->next;
    return node;
}

static void read_collision(struct robot *robot, const struct xml_element *node)
{
    const struct xml_element *geometry = only_child(robot, node, "geometry");
    const struct xml_element *first = geometry ? geometry->child : NULL, *own = skip_foreign(first);
    const struct xml_element *second = own ? skip_foreign(own->next) : NULL,
                             *shape = own ? own : first;
    if (robot->element_count == ROBOT_COUNT_MAX)
        robot_refuse(robot, node->line, "more than %d <collision> elements", (int) ROBOT_COUNT_MAX);
    if (!shape)
        robot_refuse(robot, node->line, "<collision> has no <geometry> with a shape");
    else if (second)
        robot_refuse(robot, second->line, "<%.64s>: there is already a shape", second->name);
    if (robot->failed)
        return;
    robot->elements = allocate_grow(robot->elements, &robot->element_capacity,
                                    robot->element_count + 1, sizeof *robot->elements);
    struct robot_element *element = &robot->elements[robot->element_count];
    *element = (struct robot_element){.line = node->line};
    double rpy[3];
    read_origin(robot, node, &element->origin, rpy);
    read_shape(robot, shape, element);
    robot->element_count += !robot->failed;
}

static void read_link(struct robot *robot, const struct xml_element *node)
{
    const struct robot_name *name = begin(robot, node, &robot->link_names);
    const size_t first = robot->element_count;
    if (!name)
        return;
    for (const struct xml_element *child = node->child; child; child = child->next)
        if (xml_is(child, "collision")) {
            read_collision(robot, child);
            robot->failed = false; /* the others are read too */
        }
    robot->links = allocate_grow(robot->links, &robot->link_capacity, robot->link_count + 1,
                                 sizeof *robot->links);
    robot->links[robot->link_count++] =
        (struct robot_link){.name = name,
                            .element = first,
                            .element_count = robot->element_count - first,
                            .joint = ROBOT_ROOT};
}

/* ---- Joints ---- */

static void read_type(struct robot *robot, const struct xml_element *node, struct robot_joint *out)
{
    static const char *const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    const char *type = attribute(robot, node, "type", true);
    for (int i = 0; type && i < 4; i++)
        if (strcmp(types[i], type) == 0) {
            out->type = (enum robot_joint_type) i;
            return;
        }
    robot_refuse(
        robot, node->line,
        "its type is '%.64s', expected revolute, continuous, prismatic or fixed (in place of "
        "planar or floating: a chain of these)",
        type ? type : "");
}

/* Components are first divided by the largest one, so that the length does not overflow. */
static void read_axis(struct robot *robot, const struct xml_element *node, struct robot_joint *out)
{
    double most = 0, square = 0;
    read_numbers(robot, node, "xyz", true, 3, out->axis);
    memcpy(out->given_axis, out->axis, sizeof out->axis);
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(out->axis[i]));
    for (int i = 0; i < 3; i++)
        square += (out->axis[i] / most) * (out->axis[i] / most);
    for (int i = 0; i < 3; i++)
        out->axis[i] = out->axis[i] / most / sqrt(square);
    if (most == 0 && out->type != ROBOT_FIXED)
        robot_refuse(robot, node->line, "<axis>: xyz is 0");
}

static void read_joint(struct robot *robot, const struct xml_element *node)
{
    static const char *const ends[2] = {"parent", "child"};
    struct robot_joint joint = {.name = begin(robot, node, &robot->joint_names),
                                .axis = {1, 0, 0},
                                .given_axis = {1, 0, 0},
                                .limit = {-INFINITY, INFINITY},
                                .multiplier = 1};
    if (!joint.name)
        return;
    read_type(robot, node, &joint);
    read_origin(robot, node, &joint.origin, joint.rpy);
    const struct xml_element *axis = only_child(robot, node, "axis"),
                             *limit = only_child(robot, node, "limit"),
                             *mimic = only_child(robot, node, "mimic");
    for (int end = 0; end < 2; end++) {
        const struct xml_element *link = only_child(robot, node, ends[end]);
        const char *name = link ? attribute(robot, link, "link", true) : NULL;
        if (!link)
            robot_refuse(robot, node->line, "there is no <%s>", ends[end]);
        else if (name && !utf8_is_text(name))
            robot_refuse(robot, link->line, "<%s>: the link '%.80s' has control characters",
                         ends[end], name);
        joint.link_names[end] = robot->failed ? NULL : name;
    }
    if (axis)
        read_axis(robot, axis, &joint);
    if (mimic && joint.type != ROBOT_FIXED) {
        joint.mimic_name = attribute(robot, mimic, "joint", true);
        read_numbers(robot, mimic, "multiplier", false, 1, &joint.multiplier);
        read_numbers(robot, mimic, "offset", false, 1, &joint.offset);
        joint.mimic_name = robot->failed ? NULL : joint.mimic_name;
    }
    if (joint.type == ROBOT_REVOLUTE || joint.type == ROBOT_PRISMATIC) {
        joint.limit[0] = joint.limit[1] = 0;
        if (limit) {
            read_numbers(robot, limit, "lower", false, 1, &joint.limit[0]);
            read_numbers(robot, limit, "upper", false, 1, &joint.limit[1]);
        } else {
            robot_refuse(robot, node->line,
                         "there is no <limit>, which a joint of this type needs");
        }
        if (!(joint.limit[0] <= joint.limit[1]))
            robot_refuse(robot, limit->line,
                         "<limit>: lower is above upper: exchange them, or make a "
                         "joint without limits continuous");
    }
    robot->joints = allocate_grow(robot->joints, &robot->joint_capacity, robot->joint_count + 1,
                                  sizeof *robot->joints);
    robot->joints[robot->joint_count++] = joint;
}

/* ---- A file of URDF ---- */

static void read_robot(struct robot *robot, const struct xml_element *root)
{
    static const char *const srdf[] = {"group", "group_state", "virtual_joint",
                                       "disable_collisions"};
    bool found = false;
    if (!xml_is(root, "robot"))
        robot_refuse(robot, root->line,
                     "expected <robot>, found <%.64s>: SDF and others are not supported: give the "
                     "robot as URDF",
                     root->name);
    const char *title = attribute(robot, root, "name", false);
    if (title)
        robot->title = title;
    for (const struct xml_element *node = root->child; node && !robot->failed; node = node->next) {
        for (size_t i = 0; i < sizeof srdf / sizeof *srdf; i++)
            if (xml_is(node, srdf[i]))
                robot_refuse(robot, node->line,
                             "<%s>: this is SRDF: give it by --srdf, and the "
                             "robot as URDF",
                             node->name);
        if (robot->failed)
            return;
        found = found || xml_is(node, "link");
        if (xml_is(node, "link"))
            read_link(robot, node);
        else if (xml_is(node, "joint"))
            read_joint(robot, node);
        robot_begin(robot, NULL, NULL); /* the others are read too */
    }
    if (!found)
        robot_refuse(robot, root->line, "<robot> has no <link>");
}

bool robot_read(const char *path, struct robot *out)
{
    *out = (struct robot){.title = ""};
    out->path = scene_text(&out->memory, strcmp(path, "-") == 0 ? "standard input" : path);
    const struct xml_element *root = open_file(out, path);
    if (root)
        read_robot(out, root);
    return root && robot_connect(out);
}

/* ---- SRDF ---- */

struct srdf {
    struct fmb_robot *robot;
    size_t known;                /* names of links that the robot has */
    struct robot_pairs disabled; /* pairs, sorted at the end */
};

/* Returns the body of the link that an attribute names; ROBOT_NO_BODY if it has none, or after an
 * error, or if the robot has no such link, which is counted. */
static unsigned read_body(struct srdf *srdf, const struct xml_element *node, const char *name_of)
{
    struct robot *tree = &srdf->robot->tree;
    const char *name = attribute(tree, node, name_of, true);
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
    const struct xml_element *root = open_file(tree, robot->srdf);
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
