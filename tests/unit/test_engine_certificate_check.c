/* The checker of certificates: by hand, and on random texts that say something of small pairs,
 * flat or not. What it says of a point is held against the oracle, what it says of a normal
 * against whole numbers. */

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

static const struct by_hand cubes_by_hand[] = {
    {3, false, FMB_SEPARATED, "separated + a0", true},
    {3, false, FMB_SEPARATED, "separated + d", true},
    {3, false, FMB_SEPARATED, "separated + a1 x b2", true},
    {3, false, FMB_SEPARATED, "separated - b2 x a1", true},
    {3, false, FMB_SEPARATED, "separated + (a0 x b1) x d", false},
    {3, false, FMB_SEPARATED, "separated + (a1 x d) x b1", true},
    {3, false, FMB_SEPARATED, "separated - a0", false},
    {3, false, FMB_SEPARATED, "separated + v", false},
    {3, false, FMB_SEPARATED, "separated + a3", false},
    {3, false, FMB_SEPARATED, "separated + b3", false},
    {3, false, FMB_SEPARATED, "separated + z", false},
    {3, false, FMB_SEPARATED, "separated + a1 x z", false},
    {3, false, FMB_SEPARATED, "separated + a", false},
    {3, false, FMB_SEPARATED, "separated + c0", false},
    {3, false, FMB_SEPARATED, "separated + ", false},
    {3, false, FMB_SEPARATED, "separated", false},
    {3, false, FMB_SEPARATED, "", false},
    {3, false, FMB_SEPARATED, "separated a0", false},
    {3, false, FMB_SEPARATED, "separated  + a0", false},
    {3, false, FMB_SEPARATED, " separated + a0", false},
    {3, false, FMB_SEPARATED, "separated + a0 ", false},
    {3, false, FMB_SEPARATED, "separated + a0\n", false},
    {3, false, FMB_SEPARATED, "separated + a00", false},
    {3, false, FMB_SEPARATED, "separated + a0 at 0 (1 0 0)", false},
    {3, false, FMB_SEPARATED, "separated + a1 x a1", false},
    {3, false, FMB_SEPARATED, "separated + a1 x", false},
    {3, false, FMB_SEPARATED, "separated + a1 x ", false},
    {3, false, FMB_SEPARATED, "separated + a1 x b2 x b2", false},
    {3, false, FMB_SEPARATED, "separated + (a1 x b2)", false},
    {3, false, FMB_SEPARATED, "separated + (a1 x b2) x", false},
    {3, false, FMB_SEPARATED, "separated + (a1) x b2", false},
    {3, false, FMB_SEPARATED, "separated + ((a1 x b2) x a1) x a1", false},
    {3, false, FMB_TOUCHING, "separated + a0", false},
    {3, false, FMB_OVERLAPPING, "separated + a0", false},
    {3, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 0)", false},
    {3, false, FMB_OVERLAPPING, "overlapping at 0 (1 0 0)", false},

    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 0)", true},
    {1, false, FMB_TOUCHING, "touching - b1 x a2 at 0 (1 1/2 2/3)", false},
    {1, false, FMB_TOUCHING, "touching + b1 x a2 at 0 (1 1/2 2/3)", true},
    {1, false, FMB_TOUCHING,
     "touching + b1 x a2 at 0 (1 1/2 123456789012345678901/"
     "123456789012345678902)",
     true},
    {1, false, FMB_TOUCHING,
     "touching + b1 x a2 at 0 (1 1/2 123456789012345678902/"
     "123456789012345678901)",
     false},
    {1, false, FMB_TOUCHING, "touching + v at 0 (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a1 at 0 (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 1 (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 -1/9)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (0 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (2 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 0", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 1 0 0", false},
    {1, false, FMB_TOUCHING, "touching + a0 at (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0", false},
    {1, false, FMB_TOUCHING, "touching at 0 (1 0 0)", false},
    {1, false, FMB_TOUCHING, "touching + a0 at 0 (1 0 0)x", false},
    {1, false, FMB_SEPARATED, "separated + a0", false},
    {1, false, FMB_OVERLAPPING, "overlapping at 0 (1 1/2 1/2)", false},

    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 1/2)", true},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (1/2 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (1 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (4/6 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (-2/-3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 +1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 01/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/02 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 1/0)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 0/0)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 1/)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 /2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 .5)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 0.5)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3 1/2 5e-1)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0 (2/3  1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0/1 (2/3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0/3 (2/3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at -0 (2/3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 1 (2/3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping at 0/0 (2/3 1/2 1/2)", false},
    {0.5, false, FMB_OVERLAPPING, "overlapping", false},

    {-1.5, true, FMB_OVERLAPPING, "overlapping at 3/2 (1/8 1/2 1/2)", true},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at 1 (0 1/2 1/2)", false},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at 3 (1/2 1/2 1/2)", false},
    {-1.5, true, FMB_OVERLAPPING, "overlapping at -1 (1/2 1/2 1/2)", false},
    {0.5, true, FMB_OVERLAPPING, "overlapping at 1/2 (7/8 1/2 1/2)", true},
    {0.5, true, FMB_OVERLAPPING, "overlapping at -1/2 (7/8 1/2 1/2)", false},
    {-2, true, FMB_TOUCHING, "touching - a0 at 2 (0 0 1/3)", true},
    {-2, true, FMB_TOUCHING, "touching - v at 2 (0 0 1/3)", true},
    {-2, true, FMB_TOUCHING, "touching - v at 1 (0 0 1/3)", false},
    {-2, true, FMB_TOUCHING, "touching + v at 2 (0 0 1/3)", false},
    {1, true, FMB_TOUCHING, "touching + v at 0 (1 1 1)", true},
    {1.5, true, FMB_SEPARATED, "separated + v", true},
    {-2.5, true, FMB_SEPARATED, "separated - v", true},
    {-1.5, true, FMB_SEPARATED, "separated - v", false},
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

/* A tetrahedron in space has six edges. */
static void edges_of_tetrahedra_have_six_names(void **state)
{
    struct question question = cubes(3, false);
    question.a.shape = question.b.shape = FMB_TETRAHEDRON;
    struct ready ready;
    referee_ready(&question, &ready);
    assert_true(holds(&ready.pair, FMB_SEPARATED, "separated - a3")); /* (-1, 1, 0) */
    assert_true(holds(&ready.pair, FMB_SEPARATED, "separated - b4")); /* (-1, 0, 1) */
    assert_false(holds(&ready.pair, FMB_SEPARATED, "separated - b5"));
    assert_false(holds(&ready.pair, FMB_SEPARATED, "separated - a6"));
    assert_false(holds(&ready.pair, FMB_SEPARATED, "separated + b6"));
    assert_false(holds(&ready.pair, FMB_SEPARATED, "separated + a/"));
    assert_false(holds(&ready.pair, FMB_SEPARATED, "separated + a:"));
}

static void unknown_verdicts_are_not_proved(void **state)
{
    const struct question question = cubes(3, false);
    struct ready ready;
    referee_ready(&question, &ready);
    assert_false(holds(&ready.pair, (enum fmb_verdict) 0, "separated + a0"));
    assert_false(holds(&ready.pair, (enum fmb_verdict) 4, "separated + a0"));
    assert_false(holds(&ready.pair, (enum fmb_verdict) - 1, ""));
}

/* In the plane z = 0 points have two coordinates, and there is a z. */
static void squares_by_hand_are_judged_right(void **state)
{
    struct question question = {.a = {2, FMB_TETRAHEDRON, {{1, 0}, {0, 1}}, {0}, {0}, false},
                                .b = {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0.5, 0.5}, {0}, false},
                                .duration = 1};
    struct ready ready;
    referee_ready(&question, &ready);
    assert_true(holds(&ready.pair, FMB_TOUCHING, "touching + z x a2 at 0 (1/2 1/2)") !=
                holds(&ready.pair, FMB_TOUCHING, "touching - z x a2 at 0 (1/2 1/2)"));
    assert_true(holds(&ready.pair, FMB_TOUCHING, "touching - z x a2 at 0 (1/2 1/2)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching - z x a2 at 0 (1/2 1/2 0)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching - z x a2 at 0 (1/2)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching - z x a3 at 0 (1/2 1/2)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching + z at 0 (1/2 1/2)"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching - z x b2 at 0 (1/2 1/2)"));
}

static void the_reason_is_optional(void **state)
{
    const struct question question = cubes(3, false);
    struct ready ready;
    char why[4] = "###";
    referee_ready(&question, &ready);
    assert_true(pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated + a0", NULL, 0));
    assert_false(pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated - a0", NULL, 0));
    assert_false(pair_certificate_holds(&ready.pair, FMB_SEPARATED, "separated - a0", why, 2));
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

/* before, then quarters / 4 in lowest terms; returns its length. */
static int print_quarters(char *out, size_t size, const char *before, int quarters)
{
    if (quarters % 4 == 0)
        return snprintf(out, size, "%s%d", before, quarters / 4);
    if (quarters % 2 == 0)
        return snprintf(out, size, "%s%d/2", before, quarters / 2);
    return snprintf(out, size, "%s%d/4", before, quarters);
}

/* A point of the frame at time t, or near it: parameters that are quarters, of a simplex too. */
static void draw_point(struct draw *draw, const struct solid *solid, double t,
                       double p[FMB_DIM_MAX])
{
    for (int axis = 0; axis < solid->dim; axis++)
        p[axis] = solid->origin[axis] + (solid->moving ? t * solid->velocity[axis] : 0);
    for (int i = 0; i < solid_count(solid); i++) {
        const double x = draw_int(draw, 0, solid->shape == FMB_CUBOID ? 4 : 2) / 4.0;
        for (int axis = 0; axis < solid->dim; axis++)
            p[axis] += x * solid->component[i][axis];
    }
    if (draw_int(draw, 0, 3) == 0)
        p[draw_int(draw, 0, solid->dim - 1)] += draw_int(draw, -1, 1) / 4.0;
}

static bool has_velocity(const struct solid *solid)
{
    for (int axis = 0; axis < solid->dim && solid->moving; axis++)
        if (solid->velocity[axis] != 0)
            return true;
    return false;
}

/* On output: " at TIME (POINT)" in text, the numbers in *t and p, all of them quarters. */
static void draw_event(struct draw *draw, const struct question *question, char *text, size_t size,
                       double *t, double p[FMB_DIM_MAX])
{
    const bool moving = has_velocity(&question->a) || has_velocity(&question->b);
    const int quarters = moving ? draw_int(draw, 0, (int) (4 * question->duration)) : 0;
    int used = print_quarters(text, size, " at ", quarters);
    *t = quarters / 4.0;
    draw_point(draw, draw_coin(draw) ? &question->a : &question->b, *t, p);
    for (int axis = 0; axis < question->a.dim; axis++)
        used += print_quarters(text + used, size - (size_t) used, axis == 0 ? " (" : " ",
                               (int) (4 * p[axis]));
    snprintf(text + used, size - (size_t) used, ")");
}

/* The certificate with the event in place of its own. */
static void put_event(const char *certificate, const char *event, char *out, size_t size)
{
    const char *at = strstr(certificate, " at ");
    snprintf(out, size, "%.*s%s", (int) (at - certificate), certificate, event);
}

static void points_are_where_the_oracle_says(void **state)
{
    struct draw draw;
    draw_begin(&draw, "points_are_where_the_oracle_says");
    long taken = 0, refused = 0;
    char text[TEXT_SIZE], event[200], other[2 * TEXT_SIZE];
    for (long n = draw_sample(12000); n > 0; n--) {
        struct question question;
        struct ready ready;
        double t, p[FMB_DIM_MAX] = {0};
        question = draw_question(&draw);
        referee_ready(&question, &ready);
        const enum fmb_verdict verdict = make(&ready.pair, text);
        if (verdict == FMB_SEPARATED)
            continue;
        draw_event(&draw, &question, event, sizeof event, &t, p);
        put_event(text, event, other, sizeof other);
        const enum fmb_verdict in_a = oracle_of_point(&question.a, t, p);
        const enum fmb_verdict in_b = oracle_of_point(&question.b, t, p);
        const bool right = in_a >= verdict && in_b >= verdict;
        if (holds(&ready.pair, verdict, other) != right) {
            printf("# %s\n", other);
            referee_fail(&question, "the checker and the oracle differ over a point");
        }
        *(right ? &taken : &refused) += 1;
    }
    printf("# %ld points taken, %ld refused\n", taken, refused);
    assert_true(taken > 0 && refused > 0);
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

/* A name that fmb.h gives to a vector of the pair, and the vector. */
static struct integer_vector draw_vector(struct draw *draw, const struct question *question,
                                         char name[3])
{
    static const struct integer_vector zero;
    const struct solid *a = &question->a, *b = &question->b;
    const int kind = draw_int(draw, 0, 9);
    name[1] = '\0';
    if (kind == 0) {
        name[0] = 'd';
        return difference(integer_vector(b->origin), integer_vector(a->origin));
    }
    if (kind == 1) {
        name[0] = 'v';
        return difference(b->moving ? integer_vector(b->velocity) : zero,
                          a->moving ? integer_vector(a->velocity) : zero);
    }
    if (kind <= 4 && a->dim == 2) {
        name[0] = 'z';
        return (struct integer_vector){{0, 0, 1}};
    }
    static const int from[] = {-1, -1, -1, 0, 0, 1}, to[] = {0, 1, 2, 1, 2, 2};
    const struct solid *solid = draw_coin(draw) ? a : b;
    const int count = solid_count(solid);
    const bool simplex = solid->shape != FMB_CUBOID;
    const int edge = draw_int(draw, 0, simplex ? count * (count + 1) / 2 - 1 : count - 1);
    name[0] = solid == a ? 'a' : 'b';
    name[1] = (char) ('0' + edge);
    name[2] = '\0';
    if (simplex && count == 2 && edge == 2)
        return difference(integer_vector(solid->component[1]), integer_vector(solid->component[0]));
    const struct integer_vector end = integer_vector(solid->component[to[edge]]);
    return from[edge] < 0 ? end : difference(end, integer_vector(solid->component[from[edge]]));
}

/* On output: " NORMAL" in text. Returns N. */
static struct integer_vector draw_normal(struct draw *draw, const struct question *question,
                                         char *text, size_t size)
{
    char u[3], v[3], w[3], sign = draw_coin(draw) ? '+' : '-';
    struct integer_vector normal = draw_vector(draw, question, u);
    const int vectors = draw_int(draw, 1, 3);
    if (vectors > 1)
        normal = product(normal, draw_vector(draw, question, v));
    if (vectors > 2)
        normal = product(normal, draw_vector(draw, question, w));
    switch (vectors) {
    case 1: snprintf(text, size, " %c %s", sign, u); break;
    case 2: snprintf(text, size, " %c %s x %s", sign, u, v); break;
    case 3: snprintf(text, size, " %c (%s x %s) x %s", sign, u, v, w); break;
    }
    static const struct integer_vector zero;
    return sign == '-' ? difference(zero, normal) : normal;
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
    char text[TEXT_SIZE], normal_text[40], other[2 * TEXT_SIZE];
    for (long n = draw_sample(12000); n > 0; n--) {
        struct question question;
        struct ready ready;
        question = draw_question(&draw);
        referee_ready(&question, &ready);
        const enum fmb_verdict verdict = make(&ready.pair, text);
        if (verdict == FMB_OVERLAPPING)
            continue;
        const struct integer_vector normal =
            draw_normal(&draw, &question, normal_text, sizeof normal_text);
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
    const struct question question = cubes(0, false);
    struct ready ready;
    referee_ready(&question, &ready);
    const size_t size = 2 * ZEROS + 100;
    char *zeros = calloc(ZEROS + 1, 1), *text = malloc(size);
    memset(zeros, '0', ZEROS);
    snprintf(text, size, "overlapping at 0 (1/2 1/2 1%s/1%s1)", zeros, zeros + 1);
    assert_true(holds(&ready.pair, FMB_OVERLAPPING, text));
    snprintf(text, size, "overlapping at 0 (1/2 1/2 1%s1/1%s)", zeros + 1, zeros);
    assert_false(holds(&ready.pair, FMB_OVERLAPPING, text));
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
    assert_true(holds(&ready.pair, FMB_SEPARATED, "separated + a1 x a2"));
    assert_false(holds(&ready.pair, FMB_TOUCHING, "touching + a1 x a2 at 0 (0 0 0)"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_by_hand_are_judged_right),
        cmocka_unit_test(squares_by_hand_are_judged_right),
        cmocka_unit_test(edges_of_tetrahedra_have_six_names),
        cmocka_unit_test(unknown_verdicts_are_not_proved),
        cmocka_unit_test(the_reason_is_optional),
        cmocka_unit_test(points_are_where_the_oracle_says),
        cmocka_unit_test(normals_are_what_whole_numbers_say),
        cmocka_unit_test(random_bytes_prove_nothing),
        cmocka_unit_test(many_digits_are_read),
        cmocka_unit_test(corners_beyond_the_doubles_are_judged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
