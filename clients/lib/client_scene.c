#include "client_scene.h"

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
        if (placement->name && !query_name_ok(placement->name))
            return refuse(why, FMB_BAD_NAME, i, "name");
        if (client_scene_geometry_bytes(placement->body) >
            GEOMETRY_NONE_BYTES + FMB_CLIENT_BODY_BYTES_MAX)
            return refuse(why, FMB_OVER_LIMIT, i, "body");
    }
    return status;
}

/* ---- Placements ---- */

/* Returns the counts and the size of an encoded body. */
static struct body_view view_of(const struct fmb_body *body)
{
    struct body_view out = {.dim = body->dim, .frame_count = (int32_t) body->frame_count};
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        bool by_vertices;
        out.number_count +=
            (int32_t) fmb_frame_numbers(frame, &by_vertices, NULL, 0) + (frame->radius != 0);
        out.count_count += by_vertices;
    }
    out.size = GEOMETRY_NONE_BYTES + body->frame_count + 4 * (size_t) out.count_count +
               sizeof(double) * (size_t) out.number_count;
    return out;
}

size_t client_scene_geometry_bytes(const struct fmb_body *body)
{
    return view_of(body).size;
}

/* Encodes the frames of a body (placement_t.lcm). */
static void write_body(const struct fmb_body *body, struct body_view *out, unsigned char *bytes)
{
    unsigned char *end = bytes + out->size;
    struct writer shapes = {bytes, end};
    out->bytes = bytes;
    writer_int32(&shapes, out->dim);
    writer_int32(&shapes, out->frame_count);
    struct writer counts = {shapes.at + out->frame_count, end};
    writer_int32(&counts, out->count_count);
    struct writer numbers = {counts.at + 4 * out->count_count, end};
    writer_int32(&numbers, out->number_count);
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        double number[FMB_DIM_MAX * FMB_HULL_VERTICES_MAX];
        bool by_vertices;
        const size_t count =
            fmb_frame_numbers(frame, &by_vertices, number, FMB_DIM_MAX * FMB_HULL_VERTICES_MAX);
        const bool has_radius = frame->radius != 0;
        *writer_take(&shapes, 1) = (unsigned char) geometry_code(
            (struct geometry_shape){(int) frame->shape, by_vertices, has_radius});
        if (by_vertices)
            writer_int32(&counts, (int32_t) count / out->dim);
        if (has_radius)
            writer_double(&numbers, frame->radius);
        for (size_t k = 0; k < count; k++)
            writer_double(&numbers, number[k]);
    }
}

void client_scene_placement(const struct fmb_placement *of, const struct handle *handle,
                            unsigned char *bytes, struct query_placement *out)
{
    const int dim = of->body->dim;
    *out = (struct query_placement){.placed = *of};
    for (int axis = 0; axis < dim; axis++)
        if (of->velocity[axis] != 0)
            out->velocity_count = dim;
    if (handle) {
        out->body = geometry_named(dim, handle);
        out->placed.name = NULL;
    } else {
        out->body = view_of(of->body);
        write_body(of->body, &out->body, bytes);
    }
}
