/* Axis-aligned bounding boxes (AABBs) of frames, swept over a window and rounded outward.
 *
 * On an axis, the points o + t v + sum x_i c_i of a frame, t in [0, T], form an interval [low,
 * high]:
 *
 *     low = o + min(0, v T) + sum_i min(0, c_i)       of a cuboid
 *     low = o + min(0, v T) + min(0, c_0, c_1, ...)   of a tetrahedron and of a face
 *
 * and high is -low of the frame with -o, -v and -c_i. So a box stores the pair {low, -high}. Both
 * are computed by the same sum, and for both rounding outward means rounding down.
 *
 * Accuracy. Terms are added one by one, and exact sums stay exact. The error of a sum is a double
 * (interval.h), and its sign says whether the sum was rounded up. If so, the sum is lowered by
 * 2^-52 of itself. That is at least one unit in the last place, and the error was at most half a
 * unit. Such a sum is a normal number, since sums do not underflow. The product v T is treated in
 * the same way. Where its error might not be a double, it is lowered unconditionally, and by
 * 2^-1074 more, since underflow makes it off by at most half of that.
 *
 * Special cases. All terms but o are zero or negative, and o is finite. A sum that overflows is
 * therefore -infinity, and stays so; +infinity does not occur, and no sum is a NaN. The computed
 * error of a sum may be a NaN if the numbers are among the largest: such a sum is lowered.
 *
 * The numbers of a hull are those of a cuboid that contains it. The box of a frame with an error is
 * expanded by the error. If the error or a coordinate is not finite, or a frame other than a hull
 * is rotated and not usable, the box is that of a ball: no point of the frame is farther than its
 * reach from the position of its body.
 *
 * No shared state. */
#ifndef FMB_AABB_H
#define FMB_AABB_H

#ifndef LANES
#define LANES 2
#endif
#include "lanes.h"
#include "prepared.h"

#include <float.h>
#include <math.h>

/* A box: [axis], each {low, -high}. In 2D the third is {0, 0}. */
struct aabb {
    lanes end[FMB_DIM_MAX];
};

/* x <= y, lane by lane. An intrinsic, because gcc splits a mask into lanes if it sees the
 * comparison that the mask comes from. */
INLINE lanes_mask aabb_at_most(lanes x, lanes y)
{
#if defined(__SSE2__)
    return (lanes_mask) _mm_cmple_pd((__m128d) x, (__m128d) y);
#else
    return x <= y;
#endif
}

/* A lower bound of x + y: the sum itself if it is exact. In: x < +infinity, y <= 0. */
INLINE lanes aabb_sum_down(lanes x, lanes y)
{
    const lanes sum = x + y, part = sum - x;
    const lanes error = (x - (sum - part)) + (y - part);
    const lanes_mask is_bound =
        aabb_at_most(lanes_of(0), error) & aabb_at_most(error, lanes_of(DBL_MAX));
    const lanes step = lanes_abs(sum) * 0x1p-52;
    return sum - lanes_select(is_bound, lanes_of(0), step);
}

/* A lower bound of -speed * duration. In: both are finite and not negative. */
INLINE double aabb_path_down(double speed, double duration)
{
    const double path = -speed * duration;
    if (speed == 0 || duration == 0 || duration == 1)
        return path;
    if (path > -0x1p-900)
        return path + path * 0x1p-52 - 0x1p-1074;
    return fma(-speed, duration, -path) < 0 ? path + path * 0x1p-52 : path;
}

/* One axis of a box, swept over the window. */
INLINE lanes aabb_sweep_axis(lanes end, double velocity, double duration)
{
    const double path = aabb_path_down(fabs(velocity), duration);
    const lanes back = {path, 0}, forth = {0, path};
    return aabb_sum_down(end, velocity < 0 ? back : forth);
}

/* {min(0, x), min(0, -x)} */
INLINE lanes aabb_of_extent(double x)
{
    return lanes_min((lanes){x, -x}, lanes_of(0));
}

/* One axis of a frame at rest. In: number points to that coordinate of the origin in the numbers of
 * a prepared frame. */
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

/* The box of a frame at rest, from its numbers. */
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

/* The box of a hull that is rotated, at rest. The sums may round here: the boxes of hulls are
 * not tight anyway.
 *
 * Let M be the sum of the terms other than o, each at most 0. Four sums of numbers of magnitudes at
 * most |o| + |M| + error round by at most 2^-53 of that each, which 2^-50 (|o| + |M|) and the
 * factor cover. Where the product underflows, the sums are exact. */
INLINE void aabb_of_turned_hull(const struct fmb_prepared *frame, const int dim, struct aabb *out)
{
    const double error = frame->number[(dim == 3 ? PREPARED_ERROR_3D : PREPARED_ERROR_2D) - 1];
    UNROLL(3)
    for (int axis = 0; axis < dim; axis++) {
        const double *number = frame->number + axis;
        const lanes origin = {number[0], -number[0]};
        lanes others = aabb_of_extent(number[dim]) + aabb_of_extent(number[2 * dim]);
        if (dim == 3)
            others += aabb_of_extent(number[3 * dim]);
        const lanes outward = (error + 0x1p-50 * (lanes_abs(origin) - others)) * (1 + 0x1p-50);
        out->end[axis] = (origin + others) - outward;
    }
}

/* The box of the ball that contains a frame at rest. */
INLINE void aabb_of_ball(const struct fmb_prepared *frame, struct aabb *out)
{
    for (int axis = 0; axis < frame->frame->dim; axis++) {
        const double at = frame->placement->position[axis];
        out->end[axis] = aabb_sum_down((lanes){at, -at}, lanes_of(-frame->frame->reach));
    }
}

/* Whether the numbers of a frame do not bound it, so that its box has to be that of a ball. */
INLINE bool aabb_needs_ball(const struct fmb_prepared *frame)
{
    const double error = prepared_error(frame);
    return error != 0 && (!(error <= DBL_MAX) || (frame->placement->orientation_count != 0 &&
                                                  !(prepared_kind(frame) & PREPARED_USABLE) &&
                                                  frame->frame->shape != FMB_HULL));
}

/* Returns the box of a prepared frame over the window [0, duration]. In: duration is legal; the
 * placement has no end, or the duration is 0. */
INLINE struct aabb aabb_of(const struct fmb_prepared *frame, double duration)
{
    const unsigned kind = prepared_kind(frame);
    const int dim = kind & PREPARED_3D ? 3 : 2;
    struct aabb out = {{{0}}};
    if (aabb_needs_ball(frame))
        aabb_of_ball(frame, &out);
    else if (kind & PREPARED_VERTICES && !(kind & (PREPARED_TETRAHEDRON | PREPARED_FACE)) &&
             prepared_error(frame) != 0)
        dim == 3 ? aabb_of_turned_hull(frame, 3, &out) : aabb_of_turned_hull(frame, 2, &out);
    else if (dim == 3)
        aabb_of_axes(frame, 3, &out);
    else
        aabb_of_axes(frame, 2, &out);
    for (int axis = 0; axis < dim && kind & PREPARED_MOVING; axis++)
        out.end[axis] = aabb_sweep_axis(out.end[axis], prepared_velocity(frame)[axis], duration);
    return out;
}

/* box := the ends of an AABB, [lower, upper][axis]. */
INLINE void aabb_get_ends(const struct aabb *aabb, double box[2][FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        box[0][axis] = aabb->end[axis][0];
        box[1][axis] = 0 - aabb->end[axis][1];
    }
}

/* Returns the smallest box that contains both. */
INLINE struct aabb aabb_union(struct aabb x, struct aabb y)
{
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        x.end[axis] = lanes_min(x.end[axis], y.end[axis]);
    return x;
}

/* Returns the probe of a box, the second operand of aabb_overlaps(): {high, -low} on each axis. */
INLINE struct aabb aabb_probe(const struct aabb *box)
{
    struct aabb out;
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] = (lanes){-box->end[axis][1], -box->end[axis][0]};
    return out;
}

/* Returns the probe of a box for all boxes within reach of it on every axis. In: reach >= 0. The
 * sums are rounded to nearest: unless it is 0, reach must include a margin for that. */
INLINE struct aabb aabb_probe_within(const struct aabb *box, double reach)
{
    struct aabb out = aabb_probe(box);
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] += lanes_of(reach);
    return out;
}

/* Returns the largest magnitude of a coordinate of the box. */
INLINE double aabb_max_coordinate(const struct aabb *box)
{
    lanes largest = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        largest = lanes_max(largest, lanes_abs(box->end[axis]));
    return largest[0] > largest[1] ? largest[0] : largest[1];
}

/* Returns whether the boxes have a point in common. In: the second is a probe. */
INLINE bool aabb_overlaps(const struct aabb *box, const struct aabb *probe)
{
    lanes_mask overlap = aabb_at_most(box->end[0], probe->end[0]);
    UNROLL(3)
    for (int axis = 1; axis < FMB_DIM_MAX; axis++)
        overlap &= aabb_at_most(box->end[axis], probe->end[axis]);
    return lanes_all(overlap);
}

#endif
