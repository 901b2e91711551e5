#include "scene_json.h"

#include "json_write.h"

#include <math.h>

static void write_components(struct json_writer *json, const struct fmb_frame *frame)
{
    json_begin(json, "components", '[');
    for (int i = 0; i < frame->count; i++)
        json_numbers(json, NULL, frame->component[i], frame->dim);
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

static void write_size(struct json_writer *json, const struct fmb_frame *box)
{
    double size[FMB_DIM_MAX];
    for (int axis = 0; axis < box->dim; axis++)
        size[axis] = box->component[axis][axis];
    json_numbers(json, "size", size, box->dim);
}

static void write_frame(struct json_writer *json, const struct fmb_frame *frame)
{
    const bool box = frame->shape == FMB_BOX;
    json_begin(json, NULL, '{');
    json_string(json, "shape", fmb_shape_name((int) frame->shape));
    if (box)
        write_size(json, frame);
    write_vector(json, box ? "position" : "origin", box ? frame->centre : frame->origin,
                 frame->dim);
    if (!box)
        write_components(json, frame);
    json_end(json, '}');
}

static void write_frames(struct json_writer *json, const struct fmb_body *body)
{
    json_begin(json, "frames", '[');
    for (unsigned i = 0; i < body->frame_count; i++)
        write_frame(json, fmb_body_frame(body, i));
    json_end(json, ']');
}

/* A body of one frame whose origin or centre is 0 is written as that frame. A frame of components
 * then has the position of the body as its origin, unless the body is turned. */
static void write_only_frame(struct json_writer *json, const struct scene_body *body)
{
    const struct fmb_frame *frame = fmb_body_frame(&body->body, 0);
    json_string(json, "shape", fmb_shape_name((int) frame->shape));
    if (frame->shape == FMB_BOX)
        write_size(json, frame);
    else if (body->orientation_count == 0)
        json_numbers(json, "origin", body->position, frame->dim);
    if (frame->shape == FMB_BOX || body->orientation_count > 0)
        write_vector(json, "position", body->position, frame->dim);
    if (frame->shape != FMB_BOX)
        write_components(json, frame);
}

static void write_body(struct json_writer *json, int dim, const struct scene_body *body)
{
    const struct fmb_frame *first = fmb_body_frame(&body->body, 0);
    const double *origin = first->shape == FMB_BOX ? first->centre : first->origin;
    json_begin(json, NULL, '{');
    json_integer(json, "id", body->id);
    if (body->name[0])
        json_string(json, "name", body->name);
    if (body->body.frame_count == 1 && is_zero(origin, dim)) {
        write_only_frame(json, body);
    } else {
        write_frames(json, &body->body);
        write_vector(json, "position", body->position, dim);
    }
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
        write_body(json, scene->dim, &scene->body[i]);
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
