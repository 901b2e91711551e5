/* Reads a robot, a table of joint values, and a mesh, separated by zero bytes, as files; the second
 * as SRDF and as a world too. What is refused is reported. What is read is a tree whose poses are
 * rotations; its scene is valid, and reads back the same. */
#define _GNU_SOURCE /* memfd_create */
#include "fuzz.h"

#include "joints.h"
#include "json.h"
#include "robot_run.h"
#include "same_scene.h"
#include "scene_json.h"
#include "turn.h"
#include "utf8.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* ---- Files, which have no names: a robot may name the third as "102" ---- */

enum { ROBOT = 100, TABLE, MESH, WRITTEN, FILES_END };

static const char *const paths[] = {"/proc/self/fd/100", "/proc/self/fd/101"};

static void write_file(int fd, const uint8_t *bytes, size_t size)
{
    FUZZ_CHECK(ftruncate(fd, 0) == 0 && pwrite(fd, bytes, size, 0) == (ssize_t) size);
}

static void write_files(const uint8_t *data, size_t size)
{
    static bool open;
    for (int fd = ROBOT; fd < FILES_END && !open; fd++) {
        const int file = memfd_create("", 0);
        FUZZ_CHECK(file >= 0 && dup2(file, fd) == fd);
        close(file);
    }
    open = true;
    for (int fd = ROBOT; fd <= MESH; fd++) {
        const uint8_t *end = fd < MESH && size > 0 ? memchr(data, 0, size) : NULL;
        const size_t count = end ? (size_t) (end - data) : size;
        write_file(fd, data, count);
        data += end ? count + 1 : count;
        size -= end ? count + 1 : count;
    }
}

/* ---- Messages ---- */

static FILE *messages, *usual;
static char *text;
static size_t length;

static void begin_messages(void)
{
    messages = open_memstream(&text, &length);
    FUZZ_CHECK(messages);
    usual = stderr;
    stderr = messages;
}

/* Returns the number of lines, and checks that they are text. */
static int end_messages(void)
{
    int lines = 0;
    stderr = usual;
    FUZZ_CHECK(fclose(messages) == 0);
    for (const char *at = text; *at; lines++) {
        FUZZ_CHECK(strncmp(at, "fmb: ", 5) == 0);
        for (; *at != '\n'; at++)
            FUZZ_CHECK((unsigned char) *at >= ' ' && *at != 0x7f);
        at++;
    }
    free(text);
    return lines;
}

/* ---- Robots ---- */

static bool is_finite(const double *number, int count)
{
    bool good = true;
    for (int i = 0; i < count; i++)
        good = good && isfinite(number[i]);
    return good;
}

/* Quaternions may be given: they have any length within the bounds of pose.h. */
static bool is_rotation(const double q[4])
{
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return square > 0x1p-200 && square < 0x1p200;
}

static void check_robot(const struct robot *robot)
{
    bool *seen = fuzz_room(robot->link_count);
    memset(seen, 0, robot->link_count);
    FUZZ_CHECK(robot->link_count >= 1 && robot->joint_count == robot->link_count - 1);
    for (size_t i = 0; i < robot->link_count; i++) {
        const unsigned link = robot->order[i], joint = robot->links[link].joint;
        FUZZ_CHECK(!seen[link] && (joint == ROBOT_ROOT) == (i == 0));
        FUZZ_CHECK(i == 0 || seen[robot->joints[joint].link[0]]);
        FUZZ_CHECK(utf8_is_text(robot->links[link].name->name));
        seen[link] = true;
    }
    for (size_t i = 0; i < robot->joint_count; i++) {
        const struct robot_joint *joint = &robot->joints[i];
        const double *a = joint->axis, n = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
        FUZZ_CHECK(joint->limit[0] <= joint->limit[1] && is_rotation(joint->origin.q));
        FUZZ_CHECK(is_finite(joint->origin.p, 3));
        FUZZ_CHECK(joint->type == ROBOT_FIXED || fabs(n - 1) < 1e-15 * 8);
        FUZZ_CHECK(robot_find_joint(robot, joint->name->name) == joint);
        FUZZ_CHECK(!joint->mimic_name || !robot->joints[joint->mimic].mimic_name);
    }
    for (size_t i = 0; i < robot->element_count; i++) {
        const struct robot_element *element = &robot->elements[i];
        FUZZ_CHECK(is_finite(element->size, 3) && is_finite(element->origin.p, 3));
        FUZZ_CHECK(is_rotation(element->origin.q));
        for (int k = 0; k < 3; k++)
            FUZZ_CHECK(element->shape == ROBOT_MESH || element->size[k] >= 0);
    }
    free(seen);
}

static void check_poses(const struct robot *robot, const double *value)
{
    struct pose *pose = fuzz_room(robot->link_count * sizeof *pose);
    robot_place(robot, &POSE_IDENTITY, value, pose);
    for (size_t i = 0; i < robot->link_count; i++)
        FUZZ_CHECK(is_rotation(pose[i].q));
    free(pose);
}

/* ---- Scenes ---- */

static void check_scene(struct fmb_robot_scene *scene)
{
    struct owned_scene again;
    FILE *out = fdopen(dup(WRITTEN), "w");
    FUZZ_CHECK(out && fmb_scene_check(&scene->owner.scene, NULL, 0) == FMB_OK);
    write_file(WRITTEN, NULL, 0);
    rewind(out);
    scene_json_write(out, &scene->owner);
    FUZZ_CHECK(fclose(out) == 0 && lseek(WRITTEN, 0, SEEK_SET) == 0);
    struct json_reader *reader = json_open(WRITTEN);
    FUZZ_CHECK(json_next(reader, &again) == JSON_SCENE);
    FUZZ_CHECK(same_scene(&scene->owner, &again));
    scene_clear(&again);
    FUZZ_CHECK(json_next(reader, &again) == JSON_END);
    json_close(reader);
}

/* Whether a text is lines without control characters; "" is none. */
static bool is_lines(const char *lines)
{
    for (; *lines; lines++)
        if ((unsigned char) *lines < ' ' && *lines != '\n')
            return false;
    return true;
}

/* The scene of a robot at home and in this pose. with: a world, or NULL. */
static void check_scenes(const struct fmb_robot *robot, const double *value,
                         const struct fmb_robot_world *with)
{
    static const char *const ignored[][2] = {{"a", "b"}};
    struct fmb_robot_scene *scene;
    const bool made =
        fmb_robot_scene(robot, with, with ? 1 : 0, ignored, with ? 1 : 0, &scene) == 0;
    FUZZ_CHECK(made == !*fmb_robot_scene_why(scene) && is_lines(fmb_robot_scene_why(scene)));
    if (made) {
        FUZZ_CHECK(fmb_robot_moved(scene) <= fmb_robot_scene_get(scene)->placement_count);
        if (!with)
            check_scene(scene);
        if (robot_scene_place(scene, value, 0, "here"))
            check_scene(scene);
    }
    fmb_robot_scene_free(scene);
}

/* ---- Tables ---- */

static const double slack = 0.001;

static void check_row(const struct joint_table *table, const struct joint_row *row, bool refused)
{
    const struct robot *robot = table->joints->robot;
    const double *value = row->value;
    for (size_t i = 0; i < robot->joint_count && !refused; i++) {
        const struct robot_joint *joint = &robot->joints[i];
        FUZZ_CHECK(joint->type == ROBOT_FIXED ||
                   (isfinite(value[i]) && joint->limit[0] - value[i] <= slack &&
                    value[i] - joint->limit[1] <= slack));
        FUZZ_CHECK(joint->type == ROBOT_FIXED || joint->type == ROBOT_PRISMATIC ||
                   fabs(value[i]) <= TURN_RADIANS_MAX);
    }
    FUZZ_CHECK(table->has_time == isfinite(row->time));
    FUZZ_CHECK(row == table->rows || !(row->time < row[-1].time));
    FUZZ_CHECK(!row->label || (strlen(row->label) <= QUERY_NAME_MAX && utf8_is_text(row->label)));
}

static void check_table(const struct fmb_robot *whole)
{
    const struct robot *robot = &whole->tree;
    struct joints joints;
    struct joint_table table;
    begin_messages();
    FUZZ_CHECK(joints_open(robot, NULL, slack, &joints));
    const bool good = joint_table_read(paths[1], &joints, &table);
    FUZZ_CHECK((end_messages() > 0) == !good);
    begin_messages();
    const bool within = joints_check(&joints);
    const int lines = end_messages();
    FUZZ_CHECK(within == !joints.refused && (lines > 0) == !within);
    for (size_t i = 0; good && i < table.row_count; i++)
        check_row(&table, &table.rows[i], joints.refused);
    if (good && within) {
        check_poses(robot, joints.value);
        check_scenes(whole, joints.value, NULL);
    }
    joint_table_clear(&table);
    joints_clear(&joints);
}

/* Reads the second file as a world around the robot. */
static void check_world(const struct fmb_robot *robot)
{
    const struct fmb_robot_options options = {.sides = 4};
    struct robot_world world;
    begin_messages();
    const bool read = robot_world_read(paths[1], &options, &world);
    FUZZ_CHECK((end_messages() > 0) == !read);
    if (read) {
        double *value = fuzz_room(robot->tree.joint_count * sizeof *value);
        for (size_t j = 0; j < robot->tree.joint_count; j++)
            value[j] = robot_home(&robot->tree.joints[j]);
        check_scenes(robot, value, &world.world);
        free(value);
    }
    robot_world_clear(&world);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    write_files(data, size);
    for (int srdf = 0; srdf < 2; srdf++) {
        const struct fmb_robot_options options = {.sides = 4,
                                                  .objects = size % 2,
                                                  .excess = size % 2 ? 0 : 0.25,
                                                  .bus = 1,
                                                  .srdf = srdf ? paths[1] : NULL};
        struct fmb_robot *robot;
        const bool read = fmb_robot_read(paths[0], &options, &robot) == 0;
        FUZZ_CHECK(read == !*fmb_robot_why(robot) && is_lines(fmb_robot_why(robot)));
        if (read) {
            check_robot(&robot->tree);
            if (srdf == 0)
                check_table(robot);
            check_world(robot);
        }
        fmb_robot_free(robot);
    }
    return 0;
}
