/* Runs of slots against a plain map of them. */
#include "unit.h"

#include "runs.h"

#include <stdbool.h>

enum { SLOTS = 100 };

static void all_slots_can_be_taken(void **state)
{
    static struct run_slot slot[SLOTS];
    struct runs runs;
    runs_init(&runs, slot, SLOTS);
    assert_int_equal(runs_allocate(&runs, SLOTS + 1), -1);
    assert_int_equal(runs_allocate(&runs, SLOTS), 0);
    assert_int_equal(runs_allocate(&runs, 1), -1);
    assert_int_equal(runs_free(&runs, 0), 0);
    for (int i = 0; i < SLOTS; i++)
        assert_int_equal(runs_allocate(&runs, 1), i);
    assert_int_equal(runs_allocate(&runs, 1), -1);
}

/* A freed run is merged with both free neighbours, and is what is taken next. */
static void neighbours_are_merged(void **state)
{
    static struct run_slot slot[SLOTS];
    struct runs runs;
    runs_init(&runs, slot, SLOTS);
    for (int i = 0; i < SLOTS / 10; i++)
        assert_int_equal(runs_allocate(&runs, 10), 10 * i);
    assert_int_equal(runs_free(&runs, 20), 20);
    assert_int_equal(runs_free(&runs, 40), 40);
    assert_int_equal(runs_length(&runs, 40), 10);
    assert_int_equal(runs_before(&runs, 40), 30);
    assert_int_equal(runs_after(&runs, 40), 50);
    assert_int_equal(runs_allocate(&runs, 11), -1);
    assert_int_equal(runs_free(&runs, 30), 20);
    assert_int_equal(runs_length(&runs, 20), 30);
    assert_int_equal(runs_allocate(&runs, 30), 20);
    assert_int_equal(runs_free(&runs, 0), 0);
    assert_int_equal(runs_before(&runs, 0), -1);
    assert_int_equal(runs_free(&runs, 90), 90);
    assert_int_equal(runs_after(&runs, 90), -1);
}

/* A run that was freed last is found, however many shorter ones of its list there are. */
static void the_last_one_is_found(void **state)
{
    static struct run_slot slot[SLOTS];
    struct runs runs;
    runs_init(&runs, slot, SLOTS);
    for (int i = 0; i < 20; i++) /* of 4 and of 1, alternately */
        runs_allocate(&runs, i % 2 ? 1 : 4);
    const int32_t last = runs_allocate(&runs, 7);
    runs_allocate(&runs, runs_length(&runs, last + 7));
    for (int i = 0; i < 10; i++)
        runs_free(&runs, 5 * i);
    assert_int_equal(runs_allocate(&runs, 5), -1);
    assert_int_equal(runs_free(&runs, last), last);
    assert_int_equal(runs_allocate(&runs, 7), last);
}

/* Of a list, more than the first run is examined. */
static void a_longer_run_of_a_list_is_found(void **state)
{
    static struct run_slot slot[SLOTS];
    struct runs runs;
    runs_init(&runs, slot, SLOTS);
    const int32_t longer = runs_allocate(&runs, 7);
    runs_allocate(&runs, 1);
    const int32_t shorter = runs_allocate(&runs, 4);
    runs_allocate(&runs, SLOTS - (7 + 1 + 4));
    runs_free(&runs, longer);
    runs_free(&runs, shorter);
    assert_int_equal(runs_allocate(&runs, 5), longer);
}

/* Takes and frees at random: runs never overlap, what is free is counted, and the free run that is
 * returned reaches as far as it can. */
static void runs_match_a_map(void **state)
{
    enum { ROUNDS = 200000 };
    static struct run_slot slot[SLOTS];
    int length[SLOTS] = {0}, taken = 0; /* of the run that begins there */
    bool used[SLOTS] = {false};
    struct runs runs;
    runs_init(&runs, slot, SLOTS);
    srand(1);
    for (int round = 0; round < ROUNDS; round++) {
        const int at = rand() % SLOTS;
        if (length[at]) {
            const int32_t first = runs_free(&runs, at);
            memset(used + at, 0, (size_t) length[at]);
            taken -= length[at];
            length[at] = 0;
            const int32_t end = first + runs_length(&runs, first);
            assert_true(first <= at && at < end);
            for (int32_t i = first; i < end; i++)
                assert_false(used[i]);
            assert_true(first == 0 || used[first - 1]);
            assert_true(end == SLOTS || used[end]);
            continue;
        }
        const int want = 1 + rand() % 12;
        const int32_t first = runs_allocate(&runs, want);
        if (first < 0) {
            assert_true(want > 1 || taken == SLOTS);
            continue;
        }
        assert_in_range(first, 0, SLOTS - want);
        for (int32_t i = first; i < first + want; i++) {
            assert_false(used[i]);
            used[i] = true;
        }
        length[first] = want;
        taken += want;
    }
    for (int i = 0; i < SLOTS; i++)
        if (length[i])
            runs_free(&runs, i);
    assert_int_equal(runs_length(&runs, 0), SLOTS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_slots_can_be_taken), cmocka_unit_test(neighbours_are_merged),
        cmocka_unit_test(the_last_one_is_found),  cmocka_unit_test(a_longer_run_of_a_list_is_found),
        cmocka_unit_test(runs_match_a_map),
    };
    return cmocka_run_group_tests_name("runs", tests, NULL, NULL);
}
