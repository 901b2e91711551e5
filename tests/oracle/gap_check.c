/* Method. Vertices, edges and velocities are those of rational_solid.h.
 *
 * Lower bound: n . (b - a) is least in vertices, at an end of the window. It is compared with
 * lo |n| by their squares.
 *
 * Distance of a point from a frame, and of two frames: nearest.c; depth: facets.c. Sums of roots
 * are compared in floating point of 512 bits: what that rounds is far below a double's rounding. */
#include "gap_check.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "difference.h"
#include "rational_solid.h"

enum { PRECISION = 512 };

/* All lengths times scale, which makes those at the start of the window integers: rational numbers
 * without denominators are fast. */
struct world {
    int dim;
    mpq_t scale;
    struct rational_solid solid[2];
    mpq_t duration;
    rational_vector offset, drift; /* of b against a, at the start and over the window */
    struct difference difference;
};

/* Multiplies the denominators of the numbers into the scale, so far as it lacks them. */
static void include_denominators(const mpq_t number[FMB_DIM_MAX], mpq_t scale)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpz_lcm(mpq_numref(scale), mpq_numref(scale), mpq_denref(number[axis]));
}

static void multiply(rational_vector v, const mpq_t factor)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpq_mul(v[axis], v[axis], factor);
}

static void set_scale(struct world *world)
{
    mpq_set_ui(world->scale, 1, 1);
    for (int s = 0; s < 2; s++) {
        include_denominators(world->solid[s].origin, world->scale);
        include_denominators(world->solid[s].velocity, world->scale);
        for (int i = 0; i < world->solid[s].count; i++)
            include_denominators(world->solid[s].column[i], world->scale);
    }
    for (int s = 0; s < 2; s++) {
        multiply(world->solid[s].origin, world->scale);
        multiply(world->solid[s].velocity, world->scale);
        for (int i = 0; i < world->solid[s].count; i++)
            multiply(world->solid[s].column[i], world->scale);
    }
}

static void world_init(struct world *world, const struct pair *pair, unsigned i, unsigned j)
{
    world->dim = pair->a.body->dim;
    rational_solid_init(fmb_body_frame(pair->a.body, i), &pair->a, &world->solid[0]);
    rational_solid_init(fmb_body_frame(pair->b.body, j), &pair->b, &world->solid[1]);
    mpq_inits(world->duration, world->scale, NULL);
    set_scale(world);
    mpq_set_d(world->duration, pair->duration);
    rational_vector_init(world->offset);
    rational_vector_init(world->drift);
    for (int axis = 0; axis < 3; axis++) {
        mpq_sub(world->offset[axis], world->solid[1].origin[axis], world->solid[0].origin[axis]);
        mpq_sub(world->drift[axis], world->solid[1].velocity[axis], world->solid[0].velocity[axis]);
        mpq_mul(world->drift[axis], world->drift[axis], world->duration);
    }
    world->difference = (struct difference){world->dim, &world->solid[0], &world->solid[1],
                                            world->offset, world->drift};
}

static void world_clear(struct world *world)
{
    for (int side = 0; side < 2; side++)
        rational_solid_clear(&world->solid[side]);
    mpq_clears(world->duration, world->scale, NULL);
    rational_vector_clear(world->offset);
    rational_vector_clear(world->drift);
}

/* Bounds beyond the largest double are infinite. */
static double clamped(double bound)
{
    return fmax(-DBL_MAX, fmin(bound, DBL_MAX));
}

/* A length, or a coordinate, of finite doubles. */
static void set_length(const struct world *world, double length, mpq_t out)
{
    mpq_set_d(out, length);
    mpq_mul(out, out, world->scale);
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
    set_length(world, bound, limit);
    const bool holds = difference_compare(least, limit, n) >= 0;
    rational_vector_clear(n);
    mpq_clears(least, limit, NULL);
    return holds;
}

/* ---- The distance of a point from a frame ---- */

/* The square of the distance of the point from the frame of that side at a time. */
static void point_distance(struct world *world, int side, const mpq_t time, const double *point,
                           mpq_t square)
{
    struct rational_solid *solid = &world->solid[side];
    rational_vector offset;
    mpq_t at;
    rational_vector_init(offset);
    mpq_init(at);
    for (int axis = 0; axis < 3; axis++) {
        set_length(world, point[axis], at);
        mpq_sub(offset[axis], solid->origin[axis], at);
        rational_add_product(offset[axis], 1, time, solid->velocity[axis]);
    }
    difference_nearest(&(struct difference){.second = solid, .offset = offset}, square);
    rational_vector_clear(offset);
    mpq_clear(at);
}

void gap_check_distance(const struct pair *pair, mpq_t square)
{
    struct world world;
    world_init(&world, pair, 0, 0);
    difference_nearest(&world.difference, square);
    mpq_div(square, square, world.scale);
    mpq_div(square, square, world.scale);
    world_clear(&world);
}

/* The sign of the distance of the frames minus the bound, which is at least 0. */
static int compare_distance(struct world *world, double bound)
{
    mpq_t square, limit;
    mpq_inits(square, limit, NULL);
    difference_nearest(&world->difference, square);
    set_length(world, clamped(bound), limit);
    mpq_mul(limit, limit, limit);
    const int order = mpq_cmp(square, limit);
    mpq_clears(square, limit, NULL);
    return order;
}

/* sum += root of square */
static void add_root(mpf_t sum, const mpq_t square)
{
    mpf_t root;
    mpf_init2(root, PRECISION);
    mpf_set_q(root, square);
    mpf_sqrt(root, root);
    mpf_add(sum, sum, root);
    mpf_clear(root);
}

/* Whether the sum is at most the bound, but for what floating point rounds here. */
static bool at_most(const struct world *world, const mpf_t sum, double bound)
{
    mpf_t limit, slack;
    mpq_t exact;
    if (bound == INFINITY)
        return true;
    mpq_init(exact);
    set_length(world, bound, exact);
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

static bool points_prove(struct world *world, const struct fmb_gap *gap)
{
    mpq_t time, square, x, y;
    mpf_t sum;
    mpq_inits(time, square, x, y, NULL);
    mpf_init2(sum, PRECISION);
    mpq_set_d(time, gap->time);
    for (int axis = 0; axis < 3; axis++) {
        set_length(world, gap->witness[0][axis], x);
        set_length(world, gap->witness[1][axis], y);
        mpq_sub(x, x, y);
        rational_add_product(square, 1, x, x);
    }
    add_root(sum, square);
    for (int side = 0; side < 2; side++) {
        point_distance(world, side, time, gap->witness[side], square);
        add_root(sum, square);
    }
    const bool holds = at_most(world, sum, gap->bounds[1]);
    mpq_clears(time, square, x, y, NULL);
    mpf_clear(sum);
    return holds;
}

/* ---- Depth ---- */

/* The sign of minus the depth, minus the bound. */
static int compare_depth(struct world *world, double bound)
{
    mpq_t limit;
    mpq_init(limit);
    set_length(world, clamped(bound), limit);
    const int order = difference_compare_facets(&world->difference, limit);
    mpq_clear(limit);
    return order;
}

/* Whether the gap of the frames is at least the bound. */
static bool is_at_least(struct world *world, double bound)
{
    if (compare_depth(world, bound) >= 0)
        return true;
    return bound > 0 && compare_distance(world, bound) >= 0;
}

static bool upper_holds(struct world *world, const struct fmb_gap *gap)
{
    if (!gap->has_witness)
        return compare_depth(world, gap->bounds[1]) <= 0;
    if (has_finite_witness(gap))
        return points_prove(world, gap);
    return gap->bounds[1] == INFINITY || compare_distance(world, gap->bounds[1]) <= 0;
}

/* ---- All of it ---- */

/* The limit: 1e-12 of the largest coordinate of a vertex over the window, and 32 of the least
 * doubles. */
static void add_limit(const struct fmb_placement *placement, const mpq_t duration, mpq_t out)
{
    struct rational_solid solid;
    mpq_t at;
    mpq_init(at);
    for (unsigned i = 0; i < placement->body->frame_count; i++) {
        rational_solid_init(fmb_body_frame(placement->body, i), placement, &solid);
        for (int axis = 0; axis < 3; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                rational_solid_farthest(&solid, duration, axis, sign, at);
                if (mpq_cmp(at, out) > 0)
                    mpq_set(out, at);
            }
        rational_solid_clear(&solid);
    }
    mpq_clear(at);
}

static void set_limit(const struct pair *pair, mpq_t out)
{
    mpq_t at, share;
    mpq_inits(at, share, NULL);
    mpq_set_ui(out, 0, 1);
    mpq_set_d(at, pair->duration);
    add_limit(&pair->a, at, out);
    add_limit(&pair->b, at, out);
    mpq_set_str(share, "1/1000000000000", 10);
    mpq_mul(out, out, share);
    mpq_set_d(at, 0x1p-1074);
    mpq_set_ui(share, 32, 1);
    rational_add_product(out, 1, at, share);
    mpq_clears(at, share, NULL);
}

/* The width of the enclosure divided by the limit. */
static void set_width(const struct pair *pair, const struct fmb_gap *gap, mpq_t out)
{
    mpq_t low, limit;
    mpq_inits(low, limit, NULL);
    mpq_set_d(low, clamped(gap->bounds[0]));
    mpq_set_d(out, clamped(gap->bounds[1]));
    mpq_sub(out, out, low);
    set_limit(pair, limit);
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
    if (gap->has_witness != (verdict == FMB_SEPARATED))
        return fail(why, size, "witness points, or none");
    if (!(gap->time >= 0 && gap->time <= pair->duration))
        return fail(why, size, "the time is not within the window");
    if (verdict == FMB_TOUCHING && (gap->bounds[0] != 0 || gap->bounds[1] != 0))
        return fail(why, size, "bounds of a touching pair are not 0");
    if (verdict == FMB_OVERLAPPING && !(gap->bounds[1] <= 0))
        return fail(why, size, "an overlapping pair is apart");
    return is_narrow(pair, gap) || fail(why, size, "too wide");
}

/* The lower bound that the direction has to prove. */
static double bound_of_direction(const struct pair *pair, enum fmb_verdict verdict,
                                 const struct fmb_gap *gap)
{
    if (verdict != FMB_TOUCHING)
        return gap->bounds[0];
    mpq_t limit;
    mpq_init(limit);
    set_limit(pair, limit);
    const double bound = -mpq_get_d(limit);
    mpq_clear(limit);
    return bound;
}

bool gap_check(const struct pair *pair, enum fmb_verdict verdict, const struct fmb_gap *gap,
               char *why, size_t size)
{
    const unsigned count[2] = {pair->a.body->frame_count, pair->b.body->frame_count};
    const bool several = count[0] * count[1] > 1;
    bool lower = false, upper = verdict == FMB_TOUCHING, nearer = false;
    if (!check_form(pair, verdict, gap, why, size))
        return false;
    const double bound = bound_of_direction(pair, verdict, gap);
    for (unsigned k = 0; k < count[0] * count[1] && !nearer; k++) {
        struct world world;
        world_init(&world, pair, k / count[1], k % count[1]);
        const bool proven = proves(&world, gap, bound);
        lower = lower || proven;
        upper = upper || upper_holds(&world, gap);
        nearer = several && !proven && !is_at_least(&world, gap->bounds[0]);
        world_clear(&world);
    }
    if (nearer)
        return fail(why, size, "a pair of frames is nearer than the lower bound says");
    if (!lower)
        return fail(why, size, "the direction does not prove the lower bound");
    if (!upper)
        return fail(why, size,
                    gap->has_witness ? "the points do not prove the upper bound"
                                     : "a facet is nearer than the upper bound says");
    return true;
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
