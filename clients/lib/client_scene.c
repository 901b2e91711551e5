#include "client_scene.h"

#include "pair_number.h"
#include "utf8.h"
#include "writer.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The first error of a scene: its status, and text about its place. */
struct scene_error {
    char *why;
    int status;
};

/* Sets the error. Always returns false. format: the place. */
__attribute__((format(printf, 3, 4))) static bool refuse(struct scene_error *error, int status,
                                                         const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int used = vsnprintf(error->why, FMB_CLIENT_WHY_MAX, format, list);
    va_end(list);
    if (used >= 0 && used < FMB_CLIENT_WHY_MAX)
        snprintf(error->why + used, (size_t) (FMB_CLIENT_WHY_MAX - used), ": %s",
                 fmb_status_text(status));
    error->status = status;
    return false;
}

static bool check_numbers(struct scene_error *error, size_t placement, const char *field,
                          const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return refuse(error, FMB_NOT_FINITE, "placements[%zu].%s[%d]", placement, field, i);
    return true;
}

static bool may_have_vertices(int shape)
{
    return shape == FMB_TETRAHEDRON || shape == FMB_FACE || shape == FMB_HULL;
}

/* The number of numbers of a frame; 0: there is no such frame. A hull has vertices. */
static int numbers_of(int dim, const struct fmb_client_frame *frame)
{
    const bool fits = frame->vertices && frame->vertex_count <= FMB_CLIENT_BODY_BYTES_MAX;
    return (int) geometry_number_count(dim, frame->shape, fits ? (int32_t) frame->vertex_count : 0);
}

static bool check_frame(struct scene_error *error, size_t placement, size_t i, int dim,
                        const struct fmb_client_frame *frame)
{
    char field[64];
    const bool known = fmb_shape_name(frame->shape);
    const int count = numbers_of(dim, frame) - dim;
    if (!known || (frame->vertices && !may_have_vertices(frame->shape)))
        return refuse(error, FMB_UNKNOWN_SHAPE, "placements[%zu].frames[%zu].shape", placement, i);
    if (count < 0)
        return refuse(error, frame->shape == FMB_HULL ? FMB_WRONG_COUNT : FMB_WRONG_DIMENSION,
                      "placements[%zu].frames[%zu].shape", placement, i);
    if (frame->vertices) {
        snprintf(field, sizeof field, "frames[%zu].vertices", i);
        if (frame->vertex_count != (size_t) (count / dim + 1))
            return refuse(error, FMB_WRONG_COUNT, "placements[%zu].frames[%zu].vertex_count",
                          placement, i);
        return check_numbers(error, placement, field, frame->vertices, count + dim);
    }
    snprintf(field, sizeof field, "frames[%zu].origin", i);
    if (!check_numbers(error, placement, field, frame->origin, dim))
        return false;
    snprintf(field, sizeof field, "frames[%zu].components", i);
    if (!check_numbers(error, placement, field, frame->components, count))
        return false;
    for (int k = 0; k < count && frame->shape == FMB_BOX; k++)
        if (frame->components[k] < 0)
            return refuse(error, FMB_BAD_SIZE, "placements[%zu].%s[%d]", placement, field, k);
    return true;
}

static bool check_frames(struct scene_error *error, const struct fmb_client_placement *placement,
                         size_t i)
{
    if (placement->frame_count == 0)
        return refuse(error, FMB_NO_FRAMES, "placements[%zu].frame_count", i);
    if (placement->frame_count > FMB_CLIENT_BODY_BYTES_MAX)
        return refuse(error, FMB_OVER_LIMIT, "placements[%zu].frame_count", i);
    for (size_t k = 0; k < placement->frame_count; k++)
        if (!check_frame(error, i, k, placement->dim, &placement->frames[k]))
            return false;
    return client_scene_geometry_bytes(placement) <=
               GEOMETRY_NONE_BYTES + FMB_CLIENT_BODY_BYTES_MAX ||
           refuse(error, FMB_OVER_LIMIT, "placements[%zu].frame_count", i);
}

/* The rule of fmb_placement_check(): a component is 0, or at least 2^-200 times the largest. */
static bool is_orientation(const double *q, int count)
{
    double largest = 0;
    for (int i = 0; i < count; i++)
        largest = fmax(largest, fabs(q[i]));
    for (int i = 0; i < count; i++)
        if (!isfinite(q[i]) || (q[i] != 0 && fabs(q[i]) < ldexp(largest, -200)))
            return false;
    return largest > 0;
}

static bool check_orientation(struct scene_error *error,
                              const struct fmb_client_placement *placement, size_t i)
{
    const int count = placement->orientation_count;
    for (int k = 0; k < 4 && count == 0; k++)
        if (placement->orientation[k] != 0)
            return refuse(error, FMB_WRONG_COUNT, "placements[%zu].orientation_count", i);
    if (count == 0)
        return true;
    if (count != (placement->dim == 2 ? 2 : 4))
        return refuse(error, FMB_WRONG_COUNT, "placements[%zu].orientation_count", i);
    return is_orientation(placement->orientation, count) ||
           refuse(error, FMB_BAD_ORIENTATION, "placements[%zu].orientation", i);
}

static bool is_text(const char *text)
{
    return strlen(text) <= QUERY_NAME_MAX && utf8_is_text(text);
}

static bool check_placement(struct scene_error *error, const struct fmb_client_scene *scene,
                            size_t i)
{
    const struct fmb_client_placement *placement = &scene->placements[i];
    if (!query_id_ok(placement->body_id))
        return refuse(error, FMB_BAD_ID, "placements[%zu].body_id", i);
    if (placement->dim != 2 && placement->dim != 3)
        return refuse(error, FMB_WRONG_DIMENSION, "placements[%zu].dim", i);
    if (placement->dim != scene->placements[0].dim)
        return refuse(error, FMB_DIMENSIONS_DIFFER, "placements[%zu].dim", i);
    if (placement->name && !is_text(placement->name))
        return refuse(error, FMB_BAD_NAME, "placements[%zu].name", i);
    return check_frames(error, placement, i) &&
           check_numbers(error, i, "position", placement->position, placement->dim) &&
           check_orientation(error, placement, i) &&
           check_numbers(error, i, "velocity", placement->velocity, placement->dim);
}

static bool is_zero(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (numbers[i] != 0)
            return false;
    return true;
}

static bool check_placements(struct scene_error *error, const struct fmb_client_scene *scene)
{
    bool moving = false;
    if (scene->placement_count > INT_MAX)
        return refuse(error, FMB_OVER_LIMIT, "placement_count");
    for (size_t i = 0; i < scene->placement_count; i++) {
        if (!check_placement(error, scene, i))
            return false;
        moving = moving || !is_zero(scene->placements[i].velocity, scene->placements[i].dim);
    }
    return (scene->duration == 0 ? scene->instant || !moving : !scene->instant) ||
           refuse(error, FMB_BAD_DURATION, "duration");
}

static bool check_list(struct scene_error *error, const struct fmb_client_scene *scene,
                       const char *name, const unsigned (*pairs)[2], size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (pairs[i][0] >= scene->placement_count || pairs[i][1] >= scene->placement_count ||
            pairs[i][0] == pairs[i][1])
            return refuse(error, FMB_BAD_PAIR, "%s[%zu]", name, i);
    return true;
}

static bool check_groups(struct scene_error *error, const struct fmb_client_scene *scene)
{
    for (size_t i = 0; i < scene->pair_count; i++)
        if (client_scene_is_within_group(scene, scene->pairs[i]))
            return refuse(error, FMB_BAD_PAIR, "pairs[%zu]", i);
    return true;
}

static bool check_pairs(struct scene_error *error, const struct fmb_client_scene *scene)
{
    const int which = (int) scene->which;
    if (which < FMB_PAIRS_ALL || which > FMB_PAIRS_ACROSS)
        return refuse(error, FMB_UNKNOWN_WANT, "which");
    if (scene->split > (which == FMB_PAIRS_ACROSS ? scene->placement_count : 0))
        return refuse(error, FMB_BAD_PAIR, "split");
    if (which == FMB_PAIRS_LISTED ? scene->ignored_count > 0 : scene->pair_count > 0)
        return refuse(error, FMB_WRONG_COUNT,
                      which == FMB_PAIRS_LISTED ? "ignored_count" : "pair_count");
    return check_list(error, scene, "ignored", scene->ignored, scene->ignored_count) &&
           check_list(error, scene, "pairs", scene->pairs, scene->pair_count) &&
           (which != FMB_PAIRS_LISTED || check_groups(error, scene));
}

static bool check_settings(struct scene_error *error, const struct fmb_client_scene *scene)
{
    const unsigned wants = FMB_WANT_BOX | FMB_WANT_CERTIFICATE | FMB_WANT_TIMES | FMB_WANT_GAP;
    if (!(scene->duration >= 0 && isfinite(scene->duration)))
        return refuse(error, FMB_BAD_DURATION, "duration");
    if (!(scene->margin >= 0 && isfinite(scene->margin)))
        return refuse(error, FMB_BAD_MARGIN, "margin");
    if (scene->label && strlen(scene->label) > QUERY_NAME_MAX)
        return refuse(error, FMB_OVER_LIMIT, "label");
    return (scene->want & ~wants) == 0 || refuse(error, FMB_UNKNOWN_WANT, "want");
}

int client_scene_check(const struct fmb_client_scene *scene, char why[FMB_CLIENT_WHY_MAX])
{
    struct scene_error error = {.why = why};
    why[0] = '\0';
    if (check_settings(&error, scene) && check_placements(&error, scene))
        check_pairs(&error, scene);
    return error.status;
}

size_t client_scene_geometry_bytes(const struct fmb_client_placement *placement)
{
    size_t bytes = GEOMETRY_NONE_BYTES;
    for (size_t i = 0; i < placement->frame_count; i++)
        bytes += 1 + (placement->frames[i].vertices ? 4 : 0) +
                 sizeof(double) * (size_t) numbers_of(placement->dim, &placement->frames[i]);
    return bytes;
}

/* Encodes the frames as the geometry of a body (placement_t.lcm). Returns its bytes. */
static size_t write_frames(const struct fmb_client_placement *of, unsigned char *out)
{
    const size_t size = client_scene_geometry_bytes(of);
    const int dim = of->dim;
    struct writer writer = {.at = out, .end = out + size};
    int32_t counts = 0, numbers = 0;
    writer_int32(&writer, dim);
    writer_int32(&writer, (int32_t) of->frame_count);
    for (size_t i = 0; i < of->frame_count; i++) {
        const struct fmb_client_frame *frame = &of->frames[i];
        *writer_take(&writer, 1) = (unsigned char) geometry_code(frame->shape, frame->vertices);
        counts += frame->vertices != NULL;
        numbers += numbers_of(dim, frame);
    }
    writer_int32(&writer, counts);
    for (size_t i = 0; i < of->frame_count; i++)
        if (of->frames[i].vertices)
            writer_int32(&writer, (int32_t) of->frames[i].vertex_count);
    writer_int32(&writer, numbers);
    for (size_t i = 0; i < of->frame_count; i++) {
        const struct fmb_client_frame *frame = &of->frames[i];
        const int count = numbers_of(dim, frame);
        for (int k = 0; k < count; k++)
            writer_double(&writer, frame->vertices ? frame->vertices[k]
                                   : k < dim       ? frame->origin[k]
                                                   : frame->components[k - dim]);
    }
    return size;
}

void client_scene_placement(const struct fmb_client_placement *of, unsigned char *geometry,
                            struct placement *out)
{
    const size_t axes = (size_t) of->dim * sizeof(double);
    *out = (struct placement){.body_id = of->body_id,
                              .dim = of->dim,
                              .frame_count = (int32_t) of->frame_count,
                              .name = of->name,
                              .group = of->group,
                              .orientation_count = of->orientation_count};
    out->geometry = (struct geometry){geometry, write_frames(of, geometry)};
    memcpy(out->position, of->position, axes);
    memcpy(out->orientation, of->orientation, sizeof out->orientation);
    if (is_zero(of->velocity, of->dim))
        return;
    out->velocity_count = of->dim;
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

bool client_scene_is_within_group(const struct fmb_client_scene *scene, const unsigned pair[2])
{
    const int64_t group = scene->placements[pair[0]].group;
    return group != 0 && group == scene->placements[pair[1]].group;
}

bool client_scene_next_pair(const struct fmb_client_scene *scene,
                            struct client_scene_cursor *cursor, unsigned out[2])
{
    if (scene->which == FMB_PAIRS_LISTED) {
        if (cursor->next == scene->pair_count)
            return false;
        memcpy(out, scene->pairs[cursor->next++], sizeof *scene->pairs);
        return true;
    }
    const struct pair_numbers numbers = {scene->which == FMB_PAIRS_ACROSS, scene->placement_count,
                                         scene->split};
    if (!pair_find(numbers, &cursor->a, &cursor->b))
        return false;
    out[0] = (unsigned) cursor->a;
    out[1] = (unsigned) cursor->b++;
    return true;
}
