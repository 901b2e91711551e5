/* Certificates of pairs of bodies that turn within the window: worked examples for the checker,
 * certificates of random pairs, and damaged certificates. */
#include "unit.h"

#include <math.h>

#include "draw.h"
#include "fmb.h"

enum { WHY_SIZE = 200 };

/* ---- By hand ---- */

static bool holds(const struct fmb_placement pair[2], double duration, enum fmb_verdict verdict,
                  const char *text)
{
    char why[WHY_SIZE] = "?";
    const bool does =
        fmb_certificate_holds(&pair[0], &pair[1], duration, verdict, text, why, sizeof why);
    assert_true(does == (why[0] == '\0'));
    assert_null(strchr(why, '\n'));
    return does;
}

struct by_hand {
    enum fmb_verdict verdict;
    bool right;
    const char *text;
};

static void expect_by_hand(const struct fmb_placement pair[2], const struct by_hand *by_hand,
                           size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (holds(pair, 2, by_hand[i].verdict, by_hand[i].text) != by_hand[i].right)
            fail_msg("%s", by_hand[i].text);
}

/* A cube that turns by 90 degrees about z, and a cube at rest at x = 3. The first cube reaches to
 * x = sqrt(1/2), and to 1/2 along each of its own axes. At the beginning its axes are the axes of
 * the world; at the end x of the world is its -y. */
static void intervals_by_hand(void **state)
{
    static const struct by_hand cases[] = {
        {FMB_SEPARATED, true, "separated from 0 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, true, "separated from 0 to 1 normal b (1/3 0 0)"},
        {FMB_SEPARATED, true,
         "separated from 0 to 1/2 normal b (1 0 0) from 1/2 to 1 normal b (5 1 -1)"},
        {FMB_SEPARATED, true,
         "separated from 0 to 1/3 normal a (1 0 0) from 1/3 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, true,
         "separated from 0 to 1/3 normal b (1 0 0) from 1/3 to 1 normal a (0 -1 0)"},
        {FMB_SEPARATED, true, "separated from 0 to 1 normal a (1 -1 0)"},
        {FMB_SEPARATED, true, "separated from 0 to 1 product (0 0 1) (0 -1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (0 0 1) (0 1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (0 0 0) (0 -1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (0 0 1) (0 0 1)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (0 0 1)"},
        /* Directions that do not separate, at some time */
        {FMB_SEPARATED, false, "separated from 0 to 1 normal a (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal a (0 -1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (-1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (0 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 1/2 normal b (1 0 0) from 1/2 to 1 normal b (0 1 0)"},
        /* Missing times, wrong orders, and intervals beyond the window */
        {FMB_SEPARATED, false, "separated from 0 to 1/2 normal b (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 1/2 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 1/2 normal b (1 0 0) from 3/4 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 3/4 normal b (1 0 0) from 1/2 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 1/2 to 1 normal b (1 0 0) from 0 to 1/2 normal b (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 2 normal b (1 0 0)"},
        {FMB_SEPARATED, false, "separated from -1 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 0 normal b (1 0 0) from 0 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 1 normal b (1 0 0) from 1 to 1 normal b (1 0 0)"},
        {FMB_SEPARATED, false,
         "separated from 0 to 1 normal b (1 0 0) from 1 to 0 normal b (1 0 0) from 0 to 1 normal b "
         "(1 0 0)"},
        /* Other forms */
        {FMB_SEPARATED, false, "separated"},
        {FMB_SEPARATED, false, "separated normal (1 0 0)"},
        {FMB_SEPARATED, false, "separated normal b (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal c (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (2/2 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 2/2 normal b (1 0 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (1 0 0) "},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal b (1 0 0) from"},
        {FMB_TOUCHING, false, "separated from 0 to 1 normal b (1 0 0)"},
        {FMB_OVERLAPPING, false, "separated from 0 to 1 normal b (1 0 0)"},
        {FMB_OVERLAPPING, false, "overlapping at 1 a 0:1/2 7 b 0:1/2 7"},
        {FMB_TOUCHING, false, "touching normal (1 0 0) at 0 a 1 b 0"},
    };
    struct fmb_body cube;
    assert_int_equal(fmb_body_make(3, FMB_BOX, (const double[]){1, 1, 1}, 3, &cube), FMB_OK);
    const struct fmb_placement pair[2] = {{.body = &cube,
                                           .orientation = {1, 0, 0, 0},
                                           .orientation_count = 4,
                                           .end_orientation = {-1, 0, 0, -1},
                                           .end_count = 7},
                                          {.body = &cube, .position = {3, 0, 0}}};
    expect_by_hand(pair, cases, COUNT(cases));
}

/* A triangle turns by 90 degrees about its corner (0, 0), from the first quadrant to the second,
 * and moves from (0, 0) to (2, 4) in 2 s. At 1/2 s the corner is at (1/2, 1), and the triangle lies
 * between the directions of 43 and 134 degrees from it. Another triangle rests at (1/2, 5/4). */
static void overlaps_by_hand(void **state)
{
    static const struct by_hand cases[] = {
        {FMB_OVERLAPPING, true, "overlapping at 1/2 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 1/4 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 0 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 1 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 1/2 a 0 1 2 b 0 1:1/2 2:1/2"},
        {FMB_OVERLAPPING, false, "overlapping at 1/2 a 0 1 2 b 0 1:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 1/2 a 0 1 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at -2 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_OVERLAPPING, false, "overlapping at 3 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_SEPARATED, false, "overlapping at 1/2 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_TOUCHING, false, "overlapping at 1/2 a 0 1 2 b 0 1:1/8 2:1/8"},
        {FMB_SEPARATED, false, "separated from 0 to 1 normal a (1 0)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (1 0) (0 1)"},
        {FMB_SEPARATED, false, "separated from 0 to 1 product (1 0 0) (0 1 0)"},
    };
    struct fmb_body triangle;
    assert_int_equal(
        fmb_body_make(2, FMB_TETRAHEDRON, (const double[]){0, 0, 1, 0, 0, 1}, 6, &triangle),
        FMB_OK);
    struct fmb_placement pair[2] = {{.body = &triangle,
                                     .orientation = {1, 0},
                                     .orientation_count = 2,
                                     .end_position = {2, 4},
                                     .end_orientation = {2, 2},
                                     .end_count = 4},
                                    {.body = &triangle, .position = {0.5, 1.25}}};
    expect_by_hand(pair, cases, COUNT(cases));
    /* The quaternion of the pose at -2 s would be 0. */
    pair[0].end_orientation[1] = 0;
    assert_false(holds(pair, 2, FMB_OVERLAPPING, "overlapping at -2 a 0 1 2 b 0 1:1/8 2:1/8"));
    /* Without a window, or with an invalid end, there is nothing to prove. */
    assert_false(holds(pair, 0, FMB_SEPARATED, "separated from 0 to 1 normal a (1 0)"));
    pair[0].end_count = 3;
    assert_false(holds(pair, 2, FMB_OVERLAPPING, cases[0].text));
}

/* The check of a long text costs no more than the checks of its intervals. */
static void many_intervals(void **state)
{
    enum { INTERVALS = 503, SIZE = 60 * INTERVALS };
    struct fmb_body cube;
    char text[SIZE] = "separated";
    size_t used = strlen(text);
    assert_int_equal(fmb_body_make(3, FMB_BOX, (const double[]){1, 1, 1}, 3, &cube), FMB_OK);
    const struct fmb_placement pair[2] = {
        {.body = &cube, .end_position = {0, 1, 0}, .end_count = 3},
        {.body = &cube, .position = {3, 0, 0}}};
    for (int i = 0; i < INTERVALS; i++) {
        assert_false(i % 100 == 1 && holds(pair, 2, FMB_SEPARATED, text));
        used += (size_t) snprintf(text + used, SIZE - used, i ? " from %d/503" : " from 0", i);
        used += (size_t) snprintf(
            text + used, SIZE - used,
            i + 1 < INTERVALS ? " to %d/503 normal a (1 0 0)" : " to 1 normal a (1 0 0)", i + 1);
    }
    assert_true(holds(pair, 2, FMB_SEPARATED, text));
    used += (size_t) snprintf(text + used, SIZE - used, " from 1 to 504/503 normal a (1 0 0)");
    assert_false(holds(pair, 2, FMB_SEPARATED, text));
}

/* ---- Random pairs ---- */

/* Draws a body of about size 1; one in four has a radius. memory: for a hull. */
static void draw_body(struct draw *draw, int dim, double memory[100], struct fmb_body *out)
{
    enum { HULL = 12 };
    double number[3 * HULL];
    const int kind = draw_int(draw, 0, 3);
    for (size_t i = 0; i < COUNT(number); i++)
        number[i] = draw_uniform(draw, -1, 1);
    for (int axis = 0; axis < dim && kind == 0; axis++)
        number[axis] = fabs(number[axis]) + 0.125;
    assert_int_equal(kind == 0 ? fmb_body_make(dim, FMB_BOX, number, (size_t) dim, out)
                     : kind == 3
                         ? fmb_body_make_hull(dim, number, (size_t) (HULL * dim), memory, out)
                         : fmb_body_make(dim, kind == 1 ? FMB_CUBOID : FMB_TETRAHEDRON, number,
                                         (size_t) (dim * (dim + 1)), out),
                     FMB_OK);
    if (draw_int(draw, 0, 3) == 0)
        assert_int_equal(fmb_body_inflate(out, draw_uniform(draw, 0.125, 0.5)), FMB_OK);
}

/* Draws a placement with an end if it turns, with a velocity otherwise. */
static struct fmb_placement draw_placement(struct draw *draw, const struct fmb_body *body,
                                           bool turns)
{
    const int dim = body->dim;
    struct fmb_placement out = {.body = body, .orientation_count = dim == 2 ? 2 : 4};
    if (turns)
        out.end_count = dim + out.orientation_count;
    do {
        for (int i = 0; i < out.orientation_count; i++) {
            out.orientation[i] = draw_uniform(draw, -1, 1);
            out.end_orientation[i] = turns ? draw_uniform(draw, -1, 1) : 0;
        }
    } while (fmb_placement_check(&out) != FMB_OK);
    for (int axis = 0; axis < dim; axis++) {
        out.position[axis] = draw_uniform(draw, -2, 2);
        (turns ? out.end_position : out.velocity)[axis] = draw_uniform(draw, -2, 2);
    }
    return out;
}

/* out := the text with the first vector of every direction negated. */
static void negate(const char *text, char *out)
{
    bool in_vector = false;
    for (const char *at = text; *at != '\0'; at++) {
        const bool begins = *at == '(' && at[-2] != ')';
        in_vector = (in_vector && *at != ')') || begins;
        *out++ = *at;
        if (!in_vector || (*at != '(' && *at != ' '))
            continue;
        if (at[1] == '-')
            at++;
        else if (at[1] != '0')
            *out++ = '-';
    }
    *out = '\0';
}

/* Damages the text of a separated pair in several ways. No damaged text proves anything. */
static void refuse_damage(const struct fmb_placement pair[2], const char *text)
{
    char damaged[2 * FMB_CERTIFICATE_MAX];
    const char *first = strstr(text, " from "), *second = strstr(first + 1, " from ");
    negate(text, damaged);
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
    strcpy(damaged, text);
    *strrchr(damaged, 'f') = '\0'; /* without the last interval, except for its space */
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
    damaged[strlen(damaged) - 1] = '\0';
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
    if (!second)
        return;
    snprintf(damaged, sizeof damaged, "separated%s", second); /* without the first interval */
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
    snprintf(damaged, sizeof damaged, "separated%s%.*s", second, (int) (second - first), first);
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
    snprintf(damaged, sizeof damaged, "separated%.*s%s", (int) (second - first), first, first);
    assert_false(holds(pair, 2, FMB_SEPARATED, damaged));
}

/* Every decided pair has a certificate in both orders. It proves the verdict, and no other one. */
static void random_pairs(void **state)
{
    struct draw draw;
    long counts[4] = {0}, parts = 0, products = 0, bytes = 0;
    draw_begin(&draw, "random_pairs");
    const long sample = draw_sample(300);
    for (long k = 0; k < sample; k++) {
        static char text[2][FMB_CERTIFICATE_MAX];
        double memory[2][100];
        struct fmb_body body[2];
        struct fmb_answer answer;
        size_t length[2];
        const int dim = draw_int(&draw, 2, 3), turning = draw_int(&draw, 1, 3);
        struct fmb_placement pair[2], back[2];
        for (int f = 0; f < 2; f++) {
            draw_body(&draw, dim, memory[f], &body[f]);
            pair[f] = draw_placement(&draw, &body[f], turning >> f & 1);
        }
        back[0] = pair[1], back[1] = pair[0];
        const enum fmb_status status =
            fmb_decide(fmb_method_default(), &pair[0], &pair[1], 2, 0, &answer);
        counts[answer.verdict]++;
        for (int f = 0; f < 2; f++) {
            const struct fmb_placement *of = f ? back : pair;
            const enum fmb_status given =
                fmb_certificate(&of[0], &of[1], 2, text[f], FMB_CERTIFICATE_MAX, &length[f]);
            if (status != FMB_OK) /* the contact is not enclosed: the verdict may be known */
                continue;
            assert_int_equal(given, FMB_OK);
            for (enum fmb_verdict verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++)
                assert_int_equal(holds(of, 2, verdict, text[f]), verdict == answer.verdict);
            if (answer.verdict == FMB_OVERLAPPING)
                continue;
            refuse_damage(of, text[f]);
            products += strstr(text[f], "product") != NULL;
            for (const char *at = text[f]; (at = strstr(at, "from ")) != NULL; at++)
                parts++;
            bytes += (long) length[f];
        }
    }
    print_message("%ld separated, %ld overlapping, %ld not decided; %.1f intervals, %.0f bytes\n",
                  counts[FMB_SEPARATED], counts[FMB_OVERLAPPING], counts[0],
                  (double) parts / (double) (2 * counts[FMB_SEPARATED]),
                  (double) bytes / (double) (2 * counts[FMB_SEPARATED]));
    if (sample < 100) /* too few for shares */
        return;
    assert_true(counts[FMB_SEPARATED] > sample / 8 && counts[FMB_OVERLAPPING] > sample / 8);
    assert_true(counts[0] <= 1 + sample / 100 && products > 0);
}

/* Two boxes that turn as one body, 2^-51 apart, touching, or 2^-51 deep: doubles leave them open.
 * The normal of a face proves that they are apart. It is exact, and one interval suffices. */
static void clearances_that_doubles_do_not_see(void **state)
{
    struct fmb_body body[2];
    assert_int_equal(fmb_body_make(3, FMB_BOX, (const double[]){1, 0, 0, 1, 1, 1}, 6, &body[0]),
                     FMB_OK);
    for (int k = -1; k <= 1; k++) {
        const double x = 2 + k * 0x1p-51, box[6] = {x, 0.25, 0.5, 1, 2, 1};
        struct fmb_placement pair[2];
        struct fmb_answer answer;
        char text[FMB_CERTIFICATE_MAX];
        size_t length;
        assert_int_equal(fmb_body_make(3, FMB_BOX, box, 6, &body[1]), FMB_OK);
        for (int f = 0; f < 2; f++)
            pair[f] = (struct fmb_placement){.body = &body[f],
                                             .orientation = {2, 1, 0, 1},
                                             .orientation_count = 4,
                                             .end_orientation = {3, 0, 1, -1},
                                             .end_count = 7};
        assert_int_equal(fmb_decide(fmb_method_default(), &pair[0], &pair[1], 0.1, 0, &answer),
                         FMB_OK);
        assert_int_equal(answer.verdict, k < 0    ? FMB_OVERLAPPING
                                         : k == 0 ? FMB_TOUCHING
                                                  : FMB_SEPARATED);
        assert_int_equal(fmb_certificate(&pair[0], &pair[1], 0.1, text, sizeof text, &length),
                         FMB_OK);
        assert_int_equal(holds(pair, 0.1, answer.verdict, text), k != 0);
        if (k > 0)
            assert_string_equal(text, "separated from 0 to 1 normal a (1 0 0)");
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(intervals_by_hand),
        cmocka_unit_test(overlaps_by_hand),
        cmocka_unit_test(many_intervals),
        cmocka_unit_test(random_pairs),
        cmocka_unit_test(clearances_that_doubles_do_not_see),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
