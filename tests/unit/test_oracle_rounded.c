/* The oracle on frames with a radius: cases worked out by hand, closed forms, and distances found
 * in another way. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "gap_check.h"
#include "oracle.h"
#include "question.h"
#include "rounded.h"
#include "world.h"

/* clang-format off */
#define UNIT2 {{1, 0}, {0, 1}}
#define UNIT3 {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
#define DISC 2, FMB_CUBOID, {{0}}
#define SQUARE 2, FMB_CUBOID, UNIT2
#define BALL 3, FMB_CUBOID, {{0}}
#define CUBE 3, FMB_CUBOID, UNIT3
#define ALONG_X 3, FMB_TETRAHEDRON, {{4, 0, 0}, {0}, {0}}
#define ALONG_Y 3, FMB_CUBOID, {{0}, {0, 4, 0}, {0}}
#define STILL {0}, false

struct known {
    const char *what;
    struct question question;
    enum fmb_verdict verdict;
    double contact[2]; /* where a body moves */
};

static const struct known cases[] = {
    {"balls, 3 4 5", {{BALL, {1, 0, 0}, STILL, .radius = 2}, {BALL, {4, 4, 0}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"a point and a ball, 2 3 6", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7}, 1}, FMB_TOUCHING},
    {"a point and a smaller ball", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7 - 0x1p-50}, 1}, FMB_SEPARATED},
    {"a point and a larger ball", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7 + 0x1p-50}, 1}, FMB_OVERLAPPING},
    {"radii whose sum is no double", {{BALL, {0}, STILL, .radius = 0x1p-60}, {BALL, {1, 4, 8}, STILL, .radius = 9}, 1}, FMB_OVERLAPPING},
    {"a ball at a vertex", {{CUBE, {0}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7}, 1}, FMB_TOUCHING},
    {"a ball at an edge", {{CUBE, {0}, STILL}, {BALL, {-3, 0.5, 5}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"a ball on a face", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.25, 1 + 0x1p-20}, STILL, .radius = 0x1p-20}, 1}, FMB_TOUCHING},
    {"a ball that the box of a cube would meet", {{CUBE, {0}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 6.5}, 1}, FMB_SEPARATED},
    {"a ball in a cube", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.5, 0.5}, STILL, .radius = 0x1p-1074}, 1}, FMB_OVERLAPPING},
    {"a point in a ball", {{BALL, {0}, STILL}, {BALL, {0, 0, 1}, STILL, .radius = 2}, 1}, FMB_OVERLAPPING},
    {"equal centres", {{BALL, {1, 2, 3}, STILL, .radius = 1}, {BALL, {1, 2, 3}, STILL, .radius = 1}, 1}, FMB_OVERLAPPING},
    {"subnormal radii", {{BALL, {0}, STILL, .radius = 0x1p-1074}, {BALL, {0, 0, 3 * 0x1p-1074}, STILL, .radius = 0x1p-1073}, 1}, FMB_TOUCHING},
    {"the largest radius", {{BALL, {0}, STILL, .radius = DBL_MAX}, {BALL, {DBL_MAX, 0, 0}, STILL}, 1}, FMB_TOUCHING},
    {"cubes whose faces touch, with a radius", {{CUBE, {0}, STILL, .radius = 0x1p-1074}, {CUBE, {1, 0, 0}, STILL}, 1}, FMB_OVERLAPPING},
    {"rounded cubes, vertex at vertex", {{CUBE, {0}, STILL, .radius = 2}, {CUBE, {3, 4, 7}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"capsules across each other", {{ALONG_X, {-1, 0, 0}, STILL, .radius = 2}, {ALONG_Y, {1, -1, 5}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"capsules side by side", {{ALONG_X, {0}, STILL, .radius = 2}, {ALONG_X, {2, 3, 4}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"the end of a capsule at a face", {{CUBE, {0}, STILL, .radius = 1}, {ALONG_X, {4, 0.5, 0.5}, STILL, .radius = 2}, 1}, FMB_TOUCHING},
    {"a turned cuboid and a ball at its corner (3, 4, 0)",
     {{3, FMB_CUBOID, {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}}, {0}, STILL, {0}, {2, 0, 0, 1}, 4}, {BALL, {6, 6, -6}, STILL, .radius = 7}, 1},
     FMB_TOUCHING},
    {"a rounded face and a point beside its edge",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0}, STILL, .radius = 13}, {BALL, {1, -5, 12}, STILL}, 1}, FMB_TOUCHING},
    {"a disc at a corner", {{SQUARE, {0}, STILL}, {DISC, {4, 5}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"a disc at an edge", {{SQUARE, {0}, STILL, .radius = 0.5}, {DISC, {0.5, 2.5}, STILL, .radius = 1}, 1}, FMB_TOUCHING},
    {"stadiums", {{2, FMB_CUBOID, {{4, 0}, {0}}, {0}, STILL, .radius = 1}, {2, FMB_CUBOID, {{0}, {0, 4}}, {7, 4}, STILL, .radius = 4}, 1}, FMB_TOUCHING},

    {"a ball grazes a point", {{BALL, {0}, STILL}, {BALL, {-6, 5, 0}, {3, 0, 0}, true, .radius = 5}, 4}, FMB_TOUCHING, {2, 2}},
    {"a ball grazes a point a third of a second later", {{BALL, {1, 0, 0}, STILL}, {BALL, {-5, 5, 0}, {3, 0, 0}, true, .radius = 5}, 4}, FMB_TOUCHING, {2, 2}},
    {"a ball passes a point by", {{BALL, {0}, STILL}, {BALL, {-6, 5, 0}, {3, 0, 0}, true, .radius = 5 - 0x1p-50}, 4}, FMB_SEPARATED},
    {"a ball slides on a cube", {{CUBE, {0}, STILL}, {BALL, {-3, 0.5, 2}, {1, 0, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {3, 4}},
    {"a ball slides on a cube as the window begins", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.5, 2}, {0.25, 0, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {0, 2}},
    {"a capsule slides along a rounded edge",
     {{CUBE, {0}, STILL, .radius = 2}, {ALONG_X, {-8, 4, 5}, {2, 0, 0}, true, .radius = 3}, 8}, FMB_TOUCHING, {2, 4.5}},
    {"a ball flies through a point", {{BALL, {0}, STILL}, {BALL, {-13, 3, 0}, {2, 0, 0}, true, .radius = 5}, 16}, FMB_OVERLAPPING, {4.5, 8.5}},
    {"both fly", {{BALL, {-13, 0, 0}, {3, 1, 0}, true, .radius = 1}, {BALL, {0, 0, 3}, {1, 1, 0}, true, .radius = 4}, 16}, FMB_OVERLAPPING, {4.5, 8.5}},
    {"a ball flies in", {{CUBE, {0}, STILL}, {BALL, {9, 0.5, 0.5}, {-2, 0, 0}, true, .radius = 2}, 4}, FMB_OVERLAPPING, {3, 4}},
    {"a ball arrives", {{CUBE, {0}, STILL}, {BALL, {9, 0.5, 0.5}, {-2, 0, 0}, true, .radius = 2}, 3}, FMB_TOUCHING, {3, 3}},
    {"a ball leaves", {{CUBE, {0}, STILL}, {BALL, {4, 5, 0.5}, {3, 4, 0}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 0}},
    {"a ball leaves as fast as it can", {{CUBE, {0}, STILL}, {BALL, {4, 5, 0.5}, {4, -3, 0}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 0}},
    {"equal velocities", {{BALL, {0}, {1, 2, 3}, true, .radius = 2}, {BALL, {2, 3, 6}, {1, 2, 3}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 3}},
    {"no time", {{BALL, {0}, {1, 2, 3}, true, .radius = 2}, {BALL, {2, 3, 6}, STILL, .radius = 5}, 0}, FMB_TOUCHING, {0, 0}},
    {"a disc slides along a square", {{SQUARE, {0}, STILL}, {DISC, {-3, 2}, {1, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {3, 4}},
};
/* clang-format on */

struct posed {
    struct fmb_body body[2];
    struct pair pair;
};

static void place(const struct question *question, struct posed *out)
{
    question_pair(question, out->body, &out->pair);
}

static enum fmb_verdict verdict_of(const struct pair *pair)
{
    struct oracle_answer truth;
    oracle_init(&truth);
    oracle_decide(pair, 0, &truth);
    const enum fmb_verdict verdict = truth.verdict;
    oracle_clear(&truth);
    return verdict;
}

static bool accepts(const struct pair *pair, double first, double last)
{
    return !rounded_contact_fault(pair, (const double[2]){first, last});
}

/* The contact that is expected, and no other. */
static void assert_contact(const struct known *known, const struct pair *pair)
{
    const double T = pair->duration;
    const bool moving = pair->a.velocity[0] != pair->b.velocity[0];
    const double first = moving ? known->contact[0] : 0, last = moving ? known->contact[1] : T;
    if (!accepts(pair, first, last))
        fail_msg("%s: the true contact is refused", known->what);
    const bool bad =
        (first > 0 && !accepts(pair, first - 0.9e-12 * T, last)) ||
        (last < T && !accepts(pair, first, last + 0.9e-12 * T)) ||
        (first > 0 && accepts(pair, first - 1.1e-12 * T, last)) ||
        (last < T && accepts(pair, first, last + 1.1e-12 * T)) ||
        (first < T && accepts(pair, nextafter(first, T), fmax(nextafter(first, T), last))) ||
        (last > 0 && accepts(pair, fmin(first, nextafter(last, 0)), nextafter(last, 0)));
    if (bad)
        fail_msg("%s: a wrong contact is accepted, or one that is close enough refused",
                 known->what);
}

static void by_hand(void **state)
{
    for (size_t i = 0; i < 2 * COUNT(cases); i++) {
        const struct known *known = &cases[i / 2];
        const struct question swapped = question_swapped(&known->question);
        struct posed posed;
        place(i % 2 ? &swapped : &known->question, &posed);
        if (verdict_of(&posed.pair) != known->verdict)
            fail_msg("%s: verdict %d", known->what, verdict_of(&posed.pair));
        if (known->verdict != FMB_SEPARATED)
            assert_contact(known, &posed.pair);
    }
}

/* ---- Distances in another way ---- */

enum { POINTS_MAX = 2 * VERTICES_MAX * VERTICES_MAX };

/* Of small whole numbers: the vertices of the swept difference. */
static int list_points(const struct question *question, double point[POINTS_MAX][FMB_DIM_MAX])
{
    double vertex[2][VERTICES_MAX][FMB_DIM_MAX] = {{{0}}};
    const struct solid *solid[2] = {&question->a, &question->b};
    const int of_a = solid_vertices(solid[0], vertex[0]),
              of_b = solid_vertices(solid[1], vertex[1]);
    int count = 0;
    for (int k = 0; k < of_a * of_b; k++)
        for (int late = 0; late < 2; late++, count++)
            for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
                point[count][axis] = vertex[1][k % of_b][axis] + solid[1]->origin[axis] -
                                     vertex[0][k / of_b][axis] - solid[0]->origin[axis];
                for (int side = 0; side < 2; side++)
                    if (solid[side]->moving)
                        point[count][axis] += (side ? late : -late) * question->duration *
                                              solid[side]->velocity[axis];
            }
    return count;
}

static double dot(const double *x, const double *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/* The squared distance as a quotient of whole numbers. */
struct quotient {
    double over, under;
};

static void lower(struct quotient *least, double over, double under)
{
    if (over * least->under < least->over * under)
        *least = (struct quotient){over, under};
}

static void subtract(const double *x, const double *y, double *out)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = x[axis] - y[axis];
}

/* The least squared distance of the origin from a vertex, from the middle of an edge between two,
 * or from a triangle of three, where the nearest point is inside of it. Of a polytope that does not
 * contain the origin that is its distance, as the nearest point is inside of a face. All products
 * are whole numbers below 2^53. */
static struct quotient by_faces(const double (*p)[FMB_DIM_MAX], int count)
{
    struct quotient least = {dot(p[0], p[0]), 1};
    for (int i = 0; i < count; i++) {
        lower(&least, dot(p[i], p[i]), 1);
        for (int j = 0; j < i; j++) {
            double e[3], n[3];
            subtract(p[j], p[i], e);
            const double ee = dot(e, e), at = -dot(p[i], e);
            if (at > 0 && at < ee)
                lower(&least, dot(p[i], p[i]) * ee - at * at, ee);
            for (int k = 0; k < j; k++) {
                double f[3];
                subtract(p[k], p[i], f);
                for (int axis = 0; axis < 3; axis++)
                    n[axis] = e[(axis + 1) % 3] * f[(axis + 2) % 3] -
                              e[(axis + 2) % 3] * f[(axis + 1) % 3];
                const double nn = dot(n, n), ff = dot(f, f), ef = dot(e, f), to = -dot(p[i], f);
                const double x = at * ff - to * ef, y = to * ee - at * ef; /* times nn */
                if (x > 0 && y > 0 && x + y < nn)
                    lower(&least, dot(n, p[i]) * dot(n, p[i]), nn);
            }
        }
    }
    return least;
}

static void draw_small(struct draw *draw, struct question *out)
{
    const int dim = draw_int(draw, 2, 3);
    *out = (struct question){.duration = draw_int(draw, 0, 2)};
    struct solid *solid[2] = {&out->a, &out->b};
    for (int side = 0; side < 2; side++) {
        *solid[side] = (struct solid){.dim = dim, .shape = question_draw_shape(draw, dim)};
        solid[side]->radius = draw_int(draw, 0, 3);
        draw_integers(draw, dim, -5, 5, solid[side]->origin);
        draw_integers(draw, dim, -2, 2, solid[side]->velocity);
        for (int i = draw_int(draw, 0, solid_count(solid[side])) - 1; i >= 0; i--)
            draw_integers(draw, dim, -2, 2, solid[side]->component[i]);
    }
    question_draw_movers(draw, out);
}

static void distances_are_those_of_faces(void **state)
{
    struct draw draw;
    long count[4] = {0}, apart = 0;
    draw_begin(&draw, "distances_are_those_of_faces");
    for (long n = draw_sample(1500); n > 0; n--) {
        static double point[POINTS_MAX][FMB_DIM_MAX];
        struct question question, core;
        struct posed posed;
        mpq_t square, other;
        draw_small(&draw, &question);
        core = question;
        core.a.radius = core.b.radius = 0;
        place(&core, &posed);
        const bool meet = verdict_of(&posed.pair) != FMB_SEPARATED;
        place(&question, &posed);
        const struct quotient least = by_faces(point, list_points(&question, point));
        mpq_inits(square, other, NULL);
        gap_check_distance(&posed.pair, square);
        mpq_set_d(other, least.under);
        mpq_mul(square, square, other);
        mpq_set_d(other, least.over);
        if (meet ? mpq_sgn(square) != 0 : mpq_cmp(square, other) != 0) {
            question_print(&question);
            fail_msg("the distances differ");
        }
        mpq_clears(square, other, NULL);
        const double radius = question.a.radius + question.b.radius;
        const double excess = (meet ? 0 : least.over) - radius * radius * least.under;
        const enum fmb_verdict verdict = verdict_of(&posed.pair);
        if (radius > 0)
            assert_int_equal(verdict, excess > 0    ? FMB_SEPARATED
                                      : excess == 0 ? FMB_TOUCHING
                                                    : FMB_OVERLAPPING);
        count[radius > 0 ? verdict : 0]++;
        apart += !meet;
    }
    printf("# %ld separated, %ld touching, %ld overlapping; %ld cores apart\n",
           count[FMB_SEPARATED], count[FMB_TOUCHING], count[FMB_OVERLAPPING], apart);
    assert_true(count[FMB_SEPARATED] && count[FMB_TOUCHING] && count[FMB_OVERLAPPING]);
}

/* ---- Times in another way ---- */

/* The sign of |p + t v|^2 - R^2 for balls. */
static int side_of(const struct question *question, double time)
{
    mpq_t t, way, sum, part;
    mpq_inits(t, way, sum, part, NULL);
    mpq_set_d(t, time);
    for (int axis = 0; axis < question->a.dim; axis++) {
        mpq_set_d(way, question->b.velocity[axis] - question->a.velocity[axis]);
        mpq_mul(way, way, t);
        mpq_set_d(part, question->b.origin[axis] - question->a.origin[axis]);
        mpq_add(way, way, part);
        rational_add_product(sum, 1, way, way);
    }
    mpq_set_d(part, question->a.radius + question->b.radius);
    rational_add_product(sum, -1, part, part);
    const int sign = mpq_sgn(sum);
    mpq_clears(t, way, sum, part, NULL);
    return sign;
}

/* The double next to an end of the contact, on its outer side: between a time out of contact and
 * one in it. */
static double outer_end(const struct question *question, double out, double in)
{
    while (nextafter(out, in) != in) {
        const double middle = out + (in - out) / 2;
        *(side_of(question, middle) <= 0 ? &in : &out) = middle;
    }
    return side_of(question, in) == 0 ? in : out;
}

static void balls_meet_at_roots(void **state)
{
    struct draw draw;
    long count = 0;
    draw_begin(&draw, "balls_meet_at_roots");
    for (long n = draw_sample(400); n > 0; n--) {
        struct question question = {.duration = 64};
        struct solid *solid[2] = {&question.a, &question.b};
        double p[3], v[3];
        const int dim = draw_int(&draw, 2, 3);
        for (int side = 0; side < 2; side++) {
            *solid[side] = (struct solid){dim, FMB_CUBOID, .moving = true};
            draw_integers(&draw, dim, -9, 9, solid[side]->velocity);
            draw_integers(&draw, dim, -99, 99, solid[side]->origin);
            solid[side]->radius = draw_int(&draw, 0, 40) * 0.5;
        }
        subtract(question.b.origin, question.a.origin, p);
        subtract(question.b.velocity, question.a.velocity, v);
        const double nearest = dot(v, v) == 0 ? 0 : -dot(p, v) / dot(v, v);
        if (!(nearest > 0 && nearest < 64) || side_of(&question, nearest) >= 0)
            continue;
        const double first = side_of(&question, 0) <= 0 ? 0 : outer_end(&question, 0, nearest);
        const double last = side_of(&question, 64) <= 0 ? 64 : outer_end(&question, 64, nearest);
        struct posed posed;
        place(&question, &posed);
        assert_int_equal(verdict_of(&posed.pair), FMB_OVERLAPPING);
        assert_contact(&(struct known){"balls", question, FMB_OVERLAPPING, {first, last}},
                       &posed.pair);
        count++;
    }
    assert_true(count > 0);
}

/* ---- The checks see what is wrong ---- */

static bool holds(const struct pair *pair, enum fmb_verdict verdict, const struct fmb_gap *gap)
{
    char why[200];
    return gap_check(pair, verdict, gap, why, sizeof why);
}

#define WITH(change)                \
    (__extension__({                \
        struct fmb_gap gap = right; \
        change;                     \
        gap;                        \
    }))

/* A ball whose point nearest to the cuboid is 2 away from an edge of it. */
static void gaps_of_what_is_apart(void **state)
{
    const struct question question = {
        {3, FMB_CUBOID, {{6, 0, 0}, {0, 8, 0}, {0, 0, 8}}, {0}, STILL},
        {BALL, {9, 12, 4}, STILL, .radius = 3},
        1};
    struct posed posed;
    place(&question, &posed);
    assert_int_equal(verdict_of(&posed.pair), FMB_SEPARATED);
    const struct fmb_gap right = {.bounds = {2 - 0x1p-44, 2 + 0x1p-44},
                                  .direction = {0.6, 0.8, 0},
                                  .has_witness = true,
                                  .witness = {{6, 8, 4}, {7.2, 9.6, 4}}};
    assert_true(holds(&posed.pair, FMB_SEPARATED, &right));
    const struct fmb_gap wrong[] = {
        WITH(gap.bounds[0] = 2 + 0x1p-45),
        WITH(gap.bounds[1] = 2 - 0x1p-45),
        WITH(gap.bounds[1] = 2 + 16e-12),
        WITH(gap.has_witness = false),
        WITH(gap.witness[1][0] = 7.3),
        WITH(gap.witness[0][2] = 4.1),
        WITH(gap.direction[0] = 0.8; gap.direction[1] = 0.6),
    };
    for (size_t i = 0; i < COUNT(wrong); i++)
        assert_false(holds(&posed.pair, FMB_SEPARATED, &wrong[i]));
}

/* Depth: of cores that are apart, R less their distance; of cores that overlap, R and their depth.
 */
static void gaps_of_what_overlaps(void **state)
{
    const struct solid tall = {3,   FMB_CUBOID, {{4, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                               {0}, STILL,      .radius = 2};
    struct question question = {tall, {BALL, {5, 1, 1}, STILL, .radius = 1}, 1};
    struct posed posed;
    for (int inside = 0; inside < 2; inside++) {
        const double depth = inside ? 4 : 2;
        question.b.origin[0] = inside ? 3 : 5;
        place(&question, &posed);
        assert_int_equal(verdict_of(&posed.pair), FMB_OVERLAPPING);
        const struct fmb_gap right = {.bounds = {-depth - 0x1p-44, -depth + 0x1p-44},
                                      .direction = {1, 0, 0},
                                      .has_witness = true,
                                      .witness = {{6, 1, 1}, {6 - depth, 1, 1}}};
        assert_true(holds(&posed.pair, FMB_OVERLAPPING, &right));
        const struct fmb_gap pointless = WITH(gap.has_witness = false);
        assert_true(holds(&posed.pair, FMB_OVERLAPPING, &pointless));
        const struct fmb_gap wrong[] = {
            WITH(gap.bounds[0] = -depth + 0x1p-45),
            WITH(gap.bounds[1] = -depth - 0x1p-45),
            WITH(gap.witness[0][0] = 6 + 2e-11),
            WITH(gap.witness[1][0] = 6.5 - depth),
            WITH(gap.witness[0][1] = 1 + 2e-11),
            WITH(gap.direction[0] = -1),
            WITH(gap.direction[0] = 0.6; gap.direction[1] = 0.8),
        };
        for (size_t i = 0; i < COUNT(wrong); i++)
            assert_false(holds(&posed.pair, FMB_OVERLAPPING, &wrong[i]));
    }
    question.b.moving = true;
    question.b.velocity[0] = 0x1p-40;
    place(&question, &posed);
    const struct fmb_gap moving = {.bounds = {-4 - 0x1p-43, -4 + 0x1p-43}, .direction = {1, 0, 0}};
    assert_true(holds(&posed.pair, FMB_OVERLAPPING, &moving));
    struct fmb_gap with = moving;
    with.has_witness = true;
    with.witness[0][0] = 6;
    with.witness[1][0] = 2;
    with.witness[0][1] = with.witness[0][2] = with.witness[1][1] = with.witness[1][2] = 1;
    assert_false(holds(&posed.pair, FMB_OVERLAPPING, &with));
}

static bool box_holds(const struct pair *pair, double least, double most, double side)
{
    const double box[2][FMB_DIM_MAX] = {{least, -side, -side}, {most, side, side}};
    return !rounded_box_fault(pair, (const double[2]){0, pair->duration}, box);
}

/* A ball that moves within a large cube: their box is that of its way. */
static void boxes_contain_what_is_common(void **state)
{
    const struct question question = {
        {3, FMB_BOX, {{64, 0, 0}, {0, 64, 0}, {0, 0, 64}}, {0}, STILL, .radius = 1},
        {BALL, {-2, 0, 0}, {2, 0, 0}, true, .radius = 3},
        2};
    struct posed posed;
    place(&question, &posed);
    assert_true(box_holds(&posed.pair, -5, 5, 3));
    assert_true(box_holds(&posed.pair, -5 - 30e-12, 5 + 30e-12, 3));
    assert_false(box_holds(&posed.pair, nextafter(-5, 0), 5, 3));
    assert_false(box_holds(&posed.pair, -5, nextafter(5, 0), 3));
    assert_false(box_holds(&posed.pair, -5, 5, nextafter(3, 0)));
    assert_false(box_holds(&posed.pair, -5, 5 + 40e-12, 3));
    assert_false(box_holds(&posed.pair, -HUGE_VAL, 5, 3));

    /* Where bodies touch, all that they have in common is known. */
    const struct question touching = {{BALL, {-2, 0, 0}, {1, 1, 1}, true, .radius = 2},
                                      {BALL, {3, 0, 0}, {1, 1, 1}, true, .radius = 3},
                                      1};
    place(&touching, &posed);
    const double box[2][FMB_DIM_MAX] = {{0, 0, 0}, {1, 1, 1}};
    assert_null(rounded_box_fault(&posed.pair, (const double[2]){0, 1}, box));
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++) {
            double other[2][FMB_DIM_MAX];
            memcpy(other, box, sizeof other);
            other[end][axis] += end ? -0x1p-53 : 0x1p-53;
            assert_non_null(rounded_box_fault(&posed.pair, (const double[2]){0, 1}, other));
        }
}

static bool point_holds(const struct question *question, double t, double x, double y, double z)
{
    struct posed posed;
    place(question, &posed);
    return !rounded_point_fault(&posed.pair, verdict_of(&posed.pair),
                                (const double[1 + FMB_DIM_MAX]){t, x, y, z});
}

static void points_are_common(void **state)
{
    const struct question grazing = {
        {BALL, {0}, STILL, .radius = 2}, {BALL, {-6, 5, 0}, {3, 0, 0}, true, .radius = 3}, 4};
    assert_true(point_holds(&grazing, 2, 0, 2, 0));
    assert_true(point_holds(&grazing, 2 + 3e-12, 0, 2 + 8e-12, 0)); /* the largest: 9 */
    assert_false(point_holds(&grazing, 2 + 5e-12, 0, 2, 0));
    assert_false(point_holds(&grazing, 2, 1e-11, 2, 0)); /* in neither by less than 1e-22 */
    assert_false(point_holds(&grazing, 2, 0, 2 + 1e-11, 0));
    assert_false(point_holds(&grazing, -0.0, 0, 2, 0));
    assert_false(point_holds(&grazing, 2, 0, 2, NAN));

    const struct question lens = {
        {BALL, {0}, STILL, .radius = 2}, {BALL, {0, 5, 0}, STILL, .radius = 3 + 0x1p-40}, 1};
    assert_true(point_holds(&lens, 0, 0, 2, 0));
    assert_true(point_holds(&lens, 1, 0x1p-22, 2 - 0x1p-42, 0));
    assert_true(point_holds(&lens, 0, 4e-12, 2 + 4e-12, 0));
    assert_false(point_holds(&lens, 0, 0, 2 + 9e-12, 0));
    assert_false(point_holds(&lens, 0, 0x1p-18, 2, 0)); /* in neither by less than 2^-38 */

    const struct question deep = {
        {3, FMB_BOX, {{8, 0, 0}, {0, 8, 0}, {0, 0, 8}}, {0}, STILL, .radius = 1},
        {BALL, {4, 0, 0}, STILL, .radius = 2},
        0};
    assert_true(point_holds(&deep, 0, 5, 0, 0));
    assert_true(point_holds(&deep, 0, 2, 0, 0));
    assert_true(point_holds(&deep, 0, 5 + 5e-12, 0, 0));
    assert_true(point_holds(&deep, 0, 2 - 5e-12, 0, 0));
    assert_false(point_holds(&deep, 0, 5 + 7e-12, 0, 0));
    assert_false(point_holds(&deep, 0, 2 - 7e-12, 0, 0));

    /* Without radii: plates of which one falls through the other, past its corner. */
    const struct question plates = {
        {3, FMB_FACE, {{3, 0, 0}, {0, 3, 0}}, {0}, STILL},
        {3, FMB_FACE, {{-3, 0, 0}, {0, -3, 0}}, {2, 2, 1}, {0, 0, -0.5}, true},
        4};
    assert_true(point_holds(&plates, 2, 1, 1, 0));
    assert_false(point_holds(&plates, 2, 2, 2, 0));
    assert_false(point_holds(&plates, 2.5, 1, 1, 0));
}

/* Two balls, one on each side, and a cube between that touches the one on the right. */
static void bodies_of_frames(void **state)
{
    struct fmb_frame frames[2] = {{.dim = 3, .shape = FMB_CUBOID, .count = 3, .radius = 5},
                                  {.dim = 3, .shape = FMB_CUBOID, .count = 3, .radius = 1}};
    frames[0].origin[0] = -9;
    frames[1].origin[0] = 2;
    const struct fmb_body balls = {.dim = 3, .frame_count = 2, .frames = frames};
    struct fmb_body cube = {.dim = 3, .frame_count = 1};
    cube.one = (struct fmb_frame){.dim = 3, .shape = FMB_CUBOID, .count = 3};
    for (int axis = 0; axis < 3; axis++)
        cube.one.component[axis][axis] = 1;
    struct pair pair = {{.body = &cube}, {.body = &balls}, 4};
    assert_int_equal(verdict_of(&pair), FMB_TOUCHING);
    assert_true(accepts(&pair, 0, 4));
    assert_null(rounded_point_fault(&pair, FMB_TOUCHING, (const double[4]){0, 1, 0, 0}));
    pair.b.velocity[0] = 2; /* the right one leaves, the left one arrives at t = 2 */
    assert_int_equal(verdict_of(&pair), FMB_OVERLAPPING);
    assert_true(accepts(&pair, 0, 4));
    assert_false(accepts(&pair, 2, 4));
    pair.b.position[0] = 0.5;
    assert_true(accepts(&pair, 1.75, 4));
    assert_false(accepts(&pair, 1.5, 4));
    assert_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){3, 0.5, 0, 0}));
    assert_non_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){1, 0.5, 0, 0}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_hand),
        cmocka_unit_test(distances_are_those_of_faces),
        cmocka_unit_test(balls_meet_at_roots),
        cmocka_unit_test(gaps_of_what_is_apart),
        cmocka_unit_test(gaps_of_what_overlaps),
        cmocka_unit_test(boxes_contain_what_is_common),
        cmocka_unit_test(points_are_common),
        cmocka_unit_test(bodies_of_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
