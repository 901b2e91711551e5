/* Boxes of frames over a window, rounded outward.
 *
 * On an axis, the points o + t v + sum x_i c_i of a frame, t in [0, T], reach from
 *
 *     low = o + min(0, v T) + sum_i min(0, c_i)       of a cuboid
 *     low = o + min(0, v T) + min(0, c_0, c_1, ...)   of a tetrahedron and of a face
 *
 * to high, which is -low of the frame with -o, -v and -c_i. So a box keeps low and -high side by
 * side: both come from the same sum, and both are too large where they are wrong.
 *
 * Accuracy. Terms are added one by one, and what is exact stays exact. A sum that was rounded up is
 * known by the sign of its error, which is a double (interval.h), and steps down by 2^-52 of
 * itself: by a whole unit in its last place at least, where it was at most half of one off. It is a
 * normal number then, since sums do not underflow. v T likewise; where the error of that product
 * might not be a double it steps down anyway, by 2^-1074 more, as half of that is how far off it
 * may be where it underflows.
 *
 * Special cases. All terms but o are zero or negative, and o is finite: a sum that overflows goes
 * to -infinity, and stays there. No infinity of the other sign is met, hence no number that is
 * none. Inside the error of a sum there might be one where the numbers are among the largest: such
 * a sum steps down.
 *
 * A frame with an error is widened by it. Where that error, or a coordinate, is not finite, or the
 * frame is turned without being usable, the box is that of a ball: no point of the frame is farther
 * than its radius from the position of its body. */
#ifndef FMB_AABB_H
#define FMB_AABB_H

#ifndef LANES
#define LANES 2
#endif
#include "lanes.h"
#include "prepared.h"

#include <float.h>
#include <math.h>

/* [axis], each {low, -high}. In 2D the third is {0, 0}. */
struct aabb {
    lanes end[FMB_DIM_MAX];
};

/* x <= y. gcc takes such masks apart where it sees what they are made of. */
INLINE lanes_mask aabb_at_most(lanes x, lanes y)
{
#if defined(__SSE2__)
    return (lanes_mask) _mm_cmple_pd((__m128d) x, (__m128d) y);
#else
    return x <= y;
#endif
}

/* x + y or less. On input: x is no +infinity, y <= 0. */
INLINE lanes aabb_sum_down(lanes x, lanes y)
{
    const lanes sum = x + y, part = sum - x;
    const lanes error = (x - (sum - part)) + (y - part);
    const lanes_mask holds =
        aabb_at_most(lanes_of(0), error) & aabb_at_most(error, lanes_of(DBL_MAX));
    const lanes step = lanes_abs(sum) * 0x1p-52;
    return sum - lanes_select(holds, lanes_of(0), step);
}

/* -speed * duration or less; both are finite and not negative. */
INLINE double aabb_path_down(double speed, double duration)
{
    const double path = -speed * duration;
    if (speed == 0 || duration == 0 || duration == 1)
        return path;
    if (path > -0x1p-900)
        return path + path * 0x1p-52 - 0x1p-1074;
    return fma(-speed, duration, -path) < 0 ? path + path * 0x1p-52 : path;
}

/* An axis of a box that moves. */
INLINE lanes aabb_sweep_axis(lanes end, double velocity, double duration)
{
    const double path = aabb_path_down(fabs(velocity), duration);
    const lanes back = {path, 0}, forth = {0, path};
    return aabb_sum_down(end, velocity < 0 ? back : forth);
}

/* {x, -x}, where it is negative. */
INLINE lanes aabb_of_extent(double x)
{
    return lanes_min((lanes){x, -x}, lanes_of(0));
}

/* The components, on an axis. */
INLINE lanes aabb_of_axis(const double *number, const int dim, bool cuboid)
{
    lanes end = {number[0], -number[0]};
    lanes first = aabb_of_extent(number[dim]);
    const lanes second = aabb_of_extent(number[2 * dim]);
    if (cuboid)
        end = aabb_sum_down(end, first);
    first = cuboid ? second : lanes_min(first, second);
    if (dim < 3)
        return aabb_sum_down(end, first);
    const lanes third = aabb_of_extent(number[3 * dim]);
    if (cuboid)
        end = aabb_sum_down(end, first);
    return aabb_sum_down(end, cuboid ? third : lanes_min(first, third));
}

INLINE void aabb_of_axes(const struct fmb_prepared *frame, const int dim, struct aabb *out)
{
    const unsigned kind = prepared_kind(frame);
    const bool cuboid = !(kind & (PREPARED_TETRAHEDRON | PREPARED_FACE));
    const double error = frame->number[(dim == 3 ? PREPARED_ERROR_3D : PREPARED_ERROR_2D) - 1];
    UNROLL(3)
    for (int axis = 0; axis < dim; axis++)
        out->end[axis] = aabb_of_axis(frame->number + axis, dim, cuboid);
    if (error == 0)
        return;
    for (int axis = 0; axis < dim; axis++)
        out->end[axis] = aabb_sum_down(out->end[axis], lanes_of(-error));
}

INLINE void aabb_of_ball(const struct fmb_prepared *frame, struct aabb *out)
{
    for (int axis = 0; axis < frame->frame->dim; axis++) {
        const double at = frame->placement->position[axis];
        out->end[axis] = aabb_sum_down((lanes){at, -at}, lanes_of(-frame->frame->radius));
    }
}

/* Whether the numbers of a frame do not bound it. */
INLINE bool aabb_needs_ball(const struct fmb_prepared *frame)
{
    const double error = prepared_error(frame);
    return error != 0 && (!(error <= DBL_MAX) || (frame->placement->orientation_count != 0 &&
                                                  !(prepared_kind(frame) & PREPARED_USABLE)));
}

/* On input: a prepared frame, a legal duration. */
INLINE struct aabb aabb_of(const struct fmb_prepared *frame, double duration)
{
    const unsigned kind = prepared_kind(frame);
    const int dim = kind & PREPARED_3D ? 3 : 2;
    struct aabb out = {{{0}}};
    if (aabb_needs_ball(frame))
        aabb_of_ball(frame, &out);
    else if (dim == 3)
        aabb_of_axes(frame, 3, &out);
    else
        aabb_of_axes(frame, 2, &out);
    for (int axis = 0; axis < dim && kind & PREPARED_MOVING; axis++)
        out.end[axis] = aabb_sweep_axis(out.end[axis], prepared_velocity(frame)[axis], duration);
    return out;
}

/* The smallest box that holds both. */
INLINE struct aabb aabb_union(struct aabb x, struct aabb y)
{
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        x.end[axis] = lanes_min(x.end[axis], y.end[axis]);
    return x;
}

/* What boxes are held against that may meet a box: {high, -low} of it. */
INLINE struct aabb aabb_probe(const struct aabb *box)
{
    struct aabb out;
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] = (lanes){-box->end[axis][1], -box->end[axis][0]};
    return out;
}

/* The same for boxes that may be no farther away than reach on each axis, >= 0. Sums round: reach
 * has to be larger by that where it is not 0. */
INLINE struct aabb aabb_probe_within(const struct aabb *box, double reach)
{
    struct aabb out = aabb_probe(box);
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] += lanes_of(reach);
    return out;
}

/* The largest magnitude of a coordinate. */
INLINE double aabb_max_coordinate(const struct aabb *box)
{
    lanes largest = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        largest = lanes_max(largest, lanes_abs(box->end[axis]));
    return largest[0] > largest[1] ? largest[0] : largest[1];
}

/* Whether the boxes, one of them turned round by aabb_probe(), have a point in common. */
INLINE bool aabb_overlaps(const struct aabb *box, const struct aabb *against)
{
    lanes_mask meet = aabb_at_most(box->end[0], against->end[0]);
    UNROLL(3)
    for (int axis = 1; axis < FMB_DIM_MAX; axis++)
        meet &= aabb_at_most(box->end[axis], against->end[axis]);
    return lanes_all(meet);
}

#endif
