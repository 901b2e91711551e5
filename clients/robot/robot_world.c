#include "robot_world.h"

#include "complain.h"
#include "json.h"
#include "robot_scene.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool robot_world_read_json(const char *path, struct owned_scene *out,
                           char error[ROBOT_WORLD_ERROR_MAX])
{
    struct owned_scene second;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    memset(out, 0, sizeof *out);
    if (fd < 0) {
        snprintf(error, ROBOT_WORLD_ERROR_MAX, "%s: %s", path, strerror(errno));
        return false;
    }
    struct json_reader *reader = json_open(fd);
    json_allow_links(reader);
    enum json_outcome outcome = json_next(reader, out);
    bool good = outcome == JSON_SCENE;
    if (good)
        outcome = json_next(reader, &second);
    if (good && outcome == JSON_SCENE) {
        snprintf(error, ROBOT_WORLD_ERROR_MAX, "%s: expected one scene, found a second one", path);
        scene_clear(&second);
        good = false;
    } else if (outcome != JSON_END) {
        snprintf(error, ROBOT_WORLD_ERROR_MAX, "%s: %s", path, json_error(reader));
        good = false;
    }
    json_close(reader);
    close(fd);
    return good;
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
    char error[ROBOT_WORLD_ERROR_MAX];
    *out = (struct robot_world){.path = path};
    if (!is_xml(path)) {
        if (!robot_world_read_json(path, &out->json, error)) {
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
