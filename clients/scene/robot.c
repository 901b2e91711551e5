#include "robot.h"

#include "allocate.h"
#include "complain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool robot_numbers(const char *text, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || !isfinite(out[i]) || (*end && !strchr(" \t\r\n", *end)))
            return false;
        text = end;
    }
    return text[strspn(text, " \t\r\n")] == '\0';
}

/* ---- Names ---- */

struct robot_name *robot_add_name(struct robot *robot, struct robot_name **table, const char *name,
                                  const struct robot_name **first)
{
    struct robot_name *found, *entry;
    HASH_FIND(hh, *table, name, strlen(name), found);
    *first = found;
    if (found)
        return NULL;
    entry = scene_alloc(&robot->memory, 1, sizeof *entry);
    entry->name = scene_text(&robot->memory, name);
    entry->index = HASH_COUNT(*table);
    HASH_ADD_KEYPTR(hh, *table, entry->name, strlen(name), entry);
    return entry;
}

const struct robot_joint *robot_find_joint(const struct robot *robot, const char *name)
{
    const struct robot_name *found;
    HASH_FIND(hh, robot->joint_names, name, strlen(name), found);
    return found ? &robot->joints[found->index] : NULL;
}

void robot_clear(struct robot *robot)
{
    HASH_CLEAR(hh, robot->link_names);
    HASH_CLEAR(hh, robot->joint_names);
    free(robot->links);
    free(robot->joints);
    free(robot->elements);
    free(robot->order);
    scene_clear(&robot->memory);
}

/* ---- The tree ---- */

static bool connect_joint(struct robot *robot, struct robot_joint *joint)
{
    static const char *const ends[2] = {"parent", "child"};
    for (int end = 0; end < 2; end++) {
        const char *name = joint->link_names[end];
        const struct robot_name *found;
        HASH_FIND(hh, robot->link_names, name, strlen(name), found);
        if (!found) {
            complain("%s: line %lu: joint '%s': its %s '%s' is no link of the file", robot->path,
                     joint->name->line, joint->name->name, ends[end], name);
            return false;
        }
        joint->link[end] = found->index;
    }
    struct robot_link *child = &robot->links[joint->link[1]];
    if (child->joint != ROBOT_ROOT) {
        complain("%s: line %lu: joint '%s': its child '%s' is the child of joint '%s' already",
                 robot->path, joint->name->line, joint->name->name, child->name->name,
                 robot->joints[child->joint].name->name);
        return false;
    }
    child->joint = joint->name->index;
    return true;
}

/* Returns the first root from a link on, or link_count. */
static size_t find_root(const struct robot *robot, size_t link)
{
    while (link < robot->link_count && robot->links[link].joint != ROBOT_ROOT)
        link++;
    return link;
}

/* Sets order: a queue, to which the children of each link are added. Returns its length. */
static size_t set_order(struct robot *robot, size_t root)
{
    /* Lists of the joints of each parent, in the order of the file. */
    unsigned *first = allocate(robot->link_count, sizeof *first);
    unsigned *next = allocate(robot->joint_count, sizeof *next);
    size_t count = 0;
    memset(first, 0xff, robot->link_count * sizeof *first);
    for (size_t j = robot->joint_count; j-- > 0;) {
        unsigned *head = &first[robot->joints[j].link[0]];
        next[j] = *head;
        *head = (unsigned) j;
    }
    robot->order = allocate(robot->link_count, sizeof *robot->order);
    if (root < robot->link_count)
        robot->order[count++] = (unsigned) root;
    for (size_t at = 0; at < count; at++)
        for (unsigned j = first[robot->order[at]]; j != ROBOT_ROOT; j = next[j])
            robot->order[count++] = robot->joints[j].link[1];
    free(first);
    free(next);
    return count;
}

/* Reports a cycle of links. None of its links was reached from the root; from any other such link
 * the way up leads to a cycle, and link_count steps lead into it. */
static void complain_cycle(const struct robot *robot, size_t reached)
{
    unsigned char *seen = allocate(robot->link_count, 1);
    unsigned link = 0;
    for (size_t i = 0; i < reached; i++)
        seen[robot->order[i]] = 1;
    while (seen[link])
        link++;
    free(seen);
    for (size_t i = 0; i < robot->link_count; i++)
        link = robot->joints[robot->links[link].joint].link[0];
    const struct robot_name *joint = robot->joints[robot->links[link].joint].name;
    complain("%s: line %lu: joint '%s': the joints from '%s' lead back to it: expected a tree",
             robot->path, joint->line, joint->name, robot->links[link].name->name);
}

bool robot_connect(struct robot *robot)
{
    for (size_t i = 0; i < robot->joint_count; i++)
        if (!connect_joint(robot, &robot->joints[i]))
            return false;
    const size_t root = find_root(robot, 0), other = find_root(robot, root + 1);
    if (other < robot->link_count) {
        complain("%s: line %lu: link '%s' has no parent, and nor has link '%s': expected one root",
                 robot->path, robot->links[other].name->line, robot->links[other].name->name,
                 robot->links[root].name->name);
        return false;
    }
    const size_t reached = set_order(robot, root);
    if (reached < robot->link_count)
        complain_cycle(robot, reached);
    return reached == robot->link_count;
}

/* ---- Forward kinematics ---- */

void robot_place(const struct robot *robot, const double *value, struct pose *pose)
{
    for (size_t i = 0; i < robot->link_count; i++) {
        const unsigned link = robot->order[i], j = robot->links[link].joint;
        if (j == ROBOT_ROOT) {
            pose[link] = POSE_NONE;
            continue;
        }
        const struct robot_joint *joint = &robot->joints[j];
        struct pose motion = POSE_NONE;
        if (joint->type == ROBOT_PRISMATIC)
            for (int axis = 0; axis < 3; axis++)
                motion.p[axis] = joint->axis[axis] * value[j];
        else if (joint->type != ROBOT_FIXED)
            pose_turn(joint->axis, value[j], motion.q);
        const struct pose moved = pose_compose(&joint->origin, &motion);
        pose[link] = pose_compose(&pose[joint->link[0]], &moved);
    }
}
