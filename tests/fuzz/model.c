#include "model.h"

#include "fuzz.h"

#include <string.h>

bool model_by_handle(const struct placement *placement)
{
    bool any = false;
    for (int i = 0; i < HANDLE_BYTES; i++)
        any = any || placement->handle.bytes[i];
    return any && placement->frame_count == 0 && placement->number_count == 0;
}

/* ---- Bodies ---- */

/* To the front. */
static void use(struct model *model, int i)
{
    const struct model_body used = model->newest[i];
    memmove(&model->newest[1], &model->newest[0], (size_t) i * sizeof used);
    model->newest[0] = used;
}

static int find(const struct model *model, const struct handle *handle)
{
    int i = 0;
    while (i < model->count &&
           memcmp(model->newest[i].handle.bytes, handle->bytes, HANDLE_BYTES) != 0)
        i++;
    return i;
}

static struct fmb_body make(const unsigned char *bytes, size_t size)
{
    const struct geometry geometry = {bytes, size};
    struct geometry_frame frame;
    struct fmb_body body;
    int dim;
    FUZZ_CHECK(geometry_read(&geometry, &dim, &frame));
    FUZZ_CHECK(fmb_body_make(dim, frame.shape, frame.components, (size_t) (frame.count * dim),
                             &body) == FMB_OK);
    return body;
}

enum fmb_status model_find(struct model *model, const struct placement *placement,
                           struct fmb_body *out)
{
    const int i = find(model, &placement->handle);
    if (i == model->count)
        return FMB_UNKNOWN_BODY;
    use(model, i);
    *out = make(model->newest[0].bytes, model->newest[0].size);
    return out->dim == placement->dim ? FMB_OK : FMB_WRONG_DIMENSION;
}

const struct model_body *model_peek(const struct model *model, const struct handle *handle)
{
    const int i = find(model, handle);
    return i < model->count ? &model->newest[i] : NULL;
}

struct handle model_keep(struct model *model, const struct placement *placement,
                         struct fmb_body *out)
{
    const struct geometry *geometry = &placement->geometry;
    struct model_body body = {.size = geometry->size};
    *out = make(geometry->bytes, geometry->size);
    if (placement->body_id == 0)
        return body.handle;
    memcpy(body.bytes, geometry->bytes, geometry->size);
    body.handle = hasher_handle(model->hasher, geometry->bytes, geometry->size);
    int i = find(model, &body.handle);
    if (i == model->count) {
        i = model->count < model->capacity ? model->count++ : model->count - 1;
        model->newest[i] = body;
    }
    use(model, i);
    return body.handle;
}

/* ---- Good queries ---- */

static bool good_id(int64_t id)
{
    return id >= 0 && id < INT64_C(1) << 53;
}

static bool is_finite(double number)
{
    return number - number == 0; /* else that is NaN */
}

static bool are_finite(const double *number, int count)
{
    bool good = true;
    for (int i = 0; i < count; i++)
        good = good && is_finite(number[i]);
    return good;
}

double model_number(const struct placement *placement, int i)
{
    /* dim, the count of shapes, shapes, the count of numbers */
    const unsigned char *at =
        placement->geometry.bytes + 4 + 4 + placement->frame_count + 4 + 8 * i;
    uint64_t bits = 0;
    for (int b = 0; b < 8; b++)
        bits = bits << 8 | at[b];
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* One frame with its origin at 0, and no handle. */
static bool good_frames(const struct placement *placement)
{
    const int dim = placement->dim;
    const struct handle none = {{0}};
    if (placement->frame_count != 1 ||
        memcmp(placement->handle.bytes, none.bytes, HANDLE_BYTES) != 0)
        return false;
    const int shape = placement->geometry.bytes[8];
    bool good = shape >= FMB_CUBOID && shape <= (dim == 2 ? FMB_TETRAHEDRON : FMB_FACE) &&
                placement->number_count == dim * (1 + (shape == FMB_FACE ? 2 : dim));
    for (int i = 0; good && i < placement->number_count; i++)
        good =
            is_finite(model_number(placement, i)) && (i >= dim || model_number(placement, i) == 0);
    return good;
}

bool model_good_placement(const struct placement *placement)
{
    const int dim = placement->dim;
    return good_id(placement->body_id) && (dim == 2 || dim == 3) &&
           (model_by_handle(placement) || good_frames(placement)) &&
           are_finite(placement->position, dim) && placement->orientation_count == 0 &&
           (placement->velocity_count == 0 ||
            (placement->velocity_count == dim && are_finite(placement->velocity, dim)));
}

bool model_good_request(int64_t client_id, int64_t sequence_number, double duration, int32_t method,
                        int32_t want, int32_t wants)
{
    return good_id(client_id) && good_id(sequence_number) && duration >= 0 && is_finite(duration) &&
           method >= 0 && method <= 4 && (want | wants) == wants;
}

struct fmb_frame model_frame(const struct placement *placement, const struct fmb_body *body)
{
    struct fmb_frame out = {.body = body, .moving = placement->velocity_count > 0};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.origin[axis] = placement->position[axis];
        out.velocity[axis] = placement->velocity[axis];
    }
    return out;
}
