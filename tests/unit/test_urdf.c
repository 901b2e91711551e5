/* Robots of URDF files: enclosing hulls contain their shapes, exactly; hulls have the right
 * vertices; poses of links agree with an independent computation. Arguments and output:
 * cli/scene.bats. */
#include "unit.h"

#include "draw.h"
#include "enclosure.h"
#include "mesh_hull.h"
#include "rational_solid.h"
#include "robot_scene.h"
#include "turn.h"

#include <float.h>
#include <math.h>
#include <unistd.h>

/* ---- Robots ---------------------------------------------------------------------------------- */

/* Reads a robot from a file with this text. */
static void read_text(const char *text, struct robot *out)
{
    char path[] = "/tmp/test_urdf-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
    close(fd);
    const bool good = robot_read(path, out);
    unlink(path);
    assert_true(good);
}

/* ---- Enclosures ------------------------------------------------------------------------------ */

/* A hull that should contain a solid about the z axis: its vertices relative to the centre of the
 * solid, turned back, are rings about that axis. */
struct rings {
    int sides, count;
    struct rational_solid solid; /* columns: vertices */
};

/* In: origin: of the element, in the body. */
static void rings_init(const struct fmb_frame *hull, const struct pose *origin, int sides,
                       struct rings *out)
{
    const struct fmb_placement back = {
        .orientation = {origin->q[0], -origin->q[1], -origin->q[2], -origin->q[3]},
        .orientation_count = 4};
    double memory[64];
    struct fmb_frame point;
    struct rational_solid centre;
    assert_int_equal(fmb_frame_make_hull(3, origin->p, 3, memory, &point), FMB_OK);
    rational_solid_init(&point, &back, &centre);
    rational_solid_init(hull, &back, &out->solid);
    out->sides = sides;
    out->count = out->solid.count / sides;
    assert_int_equal(out->solid.count, sides * out->count);
    for (int i = 0; i < out->solid.count; i++)
        for (int axis = 0; axis < 3; axis++)
            mpq_sub(out->solid.column[i][axis], out->solid.column[i][axis], centre.column[0][axis]);
    rational_solid_clear(&centre);
}

static mpq_t *at(struct rings *rings, int ring, int i)
{
    return rings->solid.column[ring * rings->sides + i % rings->sides];
}

/* n := (b - a) x (c - a). */
static void set_normal(mpq_t *a, mpq_t *b, mpq_t *c, rational_vector n)
{
    rational_vector u, v;
    rational_vector_init(u);
    rational_vector_init(v);
    for (int axis = 0; axis < 3; axis++) {
        mpq_sub(u[axis], b[axis], a[axis]);
        mpq_sub(v[axis], c[axis], a[axis]);
    }
    for (int axis = 0; axis < 3; axis++) {
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        mpq_set_ui(n[axis], 0, 1);
        rational_add_product(n[axis], 1, u[j], v[k]);
        rational_add_product(n[axis], -1, u[k], v[j]);
    }
    rational_vector_clear(u);
    rational_vector_clear(v);
}

/* Whether a solid is on the inner side of the plane of three points, which faces away from the
 * centre: n.a >= radius |n_xy| + length / 2 |n_z|. */
static bool is_inside(mpq_t *a, mpq_t *b, mpq_t *c, double radius, double length)
{
    rational_vector n;
    mpq_t square, left, factor;
    rational_vector_init(n);
    mpq_inits(square, left, factor, NULL);
    set_normal(a, b, c, n);
    rational_dot(left, n, a);
    mpq_set_d(factor, length);
    mpq_div_2exp(factor, factor, 1);
    mpq_abs(n[2], n[2]);
    rational_add_product(left, -1, factor, n[2]);
    mpq_set_ui(n[2], 0, 1);
    bool good = mpq_sgn(left) >= 0;
    mpq_mul(left, left, left);
    rational_dot(square, n, n);
    mpq_set_d(factor, radius);
    mpq_mul(square, square, factor);
    mpq_mul(square, square, factor);
    good = good && mpq_cmp(left, square) >= 0;
    mpq_clears(square, left, factor, NULL);
    rational_vector_clear(n);
    return good;
}

/* The faces between rings, as triangles, and the fans of both ends form a closed surface within the
 * hull, around the centre. The solid is inside if it is on the inner side of each triangle. */
static bool contains(struct rings *rings, double radius, double length)
{
    const int up = mpq_cmp(at(rings, 0, 0)[2], at(rings, rings->count - 1, 0)[2]) < 0;
    const int first = up ? 0 : rings->count - 1, step = up ? 1 : -1,
              last = rings->count - 1 - first;
    for (int i = 0; i < rings->sides; i++) {
        for (int ring = first; ring != last; ring += step) {
            mpq_t *a = at(rings, ring, i), *b = at(rings, ring, i + 1);
            mpq_t *c = at(rings, ring + step, i + 1), *d = at(rings, ring + step, i);
            if (!is_inside(a, b, c, radius, length) || !is_inside(a, c, d, radius, length))
                return false;
        }
        if (i >= 2 && (!is_inside(at(rings, first, 0), at(rings, first, i), at(rings, first, i - 1),
                                  radius, length) ||
                       !is_inside(at(rings, last, 0), at(rings, last, i - 1), at(rings, last, i),
                                  radius, length)))
            return false;
    }
    return true;
}

/* The largest distance of a vertex from the solid, in doubles. */
static double distance_outside(struct rings *rings, double radius, double length, double rounding)
{
    double most = 0;
    for (int i = 0; i < rings->solid.count; i++) {
        double x[3];
        for (int axis = 0; axis < 3; axis++)
            x[axis] = mpq_get_d(rings->solid.column[i][axis]);
        most = fmax(most, sqrt(x[0] * x[0] + x[1] * x[1]) - radius);
        assert_true(fabs(x[2]) <= length / 2 + rounding);
    }
    return most;
}

/* Whether the sides and ends that face the axes are where the cylinder ends; if it is shifted, at
 * most a rounding outside it. */
static void check_resting(const struct fmb_frame *hull, const double half[3],
                          const double centre[3], bool alone)
{
    double numbers[6 * ENCLOSURE_SIDES_MAX];
    bool by_vertices;
    const size_t count = fmb_frame_numbers(hull, &by_vertices, numbers, COUNT(numbers));
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            double most = -INFINITY;
            mpq_t exact, found;
            for (size_t i = 0; i < count; i += 3)
                most = fmax(most, side * numbers[i + axis]);
            mpq_inits(exact, found, NULL);
            mpq_set_d(exact, alone ? 0 : side * centre[axis]);
            mpq_set_d(found, half[axis]);
            mpq_add(exact, exact, found);
            mpq_set_d(found, most);
            assert_true(mpq_cmp(found, exact) >= 0);
            mpq_set_d(found, alone ? most : nextafter(most, -INFINITY));
            assert_true(alone ? mpq_equal(found, exact) : mpq_cmp(found, exact) < 0);
            mpq_clears(exact, found, NULL);
        }
}

/* A cylinder, alone in its link or beside a box. */
static void check_enclosure(int sides, double radius, double length, const double origin[6],
                            bool alone)
{
    char text[1024];
    struct robot robot;
    struct pose pose, placed = POSE_IDENTITY;
    struct owned_scene scene = {.dim = 3};
    const struct fmb_robot_options options = {.sides = sides};
    snprintf(text, sizeof text,
             "<robot><link name='a'><collision><origin xyz='%.17g %.17g %.17g' rpy='%.17g %.17g "
             "%.17g'/><geometry><cylinder radius='%.17g' length='%.17g'/></geometry></collision>"
             "%s</link></robot>",
             origin[0], origin[1], origin[2], origin[3], origin[4], origin[5], radius, length,
             alone ? "" : "<collision><geometry><box size='1 1 1'/></geometry></collision>");
    read_text(text, &robot);
    struct robot_meshes meshes = {0};
    const struct fmb_body *body =
        robot_body(&robot, &robot.links[0], &options, &scene, &meshes, &pose);
    assert_non_null(body);
    if (!alone) {
        assert_memory_equal(&pose, &placed, sizeof pose);
        placed = robot.elements[0].origin;
    }
    struct rings rings;
    rings_init(fmb_body_frame(body, 0), &placed, sides, &rings);
    if (!contains(&rings, radius, length))
        fail_msg("%d sides do not enclose: %s", sides, text);
    const bool upright = alone || (origin[3] == 0 && origin[4] == 0 && origin[5] == 0);
    if (length >= DBL_MIN && radius > 0x1p-900 && upright)
        check_resting(fmb_body_frame(body, 0), (const double[]){radius, radius, length / 2}, origin,
                      alone);
    double rounding = radius + length;
    for (int i = 0; i < 3; i++)
        rounding += fabs(origin[i]);
    rounding = 1e-12 * rounding + 0x1p-980;
    const double found = distance_outside(&rings, radius, length, rounding);
    assert_true(fabs(found - scene.outside) <= rounding); /* a bound that is reached */
    rational_solid_clear(&rings.solid);
    scene_clear(&scene);
    robot_clear(&robot);
}

static void hulls_enclose_cylinders(void **state)
{
    struct draw draw;
    draw_begin(&draw, "enclosures");
    const long count = draw_sample(120);
    for (long i = 0; i < count; i++) {
        const int large = i % 16 == 0;
        const int sides = 4 * draw_int(&draw, 1, large ? 12 : 4);
        const int size = draw_coin(&draw) ? 300 : 3;
        const double radius = fabs(draw_log(&draw, -size, size));
        const double length = fabs(draw_log(&draw, -size, size));
        double origin[6];
        for (int k = 0; k < 3; k++) {
            const bool turned = i % 2 == 0;
            origin[k] = turned ? draw_log(&draw, -size, size) : radius * draw_uniform(&draw, -9, 9);
            origin[k + 3] = turned ? draw_uniform(&draw, -7, 7) : 0;
        }
        check_enclosure(sides, radius, length, origin, draw_coin(&draw));
    }
}

/* The numbers are subnormal: their rounding errors are absolute, not relative. */
static void the_smallest_shapes_are_enclosed(void **state)
{
    static const double tiny[] = {DBL_TRUE_MIN, 3 * DBL_TRUE_MIN, DBL_MIN, 0x1p-1000};
    const double origin[6] = {DBL_TRUE_MIN, 0, -DBL_MIN, 0.1, 0.2, 0.3};
    for (size_t i = 0; i < COUNT(tiny); i++)
        for (int alone = 0; alone < 2; alone++)
            check_enclosure(16, tiny[i], tiny[(i + 1) % COUNT(tiny)], origin, alone);
}

/* ---- Hulls ----------------------------------------------------------------------------------- */

enum { POINTS_MAX = 4096 };

static double (*points)[3];
static size_t point_count;

static int setup(void **state)
{
    points = calloc(POINTS_MAX, sizeof *points);
    return points == NULL;
}

static int teardown(void **state)
{
    free(points);
    return 0;
}

static void add_point(double x, double y, double z)
{
    assert_true(point_count < POINTS_MAX);
    points[point_count][0] = x;
    points[point_count][1] = y;
    points[point_count++][2] = z;
}

/* Decides by the exact method whether a point is in the rounded hull. */
static bool is_in_rounded(const double (*vertex)[3], size_t count, double radius,
                          const double point[3])
{
    static double memory[8192], point_memory[64];
    struct fmb_body hull, single;
    struct fmb_answer answer;
    const struct fmb_placement a = {.body = &hull}, b = {.body = &single};
    assert_int_equal(fmb_body_make_hull(3, vertex[0], 3 * count, memory, &hull), FMB_OK);
    assert_int_equal(fmb_body_inflate(&hull, radius), FMB_OK);
    assert_int_equal(fmb_body_make_hull(3, point, 3, point_memory, &single), FMB_OK);
    assert_int_equal(fmb_decide(fmb_method_by_name("exact"), &a, &b, 0, 0, &answer), FMB_OK);
    return answer.verdict != FMB_SEPARATED;
}

static bool is_in_hull(const double (*vertex)[3], size_t count, const double point[3])
{
    return is_in_rounded(vertex, count, 0, point);
}

/* Checks that the vertices are minimal and that their hull contains all points. Returns their
 * number. */
static size_t check_hull(void)
{
    static double vertex[FMB_HULL_VERTICES_MAX][3], others[FMB_HULL_VERTICES_MAX][3];
    size_t found;
    assert_int_equal(mesh_hull((const double(*)[3]) points, point_count, vertex, &found), FMB_OK);
    for (size_t i = 0; found > 0 && i < point_count; i++)
        assert_true(is_in_hull((const double(*)[3]) vertex, found, points[i]));
    for (size_t i = 0; found > 1 && i < found; i++) {
        memcpy(others, vertex, sizeof others);
        memmove(others + i, others + i + 1, (found - i - 1) * sizeof *others);
        assert_false(is_in_hull((const double(*)[3]) others, found - 1, vertex[i]));
    }
    point_count = 0;
    return found;
}

static void hulls_of_grids_keep_only_their_corners(void **state)
{
    static const int sizes[][3] = {{5, 5, 5}, {12, 12, 1}, {1, 9, 1}, {1, 1, 1}, {3, 1, 7}};
    static const size_t corners[] = {8, 4, 2, 1, 4};
    for (size_t s = 0; s < COUNT(sizes); s++) {
        for (int repeat = 0; repeat < 2; repeat++)
            for (int i = 0; i < sizes[s][0] * sizes[s][1] * sizes[s][2]; i++) {
                const double u = i % sizes[s][0], v = i / sizes[s][0] % sizes[s][1];
                const double w = i / sizes[s][0] / sizes[s][1];
                /* in inclined planes and lines, exactly */
                add_point(3 * u - v, u + 2 * v + w, 5 * w - 2 * u + v);
            }
        assert_int_equal(check_hull(), corners[s]);
    }
}

static void hulls_of_random_points_contain_them_all(void **state)
{
    struct draw draw;
    draw_begin(&draw, "hulls");
    const long count = draw_sample(40);
    for (long i = 0; i < count; i++) {
        const int n = draw_int(&draw, 1, 40), most = draw_int(&draw, 0, 3);
        double at[3];
        for (int k = 0; k < n; k++) {
            draw_integers(&draw, 3, -most, most, at);
            if (i % 3 == 0)
                at[0] = draw_uniform(&draw, -1, 1);
            add_point(at[0], at[1], at[0] + at[2]);
        }
        assert_true(check_hull() > 0);
    }
}

/* On a paraboloid every point of a grid is a vertex. */
static void hulls_of_too_many_vertices_are_refused(void **state)
{
    static double vertex[FMB_HULL_VERTICES_MAX][3];
    for (int extra = 0; extra < 2; extra++) {
        size_t found;
        for (int i = 0; i < 500; i++)
            add_point(15.5, 15.5, 500 + i * 0.125); /* inside */
        for (int i = 0; i < 32 * 32 + extra; i++) {
            const int u = i % 32, v = i / 32;
            add_point(u, v, u * u + v * v);
        }
        assert_int_equal(mesh_hull((const double(*)[3]) points, point_count, vertex, &found),
                         FMB_OK);
        assert_int_equal(found, extra ? 0 : FMB_HULL_VERTICES_MAX);
        point_count = 0;
    }
}

/* Checks that a cover has at most this many vertices, or this excess, and a tight radius. */
static void check_cover(size_t most, double excess)
{
    static double vertex[FMB_HULL_VERTICES_MAX][3];
    size_t found, next = 0, outside = 0;
    double radius;
    assert_int_equal(mesh_hull_cover((const double(*)[3]) points, point_count, most, excess, vertex,
                                     &found, &radius),
                     FMB_OK);
    assert_true(found >= 1 && found <= most && (radius <= excess || found == most));
    for (size_t i = 0; i < point_count; i++) {
        next += next < found && memcmp(vertex[next], points[i], sizeof points[i]) == 0;
        assert_true(is_in_rounded((const double(*)[3]) vertex, found, radius, points[i]));
        outside +=
            !is_in_rounded((const double(*)[3]) vertex, found, radius * (1 - 1e-6), points[i]);
    }
    assert_int_equal(next, found); /* in their order */
    assert_true(radius == 0 || outside > 0);
    point_count = 0;
}

static void covers_contain_all_points(void **state)
{
    struct draw draw;
    draw_begin(&draw, "covers");
    const long count = draw_sample(40);
    for (long i = 0; i < count; i++) {
        const int n = draw_int(&draw, 1, 40), extent = draw_int(&draw, 0, 3);
        const double scale = i % 4 == 0 ? 0x1p-300 : 1;
        double at[3];
        for (int k = 0; k < n; k++) {
            draw_integers(&draw, 3, -extent, extent, at);
            if (i % 3 == 0)
                at[0] = draw_uniform(&draw, -1, 1);
            add_point(scale * at[0], scale * at[1] / 3, scale * (at[0] + at[2]));
        }
        check_cover((size_t) draw_int(&draw, 1, 40), draw_int(&draw, 0, 2) * 0.5 * scale);
    }
    for (int i = 0; i < 40 * 40; i++)
        add_point(i % 40, i / 40, (i % 40) * (i % 40) + (i / 40) * (i / 40));
    check_cover(200, 0.25);
}

/* ---- Poses ----------------------------------------------------------------------------------- */

static void turns_by_multiples_of_45_degrees_are_even(void **state)
{
    const double pi = acos(-1);
    for (int eighths = -5; eighths <= 5; eighths++) {
        double turn[2], same[2];
        turn_radians(eighths * pi / 4, turn);
        turn_degrees(eighths * 45, same);
        assert_memory_equal(turn, same, sizeof turn);
        if (eighths % 2 != 0)
            assert_true(fabs(turn[0]) == fabs(turn[1]));
        else
            assert_true(turn[0] == 0 || turn[1] == 0);
        for (int side = -1; side <= 1; side += 2) { /* the next doubles are not */
            turn_radians(nextafter(eighths * pi / 4, side * INFINITY), same);
            assert_true(same[0] * same[1] != 0);
        }
    }
}

static void turns_agree_with_the_math_library(void **state)
{
    struct draw draw;
    draw_begin(&draw, "turns");
    const long count = draw_sample(100000);
    for (long i = 0; i < count; i++) {
        double turn[2];
        const double most = i % 2 ? 10 : TURN_RADIANS_MAX;
        const double radians = draw_uniform(&draw, -most, most);
        turn_radians(radians, turn);
        assert_true(fabsl(turn[0] - cosl((long double) radians)) <= TURN_ERROR);
        assert_true(fabsl(turn[1] - sinl((long double) radians)) <= TURN_ERROR);
        const double degrees = draw_uniform(&draw, -360, 360);
        const long double exact = degrees * (acosl(-1) / 180);
        turn_degrees(degrees, turn);
        assert_true(fabsl(turn[0] - cosl(exact)) <= TURN_ERROR);
        assert_true(fabsl(turn[1] - sinl(exact)) <= TURN_ERROR);
    }
}

/* The matrix of a turn about an axis of length 1 (Rodrigues), by the math library. */
static void set_matrix(const double axis[3], double angle, double out[3][3])
{
    const double c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int k = 3 - i - j;
            const double cross = i == j ? 0 : (j - i + 3) % 3 == 1 ? -axis[k] : axis[k];
            out[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j] + s * cross;
        }
}

/* matrix := matrix * turn. */
static void turn_by(double matrix[3][3], const double axis[3], double angle)
{
    double turn[3][3], out[3][3] = {{0}};
    set_matrix(axis, angle, turn);
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            out[i / 3][i % 3] += matrix[i / 3][k] * turn[k][i % 3];
    memcpy(matrix, out, sizeof out);
}

static void shift(double at[3], double matrix[3][3], const double by[3], double factor)
{
    for (int i = 0; i < 9; i++)
        at[i / 3] += factor * matrix[i / 3][i % 3] * by[i % 3];
}

/* A chain of joints of all types. The file has the links in the order of the chain, or reversed. */
static void poses_of_links_agree_with_matrices(void **state)
{
    static const char *const types[] = {"fixed", "revolute", "prismatic", "continuous"};
    static const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    enum { JOINTS = 8 };
    struct draw draw;
    draw_begin(&draw, "chains");
    const long count = draw_sample(50);
    for (long n = 0; n < count; n++) {
        static char text[1 << 14];
        char *end = text + sprintf(text, "<robot name='chain'>");
        double matrix[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, expected[3] = {0}, value[JOINTS];
        for (int i = 0; i <= JOINTS; i++)
            end += sprintf(end, "<link name='l%d'/>", n % 2 ? JOINTS - i : i);
        for (int i = 0; i < JOINTS; i++) {
            double xyz[3], rpy[3], axis[3], length = 0;
            for (int k = 0; k < 3; k++) {
                xyz[k] = draw_uniform(&draw, -1, 1);
                rpy[k] = draw_uniform(&draw, -4, 4);
                axis[k] = draw_uniform(&draw, -9, 9);
                length += axis[k] * axis[k];
            }
            const int type = draw_int(&draw, 0, 3);
            value[i] = draw_uniform(&draw, -3, 3);
            end += sprintf(end,
                           "<joint name='j%d' type='%s'><origin xyz='%.17g %.17g %.17g' "
                           "rpy='%.17g %.17g %.17g'/><parent link='l%d'/><child link='l%d'/>"
                           "<axis xyz='%.17g %.17g %.17g'/><limit lower='-3' upper='3'/></joint>",
                           i, types[type], xyz[0], xyz[1], xyz[2], rpy[0], rpy[1], rpy[2], i, i + 1,
                           axis[0], axis[1], axis[2]);
            for (int k = 0; k < 3; k++)
                axis[k] /= sqrt(length);
            shift(expected, matrix, xyz, 1);
            for (int k = 2; k >= 0; k--) /* R = Rz(yaw) Ry(pitch) Rx(roll) */
                turn_by(matrix, unit[k], rpy[k]);
            if (type == 2)
                shift(expected, matrix, axis, value[i]);
            else if (type != 0)
                turn_by(matrix, axis, value[i]);
        }
        strcpy(end, "</robot>");
        struct robot robot;
        struct pose pose[JOINTS + 1];
        read_text(text, &robot);
        robot_place(&robot, &POSE_IDENTITY, value, pose);
        const struct pose *last = &pose[n % 2 ? 0 : JOINTS];
        for (int k = 0; k < 3; k++) {
            double column[3] = {0, 0, 0};
            column[k] = 1;
            pose_apply(last, column);
            assert_true(fabs(last->p[k] - expected[k]) < 1e-13);
            for (int i = 0; i < 3; i++)
                assert_true(fabs(column[i] - last->p[i] - matrix[i][k]) < 1e-13);
        }
        robot_clear(&robot);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hulls_enclose_cylinders),
        cmocka_unit_test(the_smallest_shapes_are_enclosed),
        cmocka_unit_test(hulls_of_grids_keep_only_their_corners),
        cmocka_unit_test(hulls_of_random_points_contain_them_all),
        cmocka_unit_test(hulls_of_too_many_vertices_are_refused),
        cmocka_unit_test(covers_contain_all_points),
        cmocka_unit_test(turns_by_multiples_of_45_degrees_are_even),
        cmocka_unit_test(turns_agree_with_the_math_library),
        cmocka_unit_test(poses_of_links_agree_with_matrices),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
