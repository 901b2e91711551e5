/* Gaps of hulls: those of shapes given by their vertices are checked as the gaps of the shapes are,
 * in rational numbers; those of other hulls, against all facets. */

#include "unit.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

#include "draw.h"
#include "gap_check.h"
#include "hull_draw.h"
#include "question.h"
#include "referee.h"
#include "support_decision.h"

/* The gap of a pair with this verdict, from its vertices. */
static struct fmb_gap gap_of_vertices(const struct frame_pair *frames, enum fmb_verdict verdict)
{
    struct support_decision decision;
    struct fmb_answer answer = {0};
    bool done = support_decision_begin_gap_and_point(frames, FMB_WANT_GAP, verdict, INFINITY, false,
                                                     &decision, &answer);
    while (!done)
        done = support_decision_step(&decision, &answer);
    assert_true(answer.has_gap);
    return answer.gap;
}

/* The gap of both solids as hulls, or of one of them: bit 0, the first is one; bit 1, the second.
 */
static struct fmb_gap gap_of_hulls(const struct question *question, unsigned which,
                                   enum fmb_verdict verdict)
{
    struct ready ready;
    struct shape_hull hull[2];
    referee_ready(question, &ready);
    hull_replace(question, which, hull, &ready.pair);
    const struct frame_pair frames = pair_frames(&ready.pair);
    return gap_of_vertices(&frames, verdict);
}

static enum fmb_verdict check(const struct question *question, unsigned which)
{
    struct ready ready;
    struct fmb_answer answer;
    char why[200] = "";
    referee_ready(question, &ready);
    assert_int_equal(pair_decide(fmb_method_default(), &ready.pair, 0, &answer), FMB_OK);
    const struct question swapped = question_swapped(question);
    const struct fmb_gap gap = gap_of_hulls(question, which, answer.verdict);
    const struct fmb_gap other =
        gap_of_hulls(&swapped, which >> 1 | (which & 1) << 1, answer.verdict);
    if (!gap_check(&ready.pair, answer.verdict, &gap, why, sizeof why)) {
        print_message("%s, verdict %d, [%.17g, %.17g] along %.17g %.17g %.17g\n", why,
                      (int) answer.verdict, gap.bounds[0], gap.bounds[1], gap.direction[0],
                      gap.direction[1], gap.direction[2]);
        referee_fail(question, why);
    }
    if (!gap_check_swapped(question_is_symmetric(question), &gap, &other))
        referee_fail(question, "swapped");
    return answer.verdict;
}

static void shapes_by_their_vertices(void **state)
{
    struct draw draw;
    int verdicts[4] = {0};
    draw_begin(&draw, "shapes_by_their_vertices");
    for (long i = draw_sample(4000); i > 0; i--) {
        const struct question question = hull_draw_question(&draw);
        verdicts[check(&question, (unsigned) draw_int(&draw, 1, 3))]++;
    }
    print_message("%d separated, %d touching, %d overlapping\n", verdicts[1], verdicts[2],
                  verdicts[3]);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0);
}

/* Every length times a power of two. */
static void scale_lengths(struct solid *solid, int exponent)
{
    double(*lengths[])[FMB_DIM_MAX] = {solid->component, solid->component + 1, solid->component + 2,
                                       &solid->origin,   &solid->velocity,     &solid->local};
    for (size_t i = 0; i < COUNT(lengths); i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            (*lengths[i])[axis] = ldexp((*lengths[i])[axis], exponent);
}

static void all_exponents(void **state)
{
    struct draw draw;
    draw_begin(&draw, "all_exponents");
    for (long i = draw_sample(2000); i > 0; i--) {
        struct question question = hull_draw_question(&draw);
        const int exponent = draw_int(&draw, -1050, 1020);
        scale_lengths(&question.a, exponent);
        scale_lengths(&question.b, exponent);
        check(&question, (unsigned) draw_int(&draw, 1, 3));
    }
}

/* The position of a body, and its frame in body coordinates, are far from the origin, and cancel.
 */
static void positions_that_cancel(void **state)
{
    struct draw draw;
    draw_begin(&draw, "positions_that_cancel");
    for (long i = draw_sample(1000); i > 0; i--) {
        struct question question = hull_draw_question(&draw);
        struct solid *solids[2] = {&question.a, &question.b};
        const double far = ldexp(1, draw_int(&draw, 5, 30));
        for (int f = 0; f < 2; f++) {
            solids[f]->orientation_count = 0;
            memset(solids[f]->orientation, 0, sizeof solids[f]->orientation);
            for (int axis = 0; axis < solids[f]->dim; axis++) {
                solids[f]->local[axis] += far;
                solids[f]->origin[axis] = draw_int(&draw, -3, 3) - far;
            }
        }
        check(&question, (unsigned) draw_int(&draw, 1, 3));
    }
}

/* Bodies that move together, by far more than their size. */
static void common_velocities(void **state)
{
    struct draw draw;
    draw_begin(&draw, "common_velocities");
    for (long i = draw_sample(500); i > 0; i--) {
        struct question question = hull_draw_question(&draw);
        const double speed = ldexp(1, draw_int(&draw, 0, 300));
        for (int axis = 0; axis < question.a.dim; axis++)
            question.a.velocity[axis] = question.b.velocity[axis] =
                speed * draw_uniform(&draw, -1, 1);
        question.a.moving = question.b.moving = true;
        check(&question, (unsigned) draw_int(&draw, 1, 3));
    }
}

/* ---- Small hulls, by all directions ---- */

enum { DIFFERENCES_MAX = SMALL_VERTICES * (SMALL_VERTICES - 1) / 2, DIRECTIONS_MAX = 64 };

/* Directions, all of small whole numbers: exact. */
struct directions {
    int count;
    double at[DIRECTIONS_MAX][FMB_DIM_MAX];
};

static double dot(const double *x, const double *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

static void cross(const double *x, const double *y, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = x[(i + 1) % 3] * y[(i + 2) % 3] - x[(i + 2) % 3] * y[(i + 1) % 3];
}

static void add_direction(struct directions *all, const double *x, const double *y)
{
    double *to = all->at[all->count];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        to[axis] = x[axis] - y[axis];
    all->count += dot(to, to) > 0;
}

static void add_differences(struct directions *all, const struct hull_pair_draw *drawn, int f)
{
    for (int i = 0; i < drawn->count[f]; i++)
        for (int j = 0; j < i; j++)
            add_direction(all, drawn->vertices[f][i], drawn->vertices[f][j]);
}

/* The drift over the window; in 2D, the axis across the plane. */
static void add_drift(struct directions *all, const struct pair *pair)
{
    static const double none[FMB_DIM_MAX] = {0, 0, 0}, across[FMB_DIM_MAX] = {0, 0, 1};
    double drift[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        drift[axis] = (pair->b.velocity[axis] - pair->a.velocity[axis]) * pair->duration;
    add_direction(all, drift, none);
    if (pair->a.body->dim == 2)
        add_direction(all, across, none);
}

/* The vertices of a frame at a time. */
static void set_vertex(const struct hull_pair_draw *drawn, int f, int k, double t, double *out)
{
    const struct fmb_placement *placement = f ? &drawn->pair.b : &drawn->pair.a;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] =
            drawn->vertices[f][k][axis] + placement->position[axis] + t * placement->velocity[axis];
}

/* The greatest n . x over a frame at a time; sign -1: of -n. */
static double most_of(const struct hull_pair_draw *drawn, int f, const double *n, double sign,
                      double t)
{
    double most = -INFINITY;
    for (int k = 0; k < drawn->count[f]; k++) {
        double v[FMB_DIM_MAX];
        set_vertex(drawn, f, k, t, v);
        most = fmax(most, sign * dot(n, v));
    }
    return most;
}

/* The greatest n . x over D, divided by |n|. */
static double reach_of(const struct hull_pair_draw *drawn, const double *n, double sign)
{
    double most = -INFINITY;
    for (int end = 0; end < 2; end++) {
        const double t = end * drawn->pair.duration;
        most = fmax(most, most_of(drawn, 1, n, sign, t) + most_of(drawn, 0, n, -sign, t));
    }
    return most / sqrt(dot(n, n));
}

/* The least reach of D over the normals of all its facets, which two of the directions span; 0 if D
 * is flat. */
static double depth_by_facets(const struct hull_pair_draw *drawn)
{
    struct directions all = {.count = 0};
    double least = INFINITY;
    add_differences(&all, drawn, 0);
    add_differences(&all, drawn, 1);
    add_drift(&all, &drawn->pair);
    for (int i = 0; i < all.count; i++)
        for (int j = 0; j < i; j++) {
            double n[FMB_DIM_MAX];
            cross(all.at[i], all.at[j], n);
            if (dot(n, n) == 0 || (drawn->pair.a.body->dim == 2 && n[2] != 0))
                continue;
            least = fmin(least, fmin(reach_of(drawn, n, 1), reach_of(drawn, n, -1)));
        }
    return least < INFINITY ? least : 0; /* of lines and points */
}

/* Checks that a point is in a frame: on the inner side of its facets and, if it is flat, of those
 * of the prism on it. */
static void check_inside(const struct hull_pair_draw *drawn, int f, const double *point, double t)
{
    struct directions all = {.count = 0};
    const int axes = FMB_DIM_MAX;
    add_differences(&all, drawn, f);
    for (int axis = 0; axis < axes; axis++) {
        static const double none[FMB_DIM_MAX] = {0, 0, 0};
        const double unit[FMB_DIM_MAX] = {axis == 0, axis == 1, axis == 2};
        add_direction(&all, unit, none);
    }
    for (int i = 0; i < all.count; i++)
        for (int j = 0; j <= i; j++) {
            double n[FMB_DIM_MAX];
            cross(all.at[i], all.at[j], n);
            for (int side = 0; side < 2; side++) {
                const double *direction = j == i ? all.at[i] : n, sign = side ? -1 : 1;
                if (sign * dot(direction, point) > most_of(drawn, f, direction, sign, t) + 1e-12)
                    fail_msg("a witness point is outside of frame %d", f);
            }
        }
}

static void check_separated(const struct hull_pair_draw *drawn, const struct fmb_gap *gap)
{
    double square = 0;
    assert_true(gap->has_witness);
    assert_true(gap->time >= 0 && gap->time <= drawn->pair.duration);
    assert_true(-reach_of(drawn, gap->direction, -1) >= gap->bounds[0] - 1e-14);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        square += pow(gap->witness[1][axis] - gap->witness[0][axis], 2);
    assert_true(sqrt(square) <= gap->bounds[1] + 1e-14);
    for (int f = 0; f < 2; f++)
        check_inside(drawn, f, gap->witness[f], gap->time);
}

static void small_hulls(void **state)
{
    struct draw draw;
    int verdicts[4] = {0};
    draw_begin(&draw, "small_hulls");
    for (long i = draw_sample(4000); i > 0; i--) {
        struct hull_pair_draw drawn;
        struct fmb_gap gap;
        char text[FMB_CERTIFICATE_MAX];
        size_t length;
        int verdict = FMB_SEPARATED;
        hull_draw_small(&draw, &drawn);
        const struct frame_pair frames = pair_frames(&drawn.pair);
        assert_int_equal(pair_certificate(&drawn.pair, text, sizeof text, &length), FMB_OK);
        while (!pair_certificate_holds(&drawn.pair, verdict, text, NULL, 0))
            assert_true(++verdict <= FMB_OVERLAPPING);
        verdicts[verdict]++;
        gap = gap_of_vertices(&frames, verdict);
        assert_true(gap.bounds[0] <= gap.bounds[1] && gap.bounds[1] - gap.bounds[0] <= 1e-11);
        assert_true(fabs(dot(gap.direction, gap.direction) - 1) < 1e-14);
        if (verdict == FMB_SEPARATED) {
            check_separated(&drawn, &gap);
            continue;
        }
        const double depth = verdict == FMB_TOUCHING ? 0 : depth_by_facets(&drawn);
        if (!(gap.bounds[0] <= -depth + 1e-14 && gap.bounds[1] >= -depth - 1e-14))
            fail_msg("%s: depth %g, [%g, %g]", text, depth, gap.bounds[0], gap.bounds[1]);
        assert_true(-reach_of(&drawn, gap.direction, -1) >= gap.bounds[0] - 1e-11);
    }
    print_message("%d separated, %d touching, %d overlapping\n", verdicts[1], verdicts[2],
                  verdicts[3]);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0);
}

/* ---- Large hulls ---- */

enum { LARGE_VERTICES = 300 };

struct large {
    int count;
    double vertices[LARGE_VERTICES][FMB_DIM_MAX];
    double memory[FMB_DIM_MAX * (LARGE_VERTICES + 8) + LARGE_VERTICES];
    struct fmb_body body;
};

/* Points on and in an ellipsoid; the first ones exactly on a face, where there is one. */
static void draw_large(struct draw *draw, int count, bool with_face, struct large *out)
{
    double numbers[LARGE_VERTICES * FMB_DIM_MAX];
    const double axes[FMB_DIM_MAX] = {1, draw_uniform(draw, 0.01, 1), draw_uniform(draw, 0.01, 1)};
    out->count = count;
    for (int k = 0; k < count; k++) {
        double *v = out->vertices[k], square = 0;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            v[axis] = draw_uniform(draw, -1, 1);
            square += v[axis] * v[axis];
        }
        const double length = draw_int(draw, 0, 3) ? sqrt(square) : 1;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            v[axis] *= axes[axis] / length;
        if (with_face && k < 5)
            v[2] = -axes[2];
        memcpy(numbers + k * FMB_DIM_MAX, v, sizeof out->vertices[k]);
    }
    assert_int_equal(
        fmb_body_make_hull(3, numbers, (size_t) count * FMB_DIM_MAX, out->memory, &out->body),
        FMB_OK);
}

/* The frame at time 0 rounded, as vertices in the world. */
static void turn(const struct fmb_placement *placement, const double *v, double *out)
{
    struct rotation_matrix rotation;
    rotation_of(placement, 3, &rotation);
    rotation_apply(&rotation, v, out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] += placement->position[axis];
}

/* The greatest n . x over b - a, rounded; n of unit length. */
static double reach_of_large(const struct large hulls[2], const struct pair *pair, const double *n)
{
    double most[2] = {-INFINITY, -INFINITY};
    for (int f = 0; f < 2; f++)
        for (int k = 0; k < hulls[f].count; k++) {
            double v[FMB_DIM_MAX];
            turn(f ? &pair->b : &pair->a, hulls[f].vertices[k], v);
            most[f] = fmax(most[f], (f ? 1 : -1) * dot(n, v));
        }
    return most[0] + most[1];
}

/* Moves b along n until it reaches a depth; the gap of a random direction is about that. */
static void set_depth(const struct large hulls[2], struct pair *pair, const double *n, double depth)
{
    const double reach = reach_of_large(hulls, pair, n);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        pair->b.position[axis] += (depth - reach) * n[axis];
}

static void check_large(struct draw *draw, const struct large hulls[2], const struct pair *pair)
{
    struct fmb_answer answer = {0};
    const struct frame_pair frames = pair_frames(pair);
    double size = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        size = fmax(size, fabs(pair->a.position[axis]) + fabs(pair->b.position[axis]));
    assert_int_equal(pair_decide(fmb_method_default(), pair, 0, &answer), FMB_OK);
    answer.gap = gap_of_vertices(&frames, answer.verdict);
    const double *bounds = answer.gap.bounds, error = 1e-13 * (1 + size);
    const double towards[FMB_DIM_MAX] = {-answer.gap.direction[0], -answer.gap.direction[1],
                                         -answer.gap.direction[2]};
    assert_true(bounds[1] >= bounds[0] && bounds[1] - bounds[0] <= 1e-12 * (1 + size));
    assert_true(reach_of_large(hulls, pair, towards) <= -bounds[0] + error);
    assert_true(answer.verdict == FMB_OVERLAPPING ? bounds[1] <= 0 : bounds[1] >= 0);
    for (int i = 0; i < 200; i++) { /* no direction near the best one, or far from it, is better */
        double n[FMB_DIM_MAX];
        const double spread = ldexp(1, -draw_int(draw, 0, 40));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            n[axis] = towards[axis] + spread * draw_uniform(draw, -1, 1);
        const double length = sqrt(dot(n, n));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            n[axis] /= length;
        assert_true(reach_of_large(hulls, pair, n) >= -bounds[1] - error);
    }
}

/* Random poses at depths from 1 to 1e-17, and gaps. */
static void large_hulls(void **state)
{
    static struct large hulls[2];
    struct draw draw;
    draw_begin(&draw, "large_hulls");
    for (long i = draw_sample(300); i > 0; i--) {
        struct pair pair = {{.body = &hulls[0].body}, {.body = &hulls[1].body}, 0};
        double n[FMB_DIM_MAX], square = 0;
        const bool face = draw_coin(&draw), equal = draw_int(&draw, 0, 4) == 0;
        draw_large(&draw, draw_int(&draw, 1, LARGE_VERTICES), face, &hulls[0]);
        draw_large(&draw, draw_int(&draw, 1, LARGE_VERTICES), face, &hulls[1]);
        pair.a.orientation_count = pair.b.orientation_count = 4;
        for (int k = 0; k < 4; k++) {
            pair.a.orientation[k] = draw_uniform(&draw, -1, 1);
            pair.b.orientation[k] = draw_uniform(&draw, -1, 1);
        }
        if (equal) { /* nearly the same pose of the same hull */
            pair.b.body = pair.a.body;
            hulls[1] = hulls[0];
            memcpy(pair.b.orientation, pair.a.orientation, sizeof pair.a.orientation);
            pair.b.orientation[0] *= 1 + ldexp(1, -draw_int(&draw, 30, 53));
            hulls[1].body.one.vertices = hulls[1].memory;
            pair.b.body = &hulls[1].body;
        }
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            n[axis] = draw_uniform(&draw, -1, 1);
            square += n[axis] * n[axis];
        }
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            n[axis] /= sqrt(square);
        if (!equal)
            set_depth(hulls, &pair, n,
                      (draw_coin(&draw) ? 1 : -1) * ldexp(1, -draw_int(&draw, 0, 58)));
        check_large(&draw, hulls, &pair);
    }
}

/* A regular polygon on itself: the first point found is v - v, the origin, which is not a vertex of
 * D. The depth is the distance of two opposite sides. */
static void polygon_on_itself(void **state)
{
    enum { SIDES = 12 };
    const double pi = 3.14159265358979, depth = 2 * cos(pi / SIDES);
    double numbers[SIDES * 2], memory[5 * SIDES + 16];
    struct fmb_body body;
    struct fmb_answer answer;
    for (int k = 0; k < SIDES; k++) {
        numbers[2 * k] = cos(2 * pi * k / SIDES);
        numbers[2 * k + 1] = sin(2 * pi * k / SIDES);
    }
    assert_int_equal(fmb_body_make_hull(2, numbers, COUNT(numbers), memory, &body), FMB_OK);
    const struct fmb_placement at = {.body = &body, .position = {0.5, 0.25}};
    assert_int_equal(fmb_decide(fmb_method_default(), &at, &at, 0, FMB_WANT_GAP, &answer), FMB_OK);
    assert_int_equal(answer.verdict, FMB_OVERLAPPING);
    assert_true(fabs(answer.gap.bounds[0] + depth) < 1e-10);
    assert_true(fabs(answer.gap.bounds[1] + depth) < 1e-10);
}

/* Any direction is that of two points at the origin of the world; it is the same in every build. */
static void points_at_the_origin_have_the_direction_of_x(void **state)
{
    static const double x[FMB_DIM_MAX] = {1};
    for (int dim = 2; dim <= 3; dim++) {
        double zero[FMB_DIM_MAX] = {0}, memory[64];
        struct fmb_body body;
        struct fmb_answer answer;
        assert_true(fmb_hull_doubles(dim, 1) <= COUNT(memory));
        assert_int_equal(fmb_body_make_hull(dim, zero, (size_t) dim, memory, &body), FMB_OK);
        const struct fmb_placement at = {.body = &body};
        fmb_decide(fmb_method_default(), &at, &at, 0, FMB_WANT_GAP, &answer);
        assert_true(answer.gap.bounds[0] == 0 && answer.gap.bounds[1] == 0);
        assert_memory_equal(answer.gap.direction, x, sizeof x);
    }
}

/* ---- Steps ---- */

static long live; /* blocks that GMP has allocated */

static void *count_allocate(size_t size)
{
    live++;
    return malloc(size);
}

static void *count_reallocate(void *memory, size_t old, size_t size)
{
    (void) old;
    return realloc(memory, size);
}

static void count_release(void *memory, size_t size)
{
    (void) size;
    live--;
    free(memory);
}

/* Points spread over a unit ball, far along one axis. */
static void make_ball(double turn_by, double far, struct large *out)
{
    double numbers[LARGE_VERTICES * FMB_DIM_MAX];
    out->count = LARGE_VERTICES;
    for (int k = 0; k < LARGE_VERTICES; k++) {
        const double z = 1 - 2 * (k + 0.5) / LARGE_VERTICES, r = sqrt(1 - z * z);
        const double angle = k * 2.4 + turn_by;
        numbers[3 * k] = far + r * cos(angle);
        numbers[3 * k + 1] = r * sin(angle);
        numbers[3 * k + 2] = z;
    }
    assert_int_equal(fmb_body_make_hull(3, numbers, COUNT(numbers), out->memory, &out->body),
                     FMB_OK);
}

/* Performs at most so many steps. Returns how many were made, and sets *gap if that is all. */
static int step_gap(const struct frame_pair *frames, int most, struct fmb_gap *gap)
{
    struct support_decision decision;
    struct fmb_answer answer = {0};
    int steps = 1;
    bool done = support_decision_begin_gap_and_point(frames, FMB_WANT_GAP, FMB_OVERLAPPING,
                                                     INFINITY, false, &decision, &answer);
    for (; !done && steps < most; steps++)
        done = support_decision_step(&decision, &answer);
    support_decision_end(&decision);
    *gap = answer.gap;
    return steps;
}

/* Concentric balls, whose depth takes hundreds of facets, and balls that are placed exactly: their
 * gap takes many steps, may be abandoned after each, and leaves no memory. */
static void steps_leave_no_memory(void **state)
{
    static struct large balls[2];
    mp_set_memory_functions(count_allocate, count_reallocate, count_release);
    for (int far = 0; far < 2; far++) {
        make_ball(0, far * 1e9, &balls[0]);
        make_ball(1, far * 1e9, &balls[1]);
        const struct fmb_placement a = {.body = &balls[0].body, .position = {far * -1e9}};
        const struct fmb_placement b = {.body = &balls[1].body,
                                        .position = {far * -1e9, 0.25 * far}};
        const struct frame_pair frames = {{&balls[0].body.one, &a}, {&balls[1].body.one, &b}, 0};
        struct fmb_gap gap, stepped;
        live = 0;
        gap = gap_of_vertices(&frames, FMB_OVERLAPPING);
        assert_int_equal(live, 0);
        const int steps = step_gap(&frames, 1000, &stepped);
        assert_true(steps > 2 && steps < 1000);
        assert_true(gap_check_same(&gap, &stepped));
        for (int most = 1; most <= steps; most++) {
            step_gap(&frames, most, &stepped);
            assert_int_equal(live, 0);
        }
    }
    mp_set_memory_functions(NULL, NULL, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_by_their_vertices),
        cmocka_unit_test(all_exponents),
        cmocka_unit_test(positions_that_cancel),
        cmocka_unit_test(common_velocities),
        cmocka_unit_test(small_hulls),
        cmocka_unit_test(large_hulls),
        cmocka_unit_test(polygon_on_itself),
        cmocka_unit_test(points_at_the_origin_have_the_direction_of_x),
        cmocka_unit_test(steps_leave_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
