/* How the scenes of two queries differ, in words. test_replay_run.c tests that nothing else is
 * compared then. */
#include "unit.h"

#include "scene_change.h"

enum { THEN, NOW, SIDES };

static struct logged_query query[SIDES];
static struct scene_query *scene[SIDES] = {&query[THEN].scene, &query[NOW].scene};

static void add_body(int side, int64_t id, const char *name)
{
    scene[side]->placement[scene[side]->placement_count++].placed =
        (struct fmb_placement){.id = id, .name = name};
    query[side].placement = scene[side]->placement;
    query[side].placement_count = scene[side]->placement_count;
}

/* The bodies a, b and c on each side; the caller changes them. */
static int begin_both(void **state)
{
    static const char *const name[] = {"a", "b", "c"};
    for (int side = 0; side < SIDES; side++) {
        memset(scene[side], 0, sizeof *scene[side]);
        query[side].kind = LOG_SCENE_QUERY;
        scene[side]->which = FMB_PAIRS_ALL;
        for (int i = 0; i < 3; i++)
            add_body(side, i + 1, name[i]);
    }
    return 0;
}

static void expect(const char *expected)
{
    char text[SCENE_CHANGE_MAX];
    const bool changed = scene_change(&(struct exchange){.query = &query[THEN]},
                                      &(struct exchange){.query = &query[NOW]}, text);
    assert_string_equal(text, expected);
    assert_int_equal(changed, *expected != 0);
}

static void keep_bodies(int side, int32_t count)
{
    scene[side]->placement_count = query[side].placement_count = count;
}

static void new_and_missing_bodies_are_named(void **state)
{
    add_body(NOW, 9, "post");
    expect("the recording has 3 bodies, the query 4: post is new");
    keep_bodies(NOW, 1);
    expect("the recording has 3 bodies, the query 1: b, c are missing");
    for (int i = 4; i < 9; i++)
        add_body(THEN, i, NULL);
    expect("the recording has 8 bodies, the query 1: b, c, 4 and 4 more are missing");
}

static void a_new_body_in_front_of_the_others_is_the_only_one_named(void **state)
{
    keep_bodies(NOW, 0);
    add_body(NOW, 9, "post");
    for (int i = 0; i < 3; i++)
        add_body(NOW, i + 1, NULL);
    expect("the recording has 3 bodies, the query 4: post is new");
}

static void a_body_is_known_by_its_name_or_else_by_its_id(void **state)
{
    scene[NOW]->placement[0].placed.id = 77;
    scene[NOW]->placement[1].placed.name = NULL;
    expect("");
    scene[NOW]->placement[2].placed.name = "lamp";
    expect("the recording has 3 bodies, the query 3: lamp is new; c is missing");
}

static void bodies_in_another_order_have_moved(void **state)
{
    const struct query_placement b = scene[NOW]->placement[1];
    scene[NOW]->placement[1] = scene[NOW]->placement[2];
    scene[NOW]->placement[2] = b;
    expect("the recording has the same bodies in another order: c, b are moved");
}

static void anonymous_bodies_are_taken_in_their_order(void **state)
{
    for (int side = 0; side < SIDES; side++)
        for (int i = 0; i < 3; i++)
            scene[side]->placement[i].placed = (struct fmb_placement){.id = 0};
    expect("");
}

/* Each row changes the pairs of the new query, or of both, in one field. */
static void other_pairs_are_a_change(void **state)
{
    enum { IGNORED, WHICH, SPLIT, LISTED, GROUP, FIRST, FIELDS };
    for (int field = 0; field < FIELDS; field++) {
        begin_both(NULL);
        for (int side = 0; side < SIDES; side++) {
            struct scene_query *of = scene[side];
            if (field == SPLIT || field == LISTED)
                of->which = field == SPLIT ? FMB_PAIRS_ACROSS : FMB_PAIRS_LISTED;
            of->split = field == SPLIT ? 1 + side : 0;
            of->index_count = field == LISTED ? 2 : 0;
            of->pair[0][0] = 0;
            of->pair[0][1] = field == LISTED ? 1 + (unsigned) side : 0;
            of->ignored_count = field == IGNORED ? 2 * side : 0;
            of->placement[1].placed.group = field == GROUP ? 5 * side : 0;
            of->first_pair = field == FIRST ? side : 0;
        }
        if (field == WHICH)
            scene[NOW]->which = FMB_PAIRS_LISTED;
        expect("the recording and the query decide different pairs of the same bodies");
    }
}

/* Counts beyond what a query can hold, as in the log of a client that was refused. */
static void a_query_that_was_refused_is_compared(void **state)
{
    char text[SCENE_CHANGE_MAX];
    scene[NOW]->ignored_count = scene[NOW]->index_count = INT32_MAX;
    scene[NOW]->placement_count = INT32_MAX;
    query[NOW].placement_count = query_stored_placements(scene[NOW]);
    assert_true(scene_change(&(struct exchange){.query = &query[THEN]},
                             &(struct exchange){.query = &query[NOW]}, text));
    assert_non_null(strstr(text, "the recording has 3 bodies"));
}

static void pair_queries_are_compared_by_their_bodies(void **state)
{
    for (int side = 0; side < SIDES; side++) {
        const struct query_placement a = scene[side]->placement[0], b = scene[side]->placement[1];
        query[side].kind = LOG_PAIR_QUERY;
        query[side].pair = (struct pair_query){.client_id = 7, .placement = {a, b}};
        query[side].placement = query[side].pair.placement;
        query[side].placement_count = 2;
    }
    expect("");
    const struct query_placement a = query[NOW].pair.placement[0];
    query[NOW].pair.placement[0] = query[NOW].pair.placement[1];
    query[NOW].pair.placement[1] = a;
    expect("the recording has the same bodies in another order: b, a are moved");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup(name, begin_both)
    const struct CMUnitTest tests[] = {
        TEST(new_and_missing_bodies_are_named),
        TEST(a_new_body_in_front_of_the_others_is_the_only_one_named),
        TEST(a_body_is_known_by_its_name_or_else_by_its_id),
        TEST(bodies_in_another_order_have_moved),
        TEST(anonymous_bodies_are_taken_in_their_order),
        TEST(other_pairs_are_a_change),
        TEST(a_query_that_was_refused_is_compared),
        TEST(pair_queries_are_compared_by_their_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
