#include "fmb_robot_flat.h"

#include "allocate.h"
#include "geometry.h"
#include "robot_scene.h"
#include "robot_world.h"

#include <stdlib.h>
#include <string.h>

struct fmb_robot_flat {
    const struct fmb_scene *scene;
    int dim;
    const char *const *links;      /* of a JSON file, or NULL */
    struct owned_scene json;       /* of a JSON file */
    struct fmb_robot_scene *robot; /* of a robot, or NULL */
    char why[ROBOT_WORLD_ERROR_MAX];
};

int fmb_robot_flat_abi(void)
{
    return FMB_ROBOT_FLAT_ABI;
}

int fmb_robot_flat_read(const char *path, const char *srdf, const char *package_path,
                        const double *base, int sides, double excess, int objects,
                        struct fmb_robot **out)
{
    struct fmb_robot_options options = {.srdf = srdf,
                                        .package_path = package_path,
                                        .sides = sides,
                                        .excess = excess,
                                        .objects = objects};
    memcpy(options.base, base, sizeof options.base);
    return fmb_robot_read(path, &options, out);
}

/* ---- Scenes ---- */

int fmb_robot_flat_json(const char *path, struct fmb_robot_flat **out)
{
    struct fmb_robot_flat *flat = *out = allocate(1, sizeof *flat);
    flat->scene = &flat->json.scene;
    if (!robot_world_read_json(path, &flat->json, flat->why))
        return -1;
    flat->dim = flat->json.dim;
    flat->links = flat->json.links;
    if (flat->scene->which != FMB_PAIRS_LISTED)
        return 0;
    snprintf(flat->why, sizeof flat->why, "%s: pairs: they are an argument of decide()", path);
    return -1;
}

int fmb_robot_flat_make(const struct fmb_robot *robot, const void *placements,
                        const char *const *links, size_t count, double margin,
                        const int64_t *ignored, size_t ignored_count, const char *const *names,
                        size_t name_count, struct fmb_robot_flat **out)
{
    struct fmb_robot_flat *flat = *out = allocate(1, sizeof *flat);
    unsigned(*pair)[2] = allocate(ignored_count, sizeof *pair);
    for (size_t i = 0; i < ignored_count; i++)
        for (int end = 0; end < 2; end++)
            pair[i][end] = (unsigned) ignored[2 * i + (size_t) end];
    const struct fmb_scene scene = {.placements = placements,
                                    .placement_count = count,
                                    .margin = margin,
                                    .ignored = (const unsigned(*)[2]) pair,
                                    .ignored_count = ignored_count};
    const struct fmb_robot_world world = {.scene = &scene, .links = links};
    const int status = fmb_robot_scene(robot, &world, 1, (const char *const(*)[2]) names,
                                       name_count, &flat->robot);
    flat->scene = &flat->robot->owner.scene;
    flat->dim = 3;
    free(pair);
    return status;
}

void fmb_robot_flat_free(struct fmb_robot_flat *flat)
{
    if (!flat)
        return;
    scene_clear(&flat->json);
    fmb_robot_scene_free(flat->robot);
    free(flat);
}

const char *fmb_robot_flat_why(struct fmb_robot_flat *flat)
{
    return flat->robot ? fmb_robot_scene_why(flat->robot) : flat->why;
}

/* ---- Copies ---- */

/* Writes the numbers of a frame as placement_t has them. Returns how many there are. number: NULL:
 * none is written. */
static size_t copy_frame(const struct fmb_frame *frame, int32_t *shape, double *number)
{
    double numbers[FMB_DIM_MAX * FMB_HULL_VERTICES_MAX];
    struct geometry_shape of = {.shape = (int) frame->shape, .has_radius = frame->radius > 0};
    const size_t count = fmb_frame_numbers(frame, &of.by_vertices, numbers);
    *shape = geometry_code(of);
    if (number && of.has_radius)
        *number++ = frame->radius;
    if (number)
        memcpy(number, numbers, count * sizeof *number);
    return count + of.has_radius;
}

void fmb_robot_flat_counts(const struct fmb_robot_flat *flat, int64_t counts[5], double settings[2])
{
    const struct fmb_scene *scene = flat->scene;
    int32_t shape;
    memset(counts, 0, 5 * sizeof *counts);
    counts[0] = flat->dim;
    counts[1] = (int64_t) scene->placement_count;
    for (size_t i = 0; i < scene->placement_count; i++)
        for (unsigned k = 0; k < scene->placements[i].body->frame_count; k++) {
            counts[2]++;
            counts[3] +=
                (int64_t) copy_frame(fmb_body_frame(scene->placements[i].body, k), &shape, NULL);
        }
    counts[4] = (int64_t) scene->ignored_count;
    settings[0] = scene->duration;
    settings[1] = scene->margin;
}

void fmb_robot_flat_copy(const struct fmb_robot_flat *flat, int64_t *frames, int32_t *shapes,
                         int64_t *counts, double *numbers, int64_t *ids, int64_t *groups,
                         const char **names, const char **links, double *velocities,
                         int64_t *ignored)
{
    const struct fmb_scene *scene = flat->scene;
    const size_t dim = (size_t) flat->dim;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const struct fmb_placement *body = &scene->placements[i];
        if (ids)
            ids[i] = body->id;
        if (groups)
            groups[i] = body->group;
        if (names)
            names[i] = body->name;
        if (links)
            links[i] = flat->links ? flat->links[i] : NULL;
        if (velocities)
            memcpy(velocities + i * dim, body->velocity, dim * sizeof *velocities);
        if (frames)
            frames[i] = body->body->frame_count;
        for (unsigned k = 0; frames && k < body->body->frame_count; k++) {
            const size_t count = copy_frame(fmb_body_frame(body->body, k), shapes++, numbers);
            *counts++ = (int64_t) count;
            numbers += count;
        }
    }
    for (size_t i = 0; ignored && i < 2 * scene->ignored_count; i++)
        ignored[i] = scene->ignored[i / 2][i % 2];
}

const void *fmb_robot_flat_placements(const struct fmb_robot_flat *flat)
{
    return flat->scene->placements;
}

int fmb_robot_flat_place(struct fmb_robot_flat *flat, const double *q,
                         void (*take)(void *scene, const void *placements, size_t count),
                         void *scene)
{
    const int status = fmb_robot_place(flat->robot, q);
    if (status == 0)
        take(scene, flat->scene->placements, fmb_robot_moved(flat->robot));
    return status;
}
