#include "model.h"

#include "fuzz.h"

#include <string.h>

bool model_by_key(const struct query_frame *frame)
{
    return frame->key != 0 && frame->components.count == 0;
}

/* To the front. */
static void use(struct model *model, int i)
{
    const struct model_body used = model->newest[i];
    memmove(&model->newest[1], &model->newest[0], (size_t) i * sizeof used);
    model->newest[0] = used;
}

static int find(const struct model *model, int64_t id)
{
    int i = 0;
    while (i < model->count && model->newest[i].id != id)
        i++;
    return i;
}

static bool is_kind(const struct fmb_body *body, const struct query_frame *frame)
{
    return body->dim == frame->dim && (int) body->shape == frame->shape;
}

bool model_find(struct model *model, const struct query_frame *frame, struct fmb_body *out)
{
    const int i = find(model, frame->body_id);
    if (i == model->count || model->newest[i].key != frame->key ||
        !is_kind(&model->newest[i].body, frame))
        return false;
    use(model, i);
    *out = model->newest[0].body;
    return true;
}

static struct fmb_body make(const struct query_frame *frame)
{
    struct fmb_body body;
    FUZZ_CHECK(fmb_body_make(frame->dim, frame->shape, frame->components.number,
                             (size_t) frame->components.count, &body) == FMB_OK);
    return body;
}

int64_t model_keep(struct model *model, const struct query_frame *frame, struct fmb_body *out)
{
    *out = make(frame);
    if (frame->body_id == 0)
        return 0;
    int i = find(model, frame->body_id);
    const bool known = i < model->count;
    if (!known)
        i = model->count < model->capacity ? model->count++ : model->count - 1;
    struct model_body *body = &model->newest[i];
    if (!known || !is_kind(&body->body, frame) ||
        memcmp(body->number, frame->components.number, sizeof body->number) != 0) {
        *body = (struct model_body){.id = frame->body_id, .key = model->next_key++, .body = *out};
        memcpy(body->number, frame->components.number, sizeof body->number);
    }
    use(model, i);
    return model->newest[0].key;
}

static bool good_id(int64_t id)
{
    return id >= 0 && id < INT64_C(1) << 53;
}

static bool finite_numbers(const struct query_numbers *numbers, int count)
{
    bool good = numbers->count == count;
    for (int i = 0; i < count && good; i++)
        good = numbers->number[i] - numbers->number[i] == 0; /* else that is NaN */
    return good;
}

bool model_good_frame(const struct query_frame *frame)
{
    const bool kind = (frame->dim == 2 || frame->dim == 3) && frame->shape >= FMB_CUBOID &&
                      frame->shape <= (frame->dim == 2 ? FMB_TETRAHEDRON : FMB_FACE);
    const int components = frame->dim * (frame->shape == FMB_FACE ? 2 : frame->dim);
    return kind && good_id(frame->body_id) && good_id(frame->key) &&
           finite_numbers(&frame->origin, frame->dim) &&
           finite_numbers(&frame->components, model_by_key(frame) ? 0 : components) &&
           finite_numbers(&frame->velocity, frame->velocity.count ? frame->dim : 0);
}

bool model_good_question(int64_t client_id, int64_t sequence_number, double duration,
                         int32_t method, int32_t want, int32_t wants)
{
    return good_id(client_id) && good_id(sequence_number) && duration >= 0 &&
           duration - duration == 0 && method >= 0 && method <= 4 && (want | wants) == wants;
}

struct fmb_frame model_frame(const struct query_frame *frame, const struct fmb_body *body)
{
    struct fmb_frame out = {.body = body, .moving = frame->velocity.count > 0};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out.origin[axis] = frame->origin.number[axis];
        out.velocity[axis] = frame->velocity.number[axis];
    }
    return out;
}
