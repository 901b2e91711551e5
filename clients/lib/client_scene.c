#include "client_scene.h"

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

void client_scene_placement(const struct fmb_placement *of, const struct handle *handle,
                            unsigned char *geometry, struct placement *out)
{
    const int dim = of->body->dim;
    *out = (struct placement){.body_id = of->id,
                              .dim = dim,
                              .group = of->group,
                              .orientation_count = of->orientation_count};
    memcpy(out->orientation, of->orientation, sizeof out->orientation);
    for (int axis = 0; axis < dim; axis++) {
        out->position[axis] = of->position[axis];
        out->velocity[axis] = of->velocity[axis];
        if (of->velocity[axis] != 0)
            out->velocity_count = dim;
    }
    if (handle) {
        geometry_write_none(dim, geometry);
        out->geometry = (struct geometry){geometry, GEOMETRY_NONE_BYTES};
        out->handle = *handle;
    } else {
        out->frame_count = (int32_t) of->body->frame_count;
        out->name = of->name;
        out->geometry = write_frames(of->body, geometry);
    }
}
