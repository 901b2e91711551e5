#include "scene_json.h"

#include "json_write.h"

#include <math.h>

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

/* Writes the members of a frame that do not depend on where its origin is. */
static void write_shape(struct json_writer *json, int dim, const struct geometry_frame *frame)
{
    double vertices[GEOMETRY_FRAME_NUMBERS_MAX];
    json_string(json, "shape", fmb_shape_name(frame->shape));
    if (frame->shape == FMB_BOX)
        json_numbers(json, "size", frame->components, dim);
    else if (frame->by_vertices)
        write_vectors(json, "vertices", vertices, dim,
                      (int) geometry_frame_numbers(dim, frame, vertices) / dim);
    else
        write_vectors(json, "components", frame->components, dim,
                      fmb_component_count(dim, frame->shape));
}

static void write_frames(struct json_writer *json, const struct scene_body *body)
{
    const int dim = body->body.dim;
    json_begin(json, "frames", '[');
    for (unsigned i = 0; i < body->body.frame_count; i++) {
        const struct geometry_frame *frame = &body->given[i];
        json_begin(json, NULL, '{');
        write_shape(json, dim, frame);
        if (!frame->by_vertices)
            write_vector(json, frame->shape == FMB_BOX ? "position" : "origin", frame->origin, dim);
        json_end(json, '}');
    }
    json_end(json, ']');
}

/* A body of one frame by vertices, or whose origin or centre is 0, is written as that frame. A
 * frame of components then has the position of the body as its origin, unless the body is turned.
 */
static void write_body(struct json_writer *json, const struct scene_body *body)
{
    const struct geometry_frame *first = body->given;
    const int dim = body->body.dim;
    const bool only =
        body->body.frame_count == 1 && (first->by_vertices || is_zero(first->origin, dim));
    const bool components = only && first->shape != FMB_BOX && !first->by_vertices;
    json_begin(json, NULL, '{');
    json_integer(json, "id", body->id);
    if (body->name[0])
        json_string(json, "name", body->name);
    if (body->group != 0)
        json_integer(json, "group", body->group);
    if (only)
        write_shape(json, dim, first);
    else
        write_frames(json, body);
    if (components && body->orientation_count == 0)
        json_numbers(json, "origin", body->position, dim);
    else
        write_vector(json, "position", body->position, dim);
    if (body->orientation_count > 0)
        json_numbers(json, "orientation", body->orientation, body->orientation_count);
    write_vector(json, "velocity", body->velocity, dim);
    json_end(json, '}');
}

static void write_bodies(struct json_writer *json, const struct scene *scene)
{
    json_break(json, "\n ");
    json_begin(json, "bodies", '[');
    for (size_t i = 0; i < scene->body_count; i++) {
        if (i > 0)
            json_break(json, "\n            ");
        write_body(json, &scene->body[i]);
    }
    json_end(json, ']');
}

static void write_pairs(struct json_writer *json, const struct scene *scene, const char *key,
                        const struct scene_pair *pair, size_t count)
{
    enum { PAIRS_PER_LINE = 8 };
    json_break(json, "\n ");
    json_begin(json, key, '[');
    for (size_t k = 0; k < count; k++) {
        if (k > 0 && k % PAIRS_PER_LINE == 0)
            json_break(json, "\n           ");
        json_begin(json, NULL, '[');
        json_integer(json, NULL, scene->body[pair[k].a].id);
        json_integer(json, NULL, scene->body[pair[k].b].id);
        json_end(json, ']');
    }
    json_end(json, ']');
}

void scene_json_write(FILE *out, const struct scene *scene)
{
    struct json_writer json = json_object(out);
    if (scene->label[0])
        json_string(&json, "label", scene->label);
    json_integer(&json, "dim", scene->dim);
    json_number(&json, "duration", scene->duration);
    if (scene->margin > 0)
        json_number(&json, "margin", scene->margin);
    write_bodies(&json, scene);
    if (!scene->all_pairs)
        write_pairs(&json, scene, "pairs", scene->pair, scene->pair_count);
    if (scene->ignored_count > 0)
        write_pairs(&json, scene, "ignore", scene->ignored, scene->ignored_count);
    json_object_end(&json);
}
