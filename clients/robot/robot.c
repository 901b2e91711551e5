#include "robot.h"

#include "allocate.h"
#include "escape.h"
#include "turn.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ---- Lines ---- */

void robot_say(struct robot_lines *lines, const char *format, ...)
{
    enum { LINE_MAX_BYTES = 16384 };
    char line[LINE_MAX_BYTES];
    va_list list;
    va_start(list, format);
    vsnprintf(line, sizeof line, format, list);
    va_end(list);
    if (!lines->out && !(lines->out = open_memstream(&lines->text, &lines->size)))
        allocate_failed();
    else if (fflush(lines->out) == 0 && lines->size > 0)
        putc('\n', lines->out);
    escape_text(lines->out, line);
}

const char *robot_lines_text(struct robot_lines *lines)
{
    if (lines->out && fflush(lines->out) != 0)
        allocate_failed();
    return lines->out ? lines->text : "";
}

void robot_lines_clear(struct robot_lines *lines)
{
    if (lines->out)
        fclose(lines->out);
    free(lines->text);
    *lines = (struct robot_lines){.out = NULL};
}

void robot_begin(struct robot *robot, const char *kind, const char *name)
{
    robot->kind = kind;
    robot->within = name;
    robot->failed = false;
}

bool robot_refuse(struct robot *robot, unsigned long line, const char *format, ...)
{
    char text[ROBOT_TEXT_MAX];
    const char *kind = robot->kind ? robot->kind : "", *name = robot->kind ? robot->within : "";
    va_list list;
    if (robot->failed)
        return false;
    robot->failed = robot->bad = true;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (robot->error_count++ < ROBOT_ERRORS_MAX)
        robot_say(&robot->errors, *kind ? "%s: line %lu: %s '%s': %s" : "%s: line %lu%s%s: %s",
                  robot->file, line, kind, name, text);
    return false;
}

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
    robot_lines_clear(&robot->errors);
    scene_clear(&robot->memory);
}

/* ---- The tree ---- */

static bool connect_joint(struct robot *robot, struct robot_joint *joint)
{
    static const char *const ends[2] = {"parent", "child"};
    robot_begin(robot, "joint", joint->name->name);
    for (int end = 0; end < 2; end++) {
        const char *name = joint->link_names[end];
        const struct robot_name *found = NULL;
        if (name)
            HASH_FIND(hh, robot->link_names, name, strlen(name), found);
        if (name && !found)
            return robot_refuse(robot, joint->name->line, "its %s '%s' is not a link of the file",
                                ends[end], name);
        if (!found)
            return false; /* has been refused */
        joint->link[end] = found->index;
    }
    struct robot_link *child = &robot->links[joint->link[1]];
    if (child->joint != ROBOT_ROOT)
        return robot_refuse(robot, joint->name->line,
                            "its child '%s' is already the child of joint '%s'", child->name->name,
                            robot->joints[child->joint].name->name);
    child->joint = joint->name->index;
    return true;
}

/* A mimic joint follows one that is none, so that its value depends on one other. */
static bool connect_mimic(struct robot *robot, struct robot_joint *joint)
{
    const struct robot_joint *found = robot_find_joint(robot, joint->mimic_name);
    if (found && found->type != ROBOT_FIXED && !found->mimic_name) {
        joint->mimic = found->name->index;
        return true;
    }
    robot->failed = false;
    return robot_refuse(robot, joint->name->line, "<mimic>: '%.64s' is %s", joint->mimic_name,
                        !found ? "not a joint of the file"
                        : !found->mimic_name
                            ? "a fixed joint"
                            : "itself a mimic joint: name the joint that it follows");
}

/* Sets the number of joints from the root to each link. Returns false if there is a cycle, or a
 * second root. */
static bool find_depths(struct robot *robot, size_t *depth)
{
    unsigned root = 0;
    for (unsigned i = 0; i < robot->link_count; i++) {
        unsigned up = i;
        while (robot->links[up].joint != ROBOT_ROOT && depth[i] < robot->link_count) {
            up = robot->joints[robot->links[up].joint].link[0];
            depth[i]++;
        }
        const struct robot_link *top = &robot->links[up];
        if (top->joint != ROBOT_ROOT) { /* a path this long runs into a cycle */
            const struct robot_name *joint = robot->joints[top->joint].name;
            robot_begin(robot, "joint", joint->name);
            return robot_refuse(robot, joint->line,
                                "the joints from '%s' lead back to it: expected a tree",
                                top->name->name);
        }
        if (i > 0 && up != root)
            return robot_refuse(
                robot, top->name->line,
                "link '%s' has no parent, and neither has link '%s': expected one root: "
                "connect them by a fixed joint",
                top->name->name, robot->links[root].name->name);
        root = up;
    }
    return true;
}

bool robot_connect(struct robot *robot)
{
    const size_t count = robot->link_count;
    size_t *depth = scene_alloc(&robot->memory, count, sizeof *depth), placed = 0;
    bool good = !robot->bad;
    for (size_t i = 0; i < robot->joint_count; i++) {
        struct robot_joint *joint = &robot->joints[i];
        good = connect_joint(robot, joint) && good;
        good = (!joint->mimic_name || connect_mimic(robot, joint)) && good;
    }
    robot_begin(robot, NULL, NULL);
    if (!good || !find_depths(robot, depth))
        return false;
    robot->order = scene_alloc(&robot->memory, count, sizeof *robot->order);
    for (size_t d = 0; placed < count; d++)
        for (unsigned i = 0; i < count; i++)
            if (depth[i] == d)
                robot->order[placed++] = i;
    return true;
}

/* ---- Values of joints ---- */

double robot_home(const struct robot_joint *joint)
{
    const double *limit = joint->limit;
    return limit[0] <= 0 && limit[1] >= 0 ? 0 : limit[0] / 2 + limit[1] / 2;
}

double robot_mimic(const struct robot_joint *joint, const double *value)
{
    return joint->multiplier * value[joint->mimic] + joint->offset;
}

void robot_follow(const struct robot *robot, const bool *given, double *value)
{
    for (size_t j = 0; j < robot->joint_count; j++) {
        const struct robot_joint *joint = &robot->joints[j];
        if (joint->mimic_name && !(given && given[j]))
            value[j] = robot_mimic(joint, value);
    }
}

const char *robot_refuse_value(const struct robot_joint *joint, double value)
{
    const bool turns = joint->type != ROBOT_PRISMATIC && joint->type != ROBOT_FIXED;
    if (!isfinite(value))
        return "is not finite";
    return turns && fabs(value) > TURN_RADIANS_MAX ? "is beyond 1048576 radians" : NULL;
}

/* ---- Forward kinematics ---- */

void robot_limit_length(double q[4])
{
    static const double longest = 0x1p60;
    double most = 0;
    for (int i = 0; i < 4; i++)
        most = fmax(most, fabs(q[i]));
    if (most > longest || most < 1 / longest)
        turn_scale(q);
}

void robot_place(const struct robot *robot, const struct pose *base, const double *value,
                 struct pose *pose)
{
    for (size_t i = 0; i < robot->link_count; i++) {
        const unsigned link = robot->order[i], j = robot->links[link].joint;
        if (j == ROBOT_ROOT) {
            pose[link] = *base;
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
        robot_limit_length(pose[link].q);
    }
}
