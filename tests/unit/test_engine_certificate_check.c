/* The checker of certificates: worked examples, and random texts about small pairs, flat or not.
 * Its answers about weights are compared with the oracle, its answers about normals with integer
 * arithmetic. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "draw.h"
#include "oracle.h"
#include "question.h"
#include "referee.h"

enum { TEXT_SIZE = 4000, WHY_SIZE = 200 };

/* ---- Questions ---- */

/* One of its components may be a multiple of another one. */
static struct solid draw_solid(struct draw *draw, int dim)
{
    struct solid solid = {.dim = dim};
    solid.shape =
        (enum fmb_shape) draw_int(draw, FMB_CUBOID, dim == 3 ? FMB_FACE : FMB_TETRAHEDRON);
    const int count = solid_count(&solid);
    for (int i = 0; i < count; i++)
        draw_integers(draw, dim, -2, 2, solid.component[i]);
    if (draw_int(draw, 0, 2) == 0) {
        const int from = draw_int(draw, 0, count - 1), to = draw_int(draw, 0, count - 1);
        const int times = draw_int(draw, -2, 2);
        for (int axis = 0; axis < dim; axis++)
            solid.component[to][axis] = times * solid.component[from][axis];
    }
    draw_integers(draw, dim, -2, 2, solid.origin);
    draw_integers(draw, dim, -2, 2, solid.velocity);
    solid.moving = draw_coin(draw);
    return solid;
}

/* Small whole numbers throughout, the window included; flat frames now and then in one plane. */
static struct question draw_question(struct draw *draw)
{
    const int dim = draw_int(draw, 2, 3);
    struct question question = {draw_solid(draw, dim), draw_solid(draw, dim), draw_int(draw, 0, 2)};
    if (draw_int(draw, 0, 3) == 0)
        for (int i = 0; i < FMB_DIM_MAX; i++)
            question.a.component[i][0] = question.b.component[i][0] = 0;
    if (draw_int(draw, 0, 2) == 0) /* so that each point of A is one of B */
        question.b = question.a;
    return question;
}

/* ---- What must be so of each text ---- */

static bool holds(const struct pair *pair, enum fmb_verdict verdict, const char *text)
{
    char why[WHY_SIZE] = "?";
    bool does = pair_certificate_holds(pair, verdict, text, why, sizeof why);
    assert_true(does == (why[0] == '\0'));
    assert_null(strchr(why, '\n'));
    return does;
}

/* On output: a certificate in a buffer of TEXT_SIZE. Returns the verdict. */
static enum fmb_verdict make(const struct pair *pair, char *text)
{
    struct fmb_answer answer;
    size_t length;
    assert_int_equal(FMB_OK, pair_certificate(pair, text, TEXT_SIZE, &length));
    assert_int_equal(FMB_OK, pair_decide(fmb_method_by_name("exact"), pair, 0, &answer));
    return answer.verdict;
}

/* ---- By hand ---- */

/* Unit cubes. B begins at x and, if moving, goes on by 1 along x. */
static struct question cubes(double x, bool moving)
{
    static const double speed = 0.5;
    struct question question = {
        .a = {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, {0}, false},
        .b = {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {x, 0, 0}, {speed, 0, 0}, moving},
        .duration = 2};
    return question;
}

struct by_hand {
    double x;
    bool moving;
    enum fmb_verdict verdict;
    const char *text;
    bool right;
};

/* Vertex k of a cube has the components i for which bit i of k is set. */
static const struct by_hand cubes_by_hand[] = {
    {3, false, FMB_SEPARATED, "separated normal (1 0 0)", true},
    {3, false, FMB_SEPARATED, "separated normal (1/3 0 0)", true},
    {3, false, FMB_SEPARATED, "separated normal (7 -1/2 5)", true},
    {3, false, FMB_SEPARATED, "separated normal (2/6 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (-1 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (0 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (0 1 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 -0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 0", false},
    {3, false, FMB_SEPARATED, "separated normal 1 0 0", false},
    {3, false, FMB_SEPARATED, "separated normal ( 1 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1  0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (01 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (+1 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1. 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1e3 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1/0 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1/ 0 0)", false},
    {3, false, FMB_SEPARATED, "separated  normal (1 0 0)", false},
    {3, false, FMB_SEPARATED, " separated normal (1 0 0)", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 0) ", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 0)\n", false},
    {3, false, FMB_SEPARATED, "separated normal (1 0 0) at 0 a 1 b 0", false},
    {3, false, FMB_SEPARATED, "separated + a0", false},
    {3, false, FMB_SEPARATED, "separated", false},
    {3, false, FMB_SEPARATED, "", false},
    {3, false, FMB_TOUCHING, "separated normal (1 0 0)", false},
    {3, false, FMB_OVERLAPPING, "separated normal (1 0 0)", false},
    {3, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1:1 b 0:1", false},
    {3, false, FMB_OVERLAPPING, "overlapping at 0 a 0 7 b 0:1/2 7:1/2", false},

    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1:1 b 0:1", true},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 0", true},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1:1/3 7:2/3 b 0:1/3 6:2/3", true},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1:1/3 7 b 0 6", true},
    {1, false, FMB_TOUCHING,
     "touching normal (1 0 0) at 0 a 1:123456789012345678901/123456789012345678902 7 b 0 6", true},
    {1, false, FMB_TOUCHING,
     "touching normal (1 0 0) at 0 a 1:123456789012345678902/123456789012345678901 7 b 0 6", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 7 b 0 6", false},
    {1, false, FMB_TOUCHING, "touching normal (-1 0 0) at 0 a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (0 1 0) at 0 a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (0 0 0) at 0 a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 1 a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 2", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 0 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1:1/2 b 0:1/2", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 8 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 b 0 a 1", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a1 b0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 01 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching at 0 a 1 b 0", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 0x", false},
    {1, false, FMB_TOUCHING, "touching normal (1 0 0) at 0 (1 0 0) a 1 b 0", false},
    {1, false, FMB_SEPARATED, "separated normal (1 0 0)", false},
    {1, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/8 1:1/2 2:1/8 4:1/4 b 0 1:1/8 2 4", false},

    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0 1 2 4 b 0:7/10 1:1/10 2:1/10 4:1/10", true},
    {0.5, false, FMB_OVERLAPPING,
     "overlapping at 0 a 0:1/5 1:3/5 2:1/10 4:1/10 b 0:7/10 1:1/10 2:1/10 4:1/10", true},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/5 1 2 4 b 0 1 2:1/10 4:1/10", true},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/5 1 2 4:1/10 b 0 1 2:1/10 4:1/10", true},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/5 1 2 4:1/10 b 0 1 2:1/10 4:1/9", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/5 1 2 4 b 0 1:1/10 2 4", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0 1 2 4 b 0 1 2:1/10 4:1/10", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0 1 2 4 b 0:2/10 1:6/10 2:1/10 4:1/10",
     false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0 1 2 4 b 0:1/5 1:3/5 2:1/10 4:1/10", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 0:1/4 1:3/4 b 0:3/4 1:1/4", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 a 1 6 b 0:1/2 7:1/2", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0/1 a 0 1 2 4 b 0:7/10 1:1/10 2:1/10 4:1/10",
     false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 1 a 0 1 2 4 b 0:7/10 1:1/10 2:1/10 4:1/10",
     false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at -0 a 0 1 2 4 b 0:7/10 1:1/10 2:1/10 4:1/10",
     false},
    {0.5, false, FMB_OVERLAPPING, "overlapping", false},

    {-1.5, true, FMB_OVERLAPPING, "overlapping at 3/2 a 0 1 2 4 b 0:1/10 1:7/10 2:1/10 4:1/10",
     false},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at 2 a 0 1 2 4 b 0:1/10 1:7/10 2:1/10 4:1/10", true},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at 3 a 0 1 2 4 b 0:1/10 1:7/10 2:1/10 4:1/10",
     false},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at 1 a 0 1 2 4 b 0:1/10 1:7/10 2:1/10 4:1/10",
     false},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at -1 a 0 1 2 4 b 0:1/10 1:7/10 2:1/10 4:1/10",
     false},
    {-2, true, FMB_TOUCHING, "touching normal (-1 0 0) at 2 a 0:2/3 4:1/3 b 1 5", true},
    {-2, true, FMB_TOUCHING, "touching normal (-1 0 0) at 1 a 0:2/3 4:1/3 b 1 5", false},
    {-2, true, FMB_TOUCHING, "touching normal (1 0 0) at 2 a 0:2/3 4:1/3 b 1 5", false},
    {1, true, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 0", true},
    {1.5, true, FMB_SEPARATED, "separated normal (1 0 0)", true},
    {-2.5, true, FMB_SEPARATED, "separated normal (-1 0 0)", true},
    {-1.5, true, FMB_SEPARATED, "separated normal (-1 0 0)", false},
};

static void cubes_by_hand_are_judged_right(void **state)
{
    for (size_t i = 0; i < COUNT(cubes_by_hand); i++) {
        const struct by_hand *by_hand = &cubes_by_hand[i];
        const struct question question = cubes(by_hand->x, by_hand->moving);
        struct ready ready;
        referee_ready(&question, &ready);
        if (holds(&ready.pair, by_hand->verdict, by_hand->text) != by_hand->right)
            fail_msg("\"%s\" as \"%s\"", by_hand->text, fmb_verdict_name(by_hand->verdict));
    }
}

/* Vertex 0 of a tetrahedron is its origin, vertex i + 1 the end of component i. */
static void vertices_of_tetrahedra_are_counted_from_the_origin(void **state)
{
    struct question question = cubes(1, false);
    question.a.shape = question.b.shape = FMB_TETRAHEDRON;
    struct ready ready;
    referee_ready(&question, &ready);
    assert_true(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 4 b 0"));
}

static void unknown_verdicts_are_not_proved(void **state)
{
    const struct question question = cubes(3, false);
    struct ready ready;
    referee_ready(&question, &ready);
    assert_false(holds(&ready.pair, (enum fmb_verdict) 0, "separated normal (1 0 0)"));
    assert_false(holds(&ready.pair, (enum fmb_verdict) 4, "separated normal (1 0 0)"));
    assert_false(holds(&ready.pair, (enum fmb_verdict) - 1, ""));
}

/* In the plane normals have two coordinates. */
static void squares_by_hand_are_judged_right(void **state)
{
    struct question question = {.a = {2, FMB_TETRAHEDRON, {{1, 0}, {0, 1}}, {0}, {0}, false},
                                .b = {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0.5, 0.5}, {0}, false},
                                .duration = 1};
    struct ready ready;
    referee_ready(&question, &ready);
    assert_true(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 1) at 0 a 1:1/2 2:1/2 b 0:1"));
    assert_true(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 1) at 0 a 1 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 1 0) at 0 a 1 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1) at 0 a 1 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (-1 -1) at 0 a 1 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 2) at 0 a 1 2 b 0"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 1) at 0 a 1 3 b 0"));
}

static void the_reason_is_optional(void **state)
{
    const struct question question = cubes(3, false);
    struct ready ready;
    char why[4] = "###";
    referee_ready(&question, &ready);
    assert_true(
        pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated normal (1 0 0)", NULL, 0));
    assert_false(
        pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated normal (-1 0 0)", NULL, 0));
    assert_false(
        pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated normal (-1 0 0)", why, 2));
    assert_int_equal('\0', why[1]);
    assert_int_equal('#', why[2]);
}

/* ---- Points, against the oracle ---- */

/* Where a frame is at time t, as a static one; the other frame is the point p. */
static enum fmb_verdict oracle_of_point(const struct solid *solid, double t, const double *p)
{
    struct question question = {.a = *solid, .duration = 1};
    struct fmb_body body[2];
    struct pair pair;
    struct oracle_answer truth;
    for (int axis = 0; axis < solid->dim; axis++)
        question.a.origin[axis] += solid->moving ? t * solid->velocity[axis] : 0;
    question.a.moving = false;
    question.b = (struct solid){.dim = solid->dim, .shape = FMB_CUBOID};
    memcpy(question.b.origin, p, sizeof question.b.origin);
    question_pair(&question, body, &pair);
    oracle_init(&truth);
    oracle_decide(&pair, 0, &truth);
    const enum fmb_verdict verdict = truth.verdict;
    oracle_clear(&truth);
    return verdict;
}

static bool has_velocity(const struct solid *solid)
{
    for (int axis = 0; axis < solid->dim && solid->moving; axis++)
        if (solid->velocity[axis] != 0)
            return true;
    return false;
}

/* A point in eighths of vertices: all of them or a few, some weights left out. */
struct weighted {
    char text[300];
    bool all, stated;
    double point[FMB_DIM_MAX]; /* at time t */
};

static int count_of_vertices(const struct solid *solid)
{
    const int count = solid_count(solid);
    return solid->shape == FMB_CUBOID ? 1 << count : count + 1;
}

static bool has_component(const struct solid *solid, int vertex, int i)
{
    return solid->shape == FMB_CUBOID ? vertex >> i & 1 : vertex == i + 1;
}

static void set_weighted(struct draw *draw, const struct solid *solid, const int eighths[8],
                         double t, struct weighted *out)
{
    const bool states_all = draw_coin(draw);
    size_t used = 0;
    out->all = out->stated = true;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->point[axis] = solid->origin[axis] + (solid->moving ? t * solid->velocity[axis] : 0);
    for (int v = 0; v < count_of_vertices(solid); v++) {
        const int divisor = eighths[v] % 2 ? 1 : eighths[v] % 4 ? 2 : eighths[v] % 8 ? 4 : 8;
        const bool states = states_all || draw_coin(draw);
        out->all = out->all && eighths[v] > 0;
        if (eighths[v] == 0)
            continue;
        out->stated = out->stated && states;
        used += (size_t) snprintf(out->text + used, sizeof out->text - used,
                                  !states        ? " %d"
                                  : divisor == 8 ? " %d:%d"
                                                 : " %d:%d/%d",
                                  v, eighths[v] / divisor, 8 / divisor);
        for (int i = 0; i < solid_count(solid); i++)
            for (int axis = 0; axis < FMB_DIM_MAX && has_component(solid, v, i); axis++)
                out->point[axis] += eighths[v] / 8.0 * solid->component[i][axis];
    }
}

static void draw_eighths(struct draw *draw, int vertices, int eighths[8])
{
    const bool all = draw_coin(draw);
    for (int v = 0; v < 8; v++)
        eighths[v] = all && v < vertices;
    for (int left = all ? 8 - vertices : 8; left > 0; left--)
        eighths[draw_int(draw, 0, vertices - 1)]++;
}

/* Replaces " at TIME a WEIGHTS b WEIGHTS" in the certificate. If the text holds, the oracle finds
 * its point in both frames. A text that states all weights, of all vertices, holds if and only if
 * both frames have the same point. */
static void weights_are_what_the_oracle_says(void **state)
{
    struct draw draw;
    draw_begin(&draw, "weights_are_what_the_oracle_says");
    long taken = 0, refused = 0, followed = 0;
    char text[TEXT_SIZE], other[2 * TEXT_SIZE];
    for (long n = draw_sample(12000); n > 0; n--) {
        const struct question question = draw_question(&draw);
        struct ready ready;
        struct weighted a, b;
        int eighths[2][8];
        referee_ready(&question, &ready);
        const enum fmb_verdict verdict = make(&ready.pair, text);
        if (verdict == FMB_SEPARATED)
            continue;
        const bool moving = has_velocity(&question.a) || has_velocity(&question.b);
        const double t = moving ? draw_int(&draw, 0, (int) question.duration) : 0;
        draw_eighths(&draw, count_of_vertices(&question.a), eighths[0]);
        draw_eighths(&draw, count_of_vertices(&question.b), eighths[1]);
        const bool same = count_of_vertices(&question.a) == count_of_vertices(&question.b);
        set_weighted(&draw, &question.a, eighths[0], t, &a);
        set_weighted(&draw, &question.b, eighths[!same], t, &b);
        snprintf(other, sizeof other, "%.*s at %g a%s b%s", (int) (strstr(text, " at ") - text),
                 text, t, a.text, b.text);
        const bool does = holds(&ready.pair, verdict, other);
        const bool one = memcmp(a.point, b.point, sizeof a.point) == 0;
        if (a.stated && b.stated && (a.all || verdict == FMB_TOUCHING) &&
            (b.all || verdict == FMB_TOUCHING) && does != one)
            referee_fail(&question, other);
        if (does && a.stated &&
            (oracle_of_point(&question.a, t, a.point) < verdict ||
             oracle_of_point(&question.b, t, a.point) < verdict))
            referee_fail(&question, other);
        *(does ? &taken : &refused) += 1;
        followed += does && !(a.stated && b.stated);
    }
    printf("# %ld taken, %ld of them with weights that follow, %ld refused\n", taken, followed,
           refused);
    assert_true(taken > 0 && followed > 0 && refused > 0);
}

/* ---- Normals, against whole numbers ---- */

struct integer_vector {
    long at[3];
};

static struct integer_vector integer_vector(const double *v)
{
    return (struct integer_vector){{(long) v[0], (long) v[1], (long) v[2]}};
}

static struct integer_vector difference(struct integer_vector u, struct integer_vector v)
{
    for (int i = 0; i < 3; i++)
        u.at[i] -= v.at[i];
    return u;
}

static struct integer_vector product(struct integer_vector u, struct integer_vector v)
{
    return (struct integer_vector){{u.at[1] * v.at[2] - u.at[2] * v.at[1],
                                    u.at[2] * v.at[0] - u.at[0] * v.at[2],
                                    u.at[0] * v.at[1] - u.at[1] * v.at[0]}};
}

static long dot(struct integer_vector u, struct integer_vector v)
{
    return u.at[0] * v.at[0] + u.at[1] * v.at[1] + u.at[2] * v.at[2];
}

/* A vector of the pair: a difference of vertices, the offset, the velocity, or the normal of the
 * plane. */
static struct integer_vector draw_vector(struct draw *draw, const struct question *question)
{
    static const struct integer_vector zero;
    const struct solid *a = &question->a, *b = &question->b;
    const int kind = draw_int(draw, 0, 9);
    if (kind == 0)
        return difference(integer_vector(b->origin), integer_vector(a->origin));
    if (kind == 1)
        return difference(b->moving ? integer_vector(b->velocity) : zero,
                          a->moving ? integer_vector(a->velocity) : zero);
    if (kind <= 4 && a->dim == 2)
        return (struct integer_vector){{0, 0, 1}};
    const struct solid *solid = draw_coin(draw) ? a : b;
    const int count = solid_count(solid), i = draw_int(draw, 0, count - 1);
    const int j = draw_int(draw, 0, count - 1);
    const struct integer_vector edge = integer_vector(solid->component[i]);
    return solid->shape == FMB_CUBOID || i == j
               ? edge
               : difference(edge, integer_vector(solid->component[j]));
}

/* A product of such vectors, with either sign. */
static struct integer_vector draw_normal(struct draw *draw, const struct question *question)
{
    static const struct integer_vector zero;
    struct integer_vector normal = draw_vector(draw, question);
    for (int vectors = draw_int(draw, 1, 3); vectors > 1; vectors--)
        normal = product(normal, draw_vector(draw, question));
    if (question->a.dim == 2)
        normal.at[2] = 0;
    return draw_coin(draw) ? difference(zero, normal) : normal;
}

/* " normal (X Y Z)" */
static void print_normal(char *out, size_t size, int dim, struct integer_vector normal)
{
    snprintf(out, size, dim == 3 ? " normal (%ld %ld %ld)" : " normal (%ld %ld)", normal.at[0],
             normal.at[1], normal.at[2]);
}

/* [0] least and [1] greatest N . x over a frame at t = 0. */
static void integer_range(const struct solid *solid, struct integer_vector normal, long range[2])
{
    range[0] = range[1] = 0;
    for (int i = 0; i < solid_count(solid); i++) {
        const long step = dot(normal, integer_vector(solid->component[i]));
        if (solid->shape == FMB_CUBOID)
            range[step > 0] += step;
        else if (step < range[0] || step > range[1])
            range[step > 0] = step;
    }
    const long origin = dot(normal, integer_vector(solid->origin));
    range[0] += origin;
    range[1] += origin;
}

static bool normal_proves(const struct question *question, enum fmb_verdict verdict,
                          struct integer_vector normal)
{
    long a[2], b[2], growth = 0;
    integer_range(&question->a, normal, a);
    integer_range(&question->b, normal, b);
    if (question->b.moving)
        growth += (long) question->duration * dot(normal, integer_vector(question->b.velocity));
    if (question->a.moving)
        growth -= (long) question->duration * dot(normal, integer_vector(question->a.velocity));
    const long gap = b[0] - a[1] + (growth < 0 ? growth : 0);
    if (verdict == FMB_SEPARATED)
        return gap > 0;
    return gap >= 0 && (a[0] < a[1] || b[0] < b[1]);
}

static void normals_are_what_whole_numbers_say(void **state)
{
    struct draw draw;
    draw_begin(&draw, "normals_are_what_whole_numbers_say");
    long taken = 0, refused = 0;
    char text[TEXT_SIZE], normal_text[80], other[2 * TEXT_SIZE];
    for (long n = draw_sample(12000); n > 0; n--) {
        struct question question;
        struct ready ready;
        question = draw_question(&draw);
        referee_ready(&question, &ready);
        const enum fmb_verdict verdict = make(&ready.pair, text);
        if (verdict == FMB_OVERLAPPING)
            continue;
        const struct integer_vector normal = draw_normal(&draw, &question);
        print_normal(normal_text, sizeof normal_text, question.a.dim, normal);
        const char *event = strstr(text, " at ");
        snprintf(other, sizeof other, "%s%s%s", fmb_verdict_name(verdict), normal_text,
                 event ? event : "");
        const bool right = normal_proves(&question, verdict, normal);
        if (holds(&ready.pair, verdict, other) != right) {
            printf("# %s\n", other);
            referee_fail(&question, "the checker and whole numbers differ over a normal");
        }
        *(right ? &taken : &refused) += 1;
    }
    printf("# %ld normals taken, %ld refused\n", taken, refused);
    assert_true(taken > 0 && refused > 0);
}

/* ---- Hostile texts ---- */

static void random_bytes_prove_nothing(void **state)
{
    const struct question question =
        cubes(0, false); /* so that the one right verdict needs a point */
    struct ready ready;
    struct draw draw;
    draw_begin(&draw, "random_bytes_prove_nothing");
    referee_ready(&question, &ready);
    for (long n = draw_sample(20000); n > 0; n--) {
        char text[60];
        const int verdict = draw_int(&draw, 1, 3);
        int used =
            draw_coin(&draw) ? snprintf(text, sizeof text, "%s ", fmb_verdict_name(verdict)) : 0;
        for (const int end = draw_int(&draw, used, (int) sizeof text - 1); used < end; used++)
            text[used] = (char) draw_int(&draw, 1, 255);
        text[used] = '\0';
        assert_false(holds(&ready.pair, (enum fmb_verdict) verdict, text));
    }
}

/* (10^n + 1) / 10^n is beyond 1, and its inverse is not. */
static void many_digits_are_read(void **state)
{
    enum { ZEROS = 20000 };
    const struct question question = cubes(1, false);
    struct ready ready;
    referee_ready(&question, &ready);
    const size_t size = 2 * ZEROS + 100;
    char *zeros = calloc(ZEROS + 1, 1), *text = malloc(size);
    memset(zeros, '0', ZEROS);
    static const char *const formats[2] = {"touching normal (1 0 0) at 0 a 1:1%s0/1%s1 7 b 0 6",
                                           "touching normal (1 0 0) at 0 a 1:1%s1/1%s0 7 b 0 6"};
    for (int i = 0; i < 2; i++) {
        snprintf(text, size, formats[i], zeros + 1, zeros + 1);
        assert_true(holds(&ready.pair, FMB_TOUCHING, text) == (i == 0));
    }
    free(text);
    free(zeros);
}

/* Of a box whose corner is beyond the largest double. */
static void corners_beyond_the_doubles_are_judged(void **state)
{
    struct question question = {{.dim = 3, .shape = FMB_BOX}, {.dim = 3, .shape = FMB_BOX}, 0};
    struct ready ready;
    for (int i = 0; i < 3; i++)
        question.a.component[i][i] = question.b.component[i][i] = i ? 1 : DBL_MAX;
    question.a.local[0] = -DBL_MAX;
    question.b.local[0] = DBL_MAX;
    referee_ready(&question, &ready);
    assert_true(holds(&ready.pair, FMB_SEPARATED, "separated normal (1 0 0)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching normal (1 0 0) at 0 a 1 b 0"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_by_hand_are_judged_right),
        cmocka_unit_test(squares_by_hand_are_judged_right),
        cmocka_unit_test(vertices_of_tetrahedra_are_counted_from_the_origin),
        cmocka_unit_test(unknown_verdicts_are_not_proved),
        cmocka_unit_test(the_reason_is_optional),
        cmocka_unit_test(weights_are_what_the_oracle_says),
        cmocka_unit_test(normals_are_what_whole_numbers_say),
        cmocka_unit_test(random_bytes_prove_nothing),
        cmocka_unit_test(many_digits_are_read),
        cmocka_unit_test(corners_beyond_the_doubles_are_judged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
