/* Queries and results that wait for each other: order, keys that are the same or nearly so, the
 * end, notes; and against a naive model. */
#include "unit.h"

#include "match.h"

static struct match *match;

static int set_up(void **state)
{
    match = match_open();
    return 0;
}

static int tear_down(void **state)
{
    match_close(match);
    return 0;
}

static struct match_key key(int64_t client, int64_t number)
{
    return (struct match_key){LOG_PAIR_QUERY, client, number, 5};
}

static struct match_item *add(struct match_key of, int64_t offset, bool is_result)
{
    const struct match_place place = {.in_range = true, .offset = offset};
    return match_add(match, &of, &place, is_result);
}

static void take(struct match_key of, int64_t offset)
{
    struct match_item *item = match_find(match, &of);
    assert_non_null(item);
    assert_int_equal(item->place.offset, offset);
    match_remove(match, item);
    free(item);
}

static void the_first_query_is_matched_first(void **state)
{
    for (int i = 0; i < 5; i++)
        add(key(1, 2), i, false);
    take(key(1, 2), 0);
    take(key(1, 2), 1);
    add(key(1, 2), 5, false);
    for (int i = 2; i < 6; i++)
        take(key(1, 2), i);
    const struct match_key of = key(1, 2);
    assert_null(match_find(match, &of));
    assert_null(match_any(match));
}

static void keys_differ_in_any_number(void **state)
{
    struct match_key keys[] = {key(1, 2), key(2, 1), key(1, 2), key(1, 2)};
    keys[2].utime++;
    keys[3].kind = LOG_SCENE_QUERY;
    for (int i = 0; i < 4; i++)
        add(keys[i], i, i % 2);
    for (int i = 3; i >= 0; i--)
        take(keys[i], i);
}

static void ids_may_be_any_numbers(void **state)
{
    static const int64_t ids[] = {INT64_MIN, -1, 0, 1, INT64_MAX};
    for (int i = 0; i < 25; i++)
        add(key(ids[i / 5], ids[i % 5]), i, false);
    for (int i = 0; i < 25; i++)
        take(key(ids[i / 5], ids[i % 5]), i);
}

/* A log of one client whose numbers never change: each step takes the same time. */
static void many_queries_may_have_one_key(void **state)
{
    for (int i = 0; i < 200000; i++)
        add(key(1, 1), i, false);
    for (int i = 0; i < 200000; i++)
        take(key(1, 1), i);
}

/* ---- The end ---- */

static int64_t found[8];
static int found_count;

static void on_found(void *user, struct match_item *query, struct match_item *result)
{
    (void) user;
    assert_true(result->is_result);
    found[found_count++] = query ? query->place.offset : -1;
    found[found_count++] = result->place.offset;
    free(query);
    free(result);
}

static void results_without_the_time_match(void **state)
{
    struct match_key later = key(1, 2);
    later.utime = 9;
    found_count = 0;
    add(key(1, 2), 0, false);
    add(later, 1, false);
    add(key(1, 3), 2, false);
    for (int i = 0; i < 3; i++) {
        struct match_key other = key(1, 2);
        other.utime = 100 + i;
        add(other, 10 + i, true);
    }
    match_finish(match, on_found, NULL);
    const int64_t expected[] = {0, 10, 1, 11, -1, 12};
    assert_int_equal(found_count, 6);
    assert_memory_equal(found, expected, sizeof expected);
    struct match_item *left = match_any(match);
    assert_int_equal(left->place.offset, 2);
}

/* ---- Notes ---- */

static void notes_are_kept(void **state)
{
    const struct match_key none = {0}, one = key(1, 2), other = key(1, 3);
    assert_null(match_noted(match, &none));
    const struct match_place query_place = {.log = 1, .offset = 77};
    const struct match_place result_place = {.log = 2, .offset = 99};
    struct match_item *query = match_new(&one, &query_place);
    match_note(match, query, &result_place);
    free(query);
    const struct match_note *note = match_noted(match, &one);
    assert_non_null(note);
    assert_int_equal(note->query_log, 1);
    assert_int_equal(note->query_offset, 77);
    assert_int_equal(note->result_log, 2);
    assert_int_equal(note->result_offset, 99);
    assert_null(match_noted(match, &other));
}

/* The last thousand of a client are all there, the first of a million is not. */
static void notes_are_of_the_last_ones(void **state)
{
    const struct match_place place = {.offset = 1};
    for (int64_t i = 0; i < 1000000; i++) {
        const struct match_key of = key(7, i);
        struct match_item *query = match_new(&of, &place);
        match_note(match, query, &place);
        free(query);
    }
    for (int64_t i = 999000; i < 1000000; i++) {
        const struct match_key of = key(7, i);
        assert_non_null(match_noted(match, &of));
    }
    const struct match_key first = key(7, 0);
    assert_null(match_noted(match, &first));
}

/* ---- A naive model ---- */

enum { KEYS = 40, QUEUE_MAX = 4000 };

static struct {
    int64_t offset[QUEUE_MAX];
    int first, count;
} queue[KEYS];

static void matching_agrees_with_a_model(void **state)
{
    memset(queue, 0, sizeof queue);
    srand(1);
    for (int64_t step = 0; step < 40000; step++) {
        const int k = rand() % KEYS;
        const struct match_key of = key(k / 7, k % 7);
        const bool grows = step / 5000 % 2 == 0;
        if (rand() % 3 < (grows ? 2 : 1) && queue[k].count < QUEUE_MAX) {
            add(of, step, false);
            queue[k].offset[queue[k].count++] = step;
        } else if (queue[k].first < queue[k].count) {
            take(of, queue[k].offset[queue[k].first++]);
        } else {
            assert_null(match_find(match, &of));
        }
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_first_query_is_matched_first), TEST(keys_differ_in_any_number),
        TEST(ids_may_be_any_numbers),           TEST(many_queries_may_have_one_key),
        TEST(results_without_the_time_match),   TEST(notes_are_kept),
        TEST(notes_are_of_the_last_ones),       TEST(matching_agrees_with_a_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
