#include "check.h"

#include "cursor.h"
#include "geometry.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool check_refuse(struct check_context *context, enum fmb_status status, const char *field,
                  const char *reason)
{
    char place[32] = "";
    if (context->index >= 0 && context->is_pair)
        snprintf(place, sizeof place, "%c.", 'a' + (char) context->index);
    else if (context->index >= 0)
        snprintf(place, sizeof place, "placements[%d].", (int) context->index);
    context->result->status = (int32_t) status;
    snprintf(context->result->detail, QUERY_TEXT_MAX, "%s%s: %s", place, field,
             reason ? reason : fmb_status_text(status));
    return false;
}

bool check_refuse_at(struct check_context *context, enum fmb_status status, const char *list, int i,
                     const char *reason)
{
    char field[32];
    snprintf(field, sizeof field, "%s[%d]", list, i);
    return check_refuse(context, status, field, reason);
}

static bool check_id(struct check_context *context, const char *field, int64_t id)
{
    return query_id_ok(id) || check_refuse(context, FMB_BAD_ID, field, "not from 0 to 2^53 - 1");
}

static bool check_count(struct check_context *context, const char *field, int64_t expected,
                        int32_t found)
{
    char reason[64];
    if (found == expected)
        return true;
    snprintf(reason, sizeof reason, "expected %lld numbers, found %d", (long long) expected,
             (int) found);
    return check_refuse(context, FMB_WRONG_COUNT, field, reason);
}

static bool check_finite(struct check_context *context, const char *list, const double *number,
                         int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(number[i]))
            return check_refuse_at(context, FMB_NOT_FINITE, list, i, NULL);
    return true;
}

/* ---- Frames ---- */

static bool check_shapes(struct check_context *context, const struct body_view *body)
{
    const struct geometry_reader reader = geometry_begin(body);
    int64_t numbers = 0;
    int32_t counts = 0;
    for (int32_t i = 0; i < body->frame_count; i++) {
        const int code = reader.shape[i];
        const struct geometry_shape shape = geometry_shape(code);
        const bool counted = shape.by_vertices && counts < body->count_count;
        const int32_t vertices =
            counted ? (int32_t) big_endian_32(reader.count + 4 * (size_t) counts) : 1;
        const int64_t count = geometry_number_count(body->dim, code, vertices);
        if (shape.shape == 0)
            return check_refuse_at(context, FMB_UNKNOWN_SHAPE, "shapes", i, NULL);
        if (count == 0 && shape.shape != FMB_HULL)
            return check_refuse(context, FMB_WRONG_DIMENSION, "dim", "a face is in 3D");
        if (counted && (count == 0 || count - shape.has_radius != (int64_t) body->dim * vertices))
            return check_refuse_at(context, FMB_WRONG_COUNT, "counts", counts,
                                   "not a number of vertices of this shape");
        if (vertices > FMB_HULL_VERTICES_MAX)
            return check_refuse_at(context, FMB_OVER_LIMIT, "counts", counts,
                                   "more than 1024 vertices");
        numbers += count;
        counts += shape.by_vertices;
    }
    static_assert(FMB_HULL_VERTICES_MAX == 1024, "the reason of a refusal");
    return check_count(context, "num_counts", counts, body->count_count) &&
           check_count(context, "num_numbers", numbers, body->number_count);
}

static bool check_numbers(struct check_context *context, const struct body_view *body)
{
    const struct geometry_reader reader = geometry_begin(body);
    for (int32_t i = 0; i < body->number_count; i++)
        if (!isfinite(cursor_double_at(reader.number + 8 * (size_t) i)))
            return check_refuse_at(context, FMB_NOT_FINITE, "numbers", i, NULL);
    return true;
}

/* No radius and no size of a box may be negative. On input: shapes and numbers have been checked.
 */
static bool check_sizes(struct check_context *context, const struct body_view *body)
{
    struct geometry_reader reader = geometry_begin(body);
    struct geometry_frame frame;
    while (geometry_next(&reader, &frame)) {
        const int32_t end = body->number_count - reader.numbers_left;
        const int32_t first = end - (int32_t) frame.count;
        if (frame.radius < 0)
            return check_refuse_at(context, FMB_BAD_SIZE, "numbers", first - 1,
                                   "a negative radius");
        for (int i = body->dim; frame.shape == FMB_BOX && i < 2 * body->dim; i++)
            if (cursor_double_at(frame.number + 8 * i) < 0)
                return check_refuse_at(context, FMB_BAD_SIZE, "numbers", first + i,
                                       "a negative size");
    }
    return true;
}

/* ---- Placements ---- */

/* A placement has either a handle or frames. */
static bool check_definition(struct check_context *context, const struct body_view *body)
{
    const bool named = !handle_is_none(&body->handle);
    if (named && body->frame_count > 0)
        return check_refuse(context, FMB_WRONG_COUNT, "num_frames", "both a handle and frames");
    if (named)
        return check_count(context, "num_counts", 0, body->count_count) &&
               check_count(context, "num_numbers", 0, body->number_count);
    if (body->frame_count == 0)
        return check_refuse(context, FMB_NO_FRAMES, "num_frames", "neither a handle nor frames");
    return true;
}

/* Whether the engine accepts these orientations. Its rules depend only on the dimension of the
 * body, so any body of that dimension will do. */
static bool are_orientations(int dim, const struct fmb_placement *placed, int end_count)
{
    static const struct fmb_body any[FMB_DIM_MAX + 1] = {
        [2] = {.dim = 2, .frame_count = 1}, [3] = {.dim = 3, .frame_count = 1}};
    struct fmb_placement turned = *placed;
    turned.body = &any[dim];
    turned.end_count = end_count;
    memset(turned.velocity, 0, sizeof turned.velocity);
    return fmb_placement_check(&turned) == FMB_OK;
}

/* On input: the position has been checked. */
static bool check_orientation(struct check_context *context, int dim,
                              const struct fmb_placement *placed)
{
    return placed->orientation_count == 0 ||
           (check_count(context, "num_orientation", dim == 2 ? 2 : 4, placed->orientation_count) &&
            (are_orientations(dim, placed, 0) ||
             check_refuse(context, FMB_BAD_ORIENTATION, "orientation",
                          "zero, not finite, or components that differ by more than 2^200")));
}

/* On input: all other fields have been checked. */
static bool check_end(struct check_context *context, int dim,
                      const struct query_placement *placement)
{
    const struct fmb_placement *placed = &placement->placed;
    if (placed->end_count == 0)
        return true;
    if (placement->velocity_count > 0)
        return check_refuse(context, FMB_WRONG_COUNT, "num_end_pose", "a velocity too");
    if (!check_count(context, "num_end_pose", dim + placed->orientation_count, placed->end_count))
        return false;
    for (int i = 0; i < placed->end_count; i++)
        if (!isfinite(i < dim ? placed->end_position[i] : placed->end_orientation[i - dim]))
            return check_refuse_at(context, FMB_NOT_FINITE, "end_pose", i, NULL);
    return are_orientations(dim, placed, placed->end_count) ||
           check_refuse(context, FMB_BAD_ORIENTATION, "end_pose",
                        "no orientation, half a turn away, or not from 1/4 to 4 times as long");
}

bool check_placement(struct check_context *context, const struct query_placement *placement)
{
    const struct fmb_placement *placed = &placement->placed;
    const struct body_view *body = &placement->body;
    const int dim = body->dim;
    if (!check_id(context, "body_id", placed->id) || !check_definition(context, body))
        return false;
    if (dim != 2 && dim != 3)
        return check_refuse(context, FMB_WRONG_DIMENSION, "dim", "neither 2 nor 3");
    return (query_by_handle(placement) ||
            (check_shapes(context, body) && check_numbers(context, body) &&
             check_sizes(context, body))) &&
           (!placed->name || query_name_ok(placed->name) ||
            check_refuse(context, FMB_BAD_NAME, "name", NULL)) &&
           check_finite(context, "position", placed->position, dim) &&
           check_orientation(context, dim, placed) &&
           (placement->velocity_count == 0 ||
            (check_count(context, "num_velocity", dim, placement->velocity_count) &&
             check_finite(context, "velocity", placed->velocity, dim))) &&
           check_end(context, dim, placement);
}

/* ---- Queries ---- */

bool check_ids(struct check_context *context, int64_t client_id, int64_t sequence_number)
{
    return check_id(context, "client_id", client_id) &&
           check_id(context, "sequence_number", sequence_number);
}

bool check_request(struct check_context *context, double duration, int32_t method, int32_t want,
                   int32_t wants)
{
    if (!(duration >= 0 && isfinite(duration)))
        return check_refuse(context, FMB_BAD_DURATION, "duration", "negative or not finite");
    if (!fmb_method_by_number(method))
        return check_refuse(context, FMB_UNKNOWN_METHOD, "method", NULL);
    if ((want & ~wants) != 0)
        return check_refuse(context, FMB_UNKNOWN_WANT, "want", NULL);
    return !(want & FMB_WANT_GAP) || fmb_method_by_number(method)->certain ||
           check_refuse(context, FMB_CANNOT_DECIDE, "method", "gives no gaps");
}
