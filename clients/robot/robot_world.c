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
    *out = (struct robot_world){.json = NULL};
    if (!is_xml(path)) {
        const bool good = fmb_robot_json_read(path, &out->json) == 0;
        const char *why = out->json->why;
        if (!good)
            complain("%s%s", why,
                     strstr(why, ": no body has the ") ? " (--ignore takes names of links)" : "");
        out->world = out->json->world;
        out->world.name = path;
        return good;
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
    fmb_robot_json_free(world->json);
    fmb_robot_scene_free(world->scene);
    fmb_robot_free(world->robot);
}

void robot_world_set_groups(struct robot_world *worlds, size_t count)
{
    int64_t most = 0;
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; worlds[w].json && i < worlds[w].world.scene->placement_count; i++) {
            const int64_t group = worlds[w].world.scene->placements[i].group;
            most = group > most ? group : most;
        }
    for (size_t w = 0; w < count; w++)
        for (size_t i = 0; worlds[w].scene && i < worlds[w].scene->owner.scene.placement_count; i++)
            worlds[w].scene->placements[i].group = most + 1;
}
