#include "scene_json.h"

#include "json_write.h"

static void write_components(struct json_writer *json, const struct fmb_body *body)
{
    json_begin(json, "components", '[');
    for (int i = 0; i < body->count; i++)
        json_numbers(json, NULL, body->component[i], body->dim);
    json_end(json, ']');
}

static void write_body(struct json_writer *json, int dim, const struct scene_body *body)
{
    json_begin(json, NULL, '{');
    json_integer(json, "id", body->id);
    json_string(json, "shape", fmb_shape_name((int) body->body.shape));
    json_numbers(json, "origin", body->origin, dim);
    write_components(json, &body->body);
    if (body->moving)
        json_numbers(json, "velocity", body->velocity, dim);
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

static void write_pairs(struct json_writer *json, const struct scene *scene)
{
    enum { PAIRS_PER_LINE = 8 };
    json_break(json, "\n ");
    json_begin(json, "pairs", '[');
    for (size_t k = 0; k < scene->pair_count; k++) {
        if (k > 0 && k % PAIRS_PER_LINE == 0)
            json_break(json, "\n           ");
        json_begin(json, NULL, '[');
        json_integer(json, NULL, scene->body[scene->pair[k].a].id);
        json_integer(json, NULL, scene->body[scene->pair[k].b].id);
        json_end(json, ']');
    }
    json_end(json, ']');
}

void scene_json_write(FILE *out, const struct scene *scene)
{
    struct json_writer json = {.out = out};
    json_begin(&json, NULL, '{');
    json_integer(&json, "dim", scene->dim);
    json_number(&json, "duration", scene->duration);
    write_bodies(&json, scene);
    if (!scene->all_pairs)
        write_pairs(&json, scene);
    json_end(&json, '}');
    json_line_end(&json);
}
