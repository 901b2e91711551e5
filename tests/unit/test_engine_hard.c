/* The exact and the certified method against the oracle on pairs that are hard for a reason:
 * verdict, interval and box, in both orders; families of pairs, and cases that have a name.
 *
 * Each family draws pairs from the seed that it prints (FMB_SEED gives one back); FMB_SAMPLE=10
 * draws ten times as many, FMB_FAST=1 an eighth. */

#include "unit.h"

#include <float.h>

#include "hard_pairs.h"
#include "referee.h"

static void engine_agrees_on_family(void **state)
{
    const struct hard_family *family = *state;
    const long size = draw_sample(family->usual);
    long count[4] = {0};
    struct draw draw;
    draw_begin(&draw, family->name);
    for (long n = 0; n < size; n++) {
        struct question question;
        hard_draw(&draw, family, &question);
        enum fmb_verdict verdict = referee_assert(&question);
        if (family->verdict > 0 && (int) verdict != family->verdict)
            referee_fail(&question, "not the verdict it was made for");
        count[verdict]++;
    }
    printf("# %s: %ld separated, %ld touching, %ld overlapping\n", family->name,
           count[FMB_SEPARATED], count[FMB_TOUCHING], count[FMB_OVERLAPPING]);
    if (family->verdict == 0 && size >= 200) /* fewer may miss one by chance */
        assert_true(count[FMB_SEPARATED] && count[FMB_TOUCHING] && count[FMB_OVERLAPPING]);
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
    double contact[2]; /* exactly; < 0: what the oracle accepts */
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

/* The interval of the exact method is the tightest: exact where its ends are doubles. */
static void case_with_a_name(void **state)
{
    const struct named *named = *state;
    struct fmb_answer exact;
    if (referee_assert(&named->question) != named->verdict)
        referee_fail(&named->question, "not the verdict that it has");
    referee_decide(&named->question, &exact);
    if (exact.has_contact && named->contact[0] >= 0 &&
        (exact.contact[0] != named->contact[0] || exact.contact[1] != named->contact[1]))
        referee_fail(&named->question, "not the times that it has");
}

int main(void)
{
    enum { FAMILIES_MAX = 32 };
    struct CMUnitTest tests[FAMILIES_MAX + COUNT(cases)];
    size_t count = 0;
    for (; hard_family_at(count); count++) {
        assert_true(count < FAMILIES_MAX);
        tests[count] =
            (struct CMUnitTest){.name = hard_family_at(count)->name,
                                .test_func = engine_agrees_on_family,
                                .initial_state = (void *) (uintptr_t) hard_family_at(count)};
    }
    for (size_t i = 0; i < COUNT(cases); i++)
        tests[count++] = (struct CMUnitTest){.name = cases[i].name,
                                             .test_func = case_with_a_name,
                                             .initial_state = (void *) (uintptr_t) &cases[i]};
    return _cmocka_run_group_tests("engine_hard", tests, count, NULL, NULL);
}
