#include "prepared.h"

#include "inlined.h"
#include "rotation.h"

#include <math.h>

/* ---- Heads ---- */

/* Bounds the length of v, whose numbers are below 2^200: the sum of squares and its root have a
 * relative error below 2^-51, and squares that underflow are small against the rest of a vector in
 * range. The rest of the 2^-46 is for vectors that are turned and rounded, which are longer by less
 * than 25 u (rotation.h), or rounded as differences of vertices. */
static double length_of(const double v[FMB_DIM_MAX])
{
    return sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]) * (1 + 0x1p-46);
}

/* The 16 upper bits of the least double of so few bits that is no smaller. */
static uint64_t size_bits(double length)
{
    uint64_t bits;
    memcpy(&bits, &length, sizeof bits);
    return (bits + UINT64_C(0x0000ffffffffffff)) >> 48;
}

/* 1 if an edge from y to x is exactly parallel to a coordinate axis, else 0. */
INLINE unsigned is_along(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX])
{
    return (x[0] == y[0]) + (x[1] == y[1]) + (x[2] == y[2]) >= 2;
}

/* Whether an edge is; in 2D some coordinate always is 0. */
INLINE bool has_edge_along(bool simplex, int count, const double c[FMB_DIM_MAX][FMB_DIM_MAX])
{
    static const double zero[FMB_DIM_MAX];
    unsigned along = is_along(c[0], zero) | is_along(c[1], zero);
    if (count == 3)
        along |= is_along(c[2], zero);
    if (simplex)
        along |= is_along(c[0], c[1]);
    if (simplex && count == 3)
        along |= is_along(c[0], c[2]) | is_along(c[1], c[2]);
    return along;
}

/* A bit of the kind, in its place in the head. */
static uint64_t in_head(unsigned kind)
{
    return (uint64_t) kind << 3 * PREPARED_SIZE_BITS;
}

unsigned long long prepared_head_of(const struct fmb_frame *frame)
{
    const bool plain = !frame->rounded && frame->bits[1] - frame->bits[0] <= 24;
    unsigned kind = PREPARED_GOOD;
    kind |= frame->shape == FMB_TETRAHEDRON ? PREPARED_TETRAHEDRON : 0;
    kind |= frame->shape == FMB_FACE ? PREPARED_FACE : 0;
    kind |= frame->dim == 3 ? PREPARED_SPACE : 0;
    kind |= frame->in_range ? PREPARED_USABLE : 0;
    kind |= plain ? PREPARED_PLAIN : 0;
    kind |= has_edge_along(frame_is_simplex(frame), frame->count,
                           (const double(*)[FMB_DIM_MAX]) frame->component)
                ? PREPARED_ALONG
                : 0;
    uint64_t head = in_head(kind);
    for (int i = 0; i < FMB_DIM_MAX && frame->in_range; i++)
        head |= size_bits(length_of(frame->component[i])) << i * PREPARED_SIZE_BITS;
    return head;
}

/* ---- Places ---- */

/* The world coordinates of a frame in progress. */
struct place {
    double origin[FMB_DIM_MAX], component[FMB_DIM_MAX][FMB_DIM_MAX];
    double error;
};
_Static_assert(sizeof(struct place) == sizeof(((struct fmb_prepared *) 0)->number),
               "the numbers of a prepared frame in 3D");

/* position + R origin. A sum that rounds is off by at most half a unit in the last place on each
 * axis, which is counted twice. exact: as set_place() returns. */
static void set_origin(const struct fmb_frame *frame, const struct rotation *rotation,
                       const double *position, struct place *out, unsigned *exact)
{
    double way[FMB_DIM_MAX];
    bool rounds = !rotation->exact;
    rotation_turn(rotation, frame->origin, 0, way);
    for (int axis = 0; axis < frame->dim; axis++)
        out->origin[axis] = position[axis] + way[axis];
    for (int axis = 0; axis < frame->dim && (!rounds || *exact); axis++)
        if (!prepared_exact_sum(position[axis], way[axis], out->origin[axis])) {
            rounds = true;
            *exact &= ~((unsigned) PREPARED_EXACT_X << axis);
        }
    if (rounds)
        out->error +=
            0x1p-52 * ((fabs(out->origin[0]) + fabs(out->origin[1])) + fabs(out->origin[2]));
}

static bool is_zero(const double v[FMB_DIM_MAX])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Returns which coordinates are exact: PREPARED_EXACT_X and so on. */
INLINE unsigned set_place(const struct fmb_frame *frame, const struct rotation *rotation,
                          const double *position, struct place *out)
{
    unsigned exact = 0;
    for (int axis = 0; axis < FMB_DIM_MAX && frame->slack == 0; axis++)
        exact |= rotation->axis_exact[axis] ? (unsigned) PREPARED_EXACT_X << axis : 0;
    out->error = frame->slack + (rotation->exact ? 0 : frame->turn_error);
    if (rotation->turned) {
        UNROLL(3)
        for (int i = 0; i < FMB_DIM_MAX; i++)
            rotation_turn(rotation, frame->component[i], 0x1p-60 * prepared_size(frame->head, i),
                          out->component[i]);
    } else {
        memcpy(out->component, frame->component, sizeof out->component);
    }
    out->origin[0] = position[0];
    out->origin[1] = position[1];
    out->origin[2] = frame->dim == 2 ? 0 : position[2];
    if (!is_zero(frame->origin))
        set_origin(frame, rotation, position, out, &exact);
    out->error *= 1 + 0x1p-40; /* for its own rounding */
    return exact;
}

/* What the head of the frame does not say yet. */
static uint64_t head_of(const struct fmb_frame *frame, const struct rotation *rotation,
                        const struct fmb_placement *placement, const struct place *place,
                        unsigned exact)
{
    uint64_t head = frame->head | in_head(exact);
    if (placement_moves(placement, frame->dim))
        head |= in_head(PREPARED_MOVING);
    if (place->error != 0)
        head &= ~in_head(PREPARED_PLAIN);
    if (rotation->exact)
        return head;
    head &= ~in_head(PREPARED_ALONG | (frame->sturdy ? 0 : PREPARED_USABLE));
    if (has_edge_along(frame_is_simplex(frame), frame->count,
                       (const double(*)[FMB_DIM_MAX]) place->component))
        head |= in_head(PREPARED_ALONG);
    return head;
}

INLINE void set(const struct fmb_frame *frame, const struct rotation *rotation,
                const struct fmb_placement *placement, struct fmb_prepared *out)
{
    struct place plane, *place = frame->dim == 3 ? (struct place *) out->number : &plane;
    const unsigned exact = set_place(frame, rotation, placement->position, place);
    out->head = head_of(frame, rotation, placement, place, exact);
    out->frame = frame;
    out->placement = placement;
    if (frame->dim == 3)
        return;
    double *number = out->number;
    memset(number, 0, sizeof out->number);
    memcpy(number, plane.origin, 2 * sizeof *number);
    memcpy(number + 2, plane.component[0], 2 * sizeof *number);
    memcpy(number + 4, plane.component[1], 2 * sizeof *number);
    number[PREPARED_ERROR_2D - 1] = plane.error;
}

void prepared_set(const struct placed_frame *placed, struct fmb_prepared *out)
{
    struct rotation rotation;
    rotation_of(placed->placement, placed->frame->dim, &rotation);
    set(placed->frame, &rotation, placed->placement, out);
}

void prepared_place(const struct fmb_placement *placement, unsigned first, unsigned count,
                    struct fmb_prepared *out)
{
    struct rotation rotation;
    rotation_of(placement, placement->body->dim, &rotation);
    for (unsigned i = 0; i < count; i++)
        set(fmb_body_frame(placement->body, first + i), &rotation, placement, &out[i]);
}

enum fmb_status fmb_prepare(const struct fmb_placement *placement, unsigned first, unsigned count,
                            struct fmb_prepared *out)
{
    enum fmb_status status = fmb_placement_check(placement);
    if (status == FMB_OK &&
        (first > placement->body->frame_count || count > placement->body->frame_count - first))
        status = FMB_BAD_PAIR;
    if (status != FMB_OK) {
        memset(out, 0, count * sizeof *out);
        return status;
    }
    prepared_place(placement, first, count, out);
    return FMB_OK;
}

/* ---- One pair ---- */

void world_frame_of(const struct fmb_prepared *prepared, struct world_frame *out)
{
    const struct fmb_frame *frame = prepared->frame;
    const size_t dim = (size_t) frame->dim;
    const double *next = prepared->number;
    memset(out, 0, sizeof *out);
    out->frame = frame;
    out->shape = frame->shape == FMB_BOX ? FMB_CUBOID : frame->shape;
    out->dim = frame->dim;
    out->count = frame->count;
    out->head = prepared->head;
    memcpy(out->origin, next, dim * sizeof *next);
    memcpy(out->velocity, prepared->placement->velocity, dim * sizeof *next);
    for (size_t i = 0; i < dim; i++) {
        next += dim;
        memcpy(out->component[i], next, dim * sizeof *next);
        for (size_t axis = 0; axis < dim; axis++)
            out->size[i] = fmax(out->size[i], fabs(next[axis]));
    }
    out->error = prepared_error(prepared);
    out->turn = out->error == 0                               ? 0
                : prepared->placement->orientation_count == 0 ? 0x1p-51
                                                              : ROTATION_ERROR;
}
