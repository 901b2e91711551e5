/* Frames of shape hull: how they are made, their box, and the support function of their vertices.
 */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "draw.h"
#include "fmb_batch.h"
#include "support.h"

enum { MANY = FMB_HULL_VERTICES_MAX };

static double memory[3 * MANY + MANY / 2 + 64];

static void hull_refuses(void **state)
{
    static double zeros[3 * MANY + 3];
    struct fmb_frame frame;
    static const double bad[3] = {0, NAN, 0}, infinite[3] = {0, 0, -INFINITY};
    assert_int_equal(fmb_frame_make_hull(1, zeros, 3, memory, &frame), FMB_WRONG_DIMENSION);
    assert_int_equal(fmb_frame_make_hull(4, zeros, 4, memory, &frame), FMB_WRONG_DIMENSION);
    assert_int_equal(fmb_frame_make_hull(3, zeros, 0, memory, &frame), FMB_WRONG_COUNT);
    assert_int_equal(fmb_frame_make_hull(3, zeros, 4, memory, &frame), FMB_WRONG_COUNT);
    assert_int_equal(fmb_frame_make_hull(3, zeros, 3 * MANY + 3, memory, &frame), FMB_OVER_LIMIT);
    assert_int_equal(fmb_frame_make_hull(3, bad, 3, memory, &frame), FMB_NOT_FINITE);
    assert_int_equal(fmb_frame_make_hull(3, infinite, 3, memory, &frame), FMB_NOT_FINITE);
    assert_int_equal(fmb_frame_make_hull(3, zeros, 3 * MANY, memory, &frame), FMB_OK);
    assert_int_equal(frame.vertex_count, 1);
    assert_int_equal(fmb_hull_doubles(3, 0), 0);
    assert_int_equal(fmb_hull_doubles(1, 5), 0);
    assert_int_equal(fmb_hull_doubles(3, MANY + 1), 0);
    assert_true(fmb_hull_doubles(3, MANY) <= COUNT(memory));
}

static void hull_keeps_the_first_of_equal_vertices(void **state)
{
    static const double vertices[] = {1, 2, 3, 0, 0, 0, 1, 2, 3, -0.0, 0, -0.0, 5, 6, 7, 1, 2, 3};
    static const double distinct[] = {1, 2, 3, 0, 0, 0, 5, 6, 7};
    struct fmb_frame frame;
    bool by_vertices = false;
    double numbers[9];
    assert_int_equal(fmb_frame_make_hull(3, vertices, COUNT(vertices), memory, &frame), FMB_OK);
    assert_int_equal(frame.vertex_count, 3);
    assert_int_equal(fmb_frame_numbers(&frame, &by_vertices, NULL, 0), 9);
    assert_int_equal(fmb_frame_numbers(&frame, &by_vertices, numbers, COUNT(numbers)), 9);
    assert_true(by_vertices);
    for (int i = 0; i < 9; i++)
        assert_true(numbers[i] == distinct[i] && !signbit(numbers[i]));
}

static void hull_writes_only_into_its_memory(void **state)
{
    for (int dim = 2; dim <= 3; dim++)
        for (size_t count = 1; count < 40; count++) {
            double vertices[3 * 40], own[3 * 48 + 32];
            struct fmb_frame frame;
            const size_t doubles = fmb_hull_doubles(dim, count);
            for (size_t i = 0; i < count * (size_t) dim; i++)
                vertices[i] = (double) (i % 7);
            for (size_t i = 0; i < COUNT(own); i++)
                own[i] = 42;
            assert_true(doubles < COUNT(own));
            assert_int_equal(fmb_frame_make_hull(dim, vertices, count * (size_t) dim, own, &frame),
                             FMB_OK);
            for (size_t i = doubles; i < COUNT(own); i++)
                assert_true(own[i] == 42);
        }
}

/* Returns the value of vertex i as support_max() computes it. */
static double value_of(const struct fmb_frame *frame, const double n[3], unsigned i)
{
    const double *v = frame->vertices + i;
    const double plane = n[0] * v[0] + n[1] * v[frame->vertex_stride];
    return frame->dim == 2 ? plane : plane + n[2] * v[2 * frame->vertex_stride];
}

static void support_is_the_first_of_the_greatest(void **state)
{
    struct draw draw;
    draw_begin(&draw, "support");
    for (int turn = 0; turn < 3000; turn++) {
        const int dim = 2 + turn % 2;
        const size_t count = 1 + (size_t) turn % 60;
        double vertices[3 * 60], n[3];
        struct fmb_frame frame;
        for (size_t i = 0; i < 3 * count; i++)
            vertices[i] = turn % 3 ? draw_int(&draw, 0, 3) : draw_log(&draw, -10, 10);
        for (int i = 0; i < 3; i++)
            n[i] = turn % 3 == 1 ? draw_int(&draw, -1, 1) : draw_uniform(&draw, -1, 1);
        assert_int_equal(fmb_frame_make_hull(dim, vertices, count * (size_t) dim, memory, &frame),
                         FMB_OK);
        const struct support_vertices all = hull_frame_vertices(&frame);
        const struct support support = support_max(&all, n);
        unsigned best = 0;
        for (unsigned i = 1; i < frame.vertex_count; i++)
            if (value_of(&frame, n, i) > value_of(&frame, n, best))
                best = i;
        assert_int_equal(support.index, best);
        assert_true(support.value == value_of(&frame, n, best));
    }
}

/* out := R(q) v in long double, by the formula of fmb.h. In 2D q is (w, z). */
static void turn(const double *q, int dim, const double *v, long double out[3])
{
    const long double w = q[0], x = dim == 3 ? q[1] : 0, y = dim == 3 ? q[2] : 0;
    const long double z = dim == 3 ? q[3] : q[1], norm = w * w + x * x + y * y + z * z;
    const long double r[3][3] = {
        {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    for (int axis = 0; axis < 3; axis++) {
        out[axis] = 0;
        for (int i = 0; i < dim; i++)
            out[axis] += r[axis][i] / norm * v[i];
    }
}

/* Vertices, flat hulls among them, and placements of very different sizes. */
static void box_holds_each_placed_vertex(void **state)
{
    struct draw draw;
    draw_begin(&draw, "boxes");
    for (int trial = 0; trial < 4000; trial++) {
        const int dim = 2 + trial % 2, span = trial % 5 == 4 ? 1023 : 15;
        const size_t count = 1 + (size_t) trial % 20;
        double vertices[3 * 20], largest = 0;
        struct fmb_body body;
        for (size_t i = 0; i < 3 * count; i++)
            vertices[i] = trial % 7 == 6 && i % (size_t) dim == 1 ? 1
                          : trial % 13 == 12 ? (draw_coin(&draw) ? DBL_MAX : -DBL_MAX)
                                             : draw_log(&draw, -span, span);
        assert_int_equal(fmb_body_make_hull(dim, vertices, count * (size_t) dim, memory, &body),
                         FMB_OK);
        struct fmb_placement placement = {.body = &body, .orientation = {1}};
        placement.orientation_count = trial % 3 ? dim == 3 ? 4 : 2 : 0;
        if (!placement.orientation_count)
            placement.orientation[0] = 0;
        for (int i = 0; i < placement.orientation_count; i++)
            placement.orientation[i] = draw_log(&draw, -20, trial % 11 ? 0 : -18);
        for (int axis = 0; axis < dim; axis++)
            placement.position[axis] = draw_log(&draw, -15, 15);
        struct fmb_prepared prepared;
        double box[2][3];
        const double none[4] = {1};
        const double *q = placement.orientation_count ? placement.orientation : none;
        assert_int_equal(fmb_prepare(&placement, 0, 1, &prepared), FMB_OK);
        fmb_box_of(&prepared, 0, box);
        for (size_t i = 0; i < count * (size_t) dim; i++)
            largest = fmax(largest, fabs(vertices[i]));
        for (size_t i = 0; i < count; i++) {
            const double *v = vertices + i * (size_t) dim;
            long double turned[3];
            turn(q, dim, v, turned);
            for (int axis = 0; axis < dim; axis++) {
                /* What long double may lose, which is less than what the box is expanded by. */
                const long double error = placement.orientation_count ? 0x1p-60L * largest : 0;
                const long double x = placement.position[axis] + turned[axis];
                assert_true(body.box[0][axis] <= v[axis] && v[axis] <= body.box[1][axis]);
                assert_true(box[0][axis] <= x + error && x - error <= box[1][axis]);
            }
        }
    }
}

/* Small numbers: nothing rounds. A quarter turn about z maps (x, y) to (-y, x). */
static void box_of_small_numbers_is_exact(void **state)
{
    static const double vertices[] = {0, 0, 0, 3, 1, -2, 1, 5, 4};
    struct fmb_body body;
    assert_int_equal(fmb_body_make_hull(3, vertices, 9, memory, &body), FMB_OK);
    static const double want[2][3] = {{10 - 5, 20, 28}, {10, 23, 34}};
    const struct fmb_placement placement = {.body = &body,
                                            .position = {10, 20, 30},
                                            .orientation = {1, 0, 0, 1},
                                            .orientation_count = 4};
    struct fmb_prepared prepared;
    double box[2][3];
    assert_int_equal(fmb_prepare(&placement, 0, 1, &prepared), FMB_OK);
    fmb_box_of(&prepared, 0, box);
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++)
            assert_true(box[end][axis] == want[end][axis]);
}

static void flat_unless_surely_solid(void **state)
{
    static const double solid[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1e-9};
    static const double plane[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    static const double segment[] = {0, 0, 1, 1, 2, 2};
    const double m = DBL_MAX; /* differences overflow */
    const double huge[] = {m, 0, 0, -m, 0, 0, 0, m, 0, 0, 0, m};
    const double huge_plane[] = {m, 0.25, 0, -m, -0.25, 0, 0, 0, 1, 0, 0, -1};
    const double huge_segment[] = {m, 0.25, -m, -0.25, 0, 0};
    struct fmb_frame frame;
    fmb_frame_make_hull(3, solid, COUNT(solid), memory, &frame);
    assert_false(frame.flat);
    fmb_frame_make_hull(3, plane, COUNT(plane), memory, &frame);
    assert_true(frame.flat);
    fmb_frame_make_hull(2, segment, COUNT(segment), memory, &frame);
    assert_true(frame.flat);
    fmb_frame_make_hull(3, huge_plane, COUNT(huge_plane), memory, &frame);
    assert_true(frame.flat);
    fmb_frame_make_hull(2, huge_segment, COUNT(huge_segment), memory, &frame);
    assert_true(frame.flat);
    fmb_frame_make_hull(3, huge, COUNT(huge), memory, &frame);
    assert_false(frame.flat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hull_refuses),
        cmocka_unit_test(hull_keeps_the_first_of_equal_vertices),
        cmocka_unit_test(hull_writes_only_into_its_memory),
        cmocka_unit_test(support_is_the_first_of_the_greatest),
        cmocka_unit_test(box_holds_each_placed_vertex),
        cmocka_unit_test(box_of_small_numbers_is_exact),
        cmocka_unit_test(flat_unless_surely_solid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
