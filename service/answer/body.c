#include "body.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

int32_t body_frame_count(const struct geometry *geometry)
{
    return geometry_begin(geometry).frames_left;
}

static void make_frame(int dim, const struct geometry_frame *frame, struct fmb_frame *out)
{
    double number[GEOMETRY_FRAME_NUMBERS_MAX];
    const size_t count = (size_t) geometry_number_count(dim, frame->shape), origin = (size_t) dim;
    memcpy(number, frame->origin, origin * sizeof *number);
    memcpy(number + origin, frame->components, (count - origin) * sizeof *number);
    const enum fmb_status status = fmb_frame_make(dim, frame->shape, number, count, out);
    assert(status == FMB_OK);
    (void) status;
}

const struct fmb_body *body_make(const struct geometry *geometry, void *memory)
{
    struct geometry_reader reader = geometry_begin(geometry);
    struct fmb_body *out = memory, body;
    struct fmb_frame *frames = (void *) ((char *) memory + offsetof(struct fmb_body, one));
    const size_t count = (size_t) reader.frames_left;
    struct geometry_frame frame;
    for (size_t i = 0; i < count; i++) {
        const bool readable = geometry_next(&reader, &frame);
        assert(readable);
        (void) readable;
        make_frame(reader.dim, &frame, &frames[i]);
    }
    const enum fmb_status status = fmb_body_make_frames(frames, count, &body);
    assert(status == FMB_OK);
    (void) status;
    memcpy(out, &body, offsetof(struct fmb_body, one)); /* the first frame is there already */
    return out;
}

const struct fmb_body *query_bodies_add(struct query_bodies *bodies,
                                        const struct geometry *geometry)
{
    const size_t size = BODY_BYTES((size_t) body_frame_count(geometry));
    void *memory = bodies->memory + bodies->used;
    assert(size <= sizeof bodies->memory - bodies->used);
    bodies->used += size;
    return body_make(geometry, memory);
}
