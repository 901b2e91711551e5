/* Method. Vertices, edges and velocities are those of rational_solid.h.
 *
 * Lower bound: n . (b - a) is least in vertices, at an end of the window. It is compared with
 * lo |n| by their squares.
 *
 * Radius: the gap of frames with radii is that of their cores minus both radii, in every case. So a
 * bound on the one is a bound on the other, and nothing else changes.
 *
 * Distance of a point from a frame, and of two frames: nearest.c; depth: facets.c. Sums of roots
 * are compared in floating point of 512 bits: what that rounds is far below a double's rounding. */
#include "gap_check.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "world.h"

enum { PRECISION = 512 };

/* Bounds beyond the largest double are infinite. */
static double clamped(double bound)
{
    return fmax(-DBL_MAX, fmin(bound, DBL_MAX));
}

/* ---- Along a direction ---- */

static void set_direction(const struct fmb_gap *gap, rational_vector n)
{
    for (int axis = 0; axis < 3; axis++)
        mpq_set_d(n[axis], gap->direction[axis]);
}

/* Whether the direction proves that the gap is at least bound. */
static bool proves(struct world *world, const struct fmb_gap *gap, double bound)
{
    if (isinf(bound)) /* from the largest double on */
        bound = bound < 0 ? -INFINITY : DBL_MAX;
    if (bound == -INFINITY)
        return true;
    rational_vector n;
    mpq_t least, limit;
    mpq_inits(least, limit, NULL);
    rational_vector_init(n);
    set_direction(gap, n);
    difference_end(&world->difference, n, -1, least, NULL);
    world_length(world, bound, limit);
    mpq_add(limit, limit, world->radius);
    const bool holds = difference_compare(least, limit, n) >= 0;
    rational_vector_clear(n);
    mpq_clears(least, limit, NULL);
    return holds;
}

/* ---- Distance ---- */

void gap_check_distance(const struct pair *pair, mpq_t square)
{
    struct world world;
    world_init(&world, pair, 0, 0);
    difference_nearest(&world.difference, square, NULL);
    mpq_div(square, square, world.scale);
    mpq_div(square, square, world.scale);
    world_clear(&world);
}

/* limit := what the gap of the cores is where that of the frames is the bound. */
static void limit_of_cores(const struct world *world, double bound, mpq_t limit)
{
    world_length(world, clamped(bound), limit);
    mpq_add(limit, limit, world->radius);
}

/* The sign of the distance of the frames minus the bound, where the cores are apart; -1 where they
 * are not. */
static int compare_distance(struct world *world, double bound)
{
    mpq_t square, limit;
    mpq_inits(square, limit, NULL);
    difference_nearest(&world->difference, square, NULL);
    limit_of_cores(world, bound, limit);
    const bool apart = mpq_sgn(square) != 0, positive = mpq_sgn(limit) >= 0;
    mpq_mul(limit, limit, limit);
    const int order = !apart ? -1 : positive ? mpq_cmp(square, limit) : 1;
    mpq_clears(square, limit, NULL);
    return order;
}

/* sum += root of square - radius, where that is positive. */
static void add_root(mpf_t sum, const mpq_t square, const mpq_t radius)
{
    mpf_t root, less;
    mpf_init2(root, PRECISION);
    mpf_init2(less, PRECISION);
    mpf_set_q(root, square);
    mpf_sqrt(root, root);
    mpf_set_q(less, radius);
    mpf_sub(root, root, less);
    if (mpf_sgn(root) > 0)
        mpf_add(sum, sum, root);
    mpf_clear(root);
    mpf_clear(less);
}

/* Whether the sum is at most the bound, but for what floating point rounds here. */
static bool at_most(const struct world *world, const mpf_t sum, double bound)
{
    mpf_t limit, slack;
    mpq_t exact;
    if (bound == INFINITY)
        return true;
    mpq_init(exact);
    world_length(world, bound, exact);
    mpf_init2(limit, PRECISION);
    mpf_init2(slack, PRECISION);
    mpf_set_q(limit, exact);
    mpq_clear(exact);
    mpf_div_2exp(slack, sum, PRECISION / 2);
    mpf_add(limit, limit, slack);
    const bool holds = mpf_cmp(sum, limit) <= 0;
    mpf_clear(limit);
    mpf_clear(slack);
    return holds;
}

static bool has_finite_witness(const struct fmb_gap *gap)
{
    for (int i = 0; i < 2 * FMB_DIM_MAX; i++)
        if (!isfinite(gap->witness[i / 3][i % 3]))
            return false;
    return true;
}

/* The witness points, scaled; square := that of the length of b - a + push times the direction. */
static void set_points(const struct world *world, const struct fmb_gap *gap, double push,
                       rational_vector point[2], mpq_t square)
{
    mpq_t way, length, part;
    mpq_inits(way, length, part, NULL);
    world_length(world, push, length);
    mpq_set_ui(square, 0, 1);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        for (int side = 0; side < 2; side++)
            world_length(world, gap->witness[side][axis], point[side][axis]);
        mpq_sub(way, point[1][axis], point[0][axis]);
        mpq_set_d(part, gap->direction[axis]);
        rational_add_product(way, 1, part, length);
        rational_add_product(square, 1, way, way);
    }
    mpq_clears(way, length, part, NULL);
}

/* sum := the length of b - a + push times the direction, plus the distances of both points from
 * their frames. */
static void sum_of_ways(struct world *world, const struct fmb_gap *gap, double push, mpf_t sum)
{
    rational_vector point[2];
    mpq_t time, square, none;
    mpq_inits(time, square, none, NULL);
    mpf_set_ui(sum, 0);
    mpq_set_d(time, gap->time);
    for (int side = 0; side < 2; side++)
        rational_vector_init(point[side]);
    set_points(world, gap, push, point, square);
    add_root(sum, square, none);
    for (int side = 0; side < 2; side++) {
        world_from_core(world, side, time, point[side], square, NULL);
        add_root(sum, square, world->solid[side].radius);
        rational_vector_clear(point[side]);
    }
    mpq_clears(time, square, none, NULL);
}

static bool points_prove(struct world *world, const struct fmb_gap *gap)
{
    mpf_t sum;
    mpf_init2(sum, PRECISION);
    sum_of_ways(world, gap, 0, sum);
    const bool holds = at_most(world, sum, gap->bounds[1]);
    mpf_clear(sum);
    return holds;
}

/* ---- Depth ---- */

/* The sign of minus the depth, minus the bound. Of cores that are apart, a distance is not seen. */
static int compare_depth(struct world *world, double bound)
{
    mpq_t limit;
    mpq_init(limit);
    limit_of_cores(world, bound, limit);
    const int order = difference_compare_facets(&world->difference, limit);
    mpq_clear(limit);
    return order;
}

/* The sign of the gap of frames that overlap, minus the bound. */
static int compare_overlap(struct world *world, double bound)
{
    mpq_t square;
    mpq_init(square);
    if (mpq_sgn(world->radius) != 0)
        difference_nearest(&world->difference, square, NULL);
    const bool apart = mpq_sgn(square) != 0;
    mpq_clear(square);
    return apart ? compare_distance(world, bound) : compare_depth(world, bound);
}

/* Whether the gap of the frames is at least the bound. */
static bool is_at_least(struct world *world, double bound)
{
    if (compare_depth(world, bound) >= 0)
        return true;
    return (bound > 0 || mpq_sgn(world->radius) != 0) && compare_distance(world, bound) >= 0;
}

static bool upper_holds(struct world *world, const struct fmb_gap *gap)
{
    if (!gap->has_witness || gap->bounds[1] <= 0)
        return compare_overlap(world, gap->bounds[1]) <= 0;
    if (has_finite_witness(gap))
        return points_prove(world, gap);
    return gap->bounds[1] == INFINITY || compare_distance(world, gap->bounds[1]) <= 0;
}

/* Whether the witness points of frames that overlap are a deepest pair: a - b is the depth along
 * the direction, and each is in its frame, all together up to the limit. */
static bool points_are_deepest(struct world *world, const struct fmb_gap *gap, const mpq_t limit)
{
    mpf_t sum;
    mpf_init2(sum, PRECISION);
    sum_of_ways(world, gap, -clamped(gap->bounds[1]), sum);
    const bool holds = at_most(world, sum, mpq_get_d(limit));
    mpf_clear(sum);
    return holds;
}

/* ---- All of it ---- */

/* The width of the enclosure divided by the limit. */
static void set_width(const struct pair *pair, const struct fmb_gap *gap, mpq_t out)
{
    mpq_t low, limit;
    mpq_inits(low, limit, NULL);
    mpq_set_d(low, clamped(gap->bounds[0]));
    mpq_set_d(out, clamped(gap->bounds[1]));
    mpq_sub(out, out, low);
    world_limit(pair, limit);
    mpq_div(out, out, limit);
    mpq_clears(low, limit, NULL);
}

double gap_check_width(const struct pair *pair, const struct fmb_gap *gap)
{
    mpq_t width;
    if (isnan(gap->bounds[0]) || isnan(gap->bounds[1]))
        return INFINITY;
    mpq_init(width);
    set_width(pair, gap, width);
    const double relative = fabs(mpq_get_d(width));
    mpq_clear(width);
    return relative;
}

static bool is_narrow(const struct pair *pair, const struct fmb_gap *gap)
{
    mpq_t width;
    if (!(gap->bounds[0] <= gap->bounds[1]))
        return false;
    mpq_init(width);
    set_width(pair, gap, width);
    const bool narrow = mpq_cmp_ui(width, 1, 1) <= 0;
    mpq_clear(width);
    return narrow;
}

static bool is_negative_zero(double number)
{
    return number == 0 && signbit(number);
}

static bool has_negative_zero(const struct fmb_gap *gap)
{
    bool has = is_negative_zero(gap->time);
    for (int i = 0; i < 2; i++) {
        has = has || is_negative_zero(gap->bounds[i]);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            has = has || is_negative_zero(gap->witness[i][axis]);
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        has = has || is_negative_zero(gap->direction[axis]);
    return has;
}

static bool is_unit(const struct fmb_gap *gap)
{
    double square = 0;
    for (int axis = 0; axis < 3; axis++)
        square += gap->direction[axis] * gap->direction[axis];
    return fabs(square - 1) <= 2e-15;
}

static bool fail(char *why, size_t size, const char *what)
{
    snprintf(why, size, "gap: %s", what);
    return false;
}

/* Separated pairs have witness points, and so do overlapping pairs without relative motion. */
static bool witness_is_due(const struct pair *pair, enum fmb_verdict verdict,
                           const struct fmb_gap *gap)
{
    bool moving = false;
    for (int axis = 0; axis < pair->a.body->dim; axis++)
        moving = moving || pair->a.velocity[axis] != pair->b.velocity[axis];
    const bool rests = !(moving && pair->duration > 0);
    return gap->has_witness == (verdict == FMB_SEPARATED || (verdict == FMB_OVERLAPPING && rests));
}

/* What does not depend on the frames. */
static bool check_form(const struct pair *pair, enum fmb_verdict verdict, const struct fmb_gap *gap,
                       char *why, size_t size)
{
    if (!is_unit(gap))
        return fail(why, size, "the direction has no unit length");
    if (pair->a.body->dim == 2 && gap->direction[2] != 0)
        return fail(why, size, "the direction leaves the plane");
    if (has_negative_zero(gap))
        return fail(why, size, "a number is -0");
    if (!witness_is_due(pair, verdict, gap))
        return fail(why, size, "witness points, or none");
    if (!(gap->time >= 0 && gap->time <= pair->duration))
        return fail(why, size, "the time is not within the window");
    if (verdict == FMB_TOUCHING && (gap->bounds[0] != 0 || gap->bounds[1] != 0))
        return fail(why, size, "bounds of a touching pair are not 0");
    if (verdict == FMB_OVERLAPPING && !(gap->bounds[1] <= 0))
        return fail(why, size, "an overlapping pair is apart");
    return is_narrow(pair, gap) || fail(why, size, "too wide");
}

/* Whether points of an overlap, if they are given, are a deepest pair of these frames. */
static bool deepest_holds(struct world *world, const struct pair *pair, const struct fmb_gap *gap)
{
    mpq_t limit;
    if (!gap->has_witness || gap->bounds[1] > 0 || !has_finite_witness(gap))
        return true;
    mpq_init(limit);
    world_limit(pair, limit);
    const bool holds = points_are_deepest(world, gap, limit);
    mpq_clear(limit);
    return holds;
}

/* The lower bound that the direction has to prove. */
static double bound_of_direction(const struct pair *pair, enum fmb_verdict verdict,
                                 const struct fmb_gap *gap)
{
    if (verdict != FMB_TOUCHING)
        return gap->bounds[0];
    mpq_t limit;
    mpq_init(limit);
    world_limit(pair, limit);
    const double bound = -mpq_get_d(limit);
    mpq_clear(limit);
    return bound;
}

bool gap_check(const struct pair *pair, enum fmb_verdict verdict, const struct fmb_gap *gap,
               char *why, size_t size)
{
    const unsigned count[2] = {pair->a.body->frame_count, pair->b.body->frame_count};
    const bool several = count[0] * count[1] > 1;
    bool lower = false, upper = verdict == FMB_TOUCHING, nearer = false, deepest = false;
    if (!check_form(pair, verdict, gap, why, size))
        return false;
    const double bound = bound_of_direction(pair, verdict, gap);
    for (unsigned k = 0; k < count[0] * count[1] && !nearer; k++) {
        struct world world;
        world_init(&world, pair, k / count[1], k % count[1]);
        const bool proven = proves(&world, gap, bound);
        lower = lower || proven;
        upper = upper || upper_holds(&world, gap);
        deepest = deepest || deepest_holds(&world, pair, gap);
        nearer = several && !proven && !is_at_least(&world, gap->bounds[0]);
        world_clear(&world);
    }
    if (nearer)
        return fail(why, size, "a pair of frames is nearer than the lower bound says");
    if (!lower)
        return fail(why, size, "the direction does not prove the lower bound");
    if (!upper)
        return fail(why, size,
                    gap->bounds[1] > 0 ? "the points do not prove the upper bound"
                                       : "the overlap is less deep than the upper bound says");
    return deepest || fail(why, size, "the points are not a deepest pair");
}

bool gap_check_lower(const struct pair *pair, unsigned i, unsigned j, const struct fmb_gap *gap)
{
    struct world world;
    world_init(&world, pair, i, j);
    const bool holds = proves(&world, gap, gap->bounds[0]);
    world_clear(&world);
    return holds;
}

bool gap_check_upper(const struct pair *pair, unsigned i, unsigned j, const struct fmb_gap *gap)
{
    struct world world;
    world_init(&world, pair, i, j);
    const bool holds = upper_holds(&world, gap);
    world_clear(&world);
    return holds;
}

/* ---- The other way round ---- */

static void turn_round(struct fmb_gap *gap)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double first = gap->witness[0][axis];
        gap->witness[0][axis] = gap->witness[1][axis];
        gap->witness[1][axis] = first;
        gap->direction[axis] = 0 - gap->direction[axis];
    }
}

bool gap_check_same(const struct fmb_gap *x, const struct fmb_gap *y)
{
    return memcmp(x->bounds, y->bounds, sizeof x->bounds) == 0 &&
           memcmp(x->direction, y->direction, sizeof x->direction) == 0 &&
           x->has_witness == y->has_witness && memcmp(&x->time, &y->time, sizeof x->time) == 0 &&
           memcmp(x->witness, y->witness, sizeof x->witness) == 0;
}

bool gap_check_swapped(bool symmetric, const struct fmb_gap *gap, const struct fmb_gap *swapped)
{
    struct fmb_gap turned = *swapped;
    if (!symmetric)
        turn_round(&turned);
    return gap_check_same(gap, &turned);
}
