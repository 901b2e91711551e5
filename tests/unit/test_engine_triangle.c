/* Faces by their vertices, exactly: pairs whose edges no double holds, against an oracle that reads
 * nothing but the vertices; their boxes, and trees of boxes. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <limits.h>
#include <math.h>

#include "allocate.h"
#include "batch.h"
#include "draw.h"
#include "fmb_batch.h"
#include "placed_pair.h"
#include "triangles.h"

/* ---- Points ---- */

/* A kind of numbers that coordinates are made of. */
typedef double numbers(struct draw *draw);

static double whole(struct draw *draw)
{
    return draw_int(draw, 0, 3);
}

static double tenth(struct draw *draw)
{
    return draw_int(draw, -12, 12) * 0.1;
}

static double tenth_of_thousands(struct draw *draw)
{
    return draw_int(draw, -12, 12) * 0.1 * 1000 + draw_int(draw, -3, 3) * 0.1;
}

/* What is subtracted from it loses its last bits, or all of them. */
static double of_two_sizes(struct draw *draw)
{
    static const int exponent[] = {0, 0, 0, 20, 40, 52, 53, 54, 60, -20, -53, -60};
    return ldexp(draw_int(draw, -3, 3), exponent[draw_int(draw, 0, (int) COUNT(exponent) - 1)]);
}

/* Each with a last place of its own, on both sides of 0. */
static double full_mantissa(struct draw *draw)
{
    return draw_log(draw, -4, 0);
}

/* A grid with holes of an ulp. */
static double near_whole(struct draw *draw)
{
    const double x = draw_int(draw, -2, 2);
    switch (draw_int(draw, 0, 5)) {
    case 0: return nextafter(x, HUGE_VAL);
    case 1: return nextafter(x, -HUGE_VAL);
    case 2: return x + 0x1p-52;
    default: return x;
    }
}

/* From one far out, near ones that differ by an ulp seem to be the same. */
static double hidden(struct draw *draw)
{
    static const double some[] = {
        0x1p54, 0, 1, 0.5, 0.1, 0x1.999999999999bp-4, 0x1.9999999999999p-4};
    return some[draw_int(draw, 0, (int) COUNT(some) - 1)];
}

static double sparse(struct draw *draw)
{
    return draw_int(draw, 0, 3) ? draw_int(draw, -1, 1) : full_mantissa(draw);
}

static double of_every_size(struct draw *draw)
{
    return draw_int(draw, 0, 2) ? draw_log(draw, -200, 200) : draw_int(draw, -1, 1);
}

static numbers *const all_numbers[] = {whole,        tenth,         tenth_of_thousands,
                                       of_two_sizes, full_mantissa, near_whole,
                                       sparse,       of_every_size, hidden};

enum { POOL = 10 };

typedef double point[3];

/* What is not drawn is made of what was: on a line or a face of earlier points, as near as rounding
 * lets it, or an ulp beside one. So drawn triangles share vertices and edges, lie in one plane or
 * nearly, and meet within edges and faces. */
static void derive_point(struct draw *draw, point *pool, int count, double out[3])
{
    const double *p = pool[draw_int(draw, 0, count - 1)], *q = pool[draw_int(draw, 0, count - 1)];
    const double *r = pool[draw_int(draw, 0, count - 1)];
    const int kind = draw_int(draw, 0, 7);
    const double s = draw_int(draw, -2, 6) * 0.25, t = draw_int(draw, 0, 4) * 0.25;
    for (int axis = 0; axis < 3; axis++)
        switch (kind) {
        case 0: out[axis] = p[axis] * 0.5 + q[axis] * 0.5; break;
        case 1: out[axis] = p[axis] + s * (q[axis] - p[axis]); break;
        case 2: out[axis] = p[axis] + t * (q[axis] - p[axis]) + s * (r[axis] - p[axis]); break;
        case 3: out[axis] = p[axis] + q[axis] - r[axis]; break;
        case 4: out[axis] = axis == 2 ? q[axis] : p[axis]; break;
        default: out[axis] = p[axis]; break;
        }
    if (kind == 7 || draw_int(draw, 0, 3) == 0) {
        double *x = &out[draw_int(draw, 0, 2)];
        *x = nextafter(*x, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
    }
}

static void draw_pool(struct draw *draw, point *pool)
{
    numbers *const number = all_numbers[draw_int(draw, 0, (int) COUNT(all_numbers) - 1)];
    const int drawn = draw_int(draw, 4, 7);
    const double flat = number(draw);
    const bool in_plane = draw_int(draw, 0, 4) == 0;
    for (int i = 0; i < POOL; i++) {
        if (i >= drawn) {
            derive_point(draw, pool, i, pool[i]);
            continue;
        }
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = number(draw);
        if (in_plane)
            pool[i][2] = flat;
    }
}

/* In no special position, so that doubles mostly decide; edges round. */
static void draw_loose_pool(struct draw *draw, point *pool)
{
    for (int i = 0; i < POOL; i++)
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = full_mantissa(draw);
}

/* To any size: exactly, or, where it comes out below the normal numbers, into their grid. */
static void scale_pool(struct draw *draw, point *pool)
{
    static const int some[] = {0,    0,   0,    0,   100,  -100,  199,
                               -199, 300, -300, 498, -498, -1020, -1070};
    const int exponent = some[draw_int(draw, 0, (int) COUNT(some) - 1)];
    for (int i = 0; i < POOL; i++)
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = ldexp(pool[i][axis], exponent);
}

static void draw_triangle(struct draw *draw, point *pool, struct triangle *out)
{
    memset(out, 0, sizeof *out);
    for (int corner = 0; corner < 3; corner++)
        memcpy(out->vertex[corner], pool[draw_int(draw, 0, POOL - 1)], sizeof out->vertex[corner]);
}

static enum fmb_status make_face(const double vertex[3][3], struct fmb_body *out)
{
    return fmb_body_make_vertices(3, FMB_FACE, vertex[0], 9, out);
}

/* A way from one point of the pool to another in the window, so that what moves often passes
 * through vertices. */
static void draw_motion(struct draw *draw, point *pool, struct triangle *out)
{
    const double *p = pool[draw_int(draw, 0, POOL - 1)], *q = pool[draw_int(draw, 0, POOL - 1)];
    out->moving = true;
    for (int axis = 0; axis < 3; axis++)
        out->velocity[axis] = q[axis] - p[axis];
}

struct drawn {
    struct triangle triangle[2];
    double duration;
};

static void draw_pair(struct draw *draw, bool moving, struct drawn *out)
{
    point pool[POOL];
    if (draw_int(draw, 0, 7))
        draw_pool(draw, pool);
    else
        draw_loose_pool(draw, pool);
    scale_pool(draw, pool);
    for (int f = 0; f < 2; f++)
        draw_triangle(draw, pool, &out->triangle[f]);
    out->duration = 1;
    if (!moving)
        return;
    const int who = draw_int(draw, 1, 3);
    for (int f = 0; f < 2; f++)
        if (who & (1 << f))
            draw_motion(draw, pool, &out->triangle[f]);
    if (draw_int(draw, 0, 3) == 0)
        out->duration = draw_int(draw, 0, 4) * 0.3;
}

/* ---- The engine ---- */

struct arranged {
    struct fmb_body body[2];
    struct pair pair;
};

static void set_frame(const struct triangle *triangle, int first, struct fmb_body *body,
                      struct fmb_placement *out)
{
    double vertex[3][3];
    for (int corner = 0; corner < 3; corner++)
        memcpy(vertex[corner], triangle->vertex[(corner + first) % 3], sizeof vertex[corner]);
    assert_int_equal(make_face((const double(*)[3]) vertex, body), FMB_OK);
    *out = (struct fmb_placement){.body = body};
    if (triangle->moving)
        memcpy(out->velocity, triangle->velocity, sizeof out->velocity);
}

/* turn: which vertex is the first of each, and which triangle is (from 9 on) the second. */
enum { TURNS = 18 };

static void set_arranged(const struct drawn *drawn, int turn, struct arranged *out)
{
    const int swapped = turn / 9;
    set_frame(&drawn->triangle[swapped], turn % 3, &out->body[0], &out->pair.a);
    set_frame(&drawn->triangle[!swapped], turn / 3 % 3, &out->body[1], &out->pair.b);
    out->pair.duration = drawn->duration;
}

static void print_drawn(const struct drawn *drawn)
{
    printf("# struct drawn drawn = {{");
    for (int f = 0; f < 2; f++) {
        const struct triangle *t = &drawn->triangle[f];
        printf("{{");
        for (int corner = 0; corner < 3; corner++)
            printf("{%a, %a, %a},", t->vertex[corner][0], t->vertex[corner][1],
                   t->vertex[corner][2]);
        printf("}, {%a, %a, %a}, %d},", t->velocity[0], t->velocity[1], t->velocity[2], t->moving);
    }
    printf("}, %a};\n", drawn->duration);
}

static void fail_of(const struct drawn *drawn, int turn, const char *what, int found, int expected)
{
    print_drawn(drawn);
    fail_msg("%s, turn %d: found %d, expected %d", what, turn, found, expected);
}

/* Whether sign * (end - exact) >= 0. */
static bool is_beyond(double end, int sign, const mpq_t exact)
{
    if (isinf(end))
        return (end > 0) == (sign > 0);
    mpq_t number;
    mpq_init(number);
    mpq_set_d(number, end);
    const int order = mpq_cmp(number, exact);
    mpq_clear(number);
    return sign * order >= 0;
}

/* The end contains the exact one; and, of the tightest, the next double does not. */
static bool is_end(double end, int which, bool tightest, const mpq_t exact)
{
    const int sign = which ? 1 : -1;
    return is_beyond(end, sign, exact) &&
           (!tightest || !is_beyond(nextafter(end, -sign * HUGE_VAL), sign, exact));
}

/* At most 1e-12 of the window out, or the next double. */
static bool is_near(double end, int which, double duration, const mpq_t exact)
{
    const double inner = nextafter(end, which ? -HUGE_VAL : HUGE_VAL);
    const double in = which ? end - 0.99e-12 * duration : end + 0.99e-12 * duration;
    return !is_beyond(inner, which ? 1 : -1, exact) || !is_beyond(in, which ? 1 : -1, exact);
}

static void assert_answer(const struct drawn *drawn, int turn, const char *method,
                          const struct triangles_answer *truth)
{
    struct arranged arranged;
    struct fmb_answer answer;
    const bool exact = strcmp(method, "exact") == 0;
    const bool moving = drawn->triangle[0].moving || drawn->triangle[1].moving;
    set_arranged(drawn, turn, &arranged);
    memset(&answer, 0xa5, sizeof answer);
    assert_int_equal(pair_decide(fmb_method_by_name(method), &arranged.pair, FMB_WANT_BOX, &answer),
                     FMB_OK);
    if (answer.verdict != truth->verdict)
        fail_of(drawn, turn, method, (int) answer.verdict, (int) truth->verdict);
    const bool meet = truth->verdict != FMB_SEPARATED;
    assert_int_equal(answer.has_contact, meet);
    assert_int_equal(answer.has_box, meet);
    if (meet && !moving)
        assert_true(answer.contact[0] == 0 && answer.contact[1] == drawn->duration);
    for (int end = 0; end < 2 && meet; end++) {
        if (moving && !(is_end(answer.contact[end], end, exact, truth->contact[end]) &&
                        is_near(answer.contact[end], end, drawn->duration, truth->contact[end])))
            fail_of(drawn, turn, exact ? "exact contact" : "certified contact", end, 0);
        for (int axis = 0; axis < 3; axis++)
            if (!is_end(answer.box[end][axis], end, exact, truth->box[end][axis]))
                fail_of(drawn, turn, exact ? "exact box" : "certified box", end, axis);
    }
}

static void assert_certificate(const struct drawn *drawn, int turn, enum fmb_verdict verdict)
{
    char text[FMB_CERTIFICATE_MAX], why[200] = "";
    size_t length;
    struct arranged arranged;
    set_arranged(drawn, turn, &arranged);
    assert_int_equal(pair_certificate(&arranged.pair, text, sizeof text, &length), FMB_OK);
    for (int other = FMB_SEPARATED; other <= FMB_OVERLAPPING && length > 0; other++) {
        const bool holds =
            pair_certificate_holds(&arranged.pair, (enum fmb_verdict) other, text, why, sizeof why);
        if (holds != (other == (int) verdict)) {
            printf("# %s: %s\n", text, why);
            fail_of(drawn, turn, "certificate", holds, other);
        }
    }
}

/* ---- Pairs, one by one ---- */

struct tally {
    long rounded, of_verdict[FMB_OVERLAPPING + 1];
};

static void count_drawn(const struct drawn *drawn, enum fmb_verdict verdict, struct tally *tally)
{
    struct arranged arranged;
    set_arranged(drawn, 0, &arranged);
    tally->rounded += arranged.body[0].one.rounded || arranged.body[1].one.rounded;
    tally->of_verdict[verdict]++;
}

static void assert_tally(const struct tally *tally, long count)
{
    printf("# %ld rounded, %ld separated, %ld touching, %ld overlapping\n", tally->rounded,
           tally->of_verdict[1], tally->of_verdict[2], tally->of_verdict[3]);
    if (count < 200)
        return;
    assert_true(tally->rounded > count / 4);
    for (int v = FMB_SEPARATED; v <= FMB_OVERLAPPING; v++)
        assert_true(tally->of_verdict[v] > count / 20);
}

static void assert_pairs(const char *what, bool moving, long usual)
{
    struct draw draw;
    struct drawn drawn;
    struct triangles_answer truth;
    struct tally tally = {0};
    const long count = draw_sample(usual);
    draw_begin(&draw, what);
    triangles_init(&truth);
    for (long i = 0; i < count; i++) {
        draw_pair(&draw, moving, &drawn);
        triangles_decide(drawn.triangle, drawn.duration, true, &truth);
        count_drawn(&drawn, truth.verdict, &tally);
        for (int turn = 0; turn < TURNS; turn++)
            assert_answer(&drawn, turn, "certified", &truth);
        assert_answer(&drawn, draw_int(&draw, 0, TURNS / 2 - 1), "exact", &truth);
        assert_answer(&drawn, draw_int(&draw, TURNS / 2, TURNS - 1), "exact", &truth);
        assert_certificate(&drawn, draw_int(&draw, 0, TURNS - 1), truth.verdict);
    }
    triangles_clear(&truth);
    assert_tally(&tally, count);
}

static void pairs_at_rest_are_what_their_vertices_say(void **state)
{
    assert_pairs("pairs_at_rest_are_what_their_vertices_say", false, 8000);
}

static void moving_pairs_are_what_their_vertices_say(void **state)
{
    assert_pairs("moving_pairs_are_what_their_vertices_say", true, 4000);
}

/* ---- Boxes ---- */

/* No larger than the rounding of its numbers makes it: with u = 2^-52 of the largest coordinate, an
 * edge is off by at most u on each axis, the frame by 3 u, and two sums step down by 2 u each. */
static void a_box_is_tight(void **state)
{
    struct draw draw;
    draw_begin(&draw, "a_box_is_tight");
    for (long n = draw_sample(20000); n > 0; n--) {
        struct drawn drawn;
        struct arranged arranged;
        struct fmb_prepared prepared;
        double box[2][FMB_DIM_MAX];
        draw_pair(&draw, false, &drawn);
        set_arranged(&drawn, 0, &arranged);
        assert_int_equal(fmb_prepare(&arranged.pair.a, 0, 1, &prepared), FMB_OK);
        fmb_box_of(&prepared, 1, box);
        const double *v0 = drawn.triangle[0].vertex[0];
        double size = 0;
        for (int k = 0; k < 9; k++)
            size = fmax(size, fabs(v0[k]));
        for (int axis = 0; axis < 3; axis++) {
            const double(*v)[3] = (const double(*)[3]) drawn.triangle[0].vertex;
            const double least = fmin(v[0][axis], fmin(v[1][axis], v[2][axis]));
            const double most = fmax(v[0][axis], fmax(v[1][axis], v[2][axis]));
            const double slack = arranged.body[0].one.rounded ? 8 * 0x1p-52 * size + 0x1p-1073 : 0;
            assert_true(box[0][axis] >= least - slack && box[1][axis] <= most + slack);
        }
    }
}

/* ---- Trees of boxes ---- */

/* In the plane the third numbers of boxes are not read. */
static void put_flat_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const double(*at)[2] = context;
    for (int axis = 0; axis < 2; axis++)
        box[0][axis] = box[1][axis] = at[index][axis];
    box[0][2] = NAN;
    box[1][2] = -INFINITY;
}

static void boxes_in_the_plane(void **state)
{
    static const double at[4][2] = {{0, 0}, {1, 0}, {0, 0}, {1, -0.0}};
    static const unsigned expected[2][2] = {{0, 2}, {1, 3}};
    const struct fmb_boxes boxes = {2, put_flat_box, at, NULL};
    struct fmb_tree tree;
    struct fmb_tree_cursor cursor = {0};
    unsigned pairs[FMB_TREE_CAPACITY_MIN][2];
    size_t count;
    void *memory = allocate(1, fmb_tree_bytes(4));
    assert_int_equal(fmb_tree_build(&boxes, 4, 1, memory, &tree), FMB_OK);
    assert_int_equal(fmb_tree_pairs(&tree, &tree, &cursor, pairs, FMB_TREE_CAPACITY_MIN, &count),
                     FMB_OK);
    assert_int_equal(count, 2);
    assert_memory_equal(pairs, expected, sizeof expected);
    free(memory);
}

static void boxes_that_cannot_be_are_refused(void **state)
{
    static const double bad[] = {-1, -0x1p-1074, INFINITY, NAN};
    struct fmb_boxes boxes = {3, put_flat_box, NULL, NULL};
    struct fmb_tree tree;
    for (size_t i = 0; i < COUNT(bad); i++) {
        tree.frame_count = 7;
        assert_int_equal(fmb_tree_build(&boxes, 3, bad[i], NULL, &tree), FMB_BAD_DURATION);
        assert_int_equal(tree.frame_count, 0);
    }
    assert_int_equal(fmb_tree_build(&boxes, UINT_MAX, 1, NULL, &tree), FMB_OVER_LIMIT);
    assert_int_equal(fmb_tree_build(&boxes, 0, 1, NULL, &tree), FMB_OK);
    assert_int_equal(tree.frame_count, 0);
    boxes.dim = 4;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
    boxes.dim = 1;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
}

/* ---- Bodies ---- */

static double any_size(struct draw *draw)
{
    switch (draw_int(draw, 0, 4)) {
    case 0: return draw_log(draw, 1018, 1023);
    case 1: return draw_coin(draw) ? DBL_MAX : -DBL_MAX;
    case 2: return ldexp(draw_int(draw, -5, 5), -1074);
    case 3: return draw_int(draw, -1, 1);
    default: return draw_finite(draw);
    }
}

/* Edges that doubles hold: the body is the same as that of its origin and components, to the byte.
 */
static void what_does_not_round_is_an_ordinary_face(void **state)
{
    struct draw draw;
    draw_begin(&draw, "what_does_not_round_is_an_ordinary_face");
    for (long n = draw_sample(2000); n > 0; n--) {
        double vertex[3][3], number[3][3];
        struct fmb_body body, ordinary;
        for (int k = 0; k < 9; k++)
            vertex[k / 3][k % 3] = draw_int(&draw, -4, 4) * 0.125;
        for (int k = 0; k < 6; k++)
            number[1 + k / 3][k % 3] = vertex[1 + k / 3][k % 3] - vertex[0][k % 3];
        memcpy(number[0], vertex[0], sizeof number[0]);
        assert_int_equal(make_face((const double(*)[3]) vertex, &body), FMB_OK);
        assert_int_equal(fmb_body_make(3, FMB_FACE, number[0], 9, &ordinary), FMB_OK);
        assert_memory_equal(&body, &ordinary, sizeof body);
    }
}

/* Coordinates up to the largest double, and subnormal ones, in one pair. */
static void pairs_at_the_ends_of_the_doubles(void **state)
{
    struct draw draw;
    struct triangles_answer truth;
    long arranged = 0;
    draw_begin(&draw, "pairs_at_the_ends_of_the_doubles");
    triangles_init(&truth);
    for (long n = draw_sample(1500); n > 0; n--) {
        struct drawn drawn = {.duration = 1};
        double pool[6];
        for (int k = 0; k < 6; k++)
            pool[k] = any_size(&draw) * 0.5;
        for (int f = 0; f < 2; f++)
            for (int k = 0; k < 9; k++)
                drawn.triangle[f].vertex[k / 3][k % 3] = pool[draw_int(&draw, 0, 5)];
        triangles_decide(drawn.triangle, 1, true, &truth);
        arranged += truth.verdict != FMB_SEPARATED;
        for (int turn = 0; turn < TURNS; turn += 5) {
            assert_answer(&drawn, turn, "certified", &truth);
            assert_answer(&drawn, turn, "exact", &truth);
        }
        assert_certificate(&drawn, draw_int(&draw, 0, TURNS - 1), truth.verdict);
    }
    triangles_clear(&truth);
    assert_true(arranged > 0);
}

/* The first face is rotated into the plane z = 0, where the second lies. The integers are rows of
 * the matrix of the rotation. Rounded, the planes cross. */
static void rotated_faces_share_their_plane(void **state)
{
    static const double flat[9] = {-0.5, -0.5, 0, 2, 0, 0, 0, 2, 0};
    for (int x = 1; x < 6; x++)
        for (int y = 1; y < 6; y++) {
            const int w = 1, z = 7;
            const double number[6] = {w * w + x * x - y * y - z * z, 2 * (x * y - w * z),
                                      2 * (x * z + w * y),           2 * (x * y + w * z),
                                      w * w - x * x + y * y - z * z, 2 * (y * z - w * x)};
            struct fmb_body body[2];
            assert_int_equal(fmb_body_make(3, FMB_FACE, number, 6, &body[0]), FMB_OK);
            assert_int_equal(fmb_body_make(3, FMB_FACE, flat, 9, &body[1]), FMB_OK);
            const struct fmb_placement a = {
                .body = &body[0], .orientation = {w, x, y, z}, .orientation_count = 4};
            const struct fmb_placement b = {.body = &body[1]};
            struct fmb_answer answer;
            assert_int_equal(fmb_decide(fmb_method_default(), &a, &b, 0, 0, &answer), FMB_OK);
            assert_int_equal(answer.verdict, FMB_OVERLAPPING);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotated_faces_share_their_plane),
        cmocka_unit_test(pairs_at_rest_are_what_their_vertices_say),
        cmocka_unit_test(moving_pairs_are_what_their_vertices_say),
        cmocka_unit_test(pairs_at_the_ends_of_the_doubles),
        cmocka_unit_test(a_box_is_tight),
        cmocka_unit_test(boxes_in_the_plane),
        cmocka_unit_test(boxes_that_cannot_be_are_refused),
        cmocka_unit_test(what_does_not_round_is_an_ordinary_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
