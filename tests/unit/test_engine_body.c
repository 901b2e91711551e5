/* Boxes, frames from vertices, bodies and placements: what they hold, and what is refused. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <limits.h>
#include <math.h>

#include "draw.h"
#include "fmb_batch.h"
#include "frame_make.h"

#define M DBL_MAX
#define S 0x1p-1074                       /* the least subnormal */
#define NEXT(x) ((x) * (1 + DBL_EPSILON)) /* for x with an even last bit and no carry */

/* ---- Boxes ---- */

static struct fmb_frame make_box(int dim, const double *number, size_t count)
{
    struct fmb_frame frame;
    memset(&frame, 0xa5, sizeof frame);
    assert_int_equal(fmb_frame_make(dim, FMB_BOX, number, count, &frame), FMB_OK);
    return frame;
}

static void boxes_have_a_centre_and_a_size(void **state)
{
    static const double number[6] = {10, 20, 30, 2, 4, 5};
    const struct fmb_frame space = make_box(3, number, 6), plane = make_box(2, number, 4);
    for (int axis = 0; axis < 3; axis++) {
        assert_true(space.centre[axis] == number[axis]);
        assert_true(space.origin[axis] == number[axis] - number[3 + axis] / 2);
        for (int i = 0; i < 3; i++)
            assert_true(space.component[i][axis] == (i == axis ? number[3 + axis] : 0));
    }
    assert_int_equal(space.shape, FMB_BOX);
    assert_int_equal(space.count, 3);
    assert_false(space.flat);
    assert_true(plane.component[0][0] == 30 && plane.component[1][1] == 2);
    assert_true(plane.origin[0] == -5 && plane.origin[1] == 19 && plane.origin[2] == 0);
}

static void boxes_of_size_0_are_flat(void **state)
{
    for (int zeros = 0; zeros < 16; zeros++) {
        const double number[3] = {zeros & 1 ? 0 : 1, zeros & 2 ? -0.0 : 2, zeros & 4 ? 0 : S};
        const struct fmb_frame space = make_box(3, number, 3), plane = make_box(2, number, 2);
        assert_int_equal(space.flat, (zeros & 7) != 0);
        assert_int_equal(plane.flat, (zeros & 3) != 0);
        assert_false(signbit(space.component[1][1]));
    }
}

static void boxes_of_negative_size_are_refused(void **state)
{
    static const double bad[] = {-1, -S, -M};
    struct fmb_frame frame;
    for (size_t i = 0; i < COUNT(bad); i++)
        for (int axis = 0; axis < 3; axis++) {
            double number[6] = {-1, -2, -3, 1, 1, 1};
            number[3 + axis] = bad[i];
            assert_int_equal(fmb_frame_make(3, FMB_BOX, number, 6, &frame), FMB_BAD_SIZE);
            assert_int_equal(fmb_frame_make(3, FMB_BOX, number + 3, 3, &frame), FMB_BAD_SIZE);
            if (axis < 2)
                assert_int_equal(fmb_frame_make(2, FMB_BOX, number + 3, 2, &frame), FMB_BAD_SIZE);
        }
}

static void an_origin_left_out_is_0(void **state)
{
    double number[12] = {0, 0, 0, 1, 2, 3, 4, 5, 7, -1, 1, 2};
    for (int shape = FMB_CUBOID; shape <= FMB_BOX; shape++)
        for (int dim = shape == FMB_FACE ? 3 : 2; dim <= 3; dim++) {
            const int components = fmb_component_count(dim, shape);
            const size_t count = (size_t) (shape == FMB_BOX ? dim : components * dim);
            struct fmb_frame with, without;
            assert_int_equal(fmb_frame_make(dim, shape, number + 3, count, &without), FMB_OK);
            assert_int_equal(
                fmb_frame_make(dim, shape, number + 3 - dim, count + (size_t) dim, &with), FMB_OK);
            assert_memory_equal(&with, &without, sizeof with);
            number[2] = 1; /* the last coordinate of the origin */
            assert_int_equal(
                fmb_frame_make(dim, shape, number + 3 - dim, count + (size_t) dim, &with), FMB_OK);
            assert_true(with.origin[dim - 1] == without.origin[dim - 1] + 1);
            number[2] = 0;
        }
}

/* ---- Frames from vertices ---- */

static void vertices_that_are_refused(void **state)
{
    static const struct {
        int dim, shape;
        size_t count;
        enum fmb_status status;
    } cases[] = {
        {3, FMB_CUBOID, 12, FMB_UNKNOWN_SHAPE},
        {3, FMB_BOX, 12, FMB_UNKNOWN_SHAPE},
        {3, 0, 12, FMB_UNKNOWN_SHAPE},
        {3, 6, 12, FMB_UNKNOWN_SHAPE},
        {3, FMB_HULL, 12, FMB_NOT_SUPPORTED},
        {2, FMB_FACE, 6, FMB_WRONG_DIMENSION},
        {1, FMB_TETRAHEDRON, 2, FMB_WRONG_DIMENSION},
        {4, FMB_TETRAHEDRON, 5, FMB_WRONG_DIMENSION},
        {3, FMB_TETRAHEDRON, 9, FMB_WRONG_COUNT},
        {3, FMB_TETRAHEDRON, 15, FMB_WRONG_COUNT},
        {2, FMB_TETRAHEDRON, 4, FMB_WRONG_COUNT},
        {3, FMB_FACE, 12, FMB_WRONG_COUNT},
        {3, FMB_FACE, 0, FMB_WRONG_COUNT},
    };
    static const double bad[] = {NAN, INFINITY, -INFINITY, M};
    struct fmb_frame frame;
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_int_equal(
            fmb_frame_make_vertices(cases[i].dim, cases[i].shape, unit3, cases[i].count, &frame),
            cases[i].status);
    for (size_t i = 0; i < COUNT(bad); i++)
        for (int at = 0; at < 12; at++) {
            double number[12];
            for (int k = 0; k < 12; k++)
                number[k] = k % 5 == 3 ? 1 : -M / 4;
            number[at] = bad[i];
            assert_int_equal(fmb_frame_make_vertices(3, FMB_TETRAHEDRON, number, 12, &frame),
                             FMB_NOT_FINITE);
            if (at < 6)
                assert_int_equal(fmb_frame_make_vertices(2, FMB_TETRAHEDRON, number, 6, &frame),
                                 FMB_NOT_FINITE);
        }
}

/* The determinant of differences of vertices, all of it rational. */
static bool are_in_one_plane(int dim, const double *vertices)
{
    mpq_t edge[3][3], term, sum;
    mpq_inits(term, sum, NULL);
    for (int k = 0; k < 9; k++) {
        const int i = k / 3, axis = k % 3;
        mpq_init(edge[i][axis]);
        if (i >= dim || axis >= dim)
            mpq_set_si(edge[i][axis], i == axis, 1);
        else {
            mpq_set_d(edge[i][axis], vertices[(i + 1) * dim + axis]);
            mpq_set_d(term, vertices[axis]);
            mpq_sub(edge[i][axis], edge[i][axis], term);
        }
    }
    for (int k = 0; k < 6; k++) {
        const int i = k % 3, j = (i + (k < 3 ? 1 : 2)) % 3, l = 3 - i - j;
        mpq_mul(term, edge[0][i], edge[1][j]);
        mpq_mul(term, term, edge[2][l]);
        (k < 3 ? mpq_add : mpq_sub)(sum, sum, term);
    }
    const bool flat = mpq_sgn(sum) == 0;
    for (int k = 0; k < 9; k++)
        mpq_clear(edge[k / 3][k % 3]);
    mpq_clears(term, sum, NULL);
    return flat;
}

/* component + rest is the difference of the vertices, and component the double next to it. */
static void expect_edges(const double *vertices, const struct fmb_frame *frame)
{
    mpq_t edge, term;
    bool rounded = false;
    mpq_inits(edge, term, NULL);
    for (int k = 0; k < frame->count * frame->dim; k++) {
        const int i = k / frame->dim, axis = k % frame->dim;
        mpq_set_d(edge, vertices[(i + 1) * frame->dim + axis]);
        mpq_set_d(term, vertices[axis]);
        mpq_sub(edge, edge, term);
        mpq_set_d(term, frame->component[i][axis]);
        mpq_sub(edge, edge, term);
        mpq_set_d(term, frame->remainder[i][axis]);
        assert_true(mpq_equal(edge, term));
        assert_true(frame->component[i][axis] ==
                    vertices[(i + 1) * frame->dim + axis] - vertices[axis]);
        rounded = rounded || frame->remainder[i][axis] != 0;
    }
    assert_int_equal(frame->rounded, rounded);
    mpq_clears(edge, term, NULL);
}

/* Vertices on a line or a plane but for an ulp: whether they are is not what rounded edges say. Of
 * any size, down to the least doubles. */
static void vertices_are_exact(void **state)
{
    struct draw draw;
    long count[2][2] = {{0}};
    draw_begin(&draw, "vertices_are_exact");
    for (long n = draw_sample(40000); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3), exponent = draw_int(&draw, -1074, 1010);
        const int shape = dim == 3 && draw_coin(&draw) ? FMB_FACE : FMB_TETRAHEDRON;
        const int numbers = shape == FMB_FACE ? 9 : (dim + 1) * dim;
        const double unit = draw_coin(&draw) ? 0.1 : 0.25;
        double vertices[12];
        struct fmb_frame frame;
        for (int k = 0; k < numbers; k++)
            vertices[k] = unit * draw_int(&draw, -3, 3) + (draw_coin(&draw) ? 0 : 1000);
        for (int axis = 0; axis < dim && draw_coin(&draw); axis++) /* the last is a copy */
            vertices[numbers - dim + axis] = vertices[numbers - 2 * dim + axis];
        if (draw_coin(&draw))
            vertices[draw_int(&draw, 0, dim)] += 0x1p-45;
        const int scaled = draw_coin(&draw) ? numbers : draw_int(&draw, 0, numbers);
        for (int k = 0; k < scaled; k++)
            vertices[k] = ldexp(vertices[k], exponent);
        assert_int_equal(fmb_frame_make_vertices(dim, shape, vertices, (size_t) numbers, &frame),
                         FMB_OK);
        expect_edges(vertices, &frame);
        const bool flat = shape == FMB_FACE || are_in_one_plane(dim, vertices);
        assert_int_equal(frame.flat, flat);
        assert_true(memcmp(frame.origin, vertices, (size_t) dim * sizeof *vertices) == 0);
        count[flat][frame.rounded]++;
    }
    assert_true(count[0][0] > 0 && count[0][1] > 0 && count[1][0] > 0 && count[1][1] > 0);
}

/* ---- The numbers of a frame ---- */

/* Whether a frame gives these numbers, and is made of them again. */
static void expect_numbers(const struct fmb_frame *frame, const double *given, size_t count)
{
    double numbers[FMB_FRAME_NUMBERS_MAX];
    struct fmb_frame again;
    bool by_vertices;
    assert_int_equal(fmb_frame_numbers(frame, &by_vertices, NULL, 0), count);
    for (size_t capacity = 0; capacity <= COUNT(numbers); capacity++) {
        for (size_t k = 0; k < COUNT(numbers); k++)
            numbers[k] = NAN;
        assert_int_equal(fmb_frame_numbers(frame, &by_vertices, numbers, capacity), count);
        for (size_t k = 0; k < COUNT(numbers); k++)
            assert_int_equal(isnan(numbers[k]), k >= capacity || k >= count);
    }
    assert_int_equal(by_vertices, frame->rounded);
    for (size_t k = 0; given && k < count; k++)
        assert_true(numbers[k] == given[k]);
    assert_int_equal((by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
                         frame->dim, frame->shape, numbers, count, &again),
                     FMB_OK);
    assert_memory_equal(&again, frame, sizeof again);
}

static void frames_give_the_numbers_they_were_made_of(void **state)
{
    static const int shapes[] = {FMB_CUBOID, FMB_TETRAHEDRON, FMB_FACE, FMB_BOX};
    struct draw draw;
    draw_begin(&draw, "frames_give_the_numbers_they_were_made_of");
    for (int n = 0; n < 4000; n++) {
        const int dim = draw_int(&draw, 2, 3), shape = shapes[draw_int(&draw, 0, dim == 3 ? 3 : 1)];
        const int components = fmb_component_count(dim, shape);
        const size_t count = (size_t) (dim + components * (shape == FMB_BOX ? 1 : dim));
        double numbers[FMB_FRAME_NUMBERS_MAX];
        struct fmb_frame frame;
        for (size_t k = 0; k < count; k++)
            numbers[k] = 0.1 * draw_int(&draw, shape == FMB_BOX ? 0 : -9, 9) + 0.0;
        assert_int_equal(fmb_frame_make(dim, shape, numbers, count, &frame), FMB_OK);
        expect_numbers(&frame, numbers, count);
    }
}

static double draw_of_exponent(struct draw *draw, int exponent)
{
    const double ends[] = {1, 1 + 0x1p-52, 2 - 0x1p-52};
    const int end = draw_int(draw, 0, 5);
    const double mantissa = end < 3 ? ends[end] : 1 + 0x1p-30 * draw_int(draw, 0, 1 << 30);
    return ldexp(draw_coin(draw) ? mantissa : -mantissa, exponent);
}

/* Returns whether a face with this coordinate of its first vertex gives its vertices. */
static bool gives_vertices(const double vertices[9])
{
    double numbers[FMB_FRAME_NUMBERS_MAX];
    struct fmb_frame frame;
    if (fmb_frame_make_vertices(3, FMB_FACE, vertices, 9, &frame) != FMB_OK)
        return false; /* a component overflows */
    expect_numbers(&frame, frame.rounded ? vertices : NULL, 9);
    bool by_vertices;
    fmb_frame_numbers(&frame, &by_vertices, numbers, COUNT(numbers));
    return by_vertices;
}

/* Vertices of all exponents, against a first vertex of all that matter for the rounding of the
 * difference, and of some others. */
static void vertices_are_recovered_exactly(void **state)
{
    enum { LEAST = -1074, MOST = 1023, NEAR = 56 };
    struct draw draw;
    long rounded = 0;
    draw_begin(&draw, "vertices_are_recovered_exactly");
    for (int first = LEAST; first <= MOST; first++)
        for (int n = -NEAR; n <= NEAR; n++) {
            double vertices[9];
            int near = first + n;
            near = near < LEAST ? LEAST : near > MOST ? MOST : near;
            for (int axis = 0; axis < 3; axis++) {
                vertices[axis] = draw_of_exponent(&draw, first);
                vertices[3 + axis] = draw_of_exponent(&draw, near);
                vertices[6 + axis] = draw_of_exponent(&draw, draw_int(&draw, LEAST, MOST));
            }
            rounded += gives_vertices(vertices);
        }
    assert_true(rounded > 100000);
    /* The sum of the first vertex and the component exceeds the largest double. */
    const double overflow[9] = {0x3p970, 0, 0, DBL_MAX, 1, 0, DBL_MAX, 0, 1};
    assert_true(overflow[0] + (overflow[3] - overflow[0]) == INFINITY);
    assert_true(gives_vertices(overflow));
}

/* ---- Bodies ---- */

static void bodies_of_one_frame_hold_it(void **state)
{
    static const double number[6] = {1, 2, 3, 2, 4, 6};
    struct fmb_body body, copy, again;
    const struct fmb_frame frame = make_box(3, number, 6);
    assert_int_equal(fmb_body_make(3, FMB_BOX, number, 6, &body), FMB_OK);
    copy = body;
    memset(&body, 0xa5, sizeof body);
    assert_int_equal(copy.frame_count, 1);
    assert_int_equal(copy.dim, 3);
    assert_ptr_equal(fmb_body_frame(&copy, 0), &copy.one);
    assert_memory_equal(&copy.one, &frame, sizeof frame);
    assert_true(copy.reach == frame.reach);
    struct fmb_frame gone = frame;
    assert_int_equal(fmb_body_make_frames(&gone, 1, &again), FMB_OK);
    memset(&gone, 0xa5, sizeof gone);
    assert_memory_equal(fmb_body_frame(&again, 0), &frame, sizeof frame);
}

/* The farthest vertex, (4, 8, 12), is 14.97 away; the one opposite, (-2, -4, -6), is nearer. */
static void no_vertex_is_beyond_the_reach(void **state)
{
    static const double near[6] = {0, 0, 0, 1, 1, 1}, far[6] = {1, 2, 3, 6, 12, 18};
    const struct fmb_frame frames[3] = {make_box(3, near, 6), make_box(3, far, 6),
                                        make_box(3, near, 6)};
    struct fmb_body body;
    assert_int_equal(fmb_body_make_frames(frames, 3, &body), FMB_OK);
    assert_int_equal(body.frame_count, 3);
    assert_ptr_equal(fmb_body_frame(&body, 1), &frames[1]);
    assert_true(frames[0].reach >= sqrt(0.75) && frames[1].reach >= sqrt(16 + 64 + 144));
    assert_true(frames[0].reach < 0.8661 && frames[1].reach < 14.967);
    assert_true(body.reach == frames[1].reach);
}

/* The three edges at the origin enclose a volume of `thickness`; the first and edge `second` are
 * nearly parallel. offset: of the origin along z. */
static struct fmb_frame make_thin(double thickness, double offset, int second)
{
    double vertex[12] = {0, 0, offset, 1, 0, 0};
    struct fmb_frame frame;
    vertex[3 * second] = vertex[3 * (5 - second) + 2] = 1;
    vertex[3 * second + 1] = thickness;
    assert_int_equal(fmb_frame_make_vertices(3, FMB_TETRAHEDRON, vertex, 12, &frame), FMB_OK);
    assert_true(frame.rounded == (offset != 0));
    return frame;
}

/* Rounding might turn a thin frame inside out: doubles decide it only if nothing is rounded. */
static void thin_frames_are_not_sturdy(void **state)
{
    for (int n = 0; n < 4; n++) {
        const int rounded = n % 2, second = 2 + n / 2;
        const double offset = rounded ? 0x1p-60 : 0;
        const struct fmb_frame thick = make_thin(0x1p-43, offset, second);
        const struct fmb_frame thin = make_thin(0x1p-45, offset, second);
        assert_true(thick.sturdy && thick.in_range);
        assert_true(!thin.sturdy && thin.in_range == !rounded);
    }
}

/* 2^600 + 2^547 is no double. */
static void radii_of_large_frames_are_rounded_up(void **state)
{
    static const double number[9] = {0x1p600, 0, 0, 0x1p547, 0, 0, 0x1p547, 0, 0};
    struct fmb_frame frame;
    assert_int_equal(fmb_frame_make(3, FMB_FACE, number, 9, &frame), FMB_OK);
    assert_true(frame.reach > 0x1p600);
}

static void bodies_that_are_refused(void **state)
{
    static struct fmb_frame frames[FMB_FRAMES_MAX + 1];
    const struct fmb_frame plane = make(2, FMB_CUBOID, unit2), space = make(3, FMB_CUBOID, unit3);
    struct fmb_body body;
    for (size_t i = 0; i < COUNT(frames); i++)
        frames[i] = space;
    assert_int_equal(fmb_body_make_frames(NULL, 0, &body), FMB_NO_FRAMES);
    assert_int_equal(fmb_body_make_frames(frames, FMB_FRAMES_MAX, &body), FMB_OK);
    assert_int_equal(fmb_body_make_frames(frames, FMB_FRAMES_MAX + 1, &body), FMB_OVER_LIMIT);
    assert_int_equal(fmb_body_make_frames(frames, SIZE_MAX, &body), FMB_OVER_LIMIT);
    for (size_t at = 0; at < 3; at++) {
        frames[at] = plane;
        assert_int_equal(fmb_body_make_frames(frames, 3, &body), FMB_DIMENSIONS_DIFFER);
        frames[at] = space;
    }
}

/* ---- Placements ---- */

static struct fmb_body plane_body, space_body;

/* Every function that takes a placement says the same of it, and writes nothing but zeros. */
static void expect_status(const struct fmb_placement *placement, enum fmb_status status)
{
    static const struct fmb_prepared no_frame;
    static const struct fmb_answer no_answer;
    const struct fmb_placement good = {.body = &plane_body};
    struct fmb_prepared prepared;
    size_t length = 7;
    char text[2] = "x";
    assert_int_equal(fmb_placement_check(placement), status);
    memset(&prepared, 0xa5, sizeof prepared);
    assert_int_equal(fmb_prepare(placement, 0, 1, &prepared), status);
    if (status == FMB_OK)
        return;
    assert_memory_equal(&prepared, &no_frame, sizeof prepared);
    for (int order = 0; order < 2; order++) {
        const struct fmb_placement *a = order ? placement : &good, *b = order ? &good : placement;
        for (size_t i = 0; fmb_method_at(i); i++) {
            struct fmb_answer answer;
            memset(&answer, 0xa5, sizeof answer);
            assert_int_equal(fmb_decide(fmb_method_at(i), a, b, 1, 0, &answer), status);
            assert_memory_equal(&answer, &no_answer, sizeof answer);
        }
        assert_int_equal(fmb_certificate(a, b, 1, text, sizeof text, &length), status);
        assert_true(length == 0 && text[0] == 0);
    }
}

static void placements_without_a_body_are_refused(void **state)
{
    static const struct fmb_body never_made;
    plane_body = make_body(2, unit2);
    expect_status(&(struct fmb_placement){.body = NULL}, FMB_NO_FRAMES);
    expect_status(&(struct fmb_placement){.body = &never_made}, FMB_NO_FRAMES);
    expect_status(&(struct fmb_placement){.body = &plane_body}, FMB_OK);
}

/* A radius that is refused changes nothing. */
static void radii_are_finite_and_not_negative(void **state)
{
    static const double bad[] = {-0x1p-1074, -1, -DBL_MAX, -INFINITY, INFINITY, NAN};
    struct fmb_body body = make_body(3, unit3), several;
    assert_int_equal(fmb_body_inflate(&body, 0.25), FMB_OK);
    const struct fmb_body before = body;
    for (size_t i = 0; i < COUNT(bad); i++) {
        const enum fmb_status status = isfinite(bad[i]) ? FMB_BAD_SIZE : FMB_NOT_FINITE;
        assert_int_equal(fmb_frame_inflate(&body.one, bad[i]), status);
        assert_int_equal(fmb_body_inflate(&body, bad[i]), status);
        assert_memory_equal(&body, &before, sizeof body);
    }
    assert_int_equal(fmb_body_inflate(&body, -0.0), FMB_OK);
    assert_false(signbit(body.one.radius));
    const struct fmb_frame frames[2] = {before.one, body.one};
    assert_int_equal(fmb_body_make_frames(frames, 2, &several), FMB_OK);
    assert_true(several.box[0][0] <= -0.25 && several.box[1][0] >= 1.25);
    assert_int_equal(fmb_body_inflate(&several, 1), FMB_WRONG_COUNT);
}

static void placements_that_are_not_finite_are_refused(void **state)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    plane_body = make_body(2, unit2);
    space_body = make_body(3, unit3);
    for (size_t i = 0; i < COUNT(bad); i++)
        for (int axis = 0; axis < 3; axis++)
            for (int dim = 2; dim <= 3; dim++) {
                struct fmb_placement placement = {.body = dim == 2 ? &plane_body : &space_body};
                const enum fmb_status status = axis < dim ? FMB_NOT_FINITE : FMB_OK;
                placement.position[axis] = bad[i];
                expect_status(&placement, status);
                placement.position[axis] = 0;
                placement.velocity[axis] = bad[i];
                expect_status(&placement, status);
                placement.velocity[axis] = M;
                expect_status(&placement, FMB_OK);
            }
}

static void counts_of_orientations(void **state)
{
    plane_body = make_body(2, unit2);
    space_body = make_body(3, unit3);
    for (int dim = 2; dim <= 3; dim++)
        for (int count = -1; count <= 6; count++) {
            const bool good = count == 0 || count == (dim == 2 ? 2 : 4);
            struct fmb_placement placement = {.body = dim == 2 ? &plane_body : &space_body,
                                              .orientation_count = count};
            placement.orientation[0] = count ? 1 : 0;
            expect_status(&placement, good ? FMB_OK : FMB_WRONG_COUNT);
            for (int i = 0; i < 4; i++) { /* an orientation, and no count */
                placement = (struct fmb_placement){.body = placement.body};
                placement.orientation[i] = i % 2 ? NAN : -S;
                expect_status(&placement, FMB_WRONG_COUNT);
            }
        }
}

/* Whether |x| 2^200 < |y|, x not 0. */
static bool is_too_small(double x, double y)
{
    mpq_t small, large;
    mpq_inits(small, large, NULL);
    mpq_set_d(small, fabs(x));
    mpq_mul_2exp(small, small, 200);
    mpq_set_d(large, fabs(y));
    const bool too_small = x != 0 && mpq_cmp(small, large) < 0;
    mpq_clears(small, large, NULL);
    return too_small;
}

static void orientations_by_hand(void **state)
{
    static const struct {
        double q[4];
        bool good;
    } cases[] = {
        {{0, 0, 0, 0}, false},
        {{-0.0, 0, -0.0, 0}, false},
        {{NAN, 1, 1, 1}, false},
        {{1, 1, 1, NAN}, false},
        {{1, INFINITY, 0, 0}, false},
        {{0, 0, 0, -INFINITY}, false},
        {{S, 0, 0, 0}, true},
        {{0, 0, -S, S}, true},
        {{M, -M, M, M}, true},
        {{0, 0, 0, 0x1p-600}, true},
        {{1, 0x1p-200, 0, 0}, true},
        {{1, 0, 0x1.fffffffffffffp-201, 0}, false},
        {{1, 0, 0, S}, false},
        {{M, 0x1.fffffffffffffp823, 0, 0}, true},
        {{M, 0x1.ffffffffffffep823, 0, 0}, false},
        {{0x1p-874, S, 0, 0}, true},
        {{NEXT(0x1p-874), S, 0, 0}, false},
    };
    space_body = make_body(3, unit3);
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct fmb_placement placement = {.body = &space_body, .orientation_count = 4};
        memcpy(placement.orientation, cases[i].q, sizeof cases[i].q);
        expect_status(&placement, cases[i].good ? FMB_OK : FMB_BAD_ORIENTATION);
    }
    plane_body = make_body(2, unit2);
    expect_status(&(struct fmb_placement){.body = &plane_body, .orientation_count = 2},
                  FMB_BAD_ORIENTATION);
}

static void components_of_orientations_may_be_far_apart(void **state)
{
    struct draw draw;
    long count[2] = {0};
    draw_begin(&draw, "components_of_orientations_may_be_far_apart");
    space_body = make_body(3, unit3);
    for (long n = draw_sample(20000); n > 0; n--) {
        struct fmb_placement placement = {.body = &space_body, .orientation_count = 4};
        double *q = placement.orientation, largest = 0;
        const double first = draw_coin(&draw) ? draw_log(&draw, -1074, 1023) : draw_finite(&draw);
        for (int i = 0; i < 4; i++) {
            q[i] = draw_int(&draw, 0, 3) ? ldexp(first, -200 * draw_int(&draw, 0, 1)) : 0;
            if (draw_coin(&draw))
                q[i] = nextafter(q[i], draw_coin(&draw) ? INFINITY : -INFINITY);
            largest = fmax(largest, fabs(q[i]));
        }
        if (!isfinite(largest))
            continue;
        bool good = largest > 0;
        for (int i = 0; i < 4; i++)
            good = good && !is_too_small(q[i], largest);
        assert_int_equal(fmb_placement_check(&placement), good ? FMB_OK : FMB_BAD_ORIENTATION);
        count[good]++;
    }
    assert_true(count[0] > 0 && count[1] > 0);
}

static void frames_that_a_body_does_not_have(void **state)
{
    static const struct {
        unsigned first, count;
        bool good;
    } cases[] = {{0, 0, true},  {0, 2, true},  {1, 1, true},        {2, 0, true},
                 {0, 3, false}, {2, 1, false}, {3, 0, false},       {UINT_MAX, 1, false},
                 {1, 2, false}, {3, 3, false}, {UINT_MAX, 3, false}};
    static const struct fmb_prepared none[3];
    const struct fmb_frame frames[2] = {make(3, FMB_CUBOID, unit3), make(3, FMB_FACE, unit3)};
    struct fmb_body body;
    assert_int_equal(fmb_body_make_frames(frames, 2, &body), FMB_OK);
    const struct fmb_placement placement = {.body = &body};
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct fmb_prepared out[3];
        memset(out, 0xa5, sizeof out);
        assert_int_equal(fmb_prepare(&placement, cases[i].first, cases[i].count, out),
                         cases[i].good ? FMB_OK : FMB_BAD_PAIR);
        if (!cases[i].good)
            assert_memory_equal(out, none, cases[i].count * sizeof *out);
        for (unsigned k = 0; cases[i].good && k < cases[i].count; k++)
            assert_ptr_equal(out[k].frame, &frames[cases[i].first + k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_have_a_centre_and_a_size),
        cmocka_unit_test(boxes_of_size_0_are_flat),
        cmocka_unit_test(boxes_of_negative_size_are_refused),
        cmocka_unit_test(an_origin_left_out_is_0),
        cmocka_unit_test(vertices_that_are_refused),
        cmocka_unit_test(vertices_are_exact),
        cmocka_unit_test(frames_give_the_numbers_they_were_made_of),
        cmocka_unit_test(vertices_are_recovered_exactly),
        cmocka_unit_test(bodies_of_one_frame_hold_it),
        cmocka_unit_test(no_vertex_is_beyond_the_reach),
        cmocka_unit_test(thin_frames_are_not_sturdy),
        cmocka_unit_test(radii_of_large_frames_are_rounded_up),
        cmocka_unit_test(bodies_that_are_refused),
        cmocka_unit_test(placements_without_a_body_are_refused),
        cmocka_unit_test(radii_are_finite_and_not_negative),
        cmocka_unit_test(placements_that_are_not_finite_are_refused),
        cmocka_unit_test(counts_of_orientations),
        cmocka_unit_test(orientations_by_hand),
        cmocka_unit_test(components_of_orientations_may_be_far_apart),
        cmocka_unit_test(frames_that_a_body_does_not_have),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
