/* Makes bodies of their encoded form, with all frames in one block of memory. No shared state. */
#ifndef BODY_H
#define BODY_H

#include "geometry.h"

#include <stddef.h>
#include <stdint.h>

/* Bytes of a body of so many frames, 1 or more. The first frame is at body.one. */
#define BODY_BYTES(frames) (offsetof(struct fmb_body, one) + (frames) * sizeof(struct fmb_frame))

/* A body that is made in several steps. */
struct body_maker {
    struct geometry_reader reader; /* at the next frame */
    void *memory;                  /* of the body */
    size_t made;                   /* frames so far */
};

/* Frames to make in one step. A frame takes 0.1 microseconds, or up to 11 if it is nearly flat,
 * since that requires an exact inverse: a step takes at most 0.2 ms. */
enum { BODY_PORTION = 16 };

/* Begins to make a body. On input: an encoded body whose frames the engine accepts; memory of
 * BODY_BYTES() of its frames, aligned as a struct fmb_body. Both must outlive the maker. */
void body_begin(struct body_maker *maker, const struct body_view *view, void *memory);

/* Makes the next frames, at most *frames, and subtracts their number from *frames. Returns the
 * body, which is at `memory` and may be copied by body_copy() only; NULL: it is not complete. */
const struct fmb_body *body_continue(struct body_maker *maker, int32_t *frames);

/* Makes a body in one step: body_begin(), then body_continue(). */
const struct fmb_body *body_make(const struct body_view *view, void *memory);

/* Copies a body and its frames. On input: memory of BODY_BYTES() of its frames, aligned as a struct
 * fmb_body. */
void body_copy(const struct fmb_body *body, void *memory);

/* The bodies that one query defines. The memory suffices for all bodies that one message can
 * define: a placement with n frames takes at least 77 + 33 n bytes of the message, and
 * BODY_BYTES(n) is less than (77 + 33 n) / 33 times the size of a frame. */
struct query_bodies {
    size_t used;             /* bytes of memory that complete bodies take */
    struct body_maker maker; /* of the next body; maker.memory is NULL if none was begun */
    _Alignas(64) unsigned char memory[(QUERY_FRAMES_MAX + 1) * sizeof(struct fmb_frame)];
};

/* Removes all bodies. */
void query_bodies_clear(struct query_bodies *bodies);

#endif
