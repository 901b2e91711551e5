/* Rotations and prepared frames, against rational numbers: entries of rotations are within their
 * bound and exact where they say so, and no vertex of a prepared frame is farther from the true one
 * than its error. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <math.h>

#include "draw.h"
#include "prepared.h"
#include "rational_solid.h"
#include "rotation.h"

/* ---- Orientations ---- */

/* Multiplies by a power of two, up to where the largest component is near an end of the doubles. */
static void scale_by_any(struct draw *draw, int count, double *q)
{
    int least = 1100, most = -1100;
    for (int i = 0; i < count; i++) {
        if (q[i] == 0)
            continue;
        least = ilogb(q[i]) < least ? ilogb(q[i]) : least;
        most = ilogb(q[i]) > most ? ilogb(q[i]) : most;
    }
    const int by = draw_int(draw, -1022 - least, 1023 - most);
    for (int i = 0; i < count; i++)
        q[i] = ldexp(q[i], by);
}

static void draw_whole(struct draw *draw, int count, double *q)
{
    const int most = 1 << draw_int(draw, 0, 8);
    draw_integers(draw, count, -most, most, q);
}

static void draw_sphere(struct draw *draw, int count, double *q)
{
    for (int i = 0; i < count; i++)
        q[i] = draw_uniform(draw, -1, 1);
}

static void draw_far_apart(struct draw *draw, int count, double *q)
{
    for (int i = 0; i < count; i++)
        q[i] = draw_int(draw, 0, 4) ? draw_log(draw, -198, 0) : 0;
    q[draw_int(draw, 0, count - 1)] = draw_log(draw, 0, 0);
}

/* Nearly a turn by a multiple of a right angle about an axis, or about two. */
static void draw_nearly_quarter(struct draw *draw, int count, double *q)
{
    const double root = draw_coin(draw) ? sqrt(0.5) : cos(acos(-1) / 4);
    for (int i = 0; i < count; i++)
        q[i] = root * draw_int(draw, -1, 1);
    q[draw_int(draw, 0, count - 1)] = draw_coin(draw) ? 1 : root;
    for (int times = draw_int(draw, 0, 2); times > 0; times--) {
        double *one = &q[draw_int(draw, 0, count - 1)];
        *one = draw_coin(draw) ? *one * (1 + draw_int(draw, -2, 2) * 0x1p-52)
                               : *one + draw_log(draw, -60, -20);
    }
}

/* A yaw by any angle after a quarter turn about x, or the other way round: one row is exact. */
static void draw_yaw_and_roll(struct draw *draw, int count, double *q)
{
    const double w = draw_uniform(draw, -1, 1), z = draw_uniform(draw, -1, 1);
    const double sign = draw_coin(draw) ? 1 : -1;
    memcpy(q, (double[4]){w, z, 0, 0}, (size_t) count * sizeof *q);
    if (count == 4 && draw_coin(draw))
        memcpy(q, (double[4]){w, sign * w, sign * z, z}, 4 * sizeof *q);
    else if (count == 4 && draw_coin(draw))
        memcpy(q, (double[4]){w, 0, 0, z}, 4 * sizeof *q);
}

static void draw_orientation(struct draw *draw, int count, double *q)
{
    static void (*const kinds[])(struct draw * draw, int count, double *q) = {
        draw_whole, draw_sphere, draw_far_apart, draw_nearly_quarter, draw_yaw_and_roll};
    do {
        memset(q, 0, 4 * sizeof *q);
        kinds[draw_int(draw, 0, (int) COUNT(kinds) - 1)](draw, count, q);
        if (draw_coin(draw) && (q[0] != 0 || q[1] != 0 || q[2] != 0 || q[3] != 0))
            scale_by_any(draw, count, q);
    } while (!rotation_is_orientation(q, count));
}

static struct fmb_placement draw_turn(struct draw *draw, int dim)
{
    struct fmb_placement placement = {.orientation_count = dim == 3 ? 4 : 2};
    draw_orientation(draw, placement.orientation_count, placement.orientation);
    return placement;
}

/* ---- Rotations ---- */

/* The matrix of an orientation: its columns are the components of the unit cube, turned. */
static void exact_matrix(const struct fmb_placement *placement, int dim, struct rational_solid *out)
{
    static const double unit[2][9] = {{1, 0, 0, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    struct fmb_frame cube;
    assert_int_equal(fmb_frame_make(dim, FMB_CUBOID, unit[dim == 3], (size_t) (dim * dim), &cube),
                     FMB_OK);
    rational_solid_init(&cube, placement, out);
}

static void print_orientation(const struct fmb_placement *placement)
{
    const double *q = placement->orientation;
    printf("# orientation {%a, %a, %a, %a}, %d\n", q[0], q[1], q[2], q[3],
           placement->orientation_count);
}

/* The square of the Frobenius norm of the error of the matrix, in units of 2^-53. */
static double error_of(const struct rotation_matrix *rotation, struct rational_solid *exact)
{
    mpq_t error, sum;
    mpq_inits(error, sum, NULL);
    for (int k = 0; k < rotation->dim * rotation->dim; k++) {
        const int i = k / rotation->dim, j = k % rotation->dim;
        mpq_set_d(error, rotation_entry(rotation, i, j));
        mpq_sub(error, error, exact->column[j][i]);
        rational_add_product(sum, 1, error, error);
    }
    const double norm = sqrt(mpq_get_d(sum)) * 0x1p53;
    mpq_clears(error, sum, NULL);
    return norm;
}

static bool is_unit_row(struct rational_solid *exact, int dim, int row)
{
    int units = 0;
    for (int j = 0; j < dim; j++)
        units += mpq_cmp_si(exact->column[j][row], 1, 1) == 0 ||
                 mpq_cmp_si(exact->column[j][row], -1, 1) == 0;
    return units == 1;
}

/* Rows that are unit vectors, and no others, are said to be exact, and are. Returns how many. */
static int expect_exact_rows(const struct fmb_placement *placement,
                             const struct rotation_matrix *rotation, struct rational_solid *exact)
{
    int units = 0;
    for (int i = 0; i < rotation->dim; i++) {
        const bool unit = is_unit_row(exact, rotation->dim, i);
        bool same = true;
        for (int j = 0; j < rotation->dim; j++)
            same = same &&
                   (mpq_sgn(exact->column[j][i]) > 0) == (rotation_entry(rotation, i, j) > 0) &&
                   (mpq_sgn(exact->column[j][i]) < 0) == (rotation_entry(rotation, i, j) < 0);
        if (rotation->axis_exact[i] != unit || (unit && !same)) {
            print_orientation(placement);
            fail_msg("row %d: exact %d, expected %d", i, rotation->axis_exact[i], unit);
        }
        units += unit;
    }
    assert_int_equal(rotation->exact, units == rotation->dim);
    return units;
}

static void rotations_are_within_their_bound(void **state)
{
    struct draw draw;
    double worst = 0;
    long of_units[FMB_DIM_MAX + 1] = {0};
    draw_begin(&draw, "rotations_are_within_their_bound");
    for (long n = draw_sample(100000); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3);
        const struct fmb_placement placement = draw_turn(&draw, dim);
        struct rotation_matrix rotation;
        struct rational_solid exact;
        rotation_of(&placement, dim, &rotation);
        exact_matrix(&placement, dim, &exact);
        const int units = expect_exact_rows(&placement, &rotation, &exact);
        const double error = error_of(&rotation, &exact);
        if (!(error <= 17.5)) { /* 15.9 and 1.5 of rotation.h */
            print_orientation(&placement);
            fail_msg("an error of %g units", error);
        }
        if (units == dim)
            assert_true(error == 0);
        worst = fmax(worst, error);
        of_units[dim == 3 ? units : 0]++;
        rational_solid_clear(&exact);
    }
    printf(
        "# largest error %.3g units in the last place of 1; rows exact: %ld none, %ld one, %ld "
        "all\n",
        worst, of_units[0], of_units[1], of_units[3]);
    assert_true(worst > 1 && of_units[0] > 0 && of_units[1] > 0 && of_units[3] > 0);
}

/* The 24 of a cube, each from its quaternion and its negative, at any length. */
static void turns_of_a_cube_are_exact(void **state)
{
    struct draw draw;
    int found = 0;
    draw_begin(&draw, "turns_of_a_cube_are_exact");
    for (int k = 0; k < 81; k++) {
        const double q[4] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 % 3 - 1, k / 27 - 1};
        const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (square != 1 && square != 2 && square != 4)
            continue;
        found++;
        for (int n = 0; n < 40; n++) {
            struct fmb_placement placement = {.orientation_count = 4};
            struct rotation_matrix rotation;
            struct rational_solid exact;
            const double length = n ? draw_log(&draw, -1060, 1022) : 1;
            for (int i = 0; i < 4; i++)
                placement.orientation[i] = length * q[i];
            rotation_of(&placement, 3, &rotation);
            exact_matrix(&placement, 3, &exact);
            assert_int_equal(expect_exact_rows(&placement, &rotation, &exact), 3);
            assert_true(error_of(&rotation, &exact) == 0);
            rational_solid_clear(&exact);
        }
    }
    assert_int_equal(found, 2 * 24);
}

static void no_orientation_is_the_identity(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct fmb_placement placement = {.orientation_count = 0};
        struct rotation_matrix rotation;
        rotation_of(&placement, dim, &rotation);
        assert_true(rotation.exact && !rotation.turned);
        for (int k = 0; k < dim * dim; k++)
            assert_true(rotation_entry(&rotation, k / dim, k % dim) == (k / dim == k % dim));
    }
}

/* ---- Frames ---- */

typedef double number_function(struct draw *draw);

static double eighth(struct draw *draw)
{
    return draw_int(draw, -16, 16) / 8.0;
}

static double tenth(struct draw *draw)
{
    return 0.1 * draw_int(draw, -9, 9);
}

static double any_of_one_size(struct draw *draw)
{
    return draw_uniform(draw, -1, 1);
}

static double of_many_sizes(struct draw *draw)
{
    return draw_int(draw, 0, 4) ? draw_log(draw, -40, 40) : 0;
}

static double of_every_size(struct draw *draw)
{
    return draw_int(draw, 0, 4) ? draw_log(draw, -1074, 900) : 0;
}

static double least(struct draw *draw)
{
    return draw_int(draw, -6, 6) * 0x1p-1074;
}

static number_function *const number_kinds[] = {eighth,        tenth,         any_of_one_size,
                                                of_many_sizes, of_every_size, least};

static void draw_numbers(struct draw *draw, number_function *number, size_t count, double *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = number(draw);
}

static void make(struct draw *draw, int dim, int shape, struct fmb_body *out)
{
    double number[4 * FMB_DIM_MAX];
    number_function *kind = number_kinds[draw_int(draw, 0, (int) COUNT(number_kinds) - 1)];
    const int components = fmb_component_count(dim, shape);
    size_t count = (size_t) (shape == FMB_BOX ? dim : components * dim);
    const bool vertices = (shape == FMB_TETRAHEDRON || shape == FMB_FACE) && draw_coin(draw);
    const bool origin = vertices || draw_int(draw, 0, 3) > 0;
    count += origin ? (size_t) dim : 0;
    draw_numbers(draw, kind, count, number);
    for (size_t i = origin ? (size_t) dim : 0; i < count && shape == FMB_BOX; i++)
        number[i] = fabs(number[i]);
    assert_int_equal(
        (vertices ? fmb_body_make_vertices : fmb_body_make)(dim, shape, number, count, out),
        FMB_OK);
}

/* Turned or not, at any place. */
static void draw_placed(struct draw *draw, struct fmb_body *body, struct fmb_placement *out)
{
    const int dim = draw_int(draw, 2, 3);
    int shape;
    do
        shape = draw_int(draw, FMB_CUBOID, FMB_BOX);
    while (fmb_component_count(dim, shape) == 0);
    make(draw, dim, shape, body);
    *out = draw_int(draw, 0, 3) ? draw_turn(draw, dim) : (struct fmb_placement){.body = NULL};
    out->body = body;
    if (draw_int(draw, 0, 3))
        draw_numbers(draw, number_kinds[draw_int(draw, 0, (int) COUNT(number_kinds) - 1)],
                     (size_t) dim, out->position);
    if (draw_int(draw, 0, 3) == 0)
        out->position[draw_int(draw, 0, dim - 1)] = draw_log(draw, 30, 50);
    if (draw_coin(draw))
        draw_numbers(draw, tenth, (size_t) dim, out->velocity);
}

static void print_placed(const struct fmb_placement *placement)
{
    const struct fmb_frame *frame = &placement->body->one;
    const double *p = placement->position, *o = frame->origin;
    print_orientation(placement);
    printf(
        "# %dD %s, rounded %d, in range %d, sturdy %d; position {%a, %a, %a}, origin {%a, %a, "
        "%a}\n",
        frame->dim, fmb_shape_name((int) frame->shape), frame->rounded, frame->in_range,
        frame->sturdy, p[0], p[1], p[2], o[0], o[1], o[2]);
    for (int i = 0; i < frame->count; i++)
        printf("# component {%a, %a, %a}\n", frame->component[i][0], frame->component[i][1],
               frame->component[i][2]);
}

/* ---- Errors of prepared frames ---- */

/* The difference of a prepared frame from the true one: of its origin and of its components. */
struct difference {
    int dim, count;
    bool simplex;
    mpq_t origin[FMB_DIM_MAX], component[FMB_DIM_MAX][FMB_DIM_MAX];
};

static void difference_init(const struct fmb_prepared *prepared, struct rational_solid *exact,
                            struct difference *out)
{
    const double *number = prepared->number;
    out->dim = prepared->frame->dim;
    out->count = prepared->frame->count;
    out->simplex = exact->hull;
    for (int k = 0; k < (1 + FMB_DIM_MAX) * FMB_DIM_MAX; k++) {
        const int i = k / FMB_DIM_MAX - 1, axis = k % FMB_DIM_MAX;
        mpq_t *to = i < 0 ? &out->origin[axis] : &out->component[i][axis];
        mpq_init(*to);
        if (i >= out->count || axis >= out->dim)
            continue;
        mpq_set_d(*to, number[out->dim * (1 + i) + axis]);
        mpq_sub(*to, *to, i < 0 ? exact->origin[axis] : exact->column[i][axis]);
    }
}

static void difference_clear(struct difference *difference)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_clear(difference->origin[axis]);
        for (int i = 0; i < FMB_DIM_MAX; i++)
            mpq_clear(difference->component[i][axis]);
    }
}

/* The largest distance of any vertex from the true one, squared. Vertex number v has component i
 * where bit i is set; a simplex has at most one. */
static void farthest_vertex(struct difference *difference, mpq_t out)
{
    mpq_t at, square;
    mpq_inits(at, square, NULL);
    mpq_set_ui(out, 0, 1);
    for (int v = 0; v < 1 << difference->count; v++) {
        if (difference->simplex && (v & (v - 1)))
            continue;
        mpq_set_ui(square, 0, 1);
        for (int axis = 0; axis < difference->dim; axis++) {
            mpq_set(at, difference->origin[axis]);
            for (int i = 0; i < difference->count; i++)
                if (v & 1 << i)
                    mpq_add(at, at, difference->component[i][axis]);
            rational_add_product(square, 1, at, at);
        }
        if (mpq_cmp(square, out) > 0)
            mpq_set(out, square);
    }
    mpq_clears(at, square, NULL);
}

/* sqrt(square) / bound; 0 if both are 0, infinite if only bound is. */
static double ratio_of(const mpq_t square, double bound)
{
    mpq_t limit;
    if (mpq_sgn(square) == 0)
        return 0;
    if (!isfinite(bound))
        return 0;
    if (bound == 0)
        return HUGE_VAL;
    mpq_init(limit);
    mpq_set_d(limit, bound);
    mpq_mul(limit, limit, limit);
    mpq_div(limit, square, limit);
    const double ratio = sqrt(mpq_get_d(limit));
    mpq_clear(limit);
    return ratio;
}

/* Whether the origin of a box is exactly centre - size / 2. */
static bool has_exact_origin(const struct fmb_frame *frame)
{
    mpq_t sum, term;
    bool exact = true;
    mpq_inits(sum, term, NULL);
    for (int axis = 0; axis < frame->dim && frame->shape == FMB_BOX; axis++) {
        mpq_set_d(sum, frame->component[axis][axis]);
        for (int twice = 0; twice < 2; twice++) {
            mpq_set_d(term, frame->origin[axis]);
            mpq_add(sum, sum, term);
            mpq_set_d(term, frame->centre[axis]);
            mpq_sub(sum, sum, term);
        }
        exact = exact && mpq_sgn(sum) == 0;
    }
    mpq_clears(sum, term, NULL);
    return exact;
}

/* Whether no operation of placing rounds: axes are only exchanged, and the origin is exact. */
static bool is_exactly_placed(const struct fmb_placement *placement, struct difference *difference)
{
    struct rotation_matrix rotation;
    rotation_of(placement, difference->dim, &rotation);
    const struct fmb_frame *frame = &placement->body->one;
    bool exact = rotation.exact && !frame->rounded && has_exact_origin(frame);
    for (int axis = 0; axis < difference->dim; axis++)
        exact = exact && mpq_sgn(difference->origin[axis]) == 0;
    return exact;
}

struct seen {
    long exact, with_error, exact_axes, centred_axes;
    double worst, worst_size, worst_turn;
};

/* On axes that are said to be exact nothing is off. */
static void expect_exact_axes(const struct fmb_placement *placement,
                              const struct fmb_prepared *prepared, struct difference *difference,
                              struct seen *seen)
{
    for (int axis = 0; axis < difference->dim; axis++) {
        if (!(prepared_kind(prepared) & PREPARED_EXACT_X << axis))
            continue;
        bool same = mpq_sgn(difference->origin[axis]) == 0;
        for (int i = 0; i < difference->count; i++)
            same = same && mpq_sgn(difference->component[i][axis]) == 0;
        if (!same) {
            print_placed(placement);
            fail_msg("axis %d is said to be exact", axis);
        }
        seen->exact_axes += prepared_error(prepared) != 0;
    }
}

/* A box with PREPARED_CENTRED: the centre of its true extent, twice, and one component along it. */
static void expect_centred(const struct fmb_placement *placement,
                           const struct fmb_prepared *prepared, struct rational_solid *exact,
                           struct difference *difference, struct seen *seen)
{
    mpq_t twice, term;
    mpq_inits(twice, term, NULL);
    for (int axis = 0; axis < difference->dim; axis++) {
        if (!(prepared_kind(prepared) & PREPARED_CENTRED) ||
            !(prepared_kind(prepared) & PREPARED_COMPONENTS_EXACT_X << axis))
            continue;
        int along = 0;
        bool same = true;
        mpq_add(twice, exact->origin[axis], exact->origin[axis]);
        for (int i = 0; i < difference->count; i++) {
            same = same && mpq_sgn(difference->component[i][axis]) == 0;
            along += mpq_sgn(exact->column[i][axis]) != 0;
            mpq_add(twice, twice, exact->column[i][axis]);
        }
        const double at[2] = {placement->position[axis], prepared->frame->centre[axis]};
        for (int k = 0; k < 4; k++) {
            mpq_set_d(term, at[k % 2]);
            mpq_sub(twice, twice, term);
        }
        if (!same || along > 1 || mpq_sgn(twice) != 0) {
            print_placed(placement);
            fail_msg("axis %d: not about position + centre", axis);
        }
        seen->centred_axes++;
    }
    mpq_clears(twice, term, NULL);
}

static void expect_error(const struct fmb_placement *placement, const struct fmb_prepared *prepared,
                         struct difference *difference, struct seen *seen)
{
    const double error = prepared_error(prepared);
    mpq_t square;
    mpq_init(square);
    farthest_vertex(difference, square);
    const double ratio = ratio_of(square, error);
    mpq_clear(square);
    if (!(ratio <= 1)) {
        print_placed(placement);
        fail_msg("a vertex is %g times the error %a away", ratio, error);
    }
    seen->worst = fmax(seen->worst, ratio);
    seen->exact += error == 0;
    seen->with_error += error != 0;
    if (is_exactly_placed(placement, difference) && error != 0) {
        print_placed(placement);
        fail_msg("an error of %a, and nothing was rounded", error);
    }
}

/* out := the square of the length of a vector. */
static void set_square(mpq_t out, mpq_t vector[FMB_DIM_MAX])
{
    mpq_set_ui(out, 0, 1);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        rational_add_product(out, 1, vector[axis], vector[axis]);
}

/* Of frames that doubles can decide: no component is longer than its size says, or farther from the
 * true one than turn times that. */
static void expect_sizes(const struct fmb_placement *placement, const struct fmb_prepared *prepared,
                         struct rational_solid *exact, struct difference *difference,
                         struct seen *seen)
{
    struct world_frame world;
    mpq_t square;
    if (!(prepared_kind(prepared) & PREPARED_USABLE))
        return;
    world_frame_of(prepared, &world);
    mpq_init(square);
    for (int i = 0; i < prepared->frame->count; i++) {
        const double size = prepared_size(prepared->summary, i);
        set_square(square, exact->column[i]);
        const double of_size = ratio_of(square, size);
        set_square(square, difference->component[i]);
        const double of_turn = ratio_of(square, world.relative_error * size);
        if (!(of_size <= 1 && of_size >= 0.9 && of_turn <= 1)) {
            print_placed(placement);
            fail_msg("component %d: %.17g of its size, error %g of the bound", i, of_size, of_turn);
        }
        seen->worst_size = fmax(seen->worst_size, of_size);
        seen->worst_turn = fmax(seen->worst_turn, of_turn);
    }
    mpq_clear(square);
}

/* The box over a window holds all true vertices at all its times. */
static void expect_box(const struct fmb_placement *placement, const struct fmb_prepared *prepared,
                       struct rational_solid *exact, double duration)
{
    double box[2][FMB_DIM_MAX];
    mpq_t end, window, bound;
    mpq_inits(end, window, bound, NULL);
    mpq_set_d(window, duration);
    fmb_box_of(prepared, duration, box);
    for (int k = 0; k < 2 * prepared->frame->dim; k++) {
        const int axis = k / 2, sign = k % 2 ? 1 : -1;
        const double x = sign * box[k % 2][axis];
        rational_solid_farthest(exact, window, axis, sign, end);
        mpq_set_d(bound, isfinite(x) ? x : 0);
        if (isnan(x) || x == -INFINITY || (x < INFINITY && mpq_cmp(bound, end) < 0)) {
            print_placed(placement);
            fail_msg("axis %d: the box ends at %a, inside of the frame", axis, sign * x);
        }
    }
    mpq_clears(end, window, bound, NULL);
}

static void errors_hold_all_vertices(void **state)
{
    struct draw draw;
    struct seen seen = {0};
    draw_begin(&draw, "errors_hold_all_vertices");
    for (long n = draw_sample(60000); n > 0; n--) {
        struct fmb_body body;
        struct fmb_placement placement;
        struct fmb_prepared prepared;
        struct rational_solid exact;
        struct difference difference;
        draw_placed(&draw, &body, &placement);
        assert_int_equal(fmb_prepare(&placement, 0, 1, &prepared), FMB_OK);
        rational_solid_init(&body.one, &placement, &exact);
        difference_init(&prepared, &exact, &difference);
        expect_error(&placement, &prepared, &difference, &seen);
        expect_exact_axes(&placement, &prepared, &difference, &seen);
        expect_centred(&placement, &prepared, &exact, &difference, &seen);
        expect_sizes(&placement, &prepared, &exact, &difference, &seen);
        expect_box(&placement, &prepared, &exact, draw_coin(&draw) ? 0 : 3);
        difference_clear(&difference);
        rational_solid_clear(&exact);
    }
    printf(
        "# %ld without an error, %ld with; at most %.3g of it; sizes at most %.17g, turns %.3g\n",
        seen.exact, seen.with_error, seen.worst, seen.worst_size, seen.worst_turn);
    assert_true(seen.exact > 0 && seen.with_error > 0 && seen.exact_axes > 0 && seen.worst > 0.25);
    assert_true(seen.centred_axes > 0 && seen.worst_size > 0.999 && seen.worst_turn > 0.05);
}

/* A search found it: the origin of the frame is off by more than most, by 0.4 of the error. */
static void the_error_holds_an_unlucky_vertex(void **state)
{
    static const double number[] = {-0x1.93a4a4446c833p-5,
                                    -0x1.03a280a60335ap-1,
                                    0x1.4b79a7628e95ep-5,
                                    0x1p-30,
                                    0,
                                    0,
                                    0,
                                    0x1p-30,
                                    0,
                                    0,
                                    0,
                                    0x1p-30};
    struct fmb_body body;
    const struct fmb_placement placement = {
        .body = &body,
        .orientation = {0x1.7b529bd80b7eep-4, 0x1.3327ee42664ep-5, 0x1.905da2e720bb4p-1,
                        0x1.788e4fdef11cap-1},
        .orientation_count = 4};
    struct fmb_prepared prepared;
    struct rational_solid exact;
    struct difference difference;
    struct seen seen = {0};
    assert_int_equal(fmb_body_make(3, FMB_TETRAHEDRON, number, COUNT(number), &body), FMB_OK);
    assert_int_equal(fmb_prepare(&placement, 0, 1, &prepared), FMB_OK);
    rational_solid_init(&body.one, &placement, &exact);
    difference_init(&prepared, &exact, &difference);
    expect_error(&placement, &prepared, &difference, &seen);
    printf("# %.3g of the error\n", seen.worst);
    assert_true(seen.worst > 0.35);
    difference_clear(&difference);
    rational_solid_clear(&exact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_are_within_their_bound),
        cmocka_unit_test(turns_of_a_cube_are_exact),
        cmocka_unit_test(no_orientation_is_the_identity),
        cmocka_unit_test(errors_hold_all_vertices),
        cmocka_unit_test(the_error_holds_an_unlucky_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
