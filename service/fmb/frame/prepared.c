#include "prepared.h"

#include "inlined.h"
#include "motion.h"
#include "rotation.h"
#include "vector.h"

#include <math.h>

/* ---- Summaries ---- */

/* Returns an upper bound of the length of v, whose numbers are below 2^200 in magnitude.
 *
 * The sum of squares and its root have a relative error below 2^-51. Squares that underflow are
 * negligible beside the others of a vector in range. The remainder of the 2^-46 covers vectors that
 * are longer because they were rotated and rounded, by less than 25 u (rotation.h), or rounded as
 * differences of vertices. */
static double length_of(const double v[FMB_DIM_MAX])
{
    return sqrt(vec3_dot(v, v)) * (1 + 0x1p-46);
}

/* Returns the 16 most significant bits of the smallest double >= length whose other bits are 0. */
static uint64_t size_bits(double length)
{
    uint64_t bits;
    memcpy(&bits, &length, sizeof bits);
    return (bits + UINT64_C(0x0000ffffffffffff)) >> 48;
}

/* Returns 1 if the edge from y to x is exactly parallel to a coordinate axis, or 0; else 0. */
INLINE unsigned is_axis_aligned(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX])
{
    return (x[0] == y[0]) + (x[1] == y[1]) + (x[2] == y[2]) >= 2;
}

/* Returns whether some edge of a frame with components c is axis-aligned. */
INLINE bool has_axis_aligned_edge(bool simplex, int count, const double c[FMB_DIM_MAX][FMB_DIM_MAX])
{
    static const double zero[FMB_DIM_MAX];
    unsigned aligned = is_axis_aligned(c[0], zero) | is_axis_aligned(c[1], zero);
    if (count == 3)
        aligned |= is_axis_aligned(c[2], zero);
    if (simplex)
        aligned |= is_axis_aligned(c[0], c[1]);
    if (simplex && count == 3)
        aligned |= is_axis_aligned(c[0], c[2]) | is_axis_aligned(c[1], c[2]);
    return aligned;
}

/* Returns flags at their position in the summary. */
static uint64_t in_summary(unsigned kind)
{
    return (uint64_t) kind << 3 * PREPARED_SIZE_BITS;
}

static const unsigned all_components_exact = PREPARED_COMPONENTS_EXACT_X * 7;

unsigned long long prepared_summary_of(const struct fmb_frame *frame)
{
    const bool plain = frame->spread == 0 && frame->bits[1] - frame->bits[0] <= 24;
    unsigned kind = PREPARED_VALID;
    kind |= frame->shape == FMB_TETRAHEDRON ? PREPARED_TETRAHEDRON : 0;
    kind |= frame->shape == FMB_FACE ? PREPARED_FACE : 0;
    kind |= frame_by_vertices(frame) ? PREPARED_VERTICES : 0;
    kind |= frame->dim == 3 ? PREPARED_3D : 0;
    kind |= frame->in_range ? PREPARED_USABLE : 0;
    kind |= plain ? PREPARED_PLAIN : 0;
    kind |= frame->rounded ? 0 : all_components_exact;
    kind |= has_axis_aligned_edge(frame_is_simplex(frame), frame->count,
                                  (const double(*)[FMB_DIM_MAX]) frame->component)
                ? PREPARED_AXIS_ALIGNED
                : 0;
    uint64_t summary = in_summary(kind);
    for (int i = 0; i < FMB_DIM_MAX && frame->in_range; i++)
        summary |= size_bits(length_of(frame->component[i])) << i * PREPARED_SIZE_BITS;
    return summary;
}

/* ---- World coordinates ---- */

/* The numbers of a prepared frame in 3D: world coordinates and their error. */
struct world_numbers {
    double origin[FMB_DIM_MAX], component[FMB_DIM_MAX][FMB_DIM_MAX];
    double error;
};
_Static_assert(sizeof(struct world_numbers) == sizeof(((struct fmb_prepared *) 0)->number),
               "world_numbers is the layout of fmb_prepared.number in 3D");

/* The relative error of a sum of two coordinates, and a little for that of this bound. */
static const double sum_rounding = 0x1.01p-53;

/* Sets out->origin to position + R origin, and adds its rounding error to out->error. Clears the
 * bits of *exact (as set_numbers() returns them) of the axes whose sum is rounded. */
static void set_origin(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                       const double *position, struct world_numbers *out, unsigned *exact)
{
    double turned[FMB_DIM_MAX];
    bool rounds = !rotation->exact;
    rotation_apply(rotation, frame->origin, turned);
    for (int axis = 0; axis < frame->dim; axis++)
        out->origin[axis] = position[axis] + turned[axis];
    for (int axis = 0; axis < frame->dim && (!rounds || *exact); axis++)
        if (!prepared_exact_sum(position[axis], turned[axis], out->origin[axis])) {
            rounds = true;
            *exact &= ~((unsigned) PREPARED_EXACT_X << axis);
        }
    if (rounds)
        out->error += sum_rounding * vec3_sum(out->origin);
}

static bool is_zero(const double v[FMB_DIM_MAX])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Returns whether no coordinate of a rotated component is too small for the filter. The
 * entries of the rotation are 0, or at least 2^-60 and therefore multiples of 2^-112. Components
 * are multiples of 2^bits[0]. Then all products, rounded or not, are multiples of
 * 2^(bits[0] - 112), and so are their sums. With bits[0] >= -288, a sum that is not 0 is at least
 * 2^-400, PREPARED_LEAST_NUMBER. */
INLINE bool rotates_in_range(const struct fmb_frame *frame, const struct rotation_matrix *rotation)
{
    return !rotation->small && frame->sturdy && frame->bits[0] >= -288;
}

/* Sets out to R times each component. The rotated components of a box are multiples of the columns
 * of R. */
INLINE void rotate_components(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                              double out[FMB_DIM_MAX][FMB_DIM_MAX])
{
    UNROLL(3)
    for (int i = 0; i < FMB_DIM_MAX; i++) {
        const double *c = frame->component[i];
        if (i == 2 && rotation->dim == 2)
            continue; /* not used in 2D */
        if (frame_has_axes(frame)) {
            const rotation_two xy = rotation->xy[i] * c[i];
            memcpy(out[i], &xy, sizeof xy);
            out[i][2] = rotation->z[i] * c[i];
        } else {
            rotation_apply(rotation, c, out[i]);
        }
    }
}

/* out := R v. Coordinates below tiny in magnitude become 0, except those of exact rows. */
static void rotate_and_trim(const struct rotation_matrix *rotation, const double v[FMB_DIM_MAX],
                            double tiny, double out[FMB_DIM_MAX])
{
    rotation_apply(rotation, v, out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        if (fabs(out[axis]) < tiny && !rotation->axis_exact[axis])
            out[axis] = 0;
}

/* Returns PREPARED_CENTRED or 0. exact: the axes along which the origin is exact, as set_numbers()
 * returns them. An exact row of the rotation is plus or minus a unit vector. */
static unsigned centred_of(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                           unsigned exact)
{
    double turned[FMB_DIM_MAX];
    bool rounded = false, same = true;
    rotation_apply(rotation, frame->centre, turned);
    for (int axis = 0; axis < frame->dim; axis++) {
        if (!rotation->axis_exact[axis])
            continue;
        rounded = rounded || !(exact & (unsigned) PREPARED_EXACT_X << axis);
        same = same && turned[axis] == frame->centre[axis];
    }
    return rounded && same ? PREPARED_CENTRED : 0;
}

/* Sets the world coordinates of a frame and their error. Each term of the error has a margin, which
 * covers the rounding of the sum too. Returns which coordinates are exact, as flags:
 * PREPARED_EXACT_X and so on. */
INLINE unsigned set_numbers(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                            const double *position, struct world_numbers *out)
{
    unsigned exact = 0;
    for (int axis = 0; axis < FMB_DIM_MAX && frame->spread == 0; axis++)
        exact |= rotation->axis_exact[axis] ? (unsigned) PREPARED_EXACT_X << axis : 0;
    out->error = frame->spread + (rotation->exact ? 0 : frame->turn_error);
    if (!rotation->turned) {
        memcpy(out->component, frame->component, sizeof out->component);
    } else if (rotates_in_range(frame, rotation)) {
        rotate_components(frame, rotation, out->component);
    } else {
        UNROLL(3)
        for (int i = 0; i < FMB_DIM_MAX; i++)
            rotate_and_trim(rotation, frame->component[i],
                            0x1p-60 * prepared_size(frame->summary, i), out->component[i]);
    }
    out->origin[0] = position[0];
    out->origin[1] = position[1];
    out->origin[2] = frame->dim == 2 ? 0 : position[2];
    if (!is_zero(frame->origin))
        set_origin(frame, rotation, position, out, &exact);
    return frame->shape == FMB_BOX ? exact | centred_of(frame, rotation, exact) : exact;
}

/* Returns the summary of a placed frame: that of the frame, updated for its placement. exact: as
 * set_numbers() returns. */
static uint64_t summary_of(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                           const struct fmb_placement *placement,
                           const struct world_numbers *numbers, unsigned exact)
{
    uint64_t summary = frame->summary | in_summary(exact);
    if (placement_moves(placement, frame->dim))
        summary |= in_summary(PREPARED_MOVING);
    if (numbers->error != 0)
        summary &= ~in_summary(PREPARED_PLAIN);
    if (rotation->exact)
        return summary;
    const bool in_range = rotates_in_range(frame, rotation);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        summary &= rotation->axis_exact[axis] && in_range
                       ? summary
                       : ~in_summary((unsigned) PREPARED_COMPONENTS_EXACT_X << axis);
    summary &= ~in_summary(PREPARED_AXIS_ALIGNED | (frame->sturdy ? 0 : PREPARED_USABLE));
    if (frame->dim == 3 && has_axis_aligned_edge(frame_is_simplex(frame), frame->count,
                                                 (const double(*)[FMB_DIM_MAX]) numbers->component))
        summary |= in_summary(PREPARED_AXIS_ALIGNED);
    return summary;
}

/* ---- Frames in general orientation ---- */

/* set() of a frame in general orientation with coordinates in range: no coordinate is exact, and
 * the frame is not plain. An edge that becomes parallel to an axis by rounding is not detected; the
 * filter then leaves the pair undecided. */
INLINE void set_in_general_orientation(const struct fmb_frame *frame,
                                       const struct rotation_matrix *rotation,
                                       const struct fmb_placement *placement,
                                       struct fmb_prepared *out)
{
    struct world_numbers *numbers = (struct world_numbers *) out->number;
    double *o = numbers->origin;
    memcpy(o, placement->position, sizeof numbers->origin);
    if (!is_zero(frame->origin)) {
        double turned[FMB_DIM_MAX];
        rotation_apply(rotation, frame->origin, turned);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            o[axis] += turned[axis];
    }
    rotate_components(frame, rotation, numbers->component);
    numbers->error = frame->spread + frame->turn_error;
    numbers->error += sum_rounding * vec3_sum(o);
    out->summary = (frame->summary &
                    ~in_summary(PREPARED_AXIS_ALIGNED | PREPARED_PLAIN | all_components_exact)) |
                   (placement_moves(placement, FMB_DIM_MAX) ? in_summary(PREPARED_MOVING) : 0);
    out->frame = frame;
    out->placement = placement;
}

/* ---- All frames ---- */

/* Stores the world coordinates of a frame in 2D in the layout of fmb_prepared.number. */
INLINE void set_numbers_2d(const double origin[2], const double component[][FMB_DIM_MAX],
                           double error, const double velocity[2], double number[13])
{
    const int used = PREPARED_VELOCITY_2D + 1;
    memcpy(number, origin, 2 * sizeof *number);
    memcpy(number + 2, component[0], 2 * sizeof *number);
    memcpy(number + 4, component[1], 2 * sizeof *number);
    number[PREPARED_ERROR_2D - 1] = error;
    memcpy(number + PREPARED_VELOCITY_2D - 1, velocity, 2 * sizeof *number);
    memset(number + used, 0, sizeof((struct fmb_prepared *) 0)->number - used * sizeof *number);
}

/* set() of a frame that is not rotated and whose origin is that of its body. The world coordinates
 * are its own numbers; the result is that of set_numbers() and summary_of(). */
static void set_unrotated(const struct fmb_frame *frame, const struct fmb_placement *placement,
                          struct fmb_prepared *out)
{
    const unsigned axes = (frame->dim == 3 ? 7u : 3u) * PREPARED_EXACT_X;
    out->summary = frame->summary | (frame->spread == 0 ? in_summary(axes) : 0) |
                   (placement_moves(placement, frame->dim) ? in_summary(PREPARED_MOVING) : 0);
    out->frame = frame;
    out->placement = placement;
    if (frame->dim == 2) {
        set_numbers_2d(placement->position, frame->component, frame->spread, placement->velocity,
                       out->number);
        return;
    }
    struct world_numbers *numbers = (struct world_numbers *) out->number;
    memcpy(numbers->origin, placement->position, sizeof numbers->origin);
    memcpy(numbers->component, frame->component, sizeof numbers->component);
    numbers->error = frame->spread;
}

INLINE bool is_unrotated(const struct fmb_frame *frame, const struct fmb_placement *placement)
{
    return placement->orientation_count == 0 && is_zero(frame->origin);
}

/* Prepares a frame with a given rotation. */
INLINE void set(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                const struct fmb_placement *placement, struct fmb_prepared *out)
{
    if (rotation->general && rotates_in_range(frame, rotation)) {
        set_in_general_orientation(frame, rotation, placement, out);
        return;
    }
    struct world_numbers numbers_2d,
        *numbers = frame->dim == 3 ? (struct world_numbers *) out->number : &numbers_2d;
    const unsigned exact = set_numbers(frame, rotation, placement->position, numbers);
    out->summary = summary_of(frame, rotation, placement, numbers, exact);
    out->frame = frame;
    out->placement = placement;
    if (frame->dim == 2)
        set_numbers_2d(numbers_2d.origin, numbers_2d.component, numbers_2d.error,
                       placement->velocity, out->number);
}

/* Not inlined: prepared_set() would save its registers even for frames that are not rotated. */
static __attribute__((noinline)) void set_rotated(const struct fmb_frame *frame,
                                                  const struct fmb_placement *placement,
                                                  struct fmb_prepared *out)
{
    struct rotation_matrix rotation;
    rotation_of(placement, frame->dim, &rotation);
    set(frame, &rotation, placement, out);
}

/* Sets the flags of frames whose placement has an end. */
static void set_flags_of_end(struct fmb_prepared *out, unsigned count)
{
    const unsigned long long set = in_summary(PREPARED_VERTICES | PREPARED_MOVING);
    for (unsigned i = 0; i < count; i++)
        out[i].summary = (out[i].summary | set) & ~in_summary(PREPARED_USABLE | PREPARED_PLAIN);
}

void prepared_set(struct placed_frame placed, struct fmb_prepared *out)
{
    if (is_unrotated(placed.frame, placed.placement))
        set_unrotated(placed.frame, placed.placement, out);
    else
        set_rotated(placed.frame, placed.placement, out);
    if (placed.placement->end_count != 0)
        set_flags_of_end(out, 1);
}

INLINE void set_frames(const struct fmb_placement *placement, unsigned first, unsigned count,
                       struct fmb_prepared *out)
{
    struct rotation_matrix rotation;
    rotation_of(placement, placement->body->dim, &rotation);
    for (unsigned i = 0; i < count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(placement->body, first + i);
        if (is_unrotated(frame, placement))
            set_unrotated(frame, placement, &out[i]);
        else
            set(frame, &rotation, placement, &out[i]);
    }
    if (placement->end_count != 0)
        set_flags_of_end(out, count);
}

void prepared_place(const struct fmb_placement *placement, unsigned first, unsigned count,
                    struct fmb_prepared *out)
{
    set_frames(placement, first, count, out);
}

/* ---- Placements ---- */

/* Returns whether all coordinates are finite: 0 times a number that is not finite is a NaN. */
INLINE bool is_finite(const double v[FMB_DIM_MAX], int dim)
{
    const double none = 0 * v[0] + 0 * v[1];
    return (dim == 2 ? none : none + 0 * v[2]) == 0;
}

INLINE enum fmb_status check_orientation(const struct fmb_placement *placement, int dim)
{
    const double *q = placement->orientation;
    if (placement->orientation_count == 0)
        return q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0 ? FMB_OK : FMB_WRONG_COUNT;
    if (placement->orientation_count != (dim == 2 ? 2 : 4))
        return FMB_WRONG_COUNT;
    return rotation_is_orientation(q, placement->orientation_count) ? FMB_OK : FMB_BAD_ORIENTATION;
}

INLINE enum fmb_status check(const struct fmb_placement *placement)
{
    const struct fmb_body *body = placement->body;
    if (!body || body->frame_count == 0)
        return FMB_NO_FRAMES;
    if (placement->end_count != 0)
        return motion_check(placement);
    if (!is_finite(placement->position, body->dim) || !is_finite(placement->velocity, body->dim))
        return FMB_NOT_FINITE;
    return check_orientation(placement, body->dim);
}

enum fmb_status fmb_placement_check(const struct fmb_placement *placement)
{
    return check(placement);
}

/* check() and rotation_of() are inlined here, so that they share subexpressions. */
enum fmb_status fmb_prepare(const struct fmb_placement *placement, unsigned first, unsigned count,
                            struct fmb_prepared *out)
{
    enum fmb_status status = check(placement);
    if (status == FMB_OK &&
        (first > placement->body->frame_count || count > placement->body->frame_count - first))
        status = FMB_BAD_PAIR;
    if (status == FMB_OK)
        set_frames(placement, first, count, out);
    else
        memset(out, 0, count * sizeof *out);
    return status;
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
    out->summary = prepared->summary;
    memcpy(out->origin, next, dim * sizeof *next);
    memcpy(out->velocity, prepared->placement->velocity, dim * sizeof *next);
    for (size_t i = 0; i < dim; i++) {
        next += dim;
        memcpy(out->component[i], next, dim * sizeof *next);
        for (size_t axis = 0; axis < dim; axis++)
            out->size[i] = fmax(out->size[i], fabs(next[axis]));
    }
    out->error = prepared_error(prepared);
    out->relative_error = out->error == 0                               ? 0
                          : prepared->placement->orientation_count == 0 ? 0x1p-51
                                                                        : ROTATION_ERROR;
}
