#include "scene_json.h"

#include "allocate.h"
#include "pair_number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Writes count vectors of dim numbers. */
static void write_vectors(struct json_writer *json, const char *key, const double *numbers, int dim,
                          int count)
{
    json_begin(json, key, '[');
    for (int i = 0; i < count; i++)
        json_numbers(json, NULL, numbers + i * dim, dim);
    json_end(json, ']');
}

/* Whether all numbers are +0, the value of a missing vector. */
static bool is_zero(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (numbers[i] != 0 || signbit(numbers[i]))
            return false;
    return true;
}

static void write_vector(struct json_writer *json, const char *key, const double *numbers, int dim)
{
    if (!is_zero(numbers, dim))
        json_numbers(json, key, numbers, dim);
}

/* The numbers of a frame, as the function that makes it takes them. */
struct frame_numbers {
    bool by_vertices;
    size_t count;
    double number[FMB_DIM_MAX * FMB_HULL_VERTICES_MAX];
};

static struct frame_numbers numbers_of(const struct fmb_frame *frame)
{
    struct frame_numbers out;
    out.count = fmb_frame_numbers(frame, &out.by_vertices, out.number,
                                  sizeof out.number / sizeof *out.number);
    return out;
}

/* Returns "sphere" for a hull of one vertex with a radius; "capsule" for a hull of two opposite
 * vertices on the last axis with a radius, in the order in which capsules are read; otherwise the
 * name of the shape. */
static const char *name_of(const struct fmb_frame *frame, const struct frame_numbers *given)
{
    const int dim = frame->dim, last = dim - 1, count = (int) given->count;
    const double *a = given->number, *b = a + dim;
    if (frame->shape != FMB_HULL || frame->radius == 0 || count > 2 * dim)
        return fmb_shape_name((int) frame->shape);
    if (count == dim)
        return "sphere";
    return b[last] > 0 && a[last] == -b[last] && isfinite(2 * b[last]) && is_zero(a, last) &&
                   is_zero(b, last)
               ? "capsule"
               : "hull";
}

/* Writes the members of a frame that do not depend on where its origin, or the centre of a sphere,
 * is. */
static void write_shape(struct json_writer *json, const struct fmb_frame *frame,
                        const struct frame_numbers *given)
{
    const int dim = frame->dim;
    const char *name = name_of(frame, given);
    json_string(json, "shape", name);
    if (frame->radius > 0)
        json_number(json, "radius", frame->radius);
    if (strcmp(name, "capsule") == 0)
        json_number(json, "length", 2 * given->number[2 * dim - 1]);
    else if (strcmp(name, "sphere") == 0)
        return;
    else if (frame->shape == FMB_BOX)
        json_numbers(json, "size", given->number + dim, dim);
    else if (given->by_vertices)
        write_vectors(json, "vertices", given->number, dim, (int) given->count / dim);
    else
        write_vectors(json, "components", given->number + dim, dim, (int) given->count / dim - 1);
}

void scene_json_frames(struct json_writer *json, const struct fmb_body *body)
{
    json_begin(json, "frames", '[');
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        const struct frame_numbers given = numbers_of(frame);
        json_begin(json, NULL, '{');
        write_shape(json, frame, &given);
        const bool sphere = strcmp(name_of(frame, &given), "sphere") == 0;
        if (!given.by_vertices || sphere)
            write_vector(json, sphere || frame->shape == FMB_BOX ? "position" : "origin",
                         given.number, body->dim);
        json_end(json, '}');
    }
    json_end(json, ']');
}

void scene_json_motion(struct json_writer *json, const struct fmb_placement *placement, int dim)
{
    if (placement->orientation_count > 0)
        json_numbers(json, "orientation", placement->orientation, placement->orientation_count);
    if (placement->end_count == 0) {
        write_vector(json, "velocity", placement->velocity, dim);
        return;
    }
    json_begin(json, "end", '{');
    json_numbers(json, "position", placement->end_position, dim);
    if (placement->orientation_count > 0)
        json_numbers(json, "orientation", placement->end_orientation, placement->orientation_count);
    json_end(json, '}');
}

/* A body of one frame by vertices (not a sphere), or whose origin or centre is 0, is written as
 * that frame. A frame of components then has the position of the body as its origin, unless the
 * body is turned.
 */
static void write_body(struct json_writer *json, const struct fmb_placement *placement)
{
    const int dim = placement->body->dim;
    const struct fmb_frame *first = fmb_body_frame(placement->body, 0);
    const struct frame_numbers given = numbers_of(first);
    const bool only = placement->body->frame_count == 1 &&
                      ((given.by_vertices && strcmp(name_of(first, &given), "sphere") != 0) ||
                       is_zero(given.number, dim));
    const bool components = only && first->shape != FMB_BOX && !given.by_vertices;
    json_begin(json, NULL, '{');
    json_integer(json, "id", placement->id);
    if (placement->name)
        json_string(json, "name", placement->name);
    if (placement->group != 0)
        json_integer(json, "group", placement->group);
    if (only)
        write_shape(json, first, &given);
    else
        scene_json_frames(json, placement->body);
    if (components && placement->orientation_count == 0)
        json_numbers(json, "origin", placement->position, dim);
    else
        write_vector(json, "position", placement->position, dim);
    scene_json_motion(json, placement, dim);
    json_end(json, '}');
}

static void write_pairs(struct json_writer *json, const struct fmb_placement *placements,
                        const char *key, const unsigned (*pair)[2], size_t count)
{
    json_begin(json, key, '[');
    for (size_t k = 0; k < count; k++)
        json_integers(json, NULL,
                      (const int64_t[]){placements[pair[k][0]].id, placements[pair[k][1]].id}, 2);
    json_end(json, ']');
}

/* Writes the ignored pairs in the order of (a, b), each once, without those within a group. */
static void write_ignored(struct json_writer *json, struct owned_scene *owner)
{
    const struct fmb_scene *scene = &owner->scene;
    const struct pair_numbers all = {.n = scene->placement_count};
    unsigned(*pair)[2] = allocate(scene->ignored_count, sizeof *pair);
    size_t count = 0;
    for (size_t a = 0, b = 0; pair_find(all, &a, &b); b++) {
        if (pair_is_within_group(scene, (unsigned) a, (unsigned) b) ||
            !ignored_has(&owner->ignored, (unsigned) a, (unsigned) b))
            continue;
        pair[count][0] = (unsigned) a;
        pair[count++][1] = (unsigned) b;
    }
    if (count > 0)
        write_pairs(json, scene->placements, "ignore", (const unsigned(*)[2]) pair, count);
    free(pair);
}

void scene_json_write(FILE *out, struct owned_scene *owner)
{
    const struct fmb_scene *scene = &owner->scene;
    struct json_writer json = json_object(out);
    if (scene->label)
        json_string(&json, "label", scene->label);
    json_integer(&json, "dim", owner->dim);
    json_number(&json, "duration", scene->duration);
    if (scene->margin > 0)
        json_number(&json, "margin", scene->margin);
    json_begin(&json, "bodies", '[');
    for (size_t i = 0; i < scene->placement_count; i++)
        write_body(&json, &scene->placements[i]);
    json_end(&json, ']');
    if (scene->which == FMB_PAIRS_LISTED)
        write_pairs(&json, scene->placements, "pairs", scene->pairs, scene->pair_count);
    if (scene->ignored_count > 0)
        write_ignored(&json, owner);
    json_object_end(&json);
}
