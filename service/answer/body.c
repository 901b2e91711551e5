#include "body.h"

#include "geometry.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

static void make_frame(int dim, const struct geometry_frame *frame, struct fmb_frame *out)
{
    double number[FMB_FRAME_NUMBERS_MAX];
    geometry_numbers(frame, number);
    const enum fmb_status status = (frame->by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
        dim, frame->shape, number, frame->count, out);
    assert(status == FMB_OK);
    (void) status;
}

static struct fmb_frame *frames_of(void *memory)
{
    return (void *) ((char *) memory + offsetof(struct fmb_body, one));
}

void body_begin(struct body_maker *maker, const struct body_view *view, void *memory)
{
    *maker = (struct body_maker){.reader = geometry_begin(view), .memory = memory};
}

const struct fmb_body *body_continue(struct body_maker *maker, int32_t *frames)
{
    struct geometry_frame frame;
    for (; maker->reader.frames_left > 0 && *frames > 0; --*frames) {
        const bool readable = geometry_next(&maker->reader, &frame);
        assert(readable);
        (void) readable;
        make_frame(maker->reader.dim, &frame, &frames_of(maker->memory)[maker->made++]);
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

void body_copy(const struct fmb_body *body, void *memory)
{
    struct fmb_body *out = memory;
    memcpy(memory, body, BODY_BYTES(body->frame_count));
    if (out->frames)
        out->frames = frames_of(memory);
}

void query_bodies_clear(struct query_bodies *bodies)
{
    bodies->used = 0;
    bodies->maker.memory = NULL;
}
