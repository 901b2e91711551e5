/* Results of two queries of one scene, whose bodies and pairs are numbered otherwise: what is
 * compared, against single pairs that are answered by themselves; and what only one query has. */
#include "unit.h"

#include "align.h"
#include "compare.h"
#include "geometry_write.h"

#include "answer_now.h"
#include "replay_answerer.h"
#include "wire.h"

static int set_up(void **state)
{
    return open_answerer();
}

/* ---- Scenes ---- */

enum { THEN, NOW, SIDES, BODIES = 12, PAIRS = BODIES * BODIES };

static struct body_names *names[SIDES];
static struct logged_query query[SIDES];
static struct logged_result result[SIDES];
static struct scene_query *scene[SIDES] = {&query[THEN].scene, &query[NOW].scene};
static int who[SIDES][BODIES]; /* which body a placement is */

static int tear_down(void **state)
{
    close_answerer();
    for (int side = 0; side < SIDES; side++) {
        body_names_close(names[side]);
        names[side] = NULL;
    }
    return 0;
}

/* Unit cubes: bodies on a line, some off it. */
static struct query_placement body(int number, int64_t id, const char *name, double shift)
{
    static unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    struct plain_frame frame = {.shape = FMB_CUBOID};
    for (int i = 0; i < 3; i++)
        frame.components[4 * i] = 1;
    return (struct query_placement){
        .placed = {.id = id,
                   .name = name,
                   .position = {0.5 * number + shift, 0.25 * (number % 3), 0}},
        .body = geometry_write(3, &frame, bytes)};
}

static void begin_scene(int side, int32_t which)
{
    query[side].kind = result[side].kind = LOG_SCENE_QUERY;
    memset(scene[side], 0, sizeof *scene[side]);
    scene[side]->client_id = 7 + side;
    scene[side]->sequence_number = 1;
    scene[side]->duration = 1;
    scene[side]->which = which;
}

static void add_body(int side, struct query_placement placement, int number)
{
    who[side][scene[side]->placement_count] = number;
    scene[side]->placement[scene[side]->placement_count++] = placement;
    query[side].placement = scene[side]->placement;
    query[side].placement_count = scene[side]->placement_count;
}

static void ignore(int side, unsigned a, unsigned b)
{
    scene[side]->ignored[scene[side]->ignored_count / 2][0] = a;
    scene[side]->ignored[scene[side]->ignored_count / 2][1] = b;
    scene[side]->ignored_count += 2;
}

static void list(int side, unsigned a, unsigned b)
{
    scene[side]->pair[scene[side]->index_count / 2][0] = a;
    scene[side]->pair[scene[side]->index_count / 2][1] = b;
    scene[side]->index_count += 2;
}

/* stop: as a service does that is short of time, after a part of the pairs. */
static void answer_side(int side, bool stop)
{
    static unsigned char sent[QUERY_BYTES_MAX], bytes[SIDES][QUERY_BYTES_MAX];
    bool complete = false;
    assert_null(
        answer_job_begin(job, ANSWER_SCENE, sent, wire_write_scene_query(scene[side], sent)));
    while (!complete) {
        complete = answer_job_step(job, answerer);
        if (!complete && stop && answer_job_has_answers(job)) {
            answer_job_stop(job);
            complete = true;
        }
    }
    const size_t size = wire_write_scene_result(answer_job_scene_result(job), bytes[side]);
    query[side].placement_count = scene[side]->placement_count;
    assert_null(wire_read_scene_result(bytes[side], (uint32_t) size, &result[side].scene));
    assert_int_equal(result[side].scene.status, FMB_OK);
}

/* ---- What is reported ---- */

static struct difference reported[PAIRS];
static char detail[COMPARE_DETAIL_MAX];
static int reported_count;

static void on_difference(void *user, const struct difference *difference)
{
    (void) user;
    if (difference->kind == DIFFERENT_SCENE) {
        assert_true(difference->whole);
        assert_string_equal(detail, ""); /* one line for each scene */
        strcpy(detail, difference->detail);
        return;
    }
    assert_true(reported_count < PAIRS);
    reported[reported_count++] = *difference;
}

/* Returns whether the two have the same numbers. */
static bool compare(void)
{
    struct align *align = align_open(names[THEN], names[NOW]);
    struct replayed replayed = {.query = &query[NOW], .then = &result[THEN], .now = &result[NOW]};
    const bool same = align_queries(align, &query[THEN], &query[NOW]);
    if (!same)
        replayed.match = align_results(align, &result[THEN], &result[NOW]);
    reported_count = 0;
    detail[0] = 0;
    const enum replay_outcome outcome =
        compare_results(&(struct compare_options){0}, &replayed, on_difference, NULL);
    assert_int_equal(outcome, reported_count > 0 || *detail ? REPLAY_DIFFERENT : REPLAY_SAME);
    align_close(align);
    return same;
}

/* ---- The model ---- */

static bool is_ignored(int side, unsigned a, unsigned b)
{
    for (int32_t k = 0; k < scene[side]->ignored_count / 2; k++) {
        const unsigned *pair = scene[side]->ignored[k];
        if ((pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a))
            return true;
    }
    const int64_t group = scene[side]->placement[a].placed.group;
    return group != 0 && group == scene[side]->placement[b].placed.group;
}

/* The pairs that a query decides, in order; answered: the result has them. */
struct plain {
    unsigned a, b;
    bool answered;
};

static int list_pairs(int side, struct plain *out)
{
    const struct scene_query *of = scene[side];
    const int32_t end = result[side].scene.end_pair;
    int count = 0, number = 0;
    if (of->which == FMB_PAIRS_LISTED) {
        for (number = of->first_pair; number < of->index_count / 2; number++)
            out[count++] = (struct plain){of->pair[number][0], of->pair[number][1], number < end};
        return count;
    }
    for (int a = 0; a < of->placement_count; a++)
        for (int b = a + 1; b < of->placement_count; b++) {
            if (of->which == FMB_PAIRS_ACROSS && (a >= of->split || b < of->split))
                continue;
            if (number >= of->first_pair && !is_ignored(side, (unsigned) a, (unsigned) b))
                out[count++] = (struct plain){(unsigned) a, (unsigned) b, number < end};
            number++;
        }
    return count;
}

/* The placement of a body; -1: none. */
static int placement_of(int side, int number)
{
    for (int i = 0; i < scene[side]->placement_count; i++)
        if (who[side][i] == number)
            return i;
    return -1;
}

/* Whether the pair of a query is among those of the other one; answered: by both results. */
static bool is_among(int side, const struct plain *pair, bool *answered)
{
    static struct plain other[PAIRS];
    const int a = placement_of(1 - side, who[side][pair->a]);
    const int b = placement_of(1 - side, who[side][pair->b]);
    const int count = list_pairs(1 - side, other);
    bool found = false;
    *answered = false;
    for (int i = 0; i < count; i++)
        if (((int) other[i].a == a && (int) other[i].b == b) ||
            ((int) other[i].a == b && (int) other[i].b == a)) {
            found = true;
            *answered = pair->answered && other[i].answered;
        }
    return found;
}

static struct fmb_answer answer_alone(int side, int first, int second)
{
    struct pair_result alone;
    const struct pair_query of = {
        .client_id = 1,
        .duration = scene[side]->duration,
        .want = scene[side]->want & ~(int32_t) FMB_WANT_TIMES, /* a pair always has them */
        .placement = {scene[side]->placement[placement_of(side, first)],
                      scene[side]->placement[placement_of(side, second)]}};
    answer_pair(answerer, &of, &alone);
    assert_int_equal(alone.status, FMB_OK);
    if (!(scene[side]->want & FMB_WANT_TIMES))
        alone.answer.has_contact = false;
    return alone.answer;
}

static bool has_only(int side)
{
    static struct plain pair[PAIRS];
    const int count = list_pairs(side, pair);
    bool answered;
    for (int i = 0; i < scene[side]->placement_count; i++)
        if (placement_of(1 - side, who[side][i]) < 0)
            return true;
    for (int i = 0; i < count; i++)
        if (!is_among(side, &pair[i], &answered))
            return true;
    return false;
}

static void check_differences(void)
{
    static struct plain pair[PAIRS];
    const int count = list_pairs(NOW, pair);
    int found = 0;
    for (int i = 0; i < count; i++) {
        const int a = who[NOW][pair[i].a], b = who[NOW][pair[i].b];
        bool answered;
        if (!is_among(NOW, &pair[i], &answered) || !answered)
            continue;
        const struct fmb_answer then = answer_alone(THEN, a, b), now = answer_alone(NOW, a, b);
        if (query_same_answer(&then, &now))
            continue;
        assert_true(found < reported_count);
        assert_int_equal(reported[found].placement[0], pair[i].a);
        assert_int_equal(reported[found].placement[1], pair[i].b);
        assert_true(query_same_answer(&reported[found].then.answer, &then));
        assert_true(query_same_answer(&reported[found].now.answer, &now));
        found++;
    }
    assert_int_equal(found, reported_count);
    assert_int_equal(*detail != 0, has_only(THEN) || has_only(NOW));
}

/* ---- Drawn scenes ---- */

static const char *const name_of[BODIES] = {"a", "b", "c", "d", "e", "f",
                                            "g", "h", "i", "j", "k", "l"};

static void shuffle(int *number, int count)
{
    for (int i = count - 1; i > 0; i--) {
        const int k = (int) draw((uint64_t) i + 1), kept = number[i];
        number[i] = number[k];
        number[k] = kept;
    }
}

static void draw_pairs(int side, int changes)
{
    const int count = scene[side]->placement_count;
    const bool listed = scene[side]->which == FMB_PAIRS_LISTED; /* then none may be ignored */
    for (int i = 0; i < changes && !listed; i++) {
        const unsigned a = (unsigned) draw((uint64_t) count);
        ignore(side, a, (a + 1 + (unsigned) draw((uint64_t) count - 1)) % (unsigned) count);
    }
    for (int i = 0; i < count; i++)
        scene[side]->placement[i].placed.group = changes > 2 && who[side][i] < 3 && !listed ? 5 : 0;
    if (scene[side]->which == FMB_PAIRS_ACROSS)
        scene[side]->split = count / 2;
    for (int i = 1; listed && i < count; i++)
        for (int k = 0; k < i; k++)
            if (changes == 0 || draw(4))
                list(side, (unsigned) (draw(2) ? i : k), (unsigned) (draw(2) ? i : k));
    for (int32_t k = 0; k < scene[side]->index_count / 2; k++) /* none with itself */
        if (scene[side]->pair[k][0] == scene[side]->pair[k][1])
            scene[side]->pair[k][1] = (scene[side]->pair[k][0] + 1) % (unsigned) count;
}

/* Bodies of one scene, some left out, in any order; by names with other ids, or by ids. */
static void draw_scene(int side, bool by_name, int32_t want, bool shuffled)
{
    static const int32_t which[] = {FMB_PAIRS_ALL, FMB_PAIRS_ALL, FMB_PAIRS_ACROSS,
                                    FMB_PAIRS_LISTED};
    int number[BODIES];
    for (int i = 0; i < BODIES; i++)
        number[i] = i;
    if (shuffled)
        shuffle(number, BODIES);
    begin_scene(side, which[draw(4)]);
    scene[side]->want = want;
    scene[side]->margin = want & FMB_WANT_GAP ? 100 : 0; /* every pair has its gap */
    for (int i = 0; i < BODIES - (shuffled ? (int) draw(4) : 0); i++) {
        const bool moved = side == NOW && draw(8) == 0;
        add_body(side,
                 body(number[i], by_name ? i + 1 : 100 + number[i],
                      by_name ? name_of[number[i]] : NULL, moved ? 0.125 : 0),
                 number[i]);
    }
    draw_pairs(side, draw(2) ? (int) draw(4) : 0);
    if (draw(4) == 0)
        scene[side]->first_pair = (int32_t) draw(5);
    answer_side(side, draw(4) == 0);
}

static void drawn_scenes_compare_as_single_pairs(void **state)
{
    int same = 0, details = 0, differences = 0, equal = 0;
    for (int round = 0; round < 3000; round++) {
        const bool by_name = draw(2), shuffled = draw(4);
        const int32_t want =
            (int32_t) (draw(2) * FMB_WANT_BOX | draw(2) * FMB_WANT_GAP | draw(2) * FMB_WANT_TIMES);
        for (int side = 0; side < SIDES; side++) {
            names[side] = body_names_open();
            draw_scene(side, by_name, want, shuffled);
            body_names_take(names[side], &query[side]);
        }
        same += compare();
        check_differences();
        details += *detail != 0;
        differences += reported_count;
        equal += !*detail && reported_count == 0;
        for (int side = 0; side < SIDES; side++) {
            body_names_close(names[side]);
            names[side] = NULL;
        }
    }
    assert_in_range(same, 1, 1000);
    assert_in_range(equal, 1, 1000);
    assert_in_range(details, 200, 3000);
    assert_in_range(differences, 300, 100000);
}

/* ---- In words ---- */

/* Three bodies on each side; the caller changes them. */
static void begin_both(void)
{
    for (int side = 0; side < SIDES; side++) {
        begin_scene(side, FMB_PAIRS_ALL);
        for (int i = 0; i < 3; i++)
            add_body(side, body(i, i + 1, name_of[i], 0), i);
    }
}

static void expect_detail(const char *expected)
{
    for (int side = 0; side < SIDES; side++)
        answer_side(side, false);
    compare();
    assert_string_equal(detail, expected);
    assert_int_equal(reported_count, 0);
}

/* The body that is new overlaps others; its pairs follow those of the recording. */
static void a_body_that_is_new_is_a_difference(void **state)
{
    begin_both();
    add_body(NOW, body(1, 9, "post", 0.25), 3);
    expect_detail("the recording has 3 bodies, the query 4: post is new");
}

static void a_body_in_front_of_the_others_is_a_difference(void **state)
{
    begin_both();
    scene[NOW]->placement_count = 0;
    add_body(NOW, body(20, 9, "post", 0), 3);
    for (int i = 0; i < 3; i++)
        add_body(NOW, body(i, i + 1, name_of[i], 0), i);
    expect_detail("the recording has 3 bodies, the query 4: post is new");
}

static void bodies_that_are_missing_are_a_difference(void **state)
{
    begin_both();
    scene[NOW]->placement_count = 1;
    expect_detail("the recording has 3 bodies, the query 1: b, c are missing");
    for (int i = 4; i < 9; i++)
        add_body(THEN, body(i, i, NULL, 0), i);
    expect_detail("the recording has 8 bodies, the query 1: b, c, 4 and 4 more are missing");
}

static void a_body_of_another_name_is_another_body(void **state)
{
    begin_both();
    scene[NOW]->placement[2].placed.name = "lamp";
    expect_detail("the recording has 3 bodies, the query 3: lamp is new; c is missing");
}

/* Names count where both sides have them; here one has none. */
static void a_body_without_a_name_is_known_by_its_id(void **state)
{
    begin_both();
    scene[NOW]->placement[1].placed.name = NULL;
    expect_detail("");
}

static void pairs_that_are_ignored_on_one_side_are_a_difference(void **state)
{
    begin_both();
    ignore(NOW, 2, 0);
    expect_detail("the recording decides 3 pairs, the query 2; a with c is missing");
    begin_both();
    ignore(THEN, 2, 0);
    ignore(THEN, 1, 0);
    expect_detail("the recording decides 1 pairs, the query 3; for example a with b is new");
}

static void another_split_is_a_difference(void **state)
{
    begin_both();
    for (int side = 0; side < SIDES; side++) {
        scene[side]->which = FMB_PAIRS_ACROSS;
        scene[side]->split = 1 + side;
    }
    expect_detail(
        "the recording decides 2 pairs, the query 2; a with b is missing; b with c is new");
}

/* A result that is none to its query is compared with nothing, and not the same. */
static void a_result_of_other_pairs_is_a_difference(void **state)
{
    begin_both();
    ignore(THEN, 0, 1);
    ignore(NOW, 1, 0); /* the same pair */
    for (int side = 0; side < SIDES; side++)
        answer_side(side, false);
    assert_false(compare());
    assert_string_equal(detail, "");
    result[THEN].scene.end_pair = 100;
    compare();
    assert_string_equal(detail, "a result is of other pairs than its query");
}

/* Indices out of range, as in the log of a client that was refused. */
static void queries_that_were_refused_are_compared(void **state)
{
    begin_both();
    ignore(NOW, 77, 0);
    for (int side = 0; side < SIDES; side++) {
        memset(&result[side].scene, 0, sizeof result[side].scene);
        result[side].scene.status = FMB_BAD_PAIR;
    }
    assert_false(compare());
    assert_string_equal(detail, "");
    assert_int_equal(reported_count, 0);
    scene[NOW]->placement_count = INT32_MAX;
    query[NOW].placement_count = query_stored_placements(scene[NOW]);
    compare();
    assert_int_equal(reported_count, 0);
    assert_true(strstr(detail, "the recording has 3 bodies"));
}

static void pair_queries_of_other_bodies_are_a_difference(void **state)
{
    begin_both();
    const struct query_placement a = scene[THEN]->placement[0], b = scene[THEN]->placement[1];
    for (int side = 0; side < SIDES; side++) {
        query[side].kind = result[side].kind = LOG_PAIR_QUERY;
        query[side].pair = (struct pair_query){.client_id = 7, .placement = {a, b}};
        query[side].placement = query[side].pair.placement;
        query[side].placement_count = 2;
        answer_pair(answerer, &query[side].pair, &result[side].pair);
    }
    assert_true(compare());
    query[NOW].pair.placement[1].placed.name = "lamp";
    assert_false(compare());
    assert_string_equal(detail,
                        "the recording has 2 bodies, the query 2: lamp is new; b is missing");
    query[NOW].pair.placement[0] = b;
    query[NOW].pair.placement[1] = a;
    assert_false(compare());
    assert_string_equal(detail, "the recording has the bodies in the other order");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(drawn_scenes_compare_as_single_pairs),
        TEST(a_body_that_is_new_is_a_difference),
        TEST(a_body_in_front_of_the_others_is_a_difference),
        TEST(bodies_that_are_missing_are_a_difference),
        TEST(a_body_of_another_name_is_another_body),
        TEST(a_body_without_a_name_is_known_by_its_id),
        TEST(pairs_that_are_ignored_on_one_side_are_a_difference),
        TEST(another_split_is_a_difference),
        TEST(a_result_of_other_pairs_is_a_difference),
        TEST(queries_that_were_refused_are_compared),
        TEST(pair_queries_of_other_bodies_are_a_difference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
