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
            complain("%s: line %lu: joint '%s': its %s '%s' is not a link of the file", robot->path,
                     joint->name->line, joint->name->name, ends[end], name);
            return false;
        }
        joint->link[end] = found->index;
    }
    struct robot_link *child = &robot->links[joint->link[1]];
    if (child->joint != ROBOT_ROOT) {
        complain("%s: line %lu: joint '%s': its child '%s' is already the child of joint '%s'",
                 robot->path, joint->name->line, joint->name->name, child->name->name,
                 robot->joints[child->joint].name->name);
        return false;
    }
    child->joint = joint->name->index;
    return true;
}

/* A mimic joint follows one that is none, so that its value depends on one other. */
static bool connect_mimic(const struct robot *robot, struct robot_joint *joint)
{
    const struct robot_joint *found = robot_find_joint(robot, joint->mimic_name);
    if (found && found->type != ROBOT_FIXED && !found->mimic_name) {
        joint->mimic = found->name->index;
        return true;
    }
    complain("%s: line %lu: joint '%s': <mimic>: '%.64s' is %s", robot->path, joint->name->line,
             joint->name->name, joint->mimic_name,
             !found               ? "not a joint of the file"
             : !found->mimic_name ? "a fixed joint"
                                  : "itself a mimic joint: name the joint that it follows");
    return false;
}

bool robot_connect(struct robot *robot)
{
    const size_t count = robot->link_count;
    size_t *depth = scene_alloc(&robot->memory, count, sizeof *depth), placed = 0;
    unsigned root = 0;
    bool good = true;
    for (size_t i = 0; i < robot->joint_count; i++) {
        struct robot_joint *joint = &robot->joints[i];
        good = connect_joint(robot, joint) && good;
        good = (!joint->mimic_name || connect_mimic(robot, joint)) && good;
    }
    if (!good)
        return false;
    for (unsigned i = 0; i < count; i++) {
        unsigned up = i;
        while (robot->links[up].joint != ROBOT_ROOT && depth[i] < count) {
            up = robot->joints[robot->links[up].joint].link[0];
            depth[i]++;
        }
        const struct robot_link *top = &robot->links[up];
        if (top->joint != ROBOT_ROOT) { /* a path this long runs into a cycle */
            const struct robot_name *joint = robot->joints[top->joint].name;
            complain(
                "%s: line %lu: joint '%s': the joints from '%s' lead back to it: expected a "
                "tree",
                robot->path, joint->line, joint->name, top->name->name);
            return false;
        }
        if (i > 0 && up != root) {
            complain(
                "%s: line %lu: link '%s' has no parent, and neither has link '%s': expected one "
                "root: connect them by a fixed joint",
                robot->path, top->name->line, top->name->name, robot->links[root].name->name);
            return false;
        }
        root = up;
    }
    robot->order = scene_alloc(&robot->memory, count, sizeof *robot->order);
    for (size_t d = 0; placed < count; d++)
        for (unsigned i = 0; i < count; i++)
            if (depth[i] == d)
                robot->order[placed++] = i;
    return true;
}

/* ---- Forward kinematics ---- */

void robot_place(const struct robot *robot, const double *value, struct pose *pose)
{
    for (size_t i = 0; i < robot->link_count; i++) {
        const unsigned link = robot->order[i], j = robot->links[link].joint;
        if (j == ROBOT_ROOT) {
            pose[link] = POSE_IDENTITY;
            continue;
        }
        const struct robot_joint *joint = &robot->joints[j];
        struct pose motion = POSE_IDENTITY;
        if (joint->type == ROBOT_PRISMATIC)
            for (int axis = 0; axis < 3; axis++)
                motion.p[axis] = joint->axis[axis] * value[j];
        else if (joint->type != ROBOT_FIXED)
            pose_turn(joint->axis, value[j], motion.q);
        const struct pose moved = pose_compose(&joint->origin, &motion);
        pose[link] = pose_compose(&pose[joint->link[0]], &moved);
    }
}
