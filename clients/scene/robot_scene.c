#include "robot_scene.h"

#include "allocate.h"
#include "complain.h"
#include "json.h"
#include "query.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- The robot ---- */

/* Reports the links without a body; if there are many, the first ones by name. */
static void report_empty(const struct robot *robot)
{
    enum { NAMED = 8 };
    char names[NAMED * (QUERY_NAME_MAX + 3)] = "", more[32] = "";
    size_t count = 0;
    for (size_t i = 0; i < robot->link_count; i++)
        if (robot->links[i].element_count == 0 && count++ < NAMED)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                     count > 1 ? ", " : "", robot->links[i].name->name);
    if (count > NAMED)
        snprintf(more, sizeof more, ", and %zu more", count - NAMED);
    if (count > 0)
        complain("%s: links without <collision> have no body: %s%s", robot->path, names, more);
}

void robot_scene_report(const struct robot_scene *scene, const char *world)
{
    report_empty(scene->robot);
    robot_meshes_report(&scene->meshes, scene->robot->path);
    scene_report_outside(scene->robot->path, scene->owner.outside);
    scene_report_outside(world, scene->world.outside);
}

/* Ignores each pair of a link's body and the body of the nearest link above it that has one. */
static void ignore_neighbours(struct robot_scene *scene)
{
    const struct robot *robot = scene->robot;
    struct fmb_scene *out = &scene->owner.scene;
    unsigned(*ignored)[2] = scene_alloc(&scene->owner, robot->link_count, sizeof *ignored);
    /* Of each link its own body, or else that of the nearest link above it; UINT32_MAX: none. */
    unsigned *body = allocate(robot->link_count, sizeof *body);
    memset(body, 0xff, robot->link_count * sizeof *body);
    for (unsigned i = 0; i < scene->robot_bodies; i++)
        body[scene->link[i]] = i;
    for (size_t i = 1; i < robot->link_count; i++) { /* the root is the first */
        const unsigned link = robot->order[i];
        const unsigned above = body[robot->joints[robot->links[link].joint].link[0]];
        if (body[link] == UINT32_MAX) {
            body[link] = above;
        } else if (above != UINT32_MAX) {
            ignored[out->ignored_count][0] = above;
            ignored[out->ignored_count++][1] = body[link];
        }
    }
    free(body);
    out->ignored = (const unsigned(*)[2]) ignored;
}

bool robot_scene_make(const struct robot *robot, const struct robot_body_options *options,
                      struct robot_scene *out)
{
    *out = (struct robot_scene){.robot = robot, .owner = {.dim = 3}};
    struct owned_scene *owner = &out->owner;
    bool good = true;
    out->placements = scene_alloc(owner, robot->link_count, sizeof *out->placements);
    out->link = scene_alloc(owner, robot->link_count, sizeof *out->link);
    out->origin = scene_alloc(owner, robot->link_count, sizeof *out->origin);
    out->pose = scene_alloc(owner, robot->link_count, sizeof *out->pose);
    for (unsigned i = 0; i < robot->link_count; i++) {
        const struct robot_link *link = &robot->links[i];
        const size_t n = out->robot_bodies;
        if (link->element_count == 0)
            continue;
        out->link[n] = i;
        out->placements[n] = (struct fmb_placement){
            .body = robot_body(robot, link, options, owner, &out->meshes, &out->origin[n]),
            .name = link->name->name,
            .id = (int64_t) n + 1};
        good = out->placements[n].body && good;
        out->robot_bodies++;
    }
    if (!good)
        return false;
    if (out->robot_bodies == 0)
        complain("%s: no link has a <collision> (<visual> is not read)", robot->path);
    ignore_neighbours(out);
    owner->scene.placements = out->placements;
    owner->scene.placement_count = out->robot_bodies;
    scene_begin_ignored(owner);
    return out->robot_bodies > 0;
}

void robot_scene_clear(struct robot_scene *scene)
{
    scene_clear(&scene->owner);
    scene_clear(&scene->world);
}

/* ---- The world ---- */

/* Reads the only scene of a file. */
static bool read_world(const char *path, struct owned_scene *out)
{
    struct owned_scene second;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        complain("%s: %s", path, strerror(errno));
        return false;
    }
    struct json_reader *reader = json_open(fd);
    enum json_outcome outcome = json_next(reader, out);
    bool good = outcome == JSON_SCENE;
    if (good)
        outcome = json_next(reader, &second);
    if (good && outcome == JSON_SCENE) {
        complain("%s: expected one scene, found a second one", path);
        scene_clear(&second);
        good = false;
    } else if (outcome != JSON_END) {
        const char *error = json_error(reader);
        complain("%s: %s%s", path, error,
                 strstr(error, ": no body has the ") ? " (--ignore takes names of links)" : "");
        good = false;
    }
    json_close(reader);
    close(fd);
    return good;
}

/* Gives new ids to the bodies of the world whose ids are those of links. */
static bool set_ids(struct robot_scene *scene, const char *path, size_t count)
{
    static const int64_t id_max = ((int64_t) 1 << DBL_MANT_DIG) - 1;
    struct fmb_placement *world = scene->placements + scene->robot_bodies;
    int64_t last = (int64_t) scene->robot_bodies, first;
    size_t changed = 0;
    for (size_t i = 0; i < count; i++)
        last = world[i].id > last ? world[i].id : last;
    first = last + 1;
    for (size_t i = 0; i < count; i++)
        if (world[i].id <= (int64_t) scene->robot_bodies) {
            world[i].id = ++last;
            changed++;
        }
    if (last > id_max)
        complain(
            "%s: ids 1 to %zu are those of links, and none is left above its largest id: give its "
            "bodies smaller ids",
            path, scene->robot_bodies);
    else if (changed > 0)
        complain(
            "%s: ids 1 to %zu are those of links: %zu of its bodies get new ids, in order, from "
            "%" PRId64 " on",
            path, scene->robot_bodies, changed, first);
    return last <= id_max;
}

bool robot_scene_add_world(struct robot_scene *scene, const char *path)
{
    struct owned_scene *owner = &scene->owner;
    struct fmb_scene *out = &owner->scene;
    const struct fmb_scene *world = &scene->world.scene;
    const size_t robot = scene->robot_bodies;
    if (!read_world(path, &scene->world))
        return false;
    if (scene->world.dim != 3 || world->which == FMB_PAIRS_LISTED) {
        complain("%s: %s", path,
                 scene->world.dim != 3
                     ? "expected a scene in 3D"
                     : "\"pairs\" would leave out the robot: use \"ignore\" or \"group\"");
        return false;
    }
    struct fmb_placement *placements =
        scene_alloc(owner, robot + world->placement_count, sizeof *placements);
    unsigned(*ignored)[2] =
        scene_alloc(owner, out->ignored_count + world->ignored_count, sizeof *ignored);
    memcpy(placements, scene->placements, robot * sizeof *placements);
    memcpy(placements + robot, world->placements, world->placement_count * sizeof *placements);
    if (out->ignored_count > 0)
        memcpy(ignored, out->ignored, out->ignored_count * sizeof *ignored);
    for (size_t i = 0; i < world->ignored_count; i++)
        for (int end = 0; end < 2; end++)
            ignored[out->ignored_count + i][end] = (unsigned) robot + world->ignored[i][end];
    scene->placements = placements;
    out->placements = placements;
    out->placement_count = robot + world->placement_count;
    out->ignored = (const unsigned(*)[2]) ignored;
    out->ignored_count += world->ignored_count;
    out->duration = world->duration;
    out->margin = world->margin;
    scene_begin_ignored(owner);
    return set_ids(scene, path, world->placement_count);
}

/* ---- Ignored pairs ---- */

/* Finds the body with this name, which ends at `end`. *out: UINT32_MAX for a link without a body.
 * Returns false after an error: the name is unknown or ambiguous. */
static bool find_body(const struct robot_scene *scene, const char *name, const char *end,
                      unsigned *out)
{
    const size_t length = (size_t) (end - name);
    const struct robot_name *link;
    size_t found = 0;
    for (size_t i = 0; i < scene->owner.scene.placement_count; i++) {
        const char *of = scene->placements[i].name;
        if (!of || strlen(of) != length || memcmp(of, name, length) != 0)
            continue;
        *out = (unsigned) i;
        found++;
    }
    HASH_FIND(hh, scene->robot->link_names, name, length, link);
    if (found == 0 && link)
        *out = UINT32_MAX;
    else if (found != 1)
        complain("--ignore: %s the name '%.*s'", found ? "several bodies have" : "no body has",
                 (int) length, name);
    return found == 1 || (found == 0 && link);
}

bool robot_scene_ignore(struct robot_scene *scene, const char *const *pair, size_t count)
{
    struct owned_scene *owner = &scene->owner;
    struct fmb_scene *out = &owner->scene;
    unsigned(*ignored)[2] = scene_alloc(owner, out->ignored_count + count, sizeof *ignored);
    if (out->ignored_count > 0)
        memcpy(ignored, out->ignored, out->ignored_count * sizeof *ignored);
    for (size_t i = 0; i < count; i++) {
        unsigned *ends = ignored[out->ignored_count];
        const char *comma = strchr(pair[i], ',');
        if (!comma) {
            complain("--ignore: expected two names, NAME,NAME, found '%.128s'", pair[i]);
            return false;
        }
        if (!find_body(scene, pair[i], comma, &ends[0]) ||
            !find_body(scene, comma + 1, comma + strlen(comma), &ends[1]))
            return false;
        if (strlen(comma + 1) == (size_t) (comma - pair[i]) &&
            strncmp(pair[i], comma + 1, (size_t) (comma - pair[i])) == 0) {
            complain("--ignore: '%s': a body is no pair with itself", pair[i]);
            return false;
        }
        out->ignored_count += ends[0] != UINT32_MAX && ends[1] != UINT32_MAX;
    }
    out->ignored = (const unsigned(*)[2]) ignored;
    scene_begin_ignored(owner);
    return true;
}

/* ---- Poses ---- */

/* Sets the pose of a placement. Components of the quaternion so small that the engine refuses them,
 * far below rounding errors, become 0; no number is -0. */
static void set_pose(const struct pose *pose, struct fmb_placement *out)
{
    out->orientation_count = pose_is_translation(pose) ? 0 : 4;
    for (int i = 0; i < 3; i++)
        out->position[i] = pose->p[i] + 0.0;
    for (int i = 0; i < 4; i++)
        out->orientation[i] =
            out->orientation_count == 0 || fabs(pose->q[i]) < 0x1p-150 ? 0 : pose->q[i];
}

bool robot_scene_place(struct robot_scene *scene, const double *value, double time,
                       const char *place)
{
    const struct fmb_scene *world = &scene->world.scene;
    robot_place(scene->robot, value, scene->pose);
    for (size_t i = 0; i < scene->robot_bodies; i++) {
        const struct pose pose = pose_compose(&scene->pose[scene->link[i]], &scene->origin[i]);
        set_pose(&pose, &scene->placements[i]);
    }
    for (size_t i = 0; i < world->placement_count; i++)
        for (int axis = 0; axis < 3; axis++)
            scene->placements[scene->robot_bodies + i].position[axis] =
                world->placements[i].position[axis] + world->placements[i].velocity[axis] * time;
    for (size_t i = 0; i < scene->owner.scene.placement_count; i++) {
        const struct fmb_placement *body = &scene->placements[i];
        const enum fmb_status status = fmb_placement_check(body);
        if (status != FMB_OK) {
            complain("%s: body %" PRId64 "%s%s: %s", place, body->id, body->name ? ", " : "",
                     body->name ? body->name : "", fmb_status_text((int) status));
            return false;
        }
    }
    return true;
}
