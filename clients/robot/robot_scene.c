/* Scenes of a robot: which bodies they have, under which ids, which pairs are ignored, and where
 * the bodies are. */
#include "robot_scene.h"

#include "allocate.h"
#include "json.h"
#include "query.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Pairs ---- */

void robot_pairs_add(struct robot_pairs *pairs, unsigned a, unsigned b, enum robot_origin origin)
{
    pairs->pair =
        allocate_grow(pairs->pair, &pairs->capacity, pairs->count + 1, sizeof *pairs->pair);
    pairs->pair[pairs->count++] =
        (struct robot_pair){.a = a < b ? a : b, .b = a < b ? b : a, .origin = origin};
}

static int by_bodies(const void *x, const void *y)
{
    const struct robot_pair *a = x, *b = y;
    return a->a != b->a ? (a->a > b->a) - (a->a < b->a) : (a->b > b->b) - (a->b < b->b);
}

static int by_bodies_and_origin(const void *x, const void *y)
{
    const struct robot_pair *a = x, *b = y;
    const int order = by_bodies(x, y);
    return order ? order : (int) a->origin - (int) b->origin;
}

void robot_pairs_sort(struct robot_pairs *pairs)
{
    size_t kept = 0;
    if (pairs->count > 0)
        qsort(pairs->pair, pairs->count, sizeof *pairs->pair, by_bodies_and_origin);
    for (size_t i = 0; i < pairs->count; i++)
        if (kept == 0 || by_bodies(&pairs->pair[kept - 1], &pairs->pair[i]) != 0)
            pairs->pair[kept++] = pairs->pair[i];
    pairs->count = kept;
}

bool robot_pairs_has(const struct robot_pairs *pairs, unsigned a, unsigned b)
{
    const struct robot_pair key = {.a = a < b ? a : b, .b = a < b ? b : a};
    return pairs->count > 0 &&
           bsearch(&key, pairs->pair, pairs->count, sizeof *pairs->pair, by_bodies);
}

/* ---- Bodies ---- */

/* place: "": none. */
static bool refuse_body(struct fmb_robot_scene *scene, const char *place,
                        const struct fmb_placement *body, const char *why)
{
    robot_say(&scene->errors, "%s%sbody %" PRId64 "%s%s: %s", place, *place ? ": " : "", body->id,
              body->name ? ", " : "", body->name ? body->name : "", why);
    return false;
}

/* Sets a carried body. */
static bool carry(struct fmb_robot_scene *scene, const char *place,
                  const struct fmb_placement *body, const char *name)
{
    const struct robot_name *link;
    struct robot_carried *out = &scene->carried[scene->carried_count++];
    const double *v = body->velocity;
    char why[QUERY_NAME_MAX + 64];
    HASH_FIND(hh, scene->robot->tree.link_names, name, strlen(name), link);
    *out = (struct robot_carried){.name = name, .pose = POSE_IDENTITY};
    memcpy(out->pose.p, body->position, sizeof out->pose.p);
    if (body->orientation_count > 0) {
        memcpy(out->pose.q, body->orientation, sizeof out->pose.q);
        robot_limit_length(out->pose.q);
    }
    snprintf(why, sizeof why, "the robot has no link '%.*s'", QUERY_NAME_MAX, name);
    if (!link)
        return refuse_body(scene, place, body, why);
    if (v[0] != 0 || v[1] != 0 || v[2] != 0 || body->end_count != 0)
        return refuse_body(scene, place, body,
                           "a body that a link carries has no velocity or end of its own");
    out->link = link->index;
    return true;
}

/* Adds the carried bodies of worlds, or the bodies that no link carries. index: receives the index
 * of each body of the worlds in the scene. */
static bool add_bodies(struct fmb_robot_scene *scene, const struct fmb_robot_world *worlds,
                       size_t count, bool carried, unsigned *index)
{
    struct fmb_scene *out = &scene->owner.scene;
    bool good = true;
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; i < worlds[w].scene->placement_count; i++, index++) {
            const char *name = worlds[w].name ? worlds[w].name : "";
            const char *link = worlds[w].links ? worlds[w].links[i] : NULL;
            if (carried != (link != NULL))
                continue;
            const struct fmb_placement *body = &worlds[w].scene->placements[i];
            *index = (unsigned) out->placement_count;
            scene->placements[out->placement_count++] = *body;
            good = (!carried || carry(scene, name, body, link)) && good;
        }
    return good;
}

/* Gives free ids to bodies whose ids links or earlier bodies have. */
static void set_ids(struct fmb_robot_scene *scene)
{
    const size_t changed =
        scene_free_ids(scene->placements, scene->owner.scene.placement_count, false);
    if (changed > 0)
        robot_say(
            &scene->notes,
            "ids of links (1 to %zu) or of others: %zu bodies get the lowest free ids, in order",
            scene->robot->body_count, changed);
}

/* Gives each rigid body of several links a group that no body of the world has. */
static void set_groups(struct fmb_robot_scene *scene)
{
    const struct fmb_robot *robot = scene->robot;
    int64_t least = 0;
    for (size_t i = robot->body_count; i < scene->owner.scene.placement_count; i++)
        least = scene->placements[i].group < least ? scene->placements[i].group : least;
    for (size_t i = 0; i < robot->body_count && !robot->srdf; i++)
        if (robot->rigid[i] != i) {
            struct fmb_placement *first = &scene->placements[robot->rigid[i]];
            first->group = first->group ? first->group : --least;
            scene->placements[i].group = first->group;
        }
}

/* ---- Ignored pairs ---- */

/* Finds the body with a name. *out: ROBOT_NO_BODY for a link without a body. Returns false after an
 * error: the name is unknown or ambiguous. */
static bool find_body(struct fmb_robot_scene *scene, const char *name, unsigned *out)
{
    const struct robot_name *link;
    size_t found = 0;
    for (size_t i = 0; i < scene->owner.scene.placement_count; i++) {
        const char *of = scene->placements[i].name;
        if (!of || strcmp(of, name) != 0)
            continue;
        *out = (unsigned) i;
        found++;
    }
    HASH_FIND(hh, scene->robot->tree.link_names, name, strlen(name), link);
    if (found == 0 && link)
        *out = ROBOT_NO_BODY;
    else if (found != 1)
        robot_say(&scene->errors, "ignore: %s the name '%.80s'",
                  found ? "several bodies have" : "no body has", name);
    return found == 1 || (found == 0 && link);
}

static bool ignore_named(struct fmb_robot_scene *scene, const char *const name[2])
{
    unsigned end[2];
    const bool found[2] = {find_body(scene, name[0], &end[0]), find_body(scene, name[1], &end[1])};
    if (!found[0] || !found[1])
        return false;
    if (strcmp(name[0], name[1]) == 0) {
        robot_say(&scene->errors, "ignore: '%.64s,%.64s': a body is no pair with itself", name[0],
                  name[1]);
        return false;
    }
    if (end[0] != ROBOT_NO_BODY && end[1] != ROBOT_NO_BODY)
        robot_pairs_add(&scene->ignored, end[0], end[1], ROBOT_OPTION);
    return true;
}

static void ignore_world(struct fmb_robot_scene *scene, const struct fmb_robot_world *worlds,
                         size_t count, const unsigned *index)
{
    for (size_t w = 0; w < count; w++) {
        const struct fmb_scene *world = worlds[w].scene;
        for (size_t i = 0; i < world->ignored_count; i++)
            robot_pairs_add(&scene->ignored, index[world->ignored[i][0]],
                            index[world->ignored[i][1]], ROBOT_WORLD);
        index += world->placement_count;
    }
}

/* Adds the ignored pairs of the robot, the pairs of carried bodies and their links, and the pairs
 * of other bodies and links whose collisions are disabled by default. */
static void ignore_of_robot(struct fmb_robot_scene *scene)
{
    const struct fmb_robot *robot = scene->robot;
    for (size_t i = 0; i < robot->ignored.count; i++) {
        const struct robot_pair *pair = &robot->ignored.pair[i];
        robot_pairs_add(&scene->ignored, pair->a, pair->b, pair->origin);
    }
    for (size_t i = 0; i < scene->carried_count; i++) {
        const unsigned body = robot->body_of_link[scene->carried[i].link];
        if (body != ROBOT_NO_BODY)
            robot_pairs_add(&scene->ignored, body, (unsigned) (robot->body_count + i),
                            ROBOT_CARRIED);
    }
    for (unsigned a = 0; robot->untested && a < robot->body_count; a++)
        for (size_t b = robot->body_count;
             robot->untested[a] && b < scene->owner.scene.placement_count; b++)
            robot_pairs_add(&scene->ignored, a, (unsigned) b, ROBOT_SRDF_DEFAULT);
}

static void set_ignored(struct fmb_robot_scene *scene)
{
    struct fmb_scene *out = &scene->owner.scene;
    struct robot_pairs *pairs = &scene->ignored;
    robot_pairs_sort(pairs);
    unsigned(*ignored)[2] = scene_alloc(&scene->owner, pairs->count, sizeof *ignored);
    size_t kept = 0;
    for (size_t i = 0; i < pairs->count; i++)
        if (!pair_is_within_group(out, pairs->pair[i].a, pairs->pair[i].b)) {
            ignored[kept][0] = pairs->pair[i].a;
            ignored[kept][1] = pairs->pair[i].b;
            pairs->pair[kept++] = pairs->pair[i];
        }
    out->ignored_count = pairs->count = kept;
    out->ignored = (const unsigned(*)[2]) ignored;
    scene_begin_ignored(&scene->owner);
}

/* ---- The scene ---- */

static bool check_worlds(struct fmb_robot_scene *scene, const struct fmb_robot_world *worlds,
                         size_t count)
{
    struct fmb_scene *out = &scene->owner.scene;
    bool good = true;
    for (size_t w = 0; w < count; w++) {
        const struct fmb_scene *world = worlds[w].scene;
        const char *why = world->which != FMB_PAIRS_ALL
                              ? "\"pairs\" would leave out the robot: use \"ignore\" or \"group\""
                              : NULL;
        for (size_t i = 0; i < world->placement_count; i++)
            if (world->placements[i].body->dim != 3)
                why = "expected a scene in 3D";
        if (why)
            robot_say(&scene->errors, "%s%s%s", worlds[w].name ? worlds[w].name : "",
                      worlds[w].name ? ": " : "", why);
        good = good && !why;
        out->duration = fmax(out->duration, world->duration);
        out->margin = fmax(out->margin, world->margin);
    }
    for (size_t w = 0; w < count && good; w++)
        for (size_t i = 0; i < worlds[w].scene->placement_count && good; i++)
            good = worlds[w].scene->placements[i].end_count == 0 ||
                   worlds[w].scene->duration == out->duration ||
                   refuse_body(scene, worlds[w].name ? worlds[w].name : "",
                               &worlds[w].scene->placements[i],
                               "its \"end\" is for a window of another \"duration\"");
    return good;
}

int fmb_robot_scene(const struct fmb_robot *robot, const struct fmb_robot_world *worlds,
                    size_t world_count, const char *const (*ignore)[2], size_t ignore_count,
                    struct fmb_robot_scene **out)
{
    struct fmb_robot_scene *scene = *out = allocate(1, sizeof *scene);
    struct owned_scene *owner = &scene->owner;
    const struct robot *tree = &robot->tree;
    size_t count = robot->body_count;
    for (size_t w = 0; w < world_count; w++)
        count += worlds[w].scene->placement_count;
    scene->robot = robot;
    if (robot->bad) {
        robot_say(&scene->errors, "the robot was refused");
        return -1;
    }
    owner->dim = 3;
    scene->placements = scene_alloc(owner, count, sizeof *scene->placements);
    scene->begin = scene_alloc(owner, count, sizeof *scene->begin);
    scene->carried = scene_alloc(owner, count, sizeof *scene->carried);
    scene->value = scene_alloc(owner, tree->joint_count, sizeof *scene->value);
    scene->pose = scene_alloc(owner, tree->link_count, sizeof *scene->pose);
    unsigned *index = scene_alloc(owner, count, sizeof *index);
    memcpy(scene->placements, robot->bodies, robot->body_count * sizeof *scene->placements);
    owner->scene.placements = scene->placements;
    owner->scene.placement_count = robot->body_count;
    bool good = check_worlds(scene, worlds, world_count) &&
                add_bodies(scene, worlds, world_count, true, index) &&
                add_bodies(scene, worlds, world_count, false, index);
    if (!good)
        return -1;
    set_ids(scene);
    memcpy(scene->begin, scene->placements, count * sizeof *scene->begin);
    set_groups(scene);
    ignore_of_robot(scene);
    ignore_world(scene, worlds, world_count, index);
    for (size_t i = 0; i < ignore_count; i++)
        good = ignore_named(scene, ignore[i]) && good;
    set_ignored(scene);
    double *q = scene_alloc(owner, robot->joint_count, sizeof *q);
    fmb_robot_home(robot, q);
    return good && fmb_robot_place(scene, q) == 0 ? 0 : -1;
}

void fmb_robot_scene_free(struct fmb_robot_scene *scene)
{
    if (!scene)
        return;
    free(scene->ignored.pair);
    robot_lines_clear(&scene->errors);
    robot_lines_clear(&scene->notes);
    scene_clear(&scene->owner);
    free(scene);
}

const char *fmb_robot_scene_why(struct fmb_robot_scene *scene)
{
    return robot_lines_text(&scene->errors);
}

const struct fmb_scene *fmb_robot_scene_get(const struct fmb_robot_scene *scene)
{
    return &scene->owner.scene;
}

size_t fmb_robot_moved(const struct fmb_robot_scene *scene)
{
    return scene->robot->body_count + scene->carried_count;
}

/* ---- Poses ---- */

/* Sets the pose of a placement. Components of the quaternion that are so small that the engine
 * refuses them become 0, which is far below rounding errors; no number is -0. */
static void set_pose(const struct pose *pose, struct fmb_placement *out)
{
    out->orientation_count = pose_is_translation(pose) ? 0 : 4;
    for (int i = 0; i < 3; i++)
        out->position[i] = pose->p[i] + 0.0;
    for (int i = 0; i < 4; i++)
        out->orientation[i] =
            out->orientation_count == 0 || fabs(pose->q[i]) < 0x1p-150 ? 0 : pose->q[i];
}

bool robot_scene_place(struct fmb_robot_scene *scene, const double *value, double time,
                       const char *place)
{
    const struct fmb_robot *robot = scene->robot;
    const size_t bodies = robot->body_count, moved = fmb_robot_moved(scene);
    const size_t end = time != 0 || scene->time != 0 ? scene->owner.scene.placement_count : moved;
    scene->time = time;
    robot_place(&robot->tree, &robot->base, value, scene->pose);
    for (size_t i = 0; i < moved; i++) {
        const unsigned link = i < bodies ? robot->link[i] : scene->carried[i - bodies].link;
        const struct pose pose = pose_compose(
            &scene->pose[link], i < bodies ? &robot->origin[i] : &scene->carried[i - bodies].pose);
        set_pose(&pose, &scene->placements[i]);
    }
    for (size_t i = moved; i < end; i++)
        for (int axis = 0; axis < 3; axis++)
            scene->placements[i].position[axis] =
                scene->begin[i].position[axis] + scene->begin[i].velocity[axis] * time;
    for (size_t i = 0; i < end; i++) {
        const struct fmb_placement *body = &scene->placements[i];
        const enum fmb_status status = fmb_placement_check(body);
        if (status != FMB_OK)
            return refuse_body(scene, place, body, fmb_status_text((int) status));
    }
    return true;
}

int fmb_robot_place(struct fmb_robot_scene *scene, const double *q)
{
    const struct fmb_robot *robot = scene->robot;
    const struct robot *tree = &robot->tree;
    robot_lines_clear(&scene->errors);
    for (size_t i = 0; i < robot->joint_count; i++)
        scene->value[robot->moving[i]] = q[i];
    robot_follow(tree, NULL, scene->value);
    for (size_t j = 0; j < tree->joint_count; j++) {
        const struct robot_joint *joint = &tree->joints[j];
        const char *why = robot_refuse_value(joint, scene->value[j]);
        if (why) {
            robot_say(&scene->errors, "joint '%s': its value %s", joint->name->name, why);
            return -1;
        }
    }
    return robot_scene_place(scene, scene->value, 0, "") ? 0 : -1;
}

/* ---- Scenes of JSON ---- */

int fmb_robot_json_read(const char *path, struct fmb_robot_json **out)
{
    struct fmb_robot_json *json = *out = allocate(1, sizeof *json);
    struct owned_scene second = {.dim = 0};
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    json->world.scene = &json->owner.scene;
    if (fd < 0) {
        snprintf(json->why, sizeof json->why, "%s: %s", path, strerror(errno));
        return -1;
    }
    struct json_reader *reader = json_open(fd);
    json_allow_links(reader);
    enum json_outcome outcome = json_next(reader, &json->owner);
    if (outcome == JSON_SCENE)
        outcome = json_next(reader, &second);
    if (outcome != JSON_END)
        snprintf(
            json->why, sizeof json->why, "%s: %s", path,
            outcome == JSON_SCENE ? "expected one scene, found a second one" : json_error(reader));
    json->world.links = json->owner.links;
    scene_clear(&second);
    json_close(reader);
    close(fd);
    return outcome == JSON_END ? 0 : -1;
}

void fmb_robot_json_free(struct fmb_robot_json *json)
{
    if (json)
        scene_clear(&json->owner);
    free(json);
}

const char *fmb_robot_json_why(const struct fmb_robot_json *json)
{
    return json->why;
}

const struct fmb_robot_world *fmb_robot_json_get(const struct fmb_robot_json *json)
{
    return &json->world;
}
