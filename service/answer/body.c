#include "body.h"

#include "frame_numbers.h"
#include "geometry.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

/* Makes a frame; of a hull at *vertices, which is then advanced. */
static void make_frame(int dim, const struct geometry_frame *frame, double **vertices,
                       struct fmb_frame *out)
{
    double number[FMB_DIM_MAX * FMB_HULL_VERTICES_MAX];
    geometry_numbers(frame, number);
    const enum fmb_status status = frame_of_numbers(
        dim, frame->shape, frame->by_vertices, frame->radius, number, frame->count, vertices, out);
    assert(status == FMB_OK);
    (void) status;
}

size_t body_bytes(const struct body_view *view)
{
    struct geometry_reader reader = geometry_begin(view);
    struct geometry_frame frame;
    size_t doubles = 0;
    while (view->count_count > 0 && geometry_next(&reader, &frame))
        if (frame.shape == FMB_HULL)
            doubles += fmb_hull_doubles(view->dim, frame.count / (size_t) view->dim);
    return BODY_BYTES((size_t) view->frame_count) + doubles * sizeof(double);
}

static struct fmb_frame *frames_of(void *memory)
{
    return (void *) ((char *) memory + offsetof(struct fmb_body, one));
}

void body_begin(struct body_maker *maker, const struct body_view *view, void *memory)
{
    *maker = (struct body_maker){
        .reader = geometry_begin(view),
        .memory = memory,
        .vertices = (void *) ((char *) memory + BODY_BYTES((size_t) view->frame_count))};
}

const struct fmb_body *body_continue(struct body_maker *maker, int32_t *frames)
{
    const int dim = maker->reader.dim;
    struct geometry_frame frame;
    for (; maker->reader.frames_left > 0 && *frames > 0; --*frames) {
        const bool readable = geometry_next(&maker->reader, &frame);
        assert(readable);
        (void) readable;
        make_frame(dim, &frame, &maker->vertices, &frames_of(maker->memory)[maker->made++]);
        *frames -= (int32_t) (frame.count / (size_t) dim) / BODY_PORTION_VERTICES;
    }
    if (maker->reader.frames_left > 0)
        return NULL;
    struct fmb_body body;
    const enum fmb_status status =
        fmb_body_make_frames(frames_of(maker->memory), maker->made, &body);
    assert(status == FMB_OK);
    (void) status;
    memcpy(maker->memory, &body, offsetof(struct fmb_body, one)); /* the frames are there */
    return maker->memory;
}

const struct fmb_body *body_make(const struct body_view *view, void *memory)
{
    struct body_maker maker;
    int32_t frames = INT32_MAX;
    body_begin(&maker, view, memory);
    return body_continue(&maker, &frames);
}

void body_copy(const struct body_view *view, const struct fmb_body *body, void *memory)
{
    struct fmb_body *out = memcpy(memory, body, body_bytes(view));
    struct fmb_frame *frames = frames_of(memory);
    if (out->frames)
        out->frames = frames;
    for (int32_t i = 0; view->count_count > 0 && i < view->frame_count; i++)
        if (frames[i].shape == FMB_HULL)
            frames[i].vertices =
                (const double *) ((const char *) memory +
                                  ((const char *) frames[i].vertices - (const char *) body));
}
