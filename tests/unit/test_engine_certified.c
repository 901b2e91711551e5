/* The certified method: changes of a question whose effect on the answer is known, and cases that
 * have a name. Each answer is held against the oracle, and its verdict against the exact method. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>

#include "draw.h"
#include "oracle.h"
#include "question.h"
#include "referee.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static void decide(const char *method, const struct question *question, const struct ready *ready,
                   struct fmb_answer *answer)
{
    enum fmb_status status =
        pair_decide(fmb_method_by_name(method), &ready->pair, FMB_WANT_BOX, answer);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

/* The certified answer, found right. */
static void decide_checked(const struct question *question, struct fmb_answer *answer)
{
    struct ready ready;
    struct fmb_answer exact;
    char why[200];
    referee_ready(question, &ready);
    decide("certified", question, &ready, answer);
    decide("exact", question, &ready, &exact);
    if (answer->verdict != exact.verdict)
        referee_fail(question, "the exact method has another verdict");
    if (!oracle_check(&ready.pair, FMB_WANT_BOX, answer, why, sizeof why))
        referee_fail(question, why);
}

/* ---- Questions ---- */

static double whole(struct draw *draw)
{
    return draw_int(draw, -4, 4);
}

static double any(struct draw *draw)
{
    return draw_uniform(draw, -4, 4);
}

static struct solid draw_solid(struct draw *draw, int dim, double (*number)(struct draw *))
{
    struct solid solid = {.dim = dim, .moving = draw_coin(draw)};
    solid.shape = draw_int(draw, 0, 15) == 0 && dim == 3
                      ? FMB_FACE
                      : (enum fmb_shape) draw_int(draw, FMB_CUBOID, FMB_TETRAHEDRON);
    for (int axis = 0; axis < dim; axis++) {
        for (int i = 0; i < solid_count(&solid); i++)
            solid.component[i][axis] = number(draw);
        solid.origin[axis] = number(draw);
        solid.velocity[axis] = number(draw);
    }
    return solid;
}

static struct question draw_question(struct draw *draw, double (*number)(struct draw *))
{
    static const double durations[] = {0, 0.5, 1, 4};
    const int dim = draw_int(draw, 2, 3);
    struct question question = {draw_solid(draw, dim, number), draw_solid(draw, dim, number),
                                durations[draw_int(draw, 0, 3)]};
    return question;
}

/* Numbers that round, or small whole ones, and then about as often in contact by a hair. */
static struct question draw_either(struct draw *draw)
{
    return draw_question(draw, draw_coin(draw) ? whole : any);
}

/* ---- Changes ---- */

/* Calls change for each vector of the question: origins, components, velocities. */
static void change_vectors(struct question *question,
                           void (*change)(double *vector, int dim, int parameter), int parameter)
{
    struct solid *solids[2] = {&question->a, &question->b};
    for (int f = 0; f < 2; f++) {
        change(solids[f]->origin, solids[f]->dim, parameter);
        change(solids[f]->velocity, solids[f]->dim, parameter);
        for (int i = 0; i < FMB_DIM_MAX; i++)
            change(solids[f]->component[i], solids[f]->dim, parameter);
    }
}

static void swapped_is_the_same_to_the_bit(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "swapped_is_the_same_to_the_bit");
    for (long n = draw_sample(8000); n > 0; n--) {
        const struct question question = draw_either(&draw);
        const struct question swapped = question_swapped(&question);
        struct fmb_answer one, other;
        decide_checked(&question, &one);
        decide_checked(&swapped, &other);
        if (!referee_same(&one, &other))
            referee_fail(&question, "differs the other way round");
    }
}

static void expect_verdict(const struct question *question, const struct fmb_answer *expected,
                           const char *what)
{
    struct fmb_answer found;
    decide_checked(question, &found);
    if (found.verdict != expected->verdict)
        referee_fail(question, what);
}

static void rotate_axes(double *vector, int dim, int times)
{
    for (; times > 0; times--) {
        const double first = vector[0];
        memmove(vector, vector + 1, (size_t) (dim - 1) * sizeof *vector);
        vector[dim - 1] = first;
    }
}

static void exchange_axes(double *vector, int dim, int parameter)
{
    (void) dim, (void) parameter;
    const double first = vector[0];
    vector[0] = vector[1];
    vector[1] = first;
}

static void axes_have_no_order(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "axes_have_no_order");
    for (long n = draw_sample(8000); n > 0; n--) {
        struct question question = draw_either(&draw);
        struct fmb_answer answer;
        decide_checked(&question, &answer);
        change_vectors(&question, rotate_axes, draw_int(&draw, 0, 2));
        if (draw_coin(&draw))
            change_vectors(&question, exchange_axes, 0);
        expect_verdict(&question, &answer, "another verdict with other axes");
    }
}

static void scale(double *vector, int dim, int exponent)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = ldexp(vector[axis], exponent);
}

/* From one end of the doubles to the other: some of it is more than doubles can say anything of. */
static void size_is_relative(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "size_is_relative");
    for (long n = draw_sample(4000); n > 0; n--) {
        const struct question question = draw_either(&draw);
        struct fmb_answer answer;
        decide_checked(&question, &answer);
        for (int times = 0; times < 3; times++) {
            struct question scaled = question;
            change_vectors(&scaled, scale, draw_int(&draw, -950, 950));
            expect_verdict(&scaled, &answer, "another verdict at another scale");
        }
    }
}

/* Seconds so short or long that a velocity, or what it is multiplied with, may vanish. */
static void time_can_be_scaled(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "time_can_be_scaled");
    for (long n = draw_sample(6000); n > 0; n--) {
        struct question question = draw_either(&draw);
        struct fmb_answer answer;
        decide_checked(&question, &answer);
        const int exponent = draw_int(&draw, -900, 900);
        question.duration = ldexp(question.duration, exponent);
        scale(question.a.velocity, FMB_DIM_MAX, -exponent);
        scale(question.b.velocity, FMB_DIM_MAX, -exponent);
        expect_verdict(&question, &answer, "another verdict in other seconds");
    }
}

static void place_does_not_matter(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "place_does_not_matter");
    for (long n = draw_sample(8000); n > 0; n--) {
        struct question question = draw_question(&draw, whole);
        struct fmb_answer answer;
        decide_checked(&question, &answer);
        for (int axis = 0; axis < question.a.dim; axis++) {
            const double way = draw_int(&draw, -1, 1) * ldexp(1, draw_int(&draw, 0, 49));
            question.a.origin[axis] += way;
            question.b.origin[axis] += way;
        }
        expect_verdict(&question, &answer, "another verdict elsewhere");
    }
}

static void expect_times(const struct question *question, const double expected[2],
                         const double found[2])
{
    for (int end = 0; end < 2; end++)
        if (!(fabs(expected[end] - found[end]) <= 2.1e-12 * question->duration))
            referee_fail(question, "other times");
}

static void a_common_velocity_changes_no_times(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "a_common_velocity_changes_no_times");
    for (long n = draw_sample(8000); n > 0; n--) {
        struct question question = draw_question(&draw, whole);
        struct fmb_answer still, moved;
        question.a.moving = question.b.moving = true;
        decide_checked(&question, &still);
        for (int axis = 0; axis < question.a.dim; axis++) {
            const double more = draw_int(&draw, -9, 9) * ldexp(1, draw_int(&draw, 0, 20));
            question.a.velocity[axis] += more;
            question.b.velocity[axis] += more;
        }
        decide_checked(&question, &moved);
        if (still.verdict != moved.verdict)
            referee_fail(&question, "another verdict with more velocity of both");
        if (still.has_contact)
            expect_times(&question, still.contact, moved.contact);
    }
}

/* Start where they end, go back. */
static void time_runs_backwards(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "time_runs_backwards");
    for (long n = draw_sample(8000); n > 0; n--) {
        struct question question = draw_question(&draw, whole);
        struct fmb_answer forth, back;
        const double T = question.duration;
        question.a.moving = question.b.moving = true;
        decide_checked(&question, &forth);
        for (int axis = 0; axis < question.a.dim; axis++) {
            question.a.origin[axis] += T * question.a.velocity[axis];
            question.b.origin[axis] += T * question.b.velocity[axis];
            question.a.velocity[axis] = -question.a.velocity[axis];
            question.b.velocity[axis] = -question.b.velocity[axis];
        }
        decide_checked(&question, &back);
        if (forth.verdict != back.verdict)
            referee_fail(&question, "another verdict back in time");
        if (forth.has_contact)
            expect_times(&question, (double[2]){T - forth.contact[1], T - forth.contact[0]},
                         back.contact);
    }
}

/* ---- Cases with a name ---- */

#define BOX(x, y, z)          \
    3, FMB_CUBOID,            \
    {                         \
        {x, 0, 0}, {0, y, 0}, \
        {                     \
            0, 0, z           \
        }                     \
    }
#define CORNER(x, y, z)       \
    3, FMB_TETRAHEDRON,       \
    {                         \
        {x, 0, 0}, {0, y, 0}, \
        {                     \
            0, 0, z           \
        }                     \
    }
#define STILL {0}, false

struct named {
    const char *name;
    struct question question;
    enum fmb_verdict verdict;
    double contact[2]; /* exactly; < 0: near enough for the oracle will do */
};

static const struct named cases[] = {
    {"overlap_then_recede",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0.5, 0, 0}, {1, 0, 0}, true}, 2},
     FMB_OVERLAPPING,
     {0, 0.5}},
    {"slide_along_a_face",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {1, -2, 0}, {0, 1, 0}, true}, 4},
     FMB_TOUCHING,
     {1, 3}},
    {"slide_along_the_face_of_a_corner",
     {{CORNER(4, 4, 4), {0}, STILL}, {BOX(1, 1, 1), {4, 0, 0}, {-1, 1, 0}, true}, 1},
     FMB_TOUCHING,
     {0, 1}},
    {"graze_in_an_instant",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0, 2, 0}, {1, -1, 0}, true}, 4},
     FMB_TOUCHING,
     {1, 1}},
    {"graze_at_a_vertex",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(-1, -1, -1), {-1, 1, 0}, {1, -1, 0}, true}, 2},
     FMB_TOUCHING,
     {-1, -1}},
    {"graze_at_a_third",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0, 2, 0}, {3, -3, 0}, true}, 1},
     FMB_TOUCHING,
     {-1, -1}},
    {"arrive_as_the_window_closes",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {3, 0, 0}, {-1, 0, 0}, true}, 2},
     FMB_TOUCHING,
     {2, 2}},
    {"velocity_zero",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0.5, 0.5, 0.5}, {0}, true}, 2},
     FMB_OVERLAPPING,
     {0, 2}},
    {"velocity_zero_touching",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {1, 1, 1}, {0}, true}, 2},
     FMB_TOUCHING,
     {0, 2}},
    {"velocity_of_a_nanometre",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {1.0000000005, 0, 0}, {-1e-9, 0, 0}, true}, 1},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"velocity_of_a_nanometre_too_slow",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {1.0000000015, 0, 0}, {-1e-9, 0, 0}, true}, 1},
     FMB_SEPARATED,
     {-1, -1}},
    {"thin_and_fast",
     {{BOX(1e-9, 1, 1), {0}, STILL}, {BOX(1e-9, 1, 1), {-5e8, 0.25, 0.25}, {1e9, 0, 0}, true}, 1},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"thin_and_fast_past",
     {{BOX(1e-9, 1, 1), {0}, STILL}, {CORNER(1e-9, 1, 1), {-5e8, 1, 0}, {1e9, 1e-9, 0}, true}, 1},
     FMB_SEPARATED,
     {-1, -1}},
    {"no_time",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0.5, 0, 0}, {1, 0, 0}, true}, 0},
     FMB_OVERLAPPING,
     {0, 0}},
    {"minus_no_time",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {1, 0, 0}, {-1, 0, 0}, true}, -0.0},
     FMB_TOUCHING,
     {0, 0}},
    {"all_time",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {3, 0, 0}, {-1, 0, 0}, true}, DBL_MAX},
     FMB_OVERLAPPING,
     {2, 4}},
    {"all_time_and_slow",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {3, 0, 0}, {-0x1p-1022, 0, 0}, true}, DBL_MAX},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"hardly_any_time",
     {{BOX(1, 1, 1), {0}, STILL}, {BOX(1, 1, 1), {0.5, 0, 0}, {1, 0, 0}, true}, 0x1p-1074},
     FMB_OVERLAPPING,
     {0, 0x1p-1074}},
    {"hardly_any_time_but_fast",
     {{BOX(1, 1, 1), {0}, STILL},
      {BOX(1, 1, 1), {1.75, 0, 0}, {-0x1p1023, 0, 0}, true},
      0x1.8p-1022},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"hardly_any_time_and_far_too_fast",
     {{BOX(0x1p-74, 0x1p-74, 0x1p-74), {0}, STILL},
      {BOX(0x1p-74, 0x1p-74, 0x1p-74), {0x1p-73, 0, 0}, {-0x1p1000, 0, 0}, true},
      3 * 0x1p-1074},
     FMB_OVERLAPPING,
     {0x1p-1074, 3 * 0x1p-1074}},
    {"both_fast_together",
     {{BOX(1, 1, 1), {0}, {1e300, -1e300, 0}, true},
      {BOX(1, 1, 1), {1, 0, 0}, {1e300, -1e300, 0}, true},
      3},
     FMB_TOUCHING,
     {0, 3}},
    {"both_slow_together",
     {{BOX(1, 1, 1), {0}, {0x1p-1000, -0x1p-1000, 0}, true},
      {BOX(1, 1, 1), {0.5, 0, 0}, {0x1p-1000, -0x1p-1000, 0}, true},
      0x1p-100},
     FMB_OVERLAPPING,
     {0, 0x1p-100}},
    {"subnormal",
     {{BOX(0x1p-1073, 0x1p-1073, 0x1p-1073), {0}, STILL},
      {CORNER(0x1p-1074, 0x1p-1074, 0x1p-1074), {0x1p-1073, 0, 0}, {0x1p-1074, 0, 0}, true},
      1},
     FMB_TOUCHING,
     {0, 0}},
    {"the_largest",
     {{BOX(1e308, 1e308, 1e308), {0}, STILL},
      {BOX(1e308, 1e308, -1e308), {1e308, 0, 0}, {-1e308, 0, 1e308}, true},
      1},
     FMB_OVERLAPPING,
     {0, 1}},
    {"the_largest_far_apart",
     {{BOX(1e308, 1e308, 1e308), {-DBL_MAX, 0, 0}, STILL},
      {CORNER(1e308, 1e308, 1e308), {DBL_MAX, 0, 0}, {-DBL_MAX, 0, 0}, true},
      1},
     FMB_SEPARATED,
     {-1, -1}},
    /* A part of the window, rounded to seconds, is off by less than any double, on the wrong side.
     */
    {"hardly_any_time_to_recede",
     {{2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, STILL},
      {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, {369 * 0x1p1007, 0}, true},
      173 * 0x1p-1007},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"hardly_any_time_to_arrive",
     {{2, FMB_CUBOID, {{1, 0}, {0, 1}}, {0}, STILL},
      {2, FMB_CUBOID, {{1, 0}, {0, 1}}, {-2, 0}, {1161 * 0x1p1006, 0}, true},
      65 * 0x1p-1006},
     FMB_OVERLAPPING,
     {-1, -1}},
    /* Two edges along the same axis, each the difference of two components: their slab is noise
     * that a fast drift makes large. */
    {"noise_of_a_zero_normal",
     {{3,
       FMB_TETRAHEDRON,
       {{0x1.bb4601b010ep-5, -0x1.9f5bc479f616p-5, -0x1.2ee7129a4b90ep-1},
        {-0x1.0247c11778514p-2, -0x1.9f5bc479f616p-5, -0x1.2ee7129a4b90ep-1},
        {0x1.bb4601b010ep-5, -0x1.7818e0a09f02p-1, -0x1.2ee7129a4b90ep-1}},
       {0x1.ea03ce4e4da02p-2, 0x1.c6ae0aa926bccp-3, 0x1.c40cf723bf776p+0},
       {-0x1.03ec8f602686ap+130, -0x1.0b7f357f606ap+130, 0x1.130550368b288p+130},
       true},
      {3,
       FMB_TETRAHEDRON,
       {{0x1.c8f7188f55e88p-2, -0x1.2594dabc09dep-5, -0x1.afdb5c21bbddep-1},
        {-0x1.ed32109c5841p-3, -0x1.2594dabc09dep-5, -0x1.afdb5c21bbddep-1},
        {0x1.c8f7188f55e88p-2, -0x1.4d87fa43a39cep-1, -0x1.afdb5c21bbddep-1}},
       {-0x1.eb3dae053bc25p-5, 0x1.e6c1663944f1ap-2, 0x1.f7bc13fe749fdp+0},
       {0x1.bf8d8052ba7c6p+130, 0x1.8b3941cabb608p+128, 0},
       true},
      1},
     FMB_OVERLAPPING,
     {-1, -1}},
    /* A drift with one number so small that its product with an edge underflows, in the one slab
     * that matters. */
    {"drift_that_underflows",
     {{3,
       FMB_TETRAHEDRON,
       {{0x1p-400, 0x1p-199, -0x1p-199},
        {0x1p-400 + 0x1p-451, 0x1p-199, -0x1p-199},
        {0x1p-202, -0x1p-200, -0x1p-198}},
       {0x1p-200, -0x1p-199, 0x1p-199},
       {0},
       true},
      {3,
       FMB_TETRAHEDRON,
       {{0x1p-199, 0x1p-199, 0x1p-202},
        {-0x1p-199, 0x1p-198, -0x1p-202},
        {0x1p-201, 0x1.8p-199, 0x1p-200}},
       {0x1p-400 + 0x1p-452, 0, -0x1p-641},
       {0x1p-199, 0, 0x1p-640},
       true},
      1},
     FMB_TOUCHING,
     {-1, -1}},
    /* An edge along the drift: the slab does not move, but doubles cannot know which way. */
    {"edge_along_the_drift",
     {{2,
       FMB_CUBOID,
       {{0x1.7ee0dc30fdc1cp+0, 0x1.7ee0dc30fdc1cp+0},
        {-0x1.f17dd944afc88p-2, 0x1.f17dd944afc88p-2}},
       {0},
       STILL},
      {2,
       FMB_CUBOID,
       {{0x1.7866681c8a667p-7, 0x1.0611c7b0209e8p-9},
        {0x1.be0a260794a7dp-10, 0x1.9111711cbbbc8p-7}},
       {-0x1.cb743b6dfd4eep-2, -0x1.d63ebcd0db8dep-2},
       {0x1.1d9a90aaa19b8p-1, 0x1.1d9a90aaa19b8p-1},
       true},
      1},
     FMB_OVERLAPPING,
     {-1, -1}},
    {"plane",
     {{2, FMB_TETRAHEDRON, {{1, 0}, {0, 1}}, {0}, STILL},
      {2, FMB_CUBOID, {{1, -1}, {1, 1}}, {1, 0}, {1, -1}, true},
      1},
     FMB_TOUCHING,
     {-1, -1}},
};

static void case_with_a_name(void **state)
{
    const struct named *named = *state;
    const struct question swapped = question_swapped(&named->question);
    struct fmb_answer answer, other;
    decide_checked(&named->question, &answer);
    decide_checked(&swapped, &other);
    if (!referee_same(&answer, &other))
        referee_fail(&named->question, "differs the other way round");
    if (answer.verdict != named->verdict)
        referee_fail(&named->question, "not the verdict that it has");
    if (answer.has_contact && named->contact[0] >= 0 &&
        (answer.contact[0] != named->contact[0] || answer.contact[1] != named->contact[1]))
        referee_fail(&named->question, "not the times that it has");
}

/* Windows of a few subnormals, in which frames come as far as they are wide. */
static void windows_of_subnormals(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "windows_of_subnormals");
    for (long n = draw_sample(2000); n > 0; n--) {
        struct question question = draw_either(&draw);
        const int exponent = draw_int(&draw, 0, 60);
        const double window = draw_int(&draw, 1, 9) * ldexp(1, exponent / 2);
        question.duration = window * 0x1p-1074;
        change_vectors(&question, scale, -74 + exponent / 2);
        scale(question.a.velocity, FMB_DIM_MAX, 1074 - exponent / 2 - draw_int(&draw, 0, 4));
        scale(question.b.velocity, FMB_DIM_MAX, 1074 - exponent / 2 - draw_int(&draw, 0, 4));
        struct fmb_answer answer;
        decide_checked(&question, &answer);
    }
}

/* ---- What is refused ---- */

/* A speed over a window of 2^-500 s: some make a way of about 1, of others the way is less than any
 * double. */
static double draw_speed(struct draw *draw)
{
    const double some = ldexp(draw_int(draw, -3, 3), 499);
    return draw_coin(draw) ? some : ldexp(draw_int(draw, -3, 3), draw_int(draw, -590, -570));
}

static double draw_offset(struct draw *draw)
{
    return draw_int(draw, -2, 2) + (draw_coin(draw) ? 0 : ldexp(draw_int(draw, -2, 2), -1074)) +
           (draw_coin(draw) ? 0 : draw_int(draw, -2, 2) * 0x1p-52);
}

/* A coordinate of the drift that is 0 as a double and not in truth makes the normals of its slabs
 * vanish where an edge is parallel to what is left of the drift; and of 0 along an axis. */
static void drifts_that_vanish_along_an_axis(void **state)
{
    (void) state;
    struct draw draw;
    long verdicts[4] = {0}, vanished = 0;
    draw_begin(&draw, "drifts_that_vanish_along_an_axis");
    for (long n = draw_sample(20000); n > 0; n--) {
        const int dim = 2 + draw_coin(&draw);
        struct question question = {.duration = 0x1p-500};
        struct fmb_answer answer, exact;
        struct ready ready;
        question.a = draw_solid(&draw, dim, whole);
        question.b = draw_solid(&draw, dim, whole);
        question.a.moving = question.b.moving = true;
        for (int axis = 0; axis < dim; axis++) {
            question.a.origin[axis] = 0;
            question.b.origin[axis] = draw_offset(&draw);
            question.a.velocity[axis] = 0;
            question.b.velocity[axis] = draw_speed(&draw);
            vanished += question.b.velocity[axis] != 0 &&
                        question.b.velocity[axis] * question.duration == 0;
        }
        referee_ready(&question, &ready);
        decide("certified", &question, &ready, &answer);
        decide("exact", &question, &ready, &exact);
        if (answer.verdict != exact.verdict)
            referee_fail(&question, "the exact method has another verdict");
        verdicts[answer.verdict]++;
    }
    printf("# %ld separated, %ld touching, %ld overlapping, %ld coordinates vanished\n",
           verdicts[FMB_SEPARATED], verdicts[FMB_TOUCHING], verdicts[FMB_OVERLAPPING], vanished);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0 && vanished > 0);
}

static void expect_refused(const struct pair *pair, enum fmb_status expected)
{
    static const struct fmb_answer nothing;
    struct fmb_answer answer;
    memset(&answer, 0xa5, sizeof answer);
    assert_int_equal(pair_decide(fmb_method_by_name("certified"), pair, FMB_WANT_BOX, &answer),
                     expected);
    assert_int_equal(answer.verdict, nothing.verdict);
    assert_false(answer.has_contact || answer.has_box);
}

static void what_is_not_finite_is_refused(void **state)
{
    (void) state;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    const struct question question = cases[0].question;
    struct ready ready;
    for (size_t i = 0; i < COUNT(bad); i++) {
        for (int axis = 0; axis < 3; axis++) {
            referee_ready(&question, &ready);
            ready.pair.a.position[axis] = bad[i];
            expect_refused(&ready.pair, FMB_NOT_FINITE);
            referee_ready(&question, &ready);
            ready.pair.b.velocity[axis] = bad[i];
            expect_refused(&ready.pair, FMB_NOT_FINITE);
        }
        referee_ready(&question, &ready);
        ready.pair.duration = bad[i];
        expect_refused(&ready.pair, FMB_BAD_DURATION);
        struct fmb_body body;
        double edges[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        edges[i] = bad[i];
        assert_int_equal(fmb_body_make(3, FMB_CUBOID, edges, 9, &body), FMB_NOT_FINITE);
    }
    referee_ready(&question, &ready);
    ready.pair.duration = -0x1p-1074;
    expect_refused(&ready.pair, FMB_BAD_DURATION);
}

int main(void)
{
    const struct CMUnitTest others[] = {
        cmocka_unit_test(swapped_is_the_same_to_the_bit),
        cmocka_unit_test(axes_have_no_order),
        cmocka_unit_test(size_is_relative),
        cmocka_unit_test(time_can_be_scaled),
        cmocka_unit_test(place_does_not_matter),
        cmocka_unit_test(a_common_velocity_changes_no_times),
        cmocka_unit_test(time_runs_backwards),
        cmocka_unit_test(windows_of_subnormals),
        cmocka_unit_test(drifts_that_vanish_along_an_axis),
        cmocka_unit_test(what_is_not_finite_is_refused),
    };
    struct CMUnitTest tests[COUNT(others) + COUNT(cases)];
    memcpy(tests, others, sizeof others);
    for (size_t i = 0; i < COUNT(cases); i++)
        tests[COUNT(others) + i] =
            (struct CMUnitTest){.name = cases[i].name,
                                .test_func = case_with_a_name,
                                .initial_state = (void *) (uintptr_t) &cases[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
