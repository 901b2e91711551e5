/* What a prepared frame holds, and the way back from it.
 *
 * The head, from its least significant bit: the sizes of components 0, 1 and 2, 16 bits each, then
 * the bits below. A size is the upper half of a double's upper half, rounded up: a shift to the
 * top of 64 bits makes it a double that is no smaller than the length of the component (its
 * 2-norm) and at most a fifteenth larger. 0 for a component that is not there, or is 0. */
#ifndef FMB_PREPARED_H
#define FMB_PREPARED_H

#include "fmb.h"

#include <string.h>

enum {
    PREPARED_SIZE_BITS = 16,
    PREPARED_TETRAHEDRON = 1 << 0, /* neither: a cuboid */
    PREPARED_FACE = 1 << 1,
    PREPARED_SPACE = 1 << 2,  /* 3D */
    PREPARED_MOVING = 1 << 3, /* carries a velocity */
    PREPARED_ALONG = 1 << 4,  /* an edge is parallel to a coordinate axis */
    PREPARED_USABLE = 1 << 5, /* doubles can say something of it: fmb_body.in_range */
    PREPARED_PLAIN = 1 << 6,  /* components of few bits, as people write them */
    PREPARED_GOOD = 1 << 7,   /* it was prepared */
    PREPARED_ROUNDED = 1 << 8 /* its components are off by a rest that is not here */
};

/* The bits of the kind. */
static inline unsigned prepared_kind(const struct fmb_prepared *frame)
{
    return (unsigned) (frame->head >> 3 * PREPARED_SIZE_BITS);
}

/* Of a pair: both frames plain; one of them moving. */
static inline bool prepared_both_plain(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    return prepared_kind(a) & prepared_kind(b) & PREPARED_PLAIN;
}

static inline bool prepared_one_moves(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    return (prepared_kind(a) | prepared_kind(b)) & PREPARED_MOVING;
}

static inline const double *prepared_velocity(const struct fmb_prepared *frame)
{
    return frame->number + (prepared_kind(frame) & PREPARED_SPACE ? 12 : 6);
}

/* No smaller than the length of component i. */
static inline double prepared_size(unsigned long long head, int i)
{
    const unsigned long long bits = head << (64 - PREPARED_SIZE_BITS * (1 + i));
    const unsigned long long upper = bits >> 48 << 48;
    double size;
    memcpy(&size, &upper, sizeof size);
    return size;
}

/* size, in_range and bits of a body, which are 0, from the rest of it but the
 * inverse. */
void body_measure(struct fmb_body *body);

/* A tetrahedron in 2D without its inverse, [component][axis]. Its numbers are 0 or at least 2^-400
 * and at most 2^200, so that doubles tell exactly whether it is flat. */
void body_set_plane_triangle(const double components[2][2], struct fmb_body *out);

/* Whether a window may last so long, in seconds: not negative, and finite. */
bool prepared_is_duration(double duration);

/* The head of a body, of which all else is set; of a frame with it at rest. */
unsigned long long prepared_head_of(const struct fmb_body *body);

/* The bits of the kind of a frame that is not prepared yet. */
static inline unsigned prepared_kind_of(const struct fmb_frame *frame)
{
    return (unsigned) (frame->body->head >> 3 * PREPARED_SIZE_BITS) |
           (frame->moving ? PREPARED_MOVING : 0);
}

/* As fmb_prepare(), of a frame that is known to be finite. */
void prepared_set(const struct fmb_frame *frame, struct fmb_prepared *out);

/* The frame that was prepared. Its body is put into *body, all of it but the inverse; flat says
 * whether it is usable. */
struct fmb_frame prepared_frame(const struct fmb_prepared *frame, struct fmb_body *body);

#endif
