#include "scene_json.h"

#include "number.h"

#include <inttypes.h>

static void write_vector(FILE *out, const double *numbers, int count)
{
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < count; i++)
        fprintf(out, "%s%s", i ? "," : "[", number_exact(numbers[i], text));
    putc(']', out);
}

static void write_components(FILE *out, const struct fmb_body *body)
{
    for (int i = 0; i < body->count; i++) {
        putc(i ? ',' : '[', out);
        write_vector(out, body->component[i], body->dim);
    }
    putc(']', out);
}

static void write_body(FILE *out, int dim, const struct scene_body *body)
{
    fprintf(out, "{\"id\": %" PRId64 ", \"shape\": \"%s\", \"origin\": ", body->id,
            fmb_shape_name((int) body->body.shape));
    write_vector(out, body->origin, dim);
    fputs(", \"components\": ", out);
    write_components(out, &body->body);
    if (body->moving) {
        fputs(", \"velocity\": ", out);
        write_vector(out, body->velocity, dim);
    }
    putc('}', out);
}

static void write_bodies(FILE *out, const struct scene *scene)
{
    fputs(" \"bodies\": [", out);
    for (size_t i = 0; i < scene->body_count; i++) {
        fputs(i ? ",\n            " : "", out);
        write_body(out, scene->dim, &scene->body[i]);
    }
    putc(']', out);
}

/* So many on a line. */
enum { PAIRS_A_LINE = 8 };

static void write_pairs(FILE *out, const struct scene *scene)
{
    fputs(",\n \"pairs\": [", out);
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct scene_pair *pair = &scene->pair[k];
        fprintf(out, "%s[%" PRId64 ",%" PRId64 "]",
                k == 0                 ? ""
                : k % PAIRS_A_LINE > 0 ? ", "
                                       : ",\n           ",
                scene->body[pair->a].id, scene->body[pair->b].id);
    }
    putc(']', out);
}

void scene_json_write(FILE *out, const struct scene *scene)
{
    char duration[NUMBER_TEXT_MAX];
    fprintf(out, "{\"dim\": %d, \"duration\": %s,\n", scene->dim,
            number_exact(scene->duration, duration));
    write_bodies(out, scene);
    if (!scene->all_pairs)
        write_pairs(out, scene);
    fputs("}\n", out);
}
