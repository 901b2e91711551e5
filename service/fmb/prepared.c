#include "prepared.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* The 16 upper bits of the least double of so few bits that is no smaller than the length of v,
 * whose numbers are below 2^200. The sum of squares and its root have a relative error below
 * 2^-51, and squares that underflow are small against the rest of a vector in range. */
static uint64_t size_bits(const double v[FMB_DIM_MAX])
{
    const double length = sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]) * (1 + 0x1p-50);
    uint64_t bits;
    memcpy(&bits, &length, sizeof bits);
    return (bits + UINT64_C(0x0000ffffffffffff)) >> 48;
}

/* Whether an edge is exactly parallel to a coordinate axis. */
static bool is_along(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX])
{
    return (x[0] == y[0]) + (x[1] == y[1]) + (x[2] == y[2]) >= 2;
}

static bool has_edge_along(const struct fmb_body *body)
{
    static const double zero[FMB_DIM_MAX];
    for (int i = 0; i < body->count; i++) {
        if (is_along(body->component[i], zero))
            return true;
        for (int j = 0; j < i && body->shape != FMB_CUBOID; j++)
            if (is_along(body->component[i], body->component[j]))
                return true;
    }
    return false;
}

unsigned long long prepared_head_of(const struct fmb_body *body)
{
    uint64_t kind = PREPARED_GOOD;
    kind |= body->shape == FMB_TETRAHEDRON ? PREPARED_TETRAHEDRON : 0;
    kind |= body->shape == FMB_FACE ? PREPARED_FACE : 0;
    kind |= body->dim == 3 ? PREPARED_SPACE : 0;
    kind |= body->in_range ? PREPARED_USABLE : 0;
    kind |= body->rounded ? PREPARED_ROUNDED : 0;
    kind |= has_edge_along(body) ? PREPARED_ALONG : 0;
    kind |= body->bits[1] - body->bits[0] <= 24 ? PREPARED_PLAIN : 0;
    uint64_t head = kind << 3 * PREPARED_SIZE_BITS;
    for (int i = 0; i < FMB_DIM_MAX && body->in_range; i++)
        head |= size_bits(body->component[i]) << i * PREPARED_SIZE_BITS;
    return head;
}

void prepared_set(const struct fmb_frame *frame, struct fmb_prepared *out)
{
    const struct fmb_body *body = frame->body;
    const double(*c)[FMB_DIM_MAX] = body->component;
    const uint64_t moving = frame->moving ? PREPARED_MOVING : 0;
    double *number = out->number;
    out->head = body->head | moving << 3 * PREPARED_SIZE_BITS;
    if (body->dim == 3) {
        memcpy(number, frame->origin, 3 * sizeof *number);
        memcpy(number + 3, c, 9 * sizeof *number);
        for (int axis = 0; axis < 3; axis++)
            number[12 + axis] = frame->moving ? frame->velocity[axis] : 0;
        return;
    }
    memset(number, 0, sizeof out->number);
    memcpy(number, frame->origin, 2 * sizeof *number);
    memcpy(number + 2, c[0], 2 * sizeof *number);
    memcpy(number + 4, c[1], 2 * sizeof *number);
    if (frame->moving)
        memcpy(number + 6, frame->velocity, 2 * sizeof *number);
}

enum fmb_status fmb_prepare(const struct fmb_frame *frame, struct fmb_prepared *out)
{
    const struct fmb_pair with_itself = {*frame, *frame, 0};
    const enum fmb_status status = fmb_pair_check(&with_itself);
    if (status == FMB_OK)
        prepared_set(frame, out);
    else
        memset(out, 0, sizeof *out);
    return status;
}

static enum fmb_shape shape_of(unsigned kind)
{
    return kind & PREPARED_FACE          ? FMB_FACE
           : kind & PREPARED_TETRAHEDRON ? FMB_TETRAHEDRON
                                         : FMB_CUBOID;
}

struct fmb_frame prepared_frame(const struct fmb_prepared *prepared, struct fmb_body *body)
{
    const unsigned kind = prepared_kind(prepared);
    struct fmb_frame frame = {.body = body, .moving = kind & PREPARED_MOVING};
    memset(body, 0, sizeof *body);
    body->dim = kind & PREPARED_SPACE ? 3 : 2;
    body->shape = shape_of(kind);
    body->count = fmb_component_count(body->dim, body->shape);
    body->flat = body->shape == FMB_FACE || !(kind & PREPARED_USABLE);
    const size_t dim = (size_t) body->dim;
    const double *next = prepared->number;
    memcpy(frame.origin, next, dim * sizeof *next);
    next += dim;
    for (size_t i = 0; i < dim; i++, next += dim)
        memcpy(body->component[i], next, dim * sizeof *next);
    memcpy(frame.velocity, next, dim * sizeof *next);
    body_measure(body);
    body->head = prepared->head & ~((uint64_t) PREPARED_MOVING << 3 * PREPARED_SIZE_BITS);
    return frame;
}
