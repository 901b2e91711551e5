#include "robot_world.h"

#include "allocate.h"
#include "complain.h"
#include "json.h"
#include "robot_scene.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ERROR_MAX = 4800 };

/* Reads the only scene of a JSON file. Returns false after an error: one line of text. */
static bool read_json(const char *path, struct owned_scene *out, char error[ERROR_MAX])
{
    struct owned_scene second;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    memset(out, 0, sizeof *out);
    if (fd < 0) {
        snprintf(error, ERROR_MAX, "%s: %s", path, strerror(errno));
        return false;
    }
    struct json_reader *reader = json_open(fd);
    json_allow_links(reader);
    enum json_outcome outcome = json_next(reader, out);
    bool good = outcome == JSON_SCENE;
    if (good)
        outcome = json_next(reader, &second);
    if (good && outcome == JSON_SCENE) {
        snprintf(error, ERROR_MAX, "%s: expected one scene, found a second one", path);
        scene_clear(&second);
        good = false;
    } else if (outcome != JSON_END) {
        snprintf(error, ERROR_MAX, "%s: %s", path, json_error(reader));
        good = false;
    }
    json_close(reader);
    close(fd);
    return good;
}

struct fmb_robot_json {
    struct owned_scene owner;
    struct fmb_robot_world world;
    char why[ERROR_MAX];
};

int fmb_robot_json_read(const char *path, struct fmb_robot_json **out)
{
    struct fmb_robot_json *json = *out = allocate(1, sizeof *json);
    const bool good = read_json(path, &json->owner, json->why);
    json->world = (struct fmb_robot_world){&json->owner.scene, json->owner.links, NULL};
    return good ? 0 : -1;
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

void robot_world_print(const char *path, const char *text)
{
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at == '\n')
        complain("%s%s%.*s", path, *path ? ": " : "", (int) strcspn(at, "\n"), at);
}

bool robot_world_read(const char *path, const struct fmb_robot_options *options,
                      struct robot_world *out)
{
    char error[ERROR_MAX];
    *out = (struct robot_world){.path = path};
    if (!is_xml(path)) {
        if (!read_json(path, &out->json, error)) {
            complain("%s%s", error,
                     strstr(error, ": no body has the ") ? " (--ignore takes names of links)" : "");
            return false;
        }
        out->world = (struct fmb_robot_world){&out->json.scene, out->json.links, path};
        return true;
    }
    struct fmb_robot_options as_obstacle = *options;
    as_obstacle.srdf = NULL;
    memset(as_obstacle.base, 0, sizeof as_obstacle.base);
    if (fmb_robot_read(path, &as_obstacle, &out->robot) != 0) {
        robot_world_print("", fmb_robot_why(out->robot));
        return false;
    }
    if (fmb_robot_scene(out->robot, NULL, 0, NULL, 0, &out->scene) != 0) {
        robot_world_print(path, fmb_robot_scene_why(out->scene));
        return false;
    }
    out->scene->owner.scene.ignored_count = 0;
    out->world = (struct fmb_robot_world){.scene = &out->scene->owner.scene, .name = path};
    return true;
}

void robot_world_clear(struct robot_world *world)
{
    scene_clear(&world->json);
    fmb_robot_scene_free(world->scene);
    fmb_robot_free(world->robot);
}

void robot_world_set_groups(struct robot_world *worlds, size_t count)
{
    int64_t most = 0;
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; i < worlds[w].json.scene.placement_count; i++) {
            const int64_t group = worlds[w].json.scene.placements[i].group;
            most = group > most ? group : most;
        }
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; worlds[w].scene && i < worlds[w].scene->owner.scene.placement_count; i++)
            worlds[w].scene->placements[i].group = most + 1;
}
