/* The line of a difference: the field that has changed, and by how much. */
#include "unit.h"

#include "replay_output.h"

#include <math.h>

static struct difference difference;
static struct fmb_answer *then = &difference.then.answer, *now = &difference.now.answer;

/* Two equal answers with everything. */
static int set_up(void **state)
{
    memset(&difference, 0, sizeof difference);
    difference.dim = 3;
    difference.place.number = 17;
    difference.place.utime = 1250000;
    difference.body_id[0] = 3;
    difference.body_id[1] = 7;
    *then = (struct fmb_answer){.verdict = FMB_OVERLAPPING,
                                .has_contact = true,
                                .has_box = true,
                                .has_gap = true,
                                .has_point = true,
                                .contact = {0.25, 0.5},
                                .box = {{0, 0, 0}, {1, 1, 1}},
                                .point = {0.25, 0.5, 0.75, 0},
                                .gap = {.bounds = {-0.5, -0.25}, .direction = {0, 0, 1}}};
    *now = *then;
    return 0;
}

static void expect(enum difference_kind kind, const char *expected)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    difference.kind = kind;
    replay_line(out, ESCAPE_TERMINAL, &difference, NULL, NULL, 0);
    fclose(out);
    const char *begin = "event 17  1.250000 s  ";
    assert_memory_equal(text, begin, strlen(begin));
    assert_string_equal(text + strlen(begin), expected);
    free(text);
}

static void a_number_has_its_name(void **state)
{
    now->contact[1] = 0.75;
    expect(DIFFERENT_INTERVAL, "bodies 3 7  interval end: 0.5, now 0.75 (+0.25)\n");
    now->contact[0] = nextafter(0.25, 0);
    expect(DIFFERENT_INTERVAL,
           "bodies 3 7  interval end: 0.5, now 0.75 (+0.25), and 1 more number\n");
    now->box[1][2] = 0.5;
    expect(DIFFERENT_BOX, "bodies 3 7  box max z: 1, now 0.5 (-0.5)\n");
    now->box[0][0] = -HUGE_VAL;
    expect(DIFFERENT_BOX, "bodies 3 7  box min x: 0, now -inf, and 1 more number\n");
    now->point[3] = -1;
    expect(DIFFERENT_POINT, "bodies 3 7  point position z: 0, now -1 (-1)\n");
    now->point[0] = 2.25;
    expect(DIFFERENT_POINT, "bodies 3 7  point time: 0.25, now 2.25 (+2), and 1 more number\n");
    now->gap.bounds[0] = nextafter(-0.5, 0);
    expect(DIFFERENT_GAP,
           "bodies 3 7  gap lower bound: -0.5, now -0.49999999999999994 (+5.55e-17)\n");
}

/* All that is compared has a name; bounds come before larger changes. */
static void every_number_of_a_gap_has_its_name(void **state)
{
    now->gap.frame[1] = 4;
    expect(DIFFERENT_GAP, "bodies 3 7  gap frame of the second body: 0, now 4 (+4)\n");
    now->gap.witness[1][0] = 5;
    expect(
        DIFFERENT_GAP,
        "bodies 3 7  gap witness point of the second body x: 0, now 5 (+5), and 1 more number\n");
    now->gap.witness[0][1] = 6;
    expect(
        DIFFERENT_GAP,
        "bodies 3 7  gap witness point of the first body y: 0, now 6 (+6), and 2 more numbers\n");
    now->gap.time = 7;
    expect(DIFFERENT_GAP, "bodies 3 7  gap time: 0, now 7 (+7), and 3 more numbers\n");
    now->gap.direction[2] = -8;
    expect(DIFFERENT_GAP, "bodies 3 7  gap direction z: 1, now -8 (-9), and 4 more numbers\n");
    now->gap.bounds[1] = 0;
    expect(DIFFERENT_GAP,
           "bodies 3 7  gap upper bound: -0.25, now 0 (+0.25), and 5 more numbers\n");
}

/* Numbers of witness points that one answer lacks are not compared with 0. */
static void witness_points_that_one_answer_lacks_are_named(void **state)
{
    now->gap.has_witness = true;
    now->gap.witness[0][2] = 5;
    expect(DIFFERENT_GAP,
           "bodies 3 7  gap: -0.5..-0.25 without, now -0.5..-0.25 with witness points\n");
    now->gap.bounds[0] = -0.75;
    expect(DIFFERENT_GAP, "bodies 3 7  gap lower bound: -0.5, now -0.75 (-0.25)\n");
}

static void what_one_answer_lacks_is_none(void **state)
{
    now->has_contact = now->has_box = now->has_gap = now->has_point = false;
    expect(DIFFERENT_INTERVAL, "bodies 3 7  interval: 0.25 to 0.5 s, now none\n");
    expect(DIFFERENT_BOX, "bodies 3 7  box: x 0..1  y 0..1  z 0..1, now none\n");
    expect(DIFFERENT_POINT, "bodies 3 7  point: (0.5, 0.75, 0) at 0.25 s, now none\n");
    expect(DIFFERENT_GAP, "bodies 3 7  gap: -0.5..-0.25, now none\n");
    then->has_gap = false;
    now->has_gap = true;
    now->gap.bounds[1] = HUGE_VAL;
    expect(DIFFERENT_GAP, "bodies 3 7  gap: none, now -0.5..inf\n");
}

static void other_differences_are_in_words(void **state)
{
    now->verdict = FMB_TOUCHING;
    expect(DIFFERENT_VERDICT, "bodies 3 7  verdict: overlapping, now touching\n");
    difference.whole = true;
    difference.detail = "the recording has 3 bodies, the query 4: post is new";
    difference.query_kind = LOG_SCENE_QUERY;
    expect(DIFFERENT_SCENE, "the scene: the recording has 3 bodies, the query 4: post is new\n");
    difference.query_kind = LOG_PAIR_QUERY;
    expect(DIFFERENT_SCENE, "the pair: the recording has 3 bodies, the query 4: post is new\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_number_has_its_name, set_up),
        cmocka_unit_test_setup(every_number_of_a_gap_has_its_name, set_up),
        cmocka_unit_test_setup(witness_points_that_one_answer_lacks_are_named, set_up),
        cmocka_unit_test_setup(what_one_answer_lacks_is_none, set_up),
        cmocka_unit_test_setup(other_differences_are_in_words, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
