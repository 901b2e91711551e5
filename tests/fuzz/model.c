#include "model.h"

#include "fuzz.h"

#include <glib.h>
#include <math.h>
#include <string.h>

bool model_by_handle(const struct query_placement *placement)
{
    bool any = false;
    for (int i = 0; i < HANDLE_BYTES; i++)
        any = any || placement->body.handle.bytes[i];
    return any && placement->body.frame_count == 0 && placement->body.count_count == 0 &&
           placement->body.number_count == 0;
}

/* ---- Bodies ---- */

static void make(const struct body_view *view, struct model_made *out)
{
    struct geometry_reader reader = geometry_begin(view);
    struct geometry_frame frame;
    size_t count = 0, used = 0;
    while (geometry_next(&reader, &frame)) {
        double number[MODEL_NUMBERS_MAX];
        struct fmb_frame *to = &out->frame[count++];
        FUZZ_CHECK(count <= MODEL_FRAMES_MAX && frame.count <= MODEL_NUMBERS_MAX);
        geometry_numbers(&frame, number);
        if (frame.shape == FMB_HULL) {
            const size_t doubles = fmb_hull_doubles(reader.dim, frame.count / (size_t) reader.dim);
            FUZZ_CHECK(used + doubles <= MODEL_DOUBLES_MAX);
            FUZZ_CHECK(fmb_frame_make_hull(reader.dim, number, frame.count, out->vertices + used,
                                           to) == FMB_OK);
            used += doubles;
        } else {
            FUZZ_CHECK((frame.by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
                           reader.dim, frame.shape, number, frame.count, to) == FMB_OK);
        }
        FUZZ_CHECK(fmb_frame_inflate(to, frame.radius) == FMB_OK);
    }
    FUZZ_CHECK(reader.frames_left == 0 && reader.numbers_left == 0);
    FUZZ_CHECK(fmb_body_make_frames(out->frame, count, &out->body) == FMB_OK);
}

const struct model_body *model_peek(const struct model *model, const struct handle *handle)
{
    for (int i = 0; i < model->count; i++)
        if (memcmp(model->body[i].view.handle.bytes, handle->bytes, HANDLE_BYTES) == 0)
            return &model->body[i];
    return NULL;
}

enum fmb_status model_find(const struct model *model, const struct query_placement *placement,
                           struct model_made *out)
{
    const struct model_body *body = model_peek(model, &placement->body.handle);
    if (!body)
        return FMB_UNKNOWN_BODY;
    make(&body->view, out);
    return out->body.dim == placement->body.dim ? FMB_OK : FMB_WRONG_DIMENSION;
}

struct handle model_keep(struct model *model, const struct query_placement *placement,
                         struct model_made *out)
{
    const struct body_view *view = &placement->body;
    struct handle handle = {{0}};
    make(view, out);
    if (placement->placed.id == 0)
        return handle;
    handle = handle_of(view->bytes, view->size);
    if (!model_peek(model, &handle)) {
        FUZZ_CHECK(model->count < MODEL_BODIES_MAX);
        struct model_body *body = &model->body[model->count++];
        body->view = *view;
        body->view.handle = handle;
        body->view.bytes = memcpy(body->bytes, view->bytes, view->size);
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

double model_number(const struct query_placement *placement, int i)
{
    /* dim, the count of shapes, shapes, the count of counts, counts, the count of numbers */
    const unsigned char *at = placement->body.bytes + 4 + 4 + placement->body.frame_count + 4 +
                              4 * placement->body.count_count + 4 + 8 * i;
    uint64_t bits = 0;
    for (int b = 0; b < 8; b++)
        bits = bits << 8 | at[b];
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* Number i of the counts of a placement. */
static int64_t count_at(const struct query_placement *placement, int i)
{
    const unsigned char *at =
        placement->body.bytes + 4 + 4 + placement->body.frame_count + 4 + 4 * i;
    return (int32_t) ((uint32_t) at[0] << 24 | (uint32_t) at[1] << 16 | (uint32_t) at[2] << 8 |
                      at[3]);
}

/* The numbers of a frame by the comments of placement_t.lcm; 0: no such shape. vertices: its
 * count, 0 without one. */
static int64_t numbers_of(int dim, int shape, int64_t vertices)
{
    switch (shape) {
    case 6: return dim * (dim + 1);
    case 7: return dim == 3 ? 9 : 0;
    case FMB_CUBOID:
    case FMB_TETRAHEDRON: return dim + dim * dim;
    case FMB_FACE: return dim == 3 ? 9 : 0;
    case FMB_BOX: return 2 * dim;
    case FMB_HULL: return vertices > 0 && vertices <= 1024 ? dim * vertices : 0;
    default: return 0;
    }
}

static bool good_frames(const struct query_placement *placement)
{
    const int dim = placement->body.dim;
    const struct handle none = {{0}};
    bool good = placement->body.frame_count >= 1 &&
                memcmp(placement->body.handle.bytes, none.bytes, HANDLE_BYTES) == 0;
    int64_t numbers = 0;
    int counts = 0;
    for (int f = 0; good && f < placement->body.frame_count; f++) {
        const int code = placement->body.bytes[8 + f], radius = code >= 16;
        const int shape = radius ? code - 16 : code;
        const bool counted = shape == FMB_HULL || shape >= 6;
        const bool missing = counted && counts == placement->body.count_count;
        const int64_t vertices = counted && !missing ? count_at(placement, counts++) : 0;
        const int64_t count = numbers_of(dim, shape, vertices);
        good = count > 0 && numbers + radius + count <= placement->body.number_count && !missing &&
               (!counted || vertices * dim == count);
        if (good && radius) {
            const double number = model_number(placement, (int) numbers++);
            good = is_finite(number) && number >= 0;
        }
        for (int i = 0; good && i < count; i++) {
            const double number = model_number(placement, (int) numbers + i);
            good = is_finite(number) && !(shape == FMB_BOX && i >= dim && number < 0);
        }
        numbers += count;
    }
    return good && numbers == placement->body.number_count && counts == placement->body.count_count;
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

static bool good_orientation(const struct query_placement *placement)
{
    const int count = placement->placed.orientation_count;
    const double *q = placement->placed.orientation;
    double least = HUGE_VAL, most = 0;
    if (count == 0)
        return true;
    if (count != (placement->body.dim == 2 ? 2 : 4) || !are_finite(q, count))
        return false;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(q[i]));
        least = q[i] != 0 ? fmin(least, fabs(q[i])) : least;
    }
    return most > 0 && !(most > least * 0x1p200);
}

/* Right angles and lengths need exact arithmetic, so the engine checks them. */
static bool good_end(const struct query_placement *placement, double duration)
{
    struct fmb_placement placed = placement->placed;
    const int dim = placement->body.dim, turns = placed.orientation_count;
    struct fmb_body any = {.dim = dim, .frame_count = 1};
    placed.body = &any;
    return placed.end_count == 0 ||
           (placement->velocity_count == 0 && duration > 0 && placed.end_count == dim + turns &&
            are_finite(placed.end_position, dim) && are_finite(placed.end_orientation, turns) &&
            fmb_placement_check(&placed) == FMB_OK);
}

bool model_good_placement(const struct query_placement *placement, double duration)
{
    const int dim = placement->body.dim;
    return good_id(placement->placed.id) && (dim == 2 || dim == 3) &&
           (model_by_handle(placement) || good_frames(placement)) &&
           good_name(placement->placed.name) && are_finite(placement->placed.position, dim) &&
           good_orientation(placement) &&
           (placement->velocity_count == 0 ||
            (placement->velocity_count == dim && are_finite(placement->placed.velocity, dim))) &&
           good_end(placement, duration);
}

bool model_good_request(int64_t client_id, int64_t sequence_number, double duration, int32_t method,
                        int32_t want, int32_t wants)
{
    return good_id(client_id) && good_id(sequence_number) && duration >= 0 && is_finite(duration) &&
           method >= 0 && method <= 4 && (want | wants) == wants;
}

struct fmb_placement model_place(const struct query_placement *placement,
                                 const struct model_made *made)
{
    struct fmb_placement out = {.body = &made->body,
                                .orientation_count = placement->placed.orientation_count,
                                .end_count = placement->placed.end_count};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.position[axis] = placement->placed.position[axis];
        out.velocity[axis] = placement->placed.velocity[axis];
        out.end_position[axis] = placement->placed.end_position[axis];
    }
    for (int i = 0; i < placement->placed.orientation_count; i++) {
        out.orientation[i] = placement->placed.orientation[i];
        out.end_orientation[i] = placement->placed.end_orientation[i];
    }
    return out;
}
