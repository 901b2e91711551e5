/* Method. The squared distance of two cores is convex in time. Frames meet before a time if they
 * overlap over the window up to it; or if they touch over that window, and did so before its end.
 * Let x be the shortest b - a of the cores over a part of the window, no longer than the sum R of
 * the radii r and s. The core of a, moved by x r / R, and the core of b, moved by -x s / R, meet
 * only in points that both frames contain at a time of the least distance. If the frames touch,
 * these are all their common points: each is an a + x r / R, since no other b - a is as short as x.
 * A linear program (frames.h) finds the times and the box of these points. */
#include "rounded.h"

#include <float.h>
#include <math.h>

#include "frames.h"
#include "world.h"

/* Sets the shift that moves each core by its share of the shortest b - a, so that the cores meet.
 */
static void set_shift(const struct world *world, rational_vector nearest, struct frames_part *part)
{
    mpq_t share;
    mpq_init(share);
    if (mpq_sgn(world->radius) != 0)
        mpq_div(share, world->solid[0].radius, world->radius);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_t *const a = &part->shift[0][axis], *const b = &part->shift[1][axis];
        mpq_div(*b, nearest[axis], world->scale);
        mpq_mul(*a, *b, share);
        mpq_sub(*b, *a, *b);
    }
    mpq_clear(share);
}

/* ---- Contact ---- */

/* Whether the frames meet before (sign -1) or after (+1) the time. */
static bool meet_beyond(const struct pair *pair, unsigned i, unsigned j, const mpq_t time, int sign)
{
    struct world world;
    struct frames_part part;
    rational_vector nearest;
    mpq_t contact[2], none;
    bool beyond = false;
    world_init(&world, pair, i, j);
    frames_part_init(&part);
    rational_vector_init(nearest);
    mpq_inits(contact[0], contact[1], none, NULL);
    if (sign < 0 ? mpq_sgn(time) > 0 : mpq_cmp(time, world.duration) < 0) {
        world_set_part(&world, sign < 0 ? none : time, sign < 0 ? time : world.duration);
        const int order = world_compare(&world, nearest);
        beyond = order < 0;
        if (order == 0) {
            set_shift(&world, nearest, &part);
            frames_meet(pair, i, j, &part, contact, NULL);
            beyond = sign < 0 ? mpq_cmp(contact[0], time) < 0 : mpq_cmp(contact[1], time) > 0;
        }
    }
    world_clear(&world);
    frames_part_clear(&part);
    rational_vector_clear(nearest);
    mpq_clears(contact[0], contact[1], none, NULL);
    return beyond;
}

static bool meet_within(const struct pair *pair, unsigned i, unsigned j, mpq_t time[2])
{
    struct world world;
    world_init(&world, pair, i, j);
    world_set_part(&world, time[0], time[1]);
    const bool meet = world_compare(&world, NULL) <= 0;
    world_clear(&world);
    return meet;
}

/* out := the time moved by 1e-12 of the window that way, or to the next double; but not out of it.
 */
static void moved_time(double time, int sign, double duration, mpq_t out)
{
    mpq_t step, limit;
    mpq_inits(step, limit, NULL);
    mpq_set_d(limit, duration);
    mpq_set_si(step, sign, 1000000000000);
    mpq_mul(step, step, limit);
    mpq_set_d(out, time);
    mpq_add(out, out, step);
    mpq_set_d(step, nextafter(time, sign * DBL_MAX));
    if (sign * mpq_cmp(step, out) > 0)
        mpq_set(out, step);
    if (mpq_sgn(out) < 0)
        mpq_set_ui(out, 0, 1);
    if (mpq_cmp(out, limit) > 0)
        mpq_set(out, limit);
    mpq_clears(step, limit, NULL);
}

const char *rounded_contact_fault(const struct pair *pair, const double contact[2])
{
    const unsigned count[2] = {pair->a.body->frame_count, pair->b.body->frame_count};
    const char *fault = NULL;
    mpq_t time[2];
    mpq_inits(time[0], time[1], NULL);
    for (int end = 0; end < 2 && !fault; end++) {
        const int sign = end == 0 ? -1 : +1;
        bool near = false;
        mpq_set_d(time[end], contact[end]);
        moved_time(contact[end], -sign, pair->duration, time[1 - end]);
        for (unsigned k = 0; k < count[0] * count[1] && !fault; k++) {
            near = near || meet_within(pair, k / count[1], k % count[1], time);
            if (meet_beyond(pair, k / count[1], k % count[1], time[end], sign))
                fault =
                    end == 0 ? "frames meet before the contact" : "frames meet after the contact";
        }
        if (!fault && !near)
            fault = end == 0 ? "first contact: too far out" : "last contact: too far out";
    }
    mpq_clears(time[0], time[1], NULL);
    return fault;
}

/* ---- Box ---- */

/* The sign of a coordinate minus an exact one. */
static int compare(double coordinate, const mpq_t exact)
{
    mpq_t number;
    if (isinf(coordinate))
        return coordinate > 0 ? 1 : -1;
    mpq_init(number);
    mpq_set_d(number, coordinate);
    const int order = mpq_cmp(number, exact);
    mpq_clear(number);
    return order;
}

static bool is_in_frame(struct world *world, int side, const mpq_t time, rational_vector point)
{
    mpq_t square, limit;
    mpq_inits(square, limit, NULL);
    mpq_mul(limit, world->solid[side].radius, world->solid[side].radius);
    world_from_core(world, side, time, point, square, NULL);
    const bool in = mpq_cmp(square, limit) <= 0;
    mpq_clears(square, limit, NULL);
    return in;
}

/* Whether the box contains the farthest point of the frame of that side, if it is in the other. */
static bool holds_farthest(struct world *world, int side, int axis, int sign, const mpq_t time,
                           double end)
{
    struct rational_solid *solid = &world->solid[side];
    rational_vector point, n;
    mpq_t extent;
    mpq_init(extent);
    rational_vector_init(point);
    rational_vector_init(n);
    mpq_set_si(n[axis], sign, 1);
    rational_solid_support(solid, n, extent, point);
    for (int i = 0; i < FMB_DIM_MAX; i++) {
        mpq_add(point[i], point[i], solid->origin[i]);
        rational_add_product(point[i], 1, time, solid->velocity[i]);
        rational_add_product(point[i], 1, n[i], solid->radius);
    }
    mpq_div(extent, point[axis], world->scale);
    const bool holds =
        sign * compare(end, extent) >= 0 || !is_in_frame(world, 1 - side, time, point);
    mpq_clear(extent);
    rational_vector_clear(point);
    rational_vector_clear(n);
    return holds;
}

/* Raises loosest, outwards, to what the boxes of both frames over the contact have in common. */
static void raise_loosest(struct world *world, const double contact[2],
                          mpq_t loosest[2][FMB_DIM_MAX], bool first)
{
    mpq_t least, one, start, length;
    mpq_inits(least, one, start, length, NULL);
    mpq_set_d(start, contact[0]);
    mpq_set_d(length, contact[1]);
    mpq_sub(length, length, start);
    for (int k = 0; k < 2 * world->dim; k++) {
        const int axis = k % world->dim, sign = k / world->dim ? +1 : -1;
        mpq_t *const out = &loosest[k / world->dim][axis];
        for (int side = 0; side < 2; side++) {
            struct rational_solid *solid = &world->solid[side];
            rational_solid_farthest(solid, length, axis, sign, one);
            rational_add_product(one, sign, start, solid->velocity[axis]);
            if (side == 0 || mpq_cmp(one, least) < 0)
                mpq_set(least, one);
        }
        mpq_div(least, least, world->scale);
        if (first || mpq_cmp(least, *out) > 0)
            mpq_set(*out, least);
    }
    mpq_clears(least, one, start, length, NULL);
}

/* Whether the box contains a sample of what these frames have in common. */
static bool holds_sample(struct world *world, const struct pair *pair, unsigned i, unsigned j,
                         rational_vector nearest, const double contact[2],
                         const double box[2][FMB_DIM_MAX])
{
    struct frames_part part;
    mpq_t time[4], common[2][FMB_DIM_MAX];
    bool holds = true;
    frames_part_init(&part);
    for (int k = 0; k < 4; k++)
        mpq_init(time[k]);
    rational_vector_init(common[0]);
    rational_vector_init(common[1]);
    set_shift(world, nearest, &part);
    frames_meet(pair, i, j, &part, time, common);
    mpq_set_d(time[2], contact[0]);
    mpq_set_d(time[3], contact[1]);
    for (int k = 0; k < 2 * world->dim && holds; k++) {
        const int axis = k % world->dim, end = k / world->dim, sign = end ? +1 : -1;
        holds = sign * compare(box[end][axis], common[end][axis]) >= 0;
        for (int t = 0; t < 4 && holds; t++)
            for (int side = 0; side < 2; side++)
                holds = holds && holds_farthest(world, side, axis, sign, time[t], box[end][axis]);
    }
    frames_part_clear(&part);
    for (int k = 0; k < 4; k++)
        mpq_clear(time[k]);
    rational_vector_clear(common[0]);
    rational_vector_clear(common[1]);
    return holds;
}

/* limit := limit + 1e-12 of the reach of the body */
static void add_share_of_reach(const struct fmb_placement *placement, mpq_t limit)
{
    mpq_t share;
    if (!(placement->body->reach < INFINITY))
        return;
    mpq_init(share);
    mpq_set_d(share, 1e-12 * placement->body->reach);
    mpq_add(limit, limit, share);
    mpq_clear(share);
}

const char *rounded_box_fault(const struct pair *pair, const double contact[2],
                              const double box[2][FMB_DIM_MAX])
{
    const unsigned count[2] = {pair->a.body->frame_count, pair->b.body->frame_count};
    const char *fault = NULL;
    rational_vector nearest, loosest[2];
    mpq_t limit;
    bool first = true;
    mpq_init(limit);
    rational_vector_init(nearest);
    rational_vector_init(loosest[0]);
    rational_vector_init(loosest[1]);
    for (unsigned k = 0; k < count[0] * count[1] && !fault; k++) {
        struct world world;
        world_init(&world, pair, k / count[1], k % count[1]);
        if (world_compare(&world, nearest) <= 0) {
            raise_loosest(&world, contact, loosest, first);
            first = false;
            if (!holds_sample(&world, pair, k / count[1], k % count[1], nearest, contact, box))
                fault = "the box cuts a point off";
        }
        world_clear(&world);
    }
    world_size(pair, limit);
    const bool limited = compare(0x1p1020, limit) >= 0;
    world_limit(pair, limit);
    add_share_of_reach(&pair->a, limit);
    add_share_of_reach(&pair->b, limit);
    for (int k = 0; k < 2 * pair->a.body->dim && limited && !fault; k++) {
        const int axis = k % pair->a.body->dim, end = k / pair->a.body->dim;
        mpq_add(loosest[end][axis], loosest[end][axis], limit);
        if (compare(end ? box[end][axis] : -box[end][axis], loosest[end][axis]) > 0)
            fault = "the box leaves those of the bodies";
    }
    mpq_clear(limit);
    rational_vector_clear(nearest);
    rational_vector_clear(loosest[0]);
    rational_vector_clear(loosest[1]);
    return fault;
}

/* ---- Point ---- */

/* Whether the frames, which touch or have no radii, have a point in common near that one. */
static bool is_near_common(struct world *world, const struct pair *pair, unsigned i, unsigned j,
                           const double *point, const mpq_t limit)
{
    struct frames_part part;
    rational_vector nearest;
    frames_part_init(&part);
    rational_vector_init(nearest);
    world_compare(world, nearest);
    set_shift(world, nearest, &part);
    part.near = true;
    for (int end = 0; end < 2; end++) {
        moved_time(point[0], end ? +1 : -1, pair->duration, part.time[end]);
        for (int axis = 0; axis < world->dim; axis++) {
            mpq_set_d(part.box[end][axis], point[1 + axis]);
            (end ? mpq_add : mpq_sub)(part.box[end][axis], part.box[end][axis], limit);
        }
    }
    const bool near = frames_meet(pair, i, j, &part, NULL, NULL);
    rational_vector_clear(nearest);
    frames_part_clear(&part);
    return near;
}

/* to := from + by way */
static void move(rational_vector from, const mpq_t by, rational_vector way, rational_vector to)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_set(to[axis], from[axis]);
        rational_add_product(to[axis], 1, by, way[axis]);
    }
}

/* Whether the point, moved along the way by the limit, or to its end, is in both frames. */
static bool is_in_both(struct world *world, const mpq_t time, rational_vector point,
                       rational_vector way, const mpq_t limit)
{
    rational_vector moved;
    mpq_t share, length;
    mpq_inits(share, length, NULL);
    rational_vector_init(moved);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_abs(share, way[axis]);
        mpq_add(length, length, share);
    }
    mpq_set_ui(share, 1, 1);
    if (mpq_cmp(length, limit) > 0)
        mpq_div(share, limit, length);
    move(point, share, way, moved);
    const bool in = is_in_frame(world, 0, time, moved) && is_in_frame(world, 1, time, moved);
    rational_vector_clear(moved);
    mpq_clears(share, length, NULL);
    return in;
}

/* Whether it is near one that both frames, which overlap, have at that time. */
static bool is_near_overlap(struct world *world, const double *point, const mpq_t limit_of_pair)
{
    rational_vector at, way[2], none, between, middle;
    mpq_t time, square, limit, most, share;
    mpq_inits(time, square, limit, most, share, NULL);
    rational_vector_init(at);
    rational_vector_init(none);
    rational_vector_init(between);
    rational_vector_init(middle);
    mpq_set_d(time, point[0]);
    mpq_mul(limit, limit_of_pair, world->scale);
    mpq_div(share, world->solid[0].radius, world->radius);
    for (int axis = 0; axis < world->dim; axis++)
        world_length(world, point[1 + axis], at[axis]);
    bool near = true;
    for (int side = 0; side < 2; side++) {
        rational_vector_init(way[side]);
        mpq_add(most, limit, world->solid[side].radius);
        mpq_mul(most, most, most);
        world_from_core(world, side, time, at, square, way[side]);
        near = near && mpq_cmp(square, most) <= 0;
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpq_sub(between[axis], way[1][axis], way[0][axis]);
    move(way[0], share, between, middle);
    rational_dot(square, middle, middle);
    mpq_mul(most, limit, limit);
    near = near && (mpq_cmp(square, most) <= 0 || is_in_both(world, time, at, none, limit) ||
                    is_in_both(world, time, at, way[0], limit) ||
                    is_in_both(world, time, at, way[1], limit));
    rational_vector_clear(at);
    rational_vector_clear(none);
    rational_vector_clear(between);
    rational_vector_clear(middle);
    for (int side = 0; side < 2; side++)
        rational_vector_clear(way[side]);
    mpq_clears(time, square, limit, most, share, NULL);
    return near;
}

const char *rounded_point_fault(const struct pair *pair, enum fmb_verdict verdict,
                                const double point[1 + FMB_DIM_MAX])
{
    const unsigned count[2] = {pair->a.body->frame_count, pair->b.body->frame_count};
    bool near = false, finite = true;
    mpq_t limit;
    if (!(point[0] >= 0 && point[0] <= pair->duration))
        return "the time of the point is not within the window";
    for (int k = 0; k <= FMB_DIM_MAX; k++) {
        finite = finite && !isinf(point[k]);
        if (isnan(point[k]) || (point[k] == 0 && signbit(point[k])) ||
            (k > pair->a.body->dim && point[k] != 0))
            return "the point is not a number, has a -0, or leaves the plane";
    }
    mpq_init(limit);
    world_size(pair, limit);
    if (!finite && compare(0x1.fffffffffffffp1023, limit) >= 0)
        return "the point is infinite";
    world_limit(pair, limit);
    near = !finite;
    for (unsigned k = 0; k < count[0] * count[1] && !near; k++) {
        const unsigned i = k / count[1], j = k % count[1];
        struct world world;
        if (frames_verdict(pair, i, j) != verdict)
            continue;
        world_init(&world, pair, i, j);
        near = verdict == FMB_OVERLAPPING && mpq_sgn(world.radius) != 0
                   ? is_near_overlap(&world, point, limit)
                   : is_near_common(&world, pair, i, j, point, limit);
        world_clear(&world);
    }
    mpq_clear(limit);
    return near ? NULL : "the bodies have no such point in common";
}
