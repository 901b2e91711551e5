/* The exact method against the oracle in a small world, where nearly everything touches: all
 * numbers are small integers, and every degenerate case comes up.
 *
 * In the plane all pairs are decided, one of each class under the symmetries of the square and the
 * order of the pair (test_engine_metamorphic.c tests these). In space there are
 * too many (of cuboids: 19,683 bodies at 64 places): a seeded sample is decided, whose size is
 * printed. FMB_SAMPLE=10 draws ten times as many; FMB_FAST=1 draws an eighth, and of the plane
 * takes one pair in 61. */

#include "unit.h"

#include "draw.h"
#include "oracle.h"
#include "question.h"
#include "referee.h"

/* ---- The plane, all of it ---- */

enum {
    VECTORS = 9,                         /* (x, y), each -1, 0 or 1 */
    SHAPES = 2,                          /* cuboid, tetrahedron */
    BODIES = VECTORS * VECTORS * SHAPES, /* by two vectors in either order */
    SYMMETRIES = 8                       /* of the square */
};

static void set_vector(int number, double vector[FMB_DIM_MAX])
{
    vector[0] = number % 3 - 1;
    vector[1] = number / 3 - 1;
    vector[2] = 0;
}

/* A shape and two vectors. */
static struct solid plane_body(int number)
{
    struct solid solid = {.dim = 2, .shape = number % SHAPES ? FMB_CUBOID : FMB_TETRAHEDRON};
    set_vector(number / SHAPES % VECTORS, solid.component[0]);
    set_vector(number / SHAPES / VECTORS, solid.component[1]);
    return solid;
}

/* The number of a vector after a symmetry: exchanged axes, then each axis reflected or not. */
static int moved_vector(int number, int symmetry)
{
    int x = number % 3, y = number / 3;
    if (symmetry & 1) {
        const int kept = x;
        x = y;
        y = kept;
    }
    return (symmetry & 2 ? 2 - x : x) + 3 * (symmetry & 4 ? 2 - y : y);
}

/* The least number of a body that differs by a symmetry, or by the order of its vectors. */
static int class_of(int number)
{
    int least = number;
    for (int symmetry = 0; symmetry < SYMMETRIES; symmetry++) {
        const int first = moved_vector(number / SHAPES % VECTORS, symmetry);
        const int second = moved_vector(number / SHAPES / VECTORS, symmetry);
        const int low = first < second ? first : second, high = first + second - low;
        const int moved = (low * VECTORS + high) * SHAPES + number % SHAPES;
        least = moved < least ? moved : least;
    }
    return least;
}

static struct solid with_vectors_exchanged(const struct solid *solid)
{
    struct solid other = *solid;
    memcpy(other.component[0], solid->component[1], sizeof other.component[0]);
    memcpy(other.component[1], solid->component[0], sizeof other.component[1]);
    return other;
}

/* A frame is the same set of points in every order of its components (its definition is symmetric
 * in the terms x_i c_i), and the truth does not depend on the order of the pair. So one call of the
 * oracle serves four questions to the engine: both orders of the vectors of A and of those of B,
 * each with one order of the pair. */
static void assert_all_orders(const struct question *question, const struct oracle_answer *truth)
{
    for (int order = 0; order < 4; order++) {
        struct question other = *question;
        if (order & 1)
            other.a = with_vectors_exchanged(&other.a);
        if (order & 2)
            other.b = with_vectors_exchanged(&other.b);
        if (order == 1 || order == 2)
            other = question_swapped(&other);
        referee_assert_truth(&other, truth);
    }
}

static void assert_bodies_everywhere(int number_a, int number_b, long count[4])
{
    struct question question = {plane_body(number_a), plane_body(number_b), 1};
    struct oracle_answer truth;
    oracle_init(&truth);
    for (int place = 0; place < 25; place++) {
        struct fmb_body body[2];
        struct pair pair;
        question.b.origin[0] = place % 5 - 2;
        question.b.origin[1] = place / 5 - 2;
        question_pair(&question, body, &pair);
        oracle_decide(&pair, FMB_WANT_BOX, &truth);
        assert_all_orders(&question, &truth);
        count[truth.verdict]++;
    }
    oracle_clear(&truth);
}

static void print_count(const char *what, const long count[4])
{
    printf("# %s: %ld separated, %ld touching, %ld overlapping\n", what, count[FMB_SEPARATED],
           count[FMB_TOUCHING], count[FMB_OVERLAPPING]);
    fflush(stdout);
}

static void all_of_the_plane(void **state)
{
    const int step = draw_step(61);
    long count[4] = {0};
    int turn = 0;
    for (int a = 0; a < BODIES; a++)
        for (int b = 0; class_of(a) == a && b < BODIES; b++)
            if (b / SHAPES / VECTORS <= b / SHAPES % VECTORS && class_of(b) >= a &&
                turn++ % step == 0)
                assert_bodies_everywhere(a, b, count);
    print_count("plane, static, each in 4 orders of vectors", count);
    assert_true(count[FMB_SEPARATED] && count[FMB_TOUCHING] && count[FMB_OVERLAPPING]);
}

/* ---- Samples ---- */

static struct solid draw_body(struct draw *draw, int dim)
{
    struct solid solid = {.dim = dim};
    solid.shape =
        (enum fmb_shape) draw_int(draw, FMB_CUBOID, dim == 3 ? FMB_FACE : FMB_TETRAHEDRON);
    for (int i = 0; i < solid_count(&solid); i++)
        draw_integers(draw, dim, -1, 1, solid.component[i]);
    return solid;
}

/* The unit cuboid, or tetrahedron, of space. */
static struct solid unit_body(struct draw *draw)
{
    return (struct solid){.dim = 3,
                          .shape = draw_coin(draw) ? FMB_CUBOID : FMB_TETRAHEDRON,
                          .component = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* Velocities for both, or one of them, and a window. */
static void draw_motion(struct draw *draw, struct question *question)
{
    static const double durations[] = {0, 0.5, 1, 3};
    const int dim = question->a.dim, who = draw_int(draw, 1, 3);
    question->a.moving = who & 1;
    question->b.moving = who & 2;
    if (question->a.moving)
        draw_integers(draw, dim, -1, 2, question->a.velocity);
    if (question->b.moving)
        draw_integers(draw, dim, -1, 2, question->b.velocity);
    question->duration = durations[draw_int(draw, 0, 3)];
}

static void assert_sample(const char *what, int dim, bool moving, long size)
{
    struct draw draw;
    long count[4] = {0};
    draw_begin(&draw, what);
    for (long n = 0; n < size; n++) {
        struct question question = {.duration = 1};
        question.a = dim == 2 ? draw_body(&draw, 2) : unit_body(&draw);
        question.b = draw_body(&draw, dim);
        draw_integers(&draw, dim, -1, 2, question.b.origin);
        if (moving)
            draw_motion(&draw, &question);
        count[referee_assert(&question)]++;
    }
    print_count(what, count);
}

static void plane_moving(void **state)
{
    assert_sample("plane, moving, a sample of pairs", 2, true, draw_sample(8000));
}

static void space_static(void **state)
{
    assert_sample("space, static, a sample of pairs", 3, false, draw_sample(14000));
}

static void space_moving(void **state)
{
    assert_sample("space, moving, a sample of pairs", 3, true, draw_sample(14000));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_the_plane),
        cmocka_unit_test(plane_moving),
        cmocka_unit_test(space_static),
        cmocka_unit_test(space_moving),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
