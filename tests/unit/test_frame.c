/* What goes into the engine (frames from components, pairs) and its tables. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <math.h>

#include "draw.h"
#include "fmb.h"
#include "frame_make.h"
#include "placed_pair.h"

/* ---- Frames ---- */

static void frame_holds_what_it_was_given(void **state)
{
    static const double number[6] = {1, 2, 3, 4, 5, 7};
    struct fmb_frame plane = make(2, FMB_TETRAHEDRON, number), face = make(3, FMB_FACE, number);
    assert_int_equal(plane.dim, 2);
    assert_int_equal(plane.shape, FMB_TETRAHEDRON);
    assert_int_equal(plane.count, 2);
    assert_false(plane.flat);
    assert_int_equal(face.dim, 3);
    assert_int_equal(face.shape, FMB_FACE);
    assert_int_equal(face.count, 2);
    static const double in_plane[3][3] = {{1, 2, 0}, {3, 4, 0}, {0, 0, 0}};
    static const double in_space[3][3] = {{1, 2, 3}, {4, 5, 7}, {0, 0, 0}};
    assert_memory_equal(plane.component, in_plane, sizeof in_plane);
    assert_memory_equal(face.component, in_space, sizeof in_space);
}

static void frame_refuses(void **state)
{
    static const struct {
        int dim, shape;
        size_t count;
        enum fmb_status status;
    } cases[] = {
        {3, 0, 9, FMB_UNKNOWN_SHAPE},
        {3, 6, 9, FMB_UNKNOWN_SHAPE},
        {3, FMB_HULL, 9, FMB_NOT_SUPPORTED},
        {2, -1, 4, FMB_UNKNOWN_SHAPE},
        {1, FMB_CUBOID, 1, FMB_WRONG_DIMENSION},
        {4, FMB_CUBOID, 9, FMB_WRONG_DIMENSION},
        {0, FMB_TETRAHEDRON, 0, FMB_WRONG_DIMENSION},
        {-3, FMB_CUBOID, 9, FMB_WRONG_DIMENSION},
        {2, FMB_FACE, 4, FMB_WRONG_DIMENSION},
        {3, FMB_CUBOID, 8, FMB_WRONG_COUNT},
        {3, FMB_CUBOID, 6, FMB_WRONG_COUNT},
        {3, FMB_TETRAHEDRON, 10, FMB_WRONG_COUNT},
        {2, FMB_CUBOID, 9, FMB_WRONG_COUNT},
        {3, FMB_FACE, 8, FMB_WRONG_COUNT},
        {3, FMB_FACE, 12, FMB_WRONG_COUNT},
        {3, FMB_CUBOID, 15, FMB_WRONG_COUNT},
        {1, FMB_BOX, 2, FMB_WRONG_DIMENSION},
        {3, FMB_BOX, 0, FMB_WRONG_COUNT},
        {3, FMB_BOX, 2, FMB_WRONG_COUNT},
        {3, FMB_BOX, 4, FMB_WRONG_COUNT},
        {3, FMB_BOX, 9, FMB_WRONG_COUNT},
        {2, FMB_BOX, 3, FMB_WRONG_COUNT},
        {2, FMB_CUBOID, SIZE_MAX, FMB_WRONG_COUNT},
    };
    struct fmb_frame frame;
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_int_equal(
            fmb_frame_make(cases[i].dim, cases[i].shape, unit3, cases[i].count, &frame),
            cases[i].status);
    assert_int_equal(fmb_frame_make(3, FMB_CUBOID, NULL, 0, &frame), FMB_WRONG_COUNT);
}

static void frame_refuses_each_number_that_is_not_finite(void **state)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    static const struct {
        int dim, shape;
        size_t count;
    } forms[] = {{3, FMB_CUBOID, 9}, {3, FMB_CUBOID, 12}, {3, FMB_FACE, 6}, {3, FMB_FACE, 9},
                 {2, FMB_CUBOID, 4}, {2, FMB_CUBOID, 6},  {3, FMB_BOX, 3},  {3, FMB_BOX, 6},
                 {2, FMB_BOX, 2},    {2, FMB_BOX, 4}};
    struct fmb_frame frame;
    for (size_t i = 0; i < COUNT(bad); i++)
        for (int at = 0; at < 12; at++) {
            double number[12];
            memcpy(number, unit3, sizeof number);
            number[at] = bad[i];
            for (size_t k = 0; k < COUNT(forms); k++)
                if ((size_t) at < forms[k].count)
                    assert_int_equal(fmb_frame_make(forms[k].dim, forms[k].shape, number,
                                                    forms[k].count, &frame),
                                     FMB_NOT_FINITE);
        }
}

/* ---- Flatness ---- */

/* The sign of a product of `count` doubles, added with sign to the sum. */
static void add_product(mpq_t sum, int sign, const double *factor, int count)
{
    mpq_t product, one;
    mpq_inits(product, one, NULL);
    mpq_set_si(product, sign, 1);
    for (int i = 0; i < count; i++) {
        mpq_set_d(one, factor[i]);
        mpq_mul(product, product, one);
    }
    mpq_add(sum, sum, product);
    mpq_clears(product, one, NULL);
}

/* Leibniz: the sum over the permutations of the axes. */
static void determinant(int dim, const double *number, mpq_t sum)
{
    mpq_set_ui(sum, 0, 1);
    if (dim == 2) {
        add_product(sum, +1, (double[]){number[0], number[3]}, 2);
        add_product(sum, -1, (double[]){number[1], number[2]}, 2);
    }
    for (int i = 0; dim == 3 && i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(sum, +1, (double[]){number[i], number[3 + j], number[6 + k]}, 3);
        add_product(sum, -1, (double[]){number[i], number[3 + k], number[6 + j]}, 3);
    }
}

static bool is_flat(int dim, const double *number)
{
    mpq_t sum;
    mpq_init(sum);
    determinant(dim, number, sum);
    bool flat = mpq_sgn(sum) == 0;
    mpq_clear(sum);
    return flat;
}

#define M DBL_MAX
#define S 0x1p-1074                       /* the least subnormal */
#define NEXT(x) ((x) * (1 + DBL_EPSILON)) /* for x with an even last bit and no carry */

static void flatness_by_hand(void **state)
{
    static const struct {
        bool flat;
        double number[4];
    } plane[] = {
        {false, {1, 0, 0, 1}},
        {true, {0, 0, 0, 0}},
        {true, {0, 0, 3, 4}},
        {true, {-0.0, 0, 3, 4}},
        {true, {1, 2, 2, 4}},
        {false, {1, 2, 2, NEXT(4.)}},
        {true, {0.1, 0.3, 0.2, 0.6}}, /* exact doublings, though 0.1 is not */
        {false, {0.1, 0.3, 0.30000000000000004, 0.9}},
        {false, {S, 0, 0, S}},
        {true, {S, S, S, S}},
        {false, {S, 2 * S, 2 * S, 3 * S}},
        {false, {M, 0, 0, M}},
        {true, {M, M, M, M}},
        {true, {M, -M, -M, M}},
        {false, {M, M, -M, M}},
        {true, {0x1p1000, 0x1p-1000, 0x1p1001, 0x1p-999}},
        {true, {0x1p1000, 0x1p-60, 0x1p1010, 0x1p-50}},
        {false, {0x1p1000, 0x1p-60, 0x1p1010, NEXT(0x1p-50)}},
        {true, {1e-200, 1e-200, 1e-200, 1e-200}},
        {false, {1e-200, 1e-200, 1e-200, 1.0000000000000002e-200}},
        {false, {1, 0, 0, S}},
        {false, {M, 0, 0, S}},
    };
    for (size_t i = 0; i < COUNT(plane); i++) {
        assert_int_equal(is_flat(2, plane[i].number), plane[i].flat);
        assert_int_equal(make(2, FMB_CUBOID, plane[i].number).flat, plane[i].flat);
        assert_int_equal(make(2, FMB_TETRAHEDRON, plane[i].number).flat, plane[i].flat);
    }
    static const struct {
        bool flat;
        double number[9];
    } space[] = {
        {false, {1, 0, 0, 0, 1, 0, 0, 0, 1}},
        {true, {1, 2, 3, 4, 5, 6, 7, 8, 9}},
        {false, {1, 2, 3, 4, 5, 6, 7, 8, 9.0000000000000018}},
        {true, {0}},
        {true, {1, 0, 0, 0, 1, 0, 1, 1, 0}},
        {false, {1, 0, 0, 0, 1, 0, 1, 1, S}},
        {false, {S, 0, 0, 0, S, 0, 0, 0, S}},
        {false, {M, 0, 0, 0, M, 0, 0, 0, M}},
        {true, {M, M, M, M, -M, 0, M, M, M}},
        {false, {M, 0, 0, 0, S, 0, 0, 0, 1}},
        {true, {0x1p900, 0x1p900, 0, 0, 0x1p-900, 0x1p-900, 0x1p900, 0x1p900, 0}},
    };
    for (size_t i = 0; i < COUNT(space); i++) {
        assert_int_equal(is_flat(3, space[i].number), space[i].flat);
        assert_int_equal(make(3, FMB_CUBOID, space[i].number).flat, space[i].flat);
        assert_int_equal(make(3, FMB_TETRAHEDRON, space[i].number).flat, space[i].flat);
    }
}

static void faces_are_flat(void **state)
{
    struct fmb_frame face = make(3, FMB_FACE, unit3);
    assert_true(face.flat);
    assert_false(face.inverted);
}

/* Numbers drawn so that flat bodies are frequent: integers, copies of a row, sums of rows, an
 * ulp off here and there, all at any scale. */
static void draw_nearly_flat(struct draw *draw, int dim, double *number)
{
    for (int i = 0; i < dim * dim; i++)
        number[i] = draw_coin(draw) ? draw_int(draw, -3, 3) : draw_uniform(draw, -1, 1);
    int kind = draw_int(draw, 0, 2);
    for (int axis = 0; axis < dim; axis++) {
        double *last = &number[(dim - 1) * dim + axis];
        if (kind == 1)
            *last = number[axis] * 4;
        if (kind == 2)
            *last = number[axis] + number[(dim - 2) * dim + axis];
    }
    if (draw_coin(draw)) {
        double *one = &number[draw_int(draw, 0, dim * dim - 1)];
        *one = nextafter(*one, draw_coin(draw) ? 1e9 : -1e9);
    }
    int exponent = draw_coin(draw) ? 0 : draw_int(draw, -1080, 1020);
    for (int i = 0; i < dim * dim; i++)
        number[i] = ldexp(number[i], exponent);
}

static void flatness_is_exact(void **state)
{
    struct draw draw;
    long count[2] = {0};
    draw_begin(&draw, "flatness_is_exact");
    for (long n = draw_sample(80000); n > 0; n--) {
        double number[9];
        const int dim = draw_int(&draw, 2, 3);
        draw_nearly_flat(&draw, dim, number);
        const bool flat = is_flat(dim, number);
        if (make(dim, FMB_CUBOID, number).flat != flat) {
            for (int i = 0; i < dim * dim; i++)
                printf("# %a\n", number[i]);
            fail_msg("flat should be %d", flat);
        }
        count[flat]++;
    }
    assert_true(count[0] > 0 && count[1] > 0);
}

/* ---- The inverse ---- */

/* The largest difference of inverse * components from the unit matrix. */
static double residue(const struct fmb_frame *frame)
{
    double worst = 0;
    for (int i = 0; i < frame->dim; i++)
        for (int j = 0; j < frame->dim; j++) {
            double x = 0; /* parameter j of the point at component i */
            for (int axis = 0; axis < frame->dim; axis++)
                x += frame->inverse[axis][j] * frame->component[i][axis];
            worst = fmax(worst, fabs(x - (i == j)));
        }
    return worst;
}

/* Rows near those of a unit matrix: |M - I| <= 0.3 an entry, so the condition is below 20. */
static void inverse_is_accurate(void **state)
{
    struct draw draw;
    draw_begin(&draw, "inverse_is_accurate");
    for (long n = draw_sample(40000); n > 0; n--) {
        double number[9];
        const int dim = draw_int(&draw, 2, 3), exponent = draw_int(&draw, -1015, 1015);
        for (int i = 0; i < dim * dim; i++)
            number[i] = ldexp((i % (dim + 1) == 0) + draw_uniform(&draw, -0.3, 0.3), exponent);
        struct fmb_frame frame = make(dim, FMB_CUBOID, number);
        assert_true(frame.inverted);
        assert_true(residue(&frame) < 1e-14);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                if (i >= dim || j >= dim)
                    assert_true(frame.inverse[i][j] == 0);
    }
}

/* The cofactor of number [component][axis], over the determinant: an entry of the inverse. */
static double exact_entry(int dim, const double *number, int component, int axis)
{
    mpq_t cofactor, whole;
    mpq_inits(cofactor, whole, NULL);
    determinant(dim, number, whole);
    if (dim == 2) {
        double other = number[2 * (1 - component) + 1 - axis];
        add_product(cofactor, component == axis ? 1 : -1, &other, 1);
    } else {
        int p = (component + 1) % 3, q = (component + 2) % 3;
        int j = (axis + 1) % 3, k = (axis + 2) % 3;
        add_product(cofactor, +1, (double[]){number[3 * p + j], number[3 * q + k]}, 2);
        add_product(cofactor, -1, (double[]){number[3 * p + k], number[3 * q + j]}, 2);
    }
    mpq_div(cofactor, cofactor, whole);
    double entry = mpq_get_d(cofactor);
    mpq_clears(cofactor, whole, NULL);
    return entry;
}

/* Whatever the rounding of the determinant does: the inverse keeps its sign and its size. */
static void inverse_of_nearly_flat_frames(void **state)
{
    struct draw draw;
    long checked = 0;
    draw_begin(&draw, "inverse_of_nearly_flat_frames");
    for (long n = draw_sample(40000); n > 0; n--) {
        double number[9], largest = 0, worst = 0;
        const int dim = draw_int(&draw, 2, 3);
        const double p = draw_uniform(&draw, -2, 2), q = draw_uniform(&draw, -2, 2);
        for (int i = 0; i < (dim - 1) * dim; i++)
            number[i] = draw_uniform(&draw, -1, 1);
        for (int axis = 0; axis < dim; axis++)
            number[(dim - 1) * dim + axis] =
                p * number[axis] + (dim == 3 ? q * number[3 + axis] : 0);
        struct fmb_frame frame = make(dim, FMB_CUBOID, number);
        if (!frame.inverted)
            continue;
        for (int i = 0; i < dim; i++)
            for (int axis = 0; axis < dim; axis++) {
                double exact = exact_entry(dim, number, i, axis);
                largest = fmax(largest, fabs(exact));
                worst = fmax(worst, fabs(frame.inverse[axis][i] - exact));
            }
        assert_true(worst < 0.25 * largest);
        checked++;
    }
    assert_true(checked > 100);
}

static void inverse_of_the_unit_is_exact(void **state)
{
    struct fmb_frame plane = make(2, FMB_CUBOID, unit2), space = make(3, FMB_TETRAHEDRON, unit3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            assert_true(space.inverse[i][j] == (i == j));
            assert_true(plane.inverse[i][j] == (i == j && i < 2));
        }
}

/* No inverse: flat, or its numbers are beyond the doubles. Then it is all zero. */
static void frames_without_inverse(void **state)
{
    static const double flat[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    static const double tiny[9] = {S, 0, 0, 0, S, 0, 0, 0, S};
    static const double one_tiny[9] = {1, 0, 0, 0, 1, 0, 0, 0, S};
    static const double zero[3][3];
    const struct fmb_frame frames[] = {make(3, FMB_CUBOID, flat), make(3, FMB_CUBOID, tiny),
                                       make(3, FMB_TETRAHEDRON, one_tiny),
                                       make(3, FMB_FACE, unit3)};
    for (size_t i = 0; i < COUNT(frames); i++) {
        assert_false(frames[i].inverted);
        assert_memory_equal(frames[i].inverse, zero, sizeof zero);
    }
    assert_true(frames[0].flat);
    assert_false(frames[1].flat);
    assert_false(frames[2].flat);
}

/* ---- Pairs ---- */

static struct fmb_body plane_body, space_body;

static struct pair plane_pair(void)
{
    plane_body = make_body(2, unit2);
    return (struct pair){{.body = &plane_body}, {.body = &plane_body}, .duration = 1};
}

/* With which all methods decide a pair, or refuse it. */
static enum fmb_status status_of(const struct pair *pair)
{
    struct fmb_answer answer;
    const enum fmb_status status = pair_decide(fmb_method_default(), pair, 0, &answer);
    for (size_t i = 0; fmb_method_at(i); i++)
        assert_int_equal(pair_decide(fmb_method_at(i), pair, 0, &answer), status);
    assert_int_equal(pair_check(pair), status);
    return status;
}

static void pairs_that_are_refused(void **state)
{
    struct pair pair = plane_pair();
    assert_int_equal(status_of(&pair), FMB_OK);

    space_body = make_body(3, unit3);
    pair.b.body = &space_body;
    assert_int_equal(status_of(&pair), FMB_DIMENSIONS_DIFFER);
}

static void durations(void **state)
{
    static const double good[] = {0, -0.0, S, 1, M};
    static const double bad[] = {-S, -1, NAN, INFINITY, -INFINITY};
    struct pair pair = plane_pair();
    for (size_t i = 0; i < COUNT(good); i++) {
        pair.duration = good[i];
        assert_int_equal(status_of(&pair), FMB_OK);
    }
    for (size_t i = 0; i < COUNT(bad); i++) {
        pair.duration = bad[i];
        assert_int_equal(status_of(&pair), FMB_BAD_DURATION);
    }
}

/* The z of a plane pair is ignored by the check and by the answer. */
static void axes_beyond_dim_are_not_read(void **state)
{
    struct pair pair = plane_pair();
    struct fmb_answer answer;
    pair.a.position[2] = pair.b.velocity[2] = NAN;
    assert_int_equal(status_of(&pair), FMB_OK);
    for (size_t i = 0; fmb_method_at(i); i++) {
        assert_int_equal(pair_decide(fmb_method_at(i), &pair, FMB_WANT_BOX, &answer), FMB_OK);
        assert_int_equal(answer.verdict, FMB_OVERLAPPING);
        assert_true(answer.box[0][2] == 0 && answer.box[1][2] == 0);
    }
}

static void decide_checks_first(void **state)
{
    struct fmb_answer answer;
    for (size_t i = 0; fmb_method_at(i); i++) {
        struct pair pair = plane_pair();
        assert_int_equal(pair_decide(fmb_method_at(i), &pair, FMB_WANT_CERTIFICATE, &answer),
                         FMB_UNKNOWN_WANT);
        assert_int_equal(pair_decide(fmb_method_at(i), &pair, 0x80000001U, &answer),
                         FMB_UNKNOWN_WANT);
        pair.duration = -1;
        assert_int_equal(pair_decide(fmb_method_at(i), &pair, 0, &answer), FMB_BAD_DURATION);
    }
}

/* ---- Tables ---- */

static void names_of_shapes_and_verdicts(void **state)
{
    assert_string_equal(fmb_shape_name(FMB_CUBOID), "cuboid");
    assert_string_equal(fmb_shape_name(FMB_TETRAHEDRON), "tetrahedron");
    assert_string_equal(fmb_shape_name(FMB_FACE), "face");
    assert_string_equal(fmb_shape_name(FMB_BOX), "box");
    assert_string_equal(fmb_shape_name(FMB_HULL), "hull");
    assert_string_equal(fmb_verdict_name(FMB_SEPARATED), "separated");
    assert_string_equal(fmb_verdict_name(FMB_TOUCHING), "touching");
    assert_string_equal(fmb_verdict_name(FMB_OVERLAPPING), "overlapping");
    static const int unknown[] = {-1, 0, 6, 1000, -2147483647 - 1};
    for (size_t i = 0; i < COUNT(unknown); i++) {
        assert_null(fmb_shape_name(unknown[i]));
        assert_null(fmb_verdict_name(unknown[i]));
    }
}

static void counts_of_components(void **state)
{
    for (int dim = -1; dim <= 5; dim++)
        for (int shape = -1; shape <= 5; shape++) {
            int expected = 0;
            if ((dim == 2 || dim == 3) &&
                (shape == FMB_CUBOID || shape == FMB_TETRAHEDRON || shape == FMB_BOX))
                expected = dim;
            if (dim == 3 && shape == FMB_FACE)
                expected = 2;
            assert_int_equal(fmb_component_count(dim, shape), expected);
        }
}

/* Numbers stand in logs: they never change. */
static void statuses(void **state)
{
    assert_string_equal(fmb_status_text(0), "ok");
    assert_string_equal(fmb_status_text(-1), "unknown status");
    assert_string_equal(fmb_status_text(1000), "unknown status");
    /* The texts of frequent mistakes name the remedy, or all causes. */
    assert_non_null(strstr(fmb_status_text(FMB_NOT_SUPPORTED), "fmb_body_make_hull()"));
    assert_non_null(strstr(fmb_status_text(FMB_BAD_DURATION), "0 although a body moves"));
    assert_int_equal(FMB_UNKNOWN_BODY, 1);
    assert_int_equal(FMB_CANNOT_DECIDE, 13);
    assert_int_equal(FMB_NOT_SUPPORTED, 14);
    assert_int_equal(FMB_BAD_PAIR, 15);
    assert_int_equal(FMB_BAD_ORIENTATION, 16);
    assert_int_equal(FMB_BAD_SIZE, 17);
    assert_int_equal(FMB_NO_FRAMES, 18);
    assert_int_equal(FMB_BAD_MARGIN, 19);
    assert_int_equal(FMB_BAD_NAME, 20);
    assert_int_equal(FMB_STATUS_COUNT, 21);
#define X(name, number, text) assert_string_equal(fmb_status_text(number), text);
    FMB_STATUS_MAP(X)
#undef X
}

static void methods(void **state)
{
    size_t count = 0;
    for (const struct fmb_method *method; (method = fmb_method_at(count)); count++) {
        assert_true(method->number != 0);
        assert_true(strlen(method->summary) > 0);
        assert_ptr_equal(fmb_method_by_name(method->name), method);
        assert_ptr_equal(fmb_method_by_number(method->number), method);
    }
    assert_true(count >= 3);
    assert_null(fmb_method_at(count + 1));
    assert_null(fmb_method_at(SIZE_MAX));
    assert_ptr_equal(fmb_method_by_number(0), fmb_method_default());
    assert_non_null(fmb_method_default());
    assert_non_null(fmb_method_by_name("exact"));
    assert_non_null(fmb_method_by_name("fmb"));
    assert_non_null(fmb_method_by_name("sat"));
    assert_null(fmb_method_by_name(""));
    assert_null(fmb_method_by_name("Exact"));
    assert_null(fmb_method_by_number(-1));
    assert_null(fmb_method_by_number(1000));
}

static void version_has_three_numbers(void **state)
{
    unsigned major, minor, patch;
    char more;
    assert_int_equal(sscanf(fmb_version(), "%u.%u.%u%c", &major, &minor, &patch, &more), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frame_holds_what_it_was_given),
        cmocka_unit_test(frame_refuses),
        cmocka_unit_test(frame_refuses_each_number_that_is_not_finite),
        cmocka_unit_test(flatness_by_hand),
        cmocka_unit_test(faces_are_flat),
        cmocka_unit_test(flatness_is_exact),
        cmocka_unit_test(inverse_is_accurate),
        cmocka_unit_test(inverse_of_nearly_flat_frames),
        cmocka_unit_test(inverse_of_the_unit_is_exact),
        cmocka_unit_test(frames_without_inverse),
        cmocka_unit_test(pairs_that_are_refused),
        cmocka_unit_test(durations),
        cmocka_unit_test(axes_beyond_dim_are_not_read),
        cmocka_unit_test(decide_checks_first),
        cmocka_unit_test(names_of_shapes_and_verdicts),
        cmocka_unit_test(counts_of_components),
        cmocka_unit_test(statuses),
        cmocka_unit_test(methods),
        cmocka_unit_test(version_has_three_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
