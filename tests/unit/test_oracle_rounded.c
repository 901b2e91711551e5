/* The oracle on frames with a radius: cases worked out by hand, closed forms, and distances found
 * in another way. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "gap_check.h"
#include "oracle.h"
#include "question.h"
#include "rounded.h"
#include "rounded_cases.h"
#include "world.h"

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
static void assert_contact(const struct rounded_case *known, const struct pair *pair)
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
    for (size_t i = 0; i < 2 * COUNT(rounded_cases); i++) {
        const struct rounded_case *known = &rounded_cases[i / 2];
        const struct question swapped = question_swapped(&known->question);
        struct posed posed;
        place(i % 2 ? &swapped : &known->question, &posed);
        if (verdict_of(&posed.pair) != known->verdict)
            fail_msg("%s: verdict %d", known->what, verdict_of(&posed.pair));
        if (known->verdict != FMB_SEPARATED)
            assert_contact(known, &posed.pair);
    }
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
        assert_false(holds(&posed.pair, FMB_OVERLAPPING, &pointless));
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
    /* At a vertex no facet has the distance of the cores. */
    const struct question corner = {
        {CUBE, {0}, STILL, .radius = 3}, {BALL, {3, 4, 7}, STILL, .radius = 5}, 1};
    const struct fmb_gap right = {.bounds = {-1 - 0x1p-44, -1 + 0x1p-44},
                                  .direction = {2. / 7, 3. / 7, 6. / 7},
                                  .has_witness = true,
                                  .witness = {{1 + 6. / 7, 1 + 9. / 7, 1 + 18. / 7},
                                              {3 - 10. / 7, 4 - 15. / 7, 7 - 30. / 7}}};
    const struct fmb_gap low = WITH(gap.bounds[0] -= 0x1p-42; gap.bounds[1] -= 0x1p-42);
    const struct fmb_gap high = WITH(gap.bounds[0] += 0x1p-42; gap.bounds[1] += 0x1p-42);
    place(&corner, &posed);
    assert_true(holds(&posed.pair, FMB_OVERLAPPING, &right));
    assert_false(holds(&posed.pair, FMB_OVERLAPPING, &low));
    assert_false(holds(&posed.pair, FMB_OVERLAPPING, &high));

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

    /* A ball that flies through a plate: over their contact only. */
    const struct question through = {
        {3, FMB_BOX, {{0}, {0, 64, 0}, {0, 0, 64}}, {0}, STILL, .radius = 1},
        {BALL, {-10, -10, 0}, {1, 1, 0}, true, .radius = 1},
        20};
    const double over_contact[2][FMB_DIM_MAX] = {{-1, -3, -1}, {1, 3, 1}};
    const double over_window[2][FMB_DIM_MAX] = {{-1, -3, -1}, {1, 11, 1}};
    place(&through, &posed);
    assert_true(accepts(&posed.pair, 8, 12));
    assert_null(rounded_box_fault(&posed.pair, (const double[2]){8, 12}, over_contact));
    assert_non_null(rounded_box_fault(&posed.pair, (const double[2]){8, 12}, over_window));

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

    const struct question beside = {deep.a, {BALL, {6, 0, 0}, STILL, .radius = 2}, 0};
    assert_true(point_holds(&beside, 0, 5 + 5e-12, 0, 0));
    assert_true(point_holds(&beside, 0, 4 - 5e-12, 0, 0));
    assert_false(point_holds(&beside, 0, 5 + 9e-12, 0, 0));

    /* Without radii: plates of which one falls through the other, past its corner. */
    const struct question plates = {
        {3, FMB_FACE, {{3, 0, 0}, {0, 3, 0}}, {0}, STILL},
        {3, FMB_FACE, {{-3, 0, 0}, {0, -3, 0}}, {2, 2, 1}, {0, 0, -0.5}, true},
        4};
    assert_true(point_holds(&plates, 2, 1, 1, 0));
    assert_false(point_holds(&plates, 2, 2, 2, 0));
    assert_false(point_holds(&plates, 2.5, 1, 1, 0));
}

/* A window of four subnormals, in which each double is more than 1e-12 of it: the next one will do,
 * and no other. The contact begins at 4/3 of them. */
static void times_are_as_close_as_doubles(void **state)
{
    const struct question question = {{DISC, {0}, STILL, .radius = 0x1p-1074},
                                      {DISC, {-0x1p-1073, 0}, {0.75, 0}, true},
                                      0x1p-1072};
    struct posed posed;
    place(&question, &posed);
    assert_int_equal(verdict_of(&posed.pair), FMB_OVERLAPPING);
    assert_true(accepts(&posed.pair, 0x1p-1074, 0x1p-1072));
    assert_false(accepts(&posed.pair, 0, 0x1p-1072));
    assert_false(accepts(&posed.pair, 0x1p-1073, 0x1p-1072));
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
    assert_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){3, 0.5, 0, 0}));
    assert_non_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){0, 1, 0, 0}));
    const double box[2][FMB_DIM_MAX] = {{0, 0, 0}, {1, 1, 1}};
    assert_null(rounded_box_fault(&pair, (const double[2]){0, 4}, box));
    pair.b.position[0] = 0.5;
    assert_true(accepts(&pair, 1.75, 4));
    assert_false(accepts(&pair, 1.5, 4));
    assert_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){3, 0.5, 0, 0}));
    assert_non_null(rounded_point_fault(&pair, FMB_OVERLAPPING, (const double[4]){1, 0.5, 0, 0}));

    /* One overlaps the core of the cube; the other, without a radius, only touches it. */
    char why[200];
    frames[0].origin[0] = 0.5;
    frames[1].radius = 0;
    frames[1].origin[0] = 1;
    pair = (struct pair){{.body = &cube}, {.body = &balls}, 1};
    struct fmb_answer answer = {.verdict = FMB_OVERLAPPING,
                                .has_contact = true,
                                .has_box = true,
                                .contact = {0, 1},
                                .box = {{0, 0, 0}, {1, 1, 1}}};
    assert_true(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    answer.box[0][0] = 0x1p-53;
    assert_false(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    /* The ball's centre in the middle of the cube: a gap of -5.5. That of the other frame is 0. */
    for (int axis = 0; axis < 3; axis++)
        frames[0].origin[axis] = 0.5;
    const struct fmb_gap least = {.bounds = {-5.5, -5.5},
                                  .direction = {0, -1, 0},
                                  .has_witness = true,
                                  .witness = {{0.5, 0, 0.5}, {0.5, 5.5, 0.5}}};
    const struct fmb_gap other = {.bounds = {-5.25, -5.25}, .direction = {1, 0, 0}};
    assert_true(holds(&pair, FMB_OVERLAPPING, &least));
    assert_false(holds(&pair, FMB_OVERLAPPING, &other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_hand),
        cmocka_unit_test(gaps_of_what_is_apart),
        cmocka_unit_test(gaps_of_what_overlaps),
        cmocka_unit_test(boxes_contain_what_is_common),
        cmocka_unit_test(points_are_common),
        cmocka_unit_test(times_are_as_close_as_doubles),
        cmocka_unit_test(bodies_of_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
