#include "model.h"

#include "fuzz.h"

#include <glib.h>
#include <math.h>
#include <string.h>

bool model_by_handle(const struct placement *placement)
{
    bool any = false;
    for (int i = 0; i < HANDLE_BYTES; i++)
        any = any || placement->handle.bytes[i];
    return any && placement->frame_count == 0 && placement->count_count == 0 &&
           placement->number_count == 0;
}

/* ---- Bodies ---- */

static void make(const unsigned char *bytes, size_t size, struct model_made *out)
{
    const struct geometry geometry = {bytes, size};
    struct geometry_reader reader = geometry_begin(&geometry);
    struct geometry_frame frame;
    size_t count = 0;
    while (geometry_next(&reader, &frame)) {
        double number[FMB_FRAME_NUMBERS_MAX];
        const size_t numbers = geometry_frame_numbers(reader.dim, &frame, number);
        FUZZ_CHECK(count < MODEL_FRAMES_MAX);
        FUZZ_CHECK((frame.by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
                       reader.dim, frame.shape, number, numbers, &out->frame[count++]) == FMB_OK);
    }
    FUZZ_CHECK(reader.frames_left == 0 && reader.numbers_left == 0);
    FUZZ_CHECK(fmb_body_make_frames(out->frame, count, &out->body) == FMB_OK);
}

const struct model_body *model_peek(const struct model *model, const struct handle *handle)
{
    for (int i = 0; i < model->count; i++)
        if (memcmp(model->body[i].handle.bytes, handle->bytes, HANDLE_BYTES) == 0)
            return &model->body[i];
    return NULL;
}

enum fmb_status model_find(const struct model *model, const struct placement *placement,
                           struct model_made *out)
{
    const struct model_body *body = model_peek(model, &placement->handle);
    if (!body)
        return FMB_UNKNOWN_BODY;
    make(body->bytes, body->size, out);
    return out->body.dim == placement->dim ? FMB_OK : FMB_WRONG_DIMENSION;
}

struct handle model_keep(struct model *model, const struct placement *placement,
                         struct model_made *out)
{
    const struct geometry *geometry = &placement->geometry;
    struct handle handle = {{0}};
    make(geometry->bytes, geometry->size, out);
    if (placement->body_id == 0)
        return handle;
    handle = hasher_handle(model->hasher, geometry->bytes, geometry->size);
    if (!model_peek(model, &handle)) {
        FUZZ_CHECK(model->count < MODEL_BODIES_MAX);
        struct model_body *body = &model->body[model->count++];
        body->handle = handle;
        body->size = geometry->size;
        memcpy(body->bytes, geometry->bytes, geometry->size);
    }
    return handle;
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
    /* dim, the count of shapes, shapes, the count of counts, counts, the count of numbers */
    const unsigned char *at = placement->geometry.bytes + 4 + 4 + placement->frame_count + 4 +
                              4 * placement->count_count + 4 + 8 * i;
    uint64_t bits = 0;
    for (int b = 0; b < 8; b++)
        bits = bits << 8 | at[b];
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* Number i of the counts of a placement. */
static int64_t count_at(const struct placement *placement, int i)
{
    const unsigned char *at =
        placement->geometry.bytes + 4 + 4 + placement->frame_count + 4 + 4 * i;
    return (int32_t) ((uint32_t) at[0] << 24 | (uint32_t) at[1] << 16 | (uint32_t) at[2] << 8 |
                      at[3]);
}

/* The numbers of a frame by the comments of placement_t.lcm; 0: no such shape, or a hull. */
static int numbers_of(int dim, int shape)
{
    switch (shape) {
    case 6: return dim * (dim + 1);
    case 7: return dim == 3 ? 9 : 0;
    case FMB_CUBOID:
    case FMB_TETRAHEDRON: return dim + dim * dim;
    case FMB_FACE: return dim == 3 ? 9 : 0;
    case FMB_BOX: return 2 * dim;
    default: return 0;
    }
}

static bool good_frames(const struct placement *placement)
{
    const int dim = placement->dim;
    const struct handle none = {{0}};
    bool good = placement->frame_count >= 1 &&
                memcmp(placement->handle.bytes, none.bytes, HANDLE_BYTES) == 0;
    int64_t numbers = 0;
    int counts = 0;
    for (int f = 0; good && f < placement->frame_count; f++) {
        const int shape = placement->geometry.bytes[8 + f], count = numbers_of(dim, shape);
        good = count > 0 && numbers + count <= placement->number_count;
        for (int i = 0; good && i < count; i++) {
            const double number = model_number(placement, (int) numbers + i);
            good = is_finite(number) && !(shape == FMB_BOX && i >= dim && number < 0);
        }
        if (good && shape >= 6)
            good = counts < placement->count_count && count_at(placement, counts++) * dim == count;
        numbers += count;
    }
    return good && numbers == placement->number_count && counts == placement->count_count;
}

/* Whether a name is UTF-8 of at most 64 bytes without control characters. */
static bool good_name(const char *name)
{
    const size_t length = strlen(name);
    bool good = length <= 64 && g_utf8_validate(name, (gssize) length, NULL);
    for (const char *at = name; good && *at; at = g_utf8_next_char(at))
        good = !g_unichar_iscntrl(g_utf8_get_char(at));
    return good;
}

static bool good_orientation(const struct placement *placement)
{
    const int count = placement->orientation_count;
    const double *q = placement->orientation;
    double least = HUGE_VAL, most = 0;
    if (count == 0)
        return true;
    if (count != (placement->dim == 2 ? 2 : 4) || !are_finite(q, count))
        return false;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(q[i]));
        least = q[i] != 0 ? fmin(least, fabs(q[i])) : least;
    }
    return most > 0 && !(most > least * 0x1p200);
}

bool model_good_placement(const struct placement *placement)
{
    const int dim = placement->dim;
    return good_id(placement->body_id) && (dim == 2 || dim == 3) &&
           (model_by_handle(placement) || good_frames(placement)) && good_name(placement->name) &&
           are_finite(placement->position, dim) && good_orientation(placement) &&
           (placement->velocity_count == 0 ||
            (placement->velocity_count == dim && are_finite(placement->velocity, dim)));
}

bool model_good_request(int64_t client_id, int64_t sequence_number, double duration, int32_t method,
                        int32_t want, int32_t wants)
{
    return good_id(client_id) && good_id(sequence_number) && duration >= 0 && is_finite(duration) &&
           method >= 0 && method <= 4 && (want | wants) == wants;
}

struct fmb_placement model_place(const struct placement *placement, const struct model_made *made)
{
    struct fmb_placement out = {.body = &made->body,
                                .orientation_count = placement->orientation_count};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.position[axis] = placement->position[axis];
        out.velocity[axis] = placement->velocity[axis];
    }
    for (int i = 0; i < placement->orientation_count; i++)
        out.orientation[i] = placement->orientation[i];
    return out;
}
