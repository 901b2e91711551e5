/* The methods fmb and sat: right on ordinary pairs, honest about flat ones and about overflow,
 * harmless on any input. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "draw.h"
#include "pair_draw.h"
#include "question.h"
#include "referee.h"

static const char *const inexact[] = {"fmb", "sat"};

static enum fmb_status decide(const char *method, const struct pair *pair,
                              struct fmb_answer *answer)
{
    memset(answer, 0xa5, sizeof *answer);
    return pair_decide(fmb_method_by_name(method), pair, FMB_WANT_BOX, answer);
}

/* ---- Ordinary pairs ---- */

enum { SIZE = 100 }; /* numbers are drawn from [-SIZE, SIZE] */

static double determinant(const struct solid *solid)
{
    const double(*c)[3] = solid->component;
    if (solid->dim == 2)
        return c[0][0] * c[1][1] - c[0][1] * c[1][0];
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        sum += c[0][i] * (c[1][j] * c[2][k] - c[1][k] * c[2][j]);
    }
    return sum;
}

static void draw_vector(struct draw *draw, int dim, double *vector)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = draw_uniform(draw, -SIZE, SIZE);
}

static struct solid draw_ordinary(struct draw *draw, int dim, enum fmb_shape shape, bool moving)
{
    struct solid solid = {.dim = dim, .shape = shape, .moving = moving};
    do {
        for (int i = 0; i < dim; i++)
            draw_vector(draw, dim, solid.component[i]);
    } while (fabs(determinant(&solid)) < 0.1);
    draw_vector(draw, dim, solid.origin);
    draw_vector(draw, dim, solid.velocity);
    return solid;
}

/* Kind 0 to 15: dimension, the two shapes, motion. */
static struct question draw_ordinary_pair(struct draw *draw, int kind)
{
    const int dim = kind & 1 ? 3 : 2;
    const enum fmb_shape a = kind & 2 ? FMB_CUBOID : FMB_TETRAHEDRON;
    const enum fmb_shape b = kind & 4 ? FMB_CUBOID : FMB_TETRAHEDRON;
    const bool moving = kind & 8;
    struct question question = {draw_ordinary(draw, dim, a, moving && draw_coin(draw)),
                                draw_ordinary(draw, dim, b, moving),
                                draw_coin(draw) ? 1 : draw_uniform(draw, 0.1, 5)};
    return question;
}

static void assert_contact_near(const struct question *question, const struct fmb_answer *exact,
                                const struct fmb_answer *found)
{
    if (found->has_contact != exact->has_contact)
        referee_fail(question, "an interval just where the exact method has one");
    for (int end = 0; exact->has_contact && end < 2; end++)
        if (!(fabs(found->contact[end] - exact->contact[end]) <= 1e-6 * question->duration))
            referee_fail(question, "interval far from the exact one");
}

/* Loose on the outside, by design; but 1e-9 of the size of the pair is all it may miss inside. */
static void assert_box_contains(const struct question *question, const struct fmb_answer *exact,
                                const struct fmb_answer *found)
{
    const double slack = 1e-9 * SIZE;
    if (found->has_box != exact->has_box)
        referee_fail(question, "a box just where the exact method has one");
    for (int axis = 0; exact->has_box && axis < question->a.dim; axis++)
        if (!(found->box[0][axis] <= exact->box[0][axis] + slack &&
              found->box[1][axis] >= exact->box[1][axis] - slack))
            referee_fail(question, "the box misses some of the exact one");
}

static void agree_on_ordinary_pairs(void **state)
{
    struct draw draw;
    long count[4] = {0};
    draw_begin(&draw, "agree_on_ordinary_pairs");
    for (long n = draw_sample(16000); n > 0; n--) {
        struct question question = draw_ordinary_pair(&draw, (int) (n % 16));
        struct fmb_answer exact, found;
        struct ready ready;
        referee_decide(&question, &exact);
        referee_ready(&question, &ready);
        for (size_t i = 0; i < COUNT(inexact); i++) {
            if (decide(inexact[i], &ready.pair, &found) != FMB_OK)
                referee_fail(&question, "refused");
            if (found.verdict != exact.verdict)
                referee_fail(&question, "another verdict");
            assert_contact_near(&question, &exact, &found);
            if (strcmp(inexact[i], "fmb") == 0)
                assert_box_contains(&question, &exact, &found);
            if (strcmp(inexact[i], "sat") == 0 && found.has_box)
                referee_fail(&question, "sat has no box");
        }
        count[exact.verdict]++;
    }
    printf("# ordinary pairs: %ld separated, %ld touching, %ld overlapping\n", count[FMB_SEPARATED],
           count[FMB_TOUCHING], count[FMB_OVERLAPPING]);
    assert_true(count[FMB_SEPARATED] && count[FMB_OVERLAPPING]);
}

/* ---- What the article gets wrong: 'no intersection' where bounds meet ---- */

static void unit_cubes_that_share_a_face_touch(void **state)
{
    const struct solid cube = {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, {0}, false};
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            struct question question = {cube, cube, 1};
            struct fmb_answer exact, found;
            struct ready ready;
            question.b.origin[axis] = sign;
            referee_decide(&question, &exact);
            referee_ready(&question, &ready);
            assert_int_equal(exact.verdict, FMB_TOUCHING);
            assert_int_equal(decide("fmb", &ready.pair, &found), FMB_OK);
            assert_int_equal(found.verdict, FMB_TOUCHING);
            assert_box_contains(&question, &exact, &found);
        }
}

/* ---- Edges that are parallel but for rounding ---- */

/* The normal of such a pair of edges is all rounding error: it is no axis to be separated on. */
static void what_overlaps_deeply_overlaps(void **state)
{
    struct draw draw;
    draw_begin(&draw, "what_overlaps_deeply_overlaps");
    for (long n = draw_sample(10000); n > 0; n--) {
        const double size[3] = {draw_uniform(&draw, 1, 2), draw_uniform(&draw, 1, 2),
                                draw_uniform(&draw, 1, 2)};
        struct solid box = {3, FMB_BOX, .orientation_count = 4, .moving = false};
        for (int i = 0; i < 3; i++)
            box.component[i][i] = size[i];
        for (int i = 0; i < 4; i++)
            box.orientation[i] = draw_uniform(&draw, -1, 1);
        struct question question = {box, box, 1};
        for (int i = 0; i < 4; i++)
            question.b.orientation[i] *= 1 + draw_int(&draw, -2, 2) * 0x1p-52;
        for (int axis = 0; axis < 3; axis++)
            question.b.origin[axis] = draw_uniform(&draw, -0.1, 0.1);
        question.b.moving = draw_coin(&draw);
        for (int axis = 0; axis < 3; axis++)
            question.b.velocity[axis] = draw_uniform(&draw, -0.1, 0.1);
        for (size_t i = 0; i < COUNT(inexact); i++) {
            struct fmb_answer found;
            struct ready ready;
            referee_ready(&question, &ready);
            if (decide(inexact[i], &ready.pair, &found) != FMB_OK)
                referee_fail(&question, "refused");
            if (found.verdict != FMB_OVERLAPPING)
                referee_fail(&question, "another verdict");
        }
    }
}

/* ---- Flat frames ---- */

static void say_so_of_flat_frames(void **state)
{
    const struct solid solid[2] = {
        {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, {0}, false},
        {3, FMB_TETRAHEDRON, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, {0}, true},
    };
    const struct solid flat[] = {
        {2, FMB_CUBOID, {{1, 2}, {2, 4}}, {0}, {0}, false},
        {2, FMB_TETRAHEDRON, {{0}}, {0}, {0}, true},
        {3, FMB_FACE, {{1, 0, 0}, {0, 1, 0}}, {0}, {0}, false},
        {3, FMB_CUBOID, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {0}, {0}, true},
        {3, FMB_TETRAHEDRON, {{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}, {9, 9, 9}, {0}, false},
    };
    for (size_t i = 0; i < COUNT(flat); i++) {
        const struct question question = {flat[i], solid[flat[i].dim - 2], 1};
        const struct question swapped = question_swapped(&question);
        const struct question both = {flat[i], flat[i], 1};
        const struct question *questions[] = {&question, &swapped, &both};
        for (size_t q = 0; q < COUNT(questions); q++) {
            struct ready ready;
            struct fmb_answer answer;
            referee_ready(questions[q], &ready);
            for (size_t m = 0; m < COUNT(inexact); m++)
                assert_int_equal(decide(inexact[m], &ready.pair, &answer), FMB_CANNOT_DECIDE);
        }
    }
}

/* ---- Any input ---- */

static double any_number(struct draw *draw)
{
    switch (draw_int(draw, 0, 5)) {
    case 0: return draw_int(draw, -2, 2);
    case 1: return draw_int(draw, -3, 3) * 0x1p-1074;
    case 2: return draw_uniform(draw, -1, 1) * DBL_MAX;
    case 3: return draw_log(draw, -600, 600);
    default: return draw_finite(draw);
    }
}

static struct solid draw_any_solid(struct draw *draw, int dim)
{
    struct solid solid = {.dim = dim, .moving = draw_coin(draw)};
    solid.shape = (enum fmb_shape) draw_int(draw, FMB_CUBOID, FMB_TETRAHEDRON);
    for (int axis = 0; axis < dim; axis++) {
        solid.origin[axis] = any_number(draw);
        solid.velocity[axis] = any_number(draw);
        for (int i = 0; i < dim; i++)
            solid.component[i][axis] = any_number(draw);
    }
    return solid;
}

/* Its numbers may be wrong, but they are numbers, and the interval is in the window. */
static void assert_sane(const struct question *question, const struct fmb_answer *answer)
{
    if (!fmb_verdict_name(answer->verdict))
        referee_fail(question, "no verdict");
    if (answer->has_contact != (answer->verdict != FMB_SEPARATED))
        referee_fail(question, "an interval without contact, or none with it");
    const double *contact = answer->contact;
    if (answer->has_contact &&
        !(0 <= contact[0] && contact[0] <= contact[1] && contact[1] <= question->duration))
        referee_fail(question, "interval out of the window");
    for (int axis = 0; answer->has_box && axis < FMB_DIM_MAX; axis++)
        if (!(answer->box[0][axis] <= answer->box[1][axis]))
            referee_fail(question, "a box that is no box");
}

/* Numbers that over- or underflow on the way are not to be taken for an answer: bodies ten sizes
 * apart are separated at any size, or the method reports that it cannot decide. */
static void say_so_of_numbers_out_of_range(void **state)
{
    const double sizes[] = {1, 1e50, 1e-50, 1e110, 1e-110, 1e200, 1e-200, 1e306, 1e-300, 5e-324};
    for (size_t s = 0; s < COUNT(sizes); s++)
        for (int shape = FMB_CUBOID; shape <= FMB_TETRAHEDRON; shape++)
            for (size_t i = 0; i < COUNT(inexact); i++) {
                struct question question = {.a = {.dim = 3, .shape = (enum fmb_shape) shape}};
                for (int k = 0; k < 3; k++)
                    question.a.component[k][k] = sizes[s];
                question.b = question.a;
                question.b.origin[0] = 10 * sizes[s];
                struct ready ready;
                struct fmb_answer answer;
                referee_ready(&question, &ready);
                enum fmb_status status = decide(inexact[i], &ready.pair, &answer);
                if (fabs(log10(sizes[s])) < 60)
                    assert_int_equal(status, FMB_OK);
                if (status != FMB_CANNOT_DECIDE)
                    assert_int_equal(answer.verdict, FMB_SEPARATED);
            }
}

/* Rows of b's x are so small, and of its y so large, that their combinations are infinite; without
 * these nothing separates the pair. */
static void say_so_of_rows_that_overflow(void **state)
{
    const struct question question = {
        {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, {0}, false},
        {2, FMB_CUBOID, {{1e-200, 0}, {1e200, 1e200}}, {-5e199, -4e199}, {0}, false},
        1};
    struct fmb_answer exact;
    referee_decide(&question, &exact);
    assert_int_equal(exact.verdict, FMB_SEPARATED);
    for (size_t i = 0; i < COUNT(inexact); i++) {
        struct ready ready;
        struct fmb_answer answer;
        referee_ready(&question, &ready);
        assert_int_equal(pair_decide(fmb_method_by_name(inexact[i]), &ready.pair, 0, &answer),
                         FMB_CANNOT_DECIDE);
    }
}

/* Both go beyond the largest double, side by side: 0 times infinity is on the way to their box. */
static void say_so_of_boxes_that_overflow(void **state)
{
    const struct solid square = {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, {1.5e308, 0}, true};
    const struct question question = {square, square, 2};
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(&question, &ready);
    assert_int_equal(decide("fmb", &ready.pair, &answer), FMB_CANNOT_DECIDE);
}

/* In: a pair of frames that may be flat. Returns whether a method decided it. */
static bool harmless(const struct question *question, const char *method)
{
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    const enum fmb_status status = decide(method, &ready.pair, &answer);
    if (status == FMB_CANNOT_DECIDE) {
        const struct fmb_answer nothing = {.has_box = false};
        assert_memory_equal(&answer, &nothing, sizeof answer);
        return false;
    }
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
    assert_sane(question, &answer);
    return true;
}

static void harmless_on_any_input(void **state)
{
    struct draw draw;
    draw_begin(&draw, "harmless_on_any_input");
    long decided = 0;
    for (long n = draw_sample(60000); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3);
        const struct question question = {draw_any_solid(&draw, dim), draw_any_solid(&draw, dim),
                                          fabs(any_number(&draw))};
        for (size_t i = 0; i < COUNT(inexact); i++)
            decided += harmless(&question, inexact[i]);
    }
    printf("# any input: %ld answers\n", decided);
    assert_true(decided > 0);
}

/* Rounding may leave nothing between the bounds of what touches. */
static void harmless_on_hard_pairs(void **state)
{
    struct draw draw;
    draw_begin(&draw, "harmless_on_hard_pairs");
    long decided = 0;
    for (long n = draw_sample(20000); n > 0; n--) {
        const struct cell cell = pair_draw_cell(&draw);
        struct question question;
        pair_draw(&draw, &cell, &question);
        for (size_t i = 0; i < COUNT(inexact); i++)
            decided += harmless(&question, inexact[i]);
    }
    printf("# hard pairs: %ld answers\n", decided);
    assert_true(decided > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agree_on_ordinary_pairs),
        cmocka_unit_test(unit_cubes_that_share_a_face_touch),
        cmocka_unit_test(what_overlaps_deeply_overlaps),
        cmocka_unit_test(say_so_of_flat_frames),
        cmocka_unit_test(say_so_of_numbers_out_of_range),
        cmocka_unit_test(say_so_of_rows_that_overflow),
        cmocka_unit_test(say_so_of_boxes_that_overflow),
        cmocka_unit_test(harmless_on_any_input),
        cmocka_unit_test(harmless_on_hard_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
