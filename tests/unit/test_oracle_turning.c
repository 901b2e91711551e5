/* The oracle of turning bodies, on cases worked out by hand, and on all families with time
 * reversed. build/turning compares it with the static oracle at some times of each window. */

#include "unit.h"

#include "question.h"
#include "trial.h"
#include "turn_family.h"
#include "turning.h"

/* clang-format off */
#define CUBE {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
#define POSED(kind, ...) {.dim = 3, .shape = FMB_##kind, .component = __VA_ARGS__
#define REST(...) , .origin = __VA_ARGS__}
#define FROM(...) , .ending = true, .orientation_count = 4, .origin = __VA_ARGS__
#define QUATERNION(...) , .orientation = __VA_ARGS__
#define TO(...) , .end_origin = __VA_ARGS__
#define TURNED(...) , .end_orientation = __VA_ARGS__}
#define TABLE POSED(BOX, {{9, 0, 0}, {0, 9, 0}, {0, 0, 2}}) REST({0, 0, -1})
/* 4 long and 3 high: its corner is 5/2 from the middle, by 3-4-5. */
#define ROD POSED(BOX, {{4, 0, 0}, {0, 3, 0}, {0, 0, 1}})

struct known {
    const char *what;
    struct question question;
    enum fmb_verdict verdict;
    double contact[2];
};

static const struct known known[] = {
    {"a cube yaws and slides on a table",
     {TABLE, POSED(BOX, CUBE) FROM({0, 0, 0.5}) QUATERNION({1, 0, 0, 0}) TO({1, 0, 0.5}) TURNED({1, 0, 0, 0.5}), 1},
     FMB_TOUCHING, {0, 1}},
    {"a cube a little above the table",
     {TABLE, POSED(BOX, CUBE) FROM({0, 0, 0.5 + 0x1p-40}) QUATERNION({1, 0, 0, 0}) TO({1, 0, 0.5 + 0x1p-40}) TURNED({1, 0, 0, 0.5}), 1},
     FMB_SEPARATED, {0}},
    {"a cube a little below the top of the table",
     {TABLE, POSED(BOX, CUBE) FROM({0, 0, 0.5 - 0x1p-40}) QUATERNION({1, 0, 0, 0}) TO({1, 0, 0.5 - 0x1p-40}) TURNED({1, 0, 0, 0.5}), 1},
     FMB_OVERLAPPING, {0, 1}},
    {"a cube lifts off the table",
     {TABLE, POSED(BOX, CUBE) FROM({0, 0, 0.5}) QUATERNION({1, 0, 0, 0}) TO({0, 0, 0.75}) TURNED({1, 0, 0, -0.5}), 1},
     FMB_TOUCHING, {0, 0}},
    {"a cube lands on the table",
     {TABLE, POSED(BOX, CUBE) FROM({0, 0, 1}) QUATERNION({1, 0, 0, 0.25}) TO({0, 0, 0.5}) TURNED({1, 0, 0, -0.5}), 1},
     FMB_TOUCHING, {1, 1}},
    {"a cube tumbles over an edge that stays on the table",
     {TABLE, POSED(CUBOID, CUBE) FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, -1, 0}), 1},
     FMB_TOUCHING, {0, 1}},
    {"two bodies on one turntable, a quarter turn",
     {POSED(BOX, CUBE) FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}),
      POSED(CUBOID, CUBE), .local = {0.5, 0, 0} FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_TOUCHING, {0, 1}},
    {"a rod grazes a ceiling in passing: its corner is 5 / 2 from the middle",
     {POSED(BOX, {{9, 0, 0}, {0, 1, 0}, {0, 0, 9}}) REST({0, 3, 0}),
      ROD FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_TOUCHING, {0.5, 0.5}},
    {"a rod under a ceiling an ulp lower",
     {POSED(BOX, {{9, 0, 0}, {0, 1, 0}, {0, 0, 9}}) REST({0, 3 - 0x1p-51, 0}),
      ROD FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_OVERLAPPING, {0.5, 0.5}},
    {"a rod under a ceiling an ulp higher",
     {POSED(BOX, {{9, 0, 0}, {0, 1, 0}, {0, 0, 9}}) REST({0, 3 + 0x1p-51, 0}),
      ROD FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_SEPARATED, {0}},
    {"a square rod under a ceiling at half a diagonal, rounded down",
     {POSED(BOX, {{9, 0, 0}, {0, 1, 0}, {0, 0, 9}}) REST({0, 0.5 + 0x1.6a09e667f3bccp-1, 0}),
      POSED(BOX, CUBE) FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_OVERLAPPING, {0.414214, 0.414214}},
    {"a square rod under a ceiling at half a diagonal, rounded up",
     {POSED(BOX, {{9, 0, 0}, {0, 1, 0}, {0, 0, 9}}) REST({0, 0.5 + 0x1.6a09e667f3bcep-1, 0}),
      POSED(BOX, CUBE) FROM({0}) QUATERNION({1, 0, 0, 0}) TO({0}) TURNED({1, 0, 0, 1}), 1},
     FMB_SEPARATED, {0}},
    {"a point passes through a turning plate, at sqrt(416) - 20",
     {POSED(CUBOID, {{1, 0, 0}, {0, 1, 0}}) FROM({0}) QUATERNION({4, 0, 0, 0}) TO({0}) TURNED({4, 1, 0, 0}),
      POSED(CUBOID, {{0}}) REST({0.25, 0.625, 0.125}), 1},
     FMB_OVERLAPPING, {0.396078, 0.396078}},
    {"a point passes beside a turning plate",
     {POSED(CUBOID, {{1, 0, 0}, {0, 1, 0}}) FROM({0}) QUATERNION({4, 0, 0, 0}) TO({0}) TURNED({4, 1, 0, 0}),
      POSED(CUBOID, {{0}}) REST({1.25, 0.625, 0.125}), 1},
     FMB_SEPARATED, {0}},
    {"a point on the edge of a turning plate",
     {POSED(CUBOID, {{1, 0, 0}, {0, 1, 0}}) FROM({0}) QUATERNION({4, 0, 0, 0}) TO({0}) TURNED({4, 1, 0, 0}),
      POSED(CUBOID, {{0}}) REST({1, 0.625, 0.125}), 1},
     FMB_TOUCHING, {0.396078, 0.396078}},
    {"two plates yaw in one plane",
     {POSED(CUBOID, {{1, 0, 0}, {0, 1, 0}}) FROM({0}) QUATERNION({4, 0, 0, 0}) TO({0}) TURNED({4, 0, 0, 1}),
      POSED(CUBOID, {{1, 0, 0}, {0, 1, 0}}) FROM({0.5, 0.5, 0}) QUATERNION({4, 0, 0, 0}) TO({0.5, 0.5, 0}) TURNED({4, 0, 0, -1}), 1},
     FMB_OVERLAPPING, {0, 1}},
    {"two segments cross at their middles, in one instant",
     {POSED(CUBOID, {{2, 0, 0}}), .local = {-1} FROM({0}) QUATERNION({3, 0, 0, 0}) TO({0}) TURNED({3, 0, 0, 1}),
      POSED(CUBOID, {{0, 2, 0}}), .local = {0, -1} FROM({0, 0, 1}) QUATERNION({1, 0, 0, 0}) TO({0, 0, -2}) TURNED({1, 0, 0, 0}), 1},
     FMB_OVERLAPPING, {0.333333, 0.333333}},
    {"in the plane: a segment swings into a square at rest",
     {{.dim = 2, .shape = FMB_CUBOID, .component = {{1, 0}, {0, 1}}, .origin = {1, 1}},
      {.dim = 2, .shape = FMB_CUBOID, .component = {{4, 0}, {0, 0}}, .orientation_count = 2, .orientation = {1, 0},
       .ending = true, .end_orientation = {1, 1}}, 1},
     FMB_OVERLAPPING, {0.236068, 0.618034}},
    {"in the plane: a segment stops at the corner of a square",
     {{.dim = 2, .shape = FMB_CUBOID, .component = {{1, 0}, {0, 1}}, .origin = {4, 3}},
      {.dim = 2, .shape = FMB_CUBOID, .component = {{5, 0}, {0, 0}}, .orientation_count = 2, .orientation = {1, 0},
       .ending = true, .end_orientation = {3, 1}}, 1},
     FMB_TOUCHING, {1, 1}},
};
/* clang-format on */

static void decide(const struct question *question, struct turning_truth *truth)
{
    struct fmb_body body[2];
    struct pair pair;
    question_pair(question, body, &pair);
    turning_init(truth);
    turning_decide(&pair, truth);
}

static bool is_near(const mpq_t time, double expected)
{
    return mpq_get_d(time) > expected - 1e-5 && mpq_get_d(time) < expected + 1e-5;
}

static void known_cases(void **state)
{
    for (size_t i = 0; i < COUNT(known); i++)
        for (int order = 0; order < 2; order++) {
            const struct question swapped = question_swapped(&known[i].question);
            struct turning_truth truth;
            decide(order ? &swapped : &known[i].question, &truth);
            if (truth.least != known[i].verdict || truth.most != known[i].verdict || !truth.whole)
                fail_msg("%s: from %s to %s", known[i].what, fmb_verdict_name(truth.least),
                         fmb_verdict_name(truth.most));
            if (truth.least != FMB_SEPARATED && (!is_near(truth.first[0], known[i].contact[0]) ||
                                                 !is_near(truth.first[1], known[i].contact[0]) ||
                                                 !is_near(truth.last[0], known[i].contact[1]) ||
                                                 !is_near(truth.last[1], known[i].contact[1])))
                fail_msg("%s: contact from %.17g to %.17g", known[i].what,
                         mpq_get_d(truth.first[0]), mpq_get_d(truth.last[1]));
            turning_clear(&truth);
        }
}

static void decide_trial(const struct question *question, struct turning_truth *truth)
{
    struct trial trial;
    trial_begin(question, &trial);
    turning_init(truth);
    turning_decide(&trial.pair[0], truth);
    trial_end(&trial);
}

/* Whether the intervals [p[0], p[1]] and [1 - q[1], 1 - q[0]] intersect. */
static bool is_mirrored(mpq_t p[2], mpq_t q[2])
{
    mpq_t sum[2];
    mpq_inits(sum[0], sum[1], NULL);
    for (int i = 0; i < 2; i++)
        mpq_add(sum[i], p[i], q[i]);
    const bool mirrored = mpq_cmp_ui(sum[0], 1, 1) <= 0 && mpq_cmp_ui(sum[1], 1, 1) >= 0;
    mpq_clears(sum[0], sum[1], NULL);
    return mirrored;
}

static void time_reversed(void **state)
{
    struct draw draw;
    draw_begin(&draw, "time reversed");
    for (size_t f = 0; family_turning_at(f); f++)
        for (long i = draw_sample(8); i > 0; i--) {
            const struct family *family = family_turning_at(f);
            const struct cell cell = {family->cells & FAMILY_3D || i % 2 ? 3 : 2, true, {0}};
            struct question question, back;
            struct turning_truth truth, other;
            family_draw(family, &cell, &draw, &question);
            back = question_reversed(&question);
            decide_trial(&question, &truth);
            decide_trial(&back, &other);
            if (truth.least != other.least || truth.most != other.most ||
                (truth.least != FMB_SEPARATED &&
                 !(is_mirrored(truth.first, other.last) && is_mirrored(truth.last, other.first)))) {
                question_print(&question);
                fail_msg("%s", family->name);
            }
            turning_clear(&truth);
            turning_clear(&other);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_cases),
        cmocka_unit_test(time_reversed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
