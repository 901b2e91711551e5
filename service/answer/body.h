/* Makes bodies of their encoded form, with all frames, and the vertices of hulls, in one block of
 * memory. No shared state. */
#ifndef BODY_H
#define BODY_H

#include "geometry.h"

#include <stddef.h>
#include <stdint.h>

/* Bytes of a body of so many frames, 1 or more, without the vertices of hulls, which follow. The
 * first frame is at body.one. */
#define BODY_BYTES(frames) (offsetof(struct fmb_body, one) + (frames) * sizeof(struct fmb_frame))

/* Bytes of a body with the vertices of its hulls. On input: a body whose frames the engine accepts.
 */
size_t body_bytes(const struct body_view *view);

/* A body that is made in several steps. */
struct body_maker {
    struct geometry_reader reader; /* at the next frame */
    void *memory;                  /* of the body */
    double *vertices;              /* memory of the next hull */
    size_t made;                   /* frames so far */
};

/* Frames to make in one step. A frame takes 0.1 microseconds, or up to 11 if it is nearly flat,
 * since that requires an exact inverse: a step takes at most 0.2 ms. A hull counts as one frame
 * more for each BODY_PORTION_VERTICES of its vertices. */
enum { BODY_PORTION = 16, BODY_PORTION_VERTICES = 64 };

/* Begins to make a body. On input: an encoded body whose frames the engine accepts; memory of
 * body_bytes(), aligned as a struct fmb_body. Both must outlive the maker. */
void body_begin(struct body_maker *maker, const struct body_view *view, void *memory);

/* Makes the next frames, while *frames is above 0, and subtracts their number from it. Returns the
 * body, which is at `memory` and may be copied by body_copy() only; NULL: it is not complete. */
const struct fmb_body *body_continue(struct body_maker *maker, int32_t *frames);

/* Makes a body in one step: body_begin(), then body_continue(). */
const struct fmb_body *body_make(const struct body_view *view, void *memory);

/* Copies a body that was made of view. On input: memory of body_bytes(), aligned as a struct
 * fmb_body. */
void body_copy(const struct body_view *view, const struct fmb_body *body, void *memory);

/* The bodies that one query defines. The memory suffices for all bodies that one message can
 * define. Of a message, a frame takes at least GEOMETRY_FRAME_BYTES_MIN = 21 bytes, and the
 * placement of a body 81 more, BODY_BYTES(n) being less than the size of n + 1 frames. A hull of n
 * vertices takes 5 + 8 dim n bytes of it, and 8 (dim 8 ceil(n / 8) + ceil(n / 2)) bytes of memory:
 * at most 6.9 times as many, less than BODY_HULL_BYTES for each 21. */
enum { BODY_HULL_BYTES = 21 * 7 };
struct query_bodies {
    size_t used;             /* bytes of memory that complete bodies take */
    struct body_maker maker; /* of the next body; maker.memory is NULL if none was begun */
    _Alignas(64) unsigned char memory[(QUERY_FRAMES_MAX + 1) *
                                      (sizeof(struct fmb_frame) + BODY_HULL_BYTES)];
};

#endif
