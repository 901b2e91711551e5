#include "client_scene.h"

#include "pair_number.h"
#include "utf8.h"
#include "writer.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

/* ---- Checking ---- */

static int refuse(char why[FMB_CLIENT_WHY_MAX], int status, size_t placement, const char *field)
{
    snprintf(why, FMB_CLIENT_WHY_MAX, "placements[%zu].%s: %s", placement, field,
             fmb_status_text(status));
    return status;
}

static bool is_text(const char *text)
{
    return strlen(text) <= QUERY_NAME_MAX && utf8_is_text(text);
}

int client_scene_check(const struct fmb_scene *scene, char why[FMB_CLIENT_WHY_MAX])
{
    struct fmb_scene checked = *scene;
    why[0] = '\0';
    checked.want &= ~(unsigned) FMB_WANT_CERTIFICATE;
    if (scene->placement_count > INT_MAX ||
        (scene->label && strlen(scene->label) > QUERY_NAME_MAX)) {
        snprintf(why, FMB_CLIENT_WHY_MAX, "%s: %s",
                 scene->placement_count > INT_MAX ? "placement_count" : "label",
                 fmb_status_text(FMB_OVER_LIMIT));
        return FMB_OVER_LIMIT;
    }
    const int status = (int) fmb_scene_check(&checked, why, FMB_CLIENT_WHY_MAX);
    for (size_t i = 0; status == FMB_OK && i < scene->placement_count; i++) {
        const struct fmb_placement *placement = &scene->placements[i];
        if (!query_id_ok(placement->id))
            return refuse(why, FMB_BAD_ID, i, "id");
        if (placement->name && !is_text(placement->name))
            return refuse(why, FMB_BAD_NAME, i, "name");
        if (client_scene_geometry_bytes(placement->body) >
            GEOMETRY_NONE_BYTES + FMB_CLIENT_BODY_BYTES_MAX)
            return refuse(why, FMB_OVER_LIMIT, i, "body");
    }
    return status;
}

/* ---- Placements ---- */

/* Counts of an encoded body. */
struct geometry_counts {
    int32_t counts, numbers;
    size_t bytes;
};

static struct geometry_counts counts_of(const struct fmb_body *body)
{
    struct geometry_counts out = {0};
    for (unsigned i = 0; i < body->frame_count; i++) {
        bool by_vertices;
        out.numbers += (int32_t) fmb_frame_numbers(fmb_body_frame(body, i), &by_vertices, NULL);
        out.counts += by_vertices;
    }
    out.bytes = GEOMETRY_NONE_BYTES + body->frame_count + 4 * (size_t) out.counts +
                sizeof(double) * (size_t) out.numbers;
    return out;
}

size_t client_scene_geometry_bytes(const struct fmb_body *body)
{
    return counts_of(body).bytes;
}

/* Encodes the frames as the geometry of a body (placement_t.lcm). */
static struct geometry write_frames(const struct fmb_body *body, unsigned char *out)
{
    const struct geometry_counts sum = counts_of(body);
    unsigned char *end = out + sum.bytes;
    struct writer shapes = {out, end};
    writer_int32(&shapes, body->dim);
    writer_int32(&shapes, (int32_t) body->frame_count);
    struct writer counts = {shapes.at + body->frame_count, end};
    writer_int32(&counts, sum.counts);
    struct writer numbers = {counts.at + 4 * sum.counts, end};
    writer_int32(&numbers, sum.numbers);
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        double number[FMB_FRAME_NUMBERS_MAX];
        bool by_vertices;
        const size_t count = fmb_frame_numbers(frame, &by_vertices, number);
        *writer_take(&shapes, 1) = (unsigned char) geometry_code((int) frame->shape, by_vertices);
        if (by_vertices)
            writer_int32(&counts, frame->count + 1);
        for (size_t k = 0; k < count; k++)
            writer_double(&numbers, number[k]);
    }
    return (struct geometry){out, sum.bytes};
}

static bool is_zero(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (numbers[i] != 0)
            return false;
    return true;
}

void client_scene_placement(const struct fmb_placement *of, unsigned char *geometry,
                            struct placement *out)
{
    const int dim = of->body->dim;
    const size_t axes = (size_t) dim * sizeof(double);
    *out = (struct placement){.body_id = of->id,
                              .dim = dim,
                              .frame_count = (int32_t) of->body->frame_count,
                              .name = of->name,
                              .group = of->group,
                              .orientation_count = of->orientation_count};
    out->geometry = write_frames(of->body, geometry);
    memcpy(out->position, of->position, axes);
    memcpy(out->orientation, of->orientation, sizeof out->orientation);
    if (is_zero(of->velocity, dim))
        return;
    out->velocity_count = dim;
    memcpy(out->velocity, of->velocity, axes);
}

void client_scene_use_handle(struct placement *placement, const struct handle *handle,
                             unsigned char geometry[GEOMETRY_NONE_BYTES])
{
    geometry_write_none(placement->dim, geometry);
    placement->geometry = (struct geometry){geometry, GEOMETRY_NONE_BYTES};
    placement->frame_count = 0;
    placement->name = NULL;
    placement->handle = *handle;
}

/* ---- Pairs ---- */

bool client_scene_is_within_group(const struct fmb_scene *scene, const unsigned pair[2])
{
    const int64_t group = scene->placements[pair[0]].group;
    return group != 0 && group == scene->placements[pair[1]].group;
}

static struct pair_numbers numbers_of(const struct fmb_scene *scene)
{
    return (struct pair_numbers){scene->which == FMB_PAIRS_ACROSS, scene->placement_count,
                                 scene->split};
}

bool client_scene_is_before_first(const struct fmb_scene *scene, const unsigned pair[2])
{
    return scene->which != FMB_PAIRS_LISTED &&
           pair_number(numbers_of(scene), pair[0], pair[1]) < scene->first_pair;
}

bool client_scene_next_pair(const struct fmb_scene *scene, struct client_scene_cursor *cursor,
                            unsigned out[2])
{
    if (scene->which == FMB_PAIRS_LISTED) {
        if (cursor->next == scene->pair_count)
            return false;
        memcpy(out, scene->pairs[cursor->next++], sizeof *scene->pairs);
        return true;
    }
    if (!pair_find(numbers_of(scene), &cursor->a, &cursor->b))
        return false;
    out[0] = (unsigned) cursor->a;
    out[1] = (unsigned) cursor->b++;
    return true;
}
