/* Which queries and results belong together: keys that are the same or nearly so, repeats,
 * transient results; and against a naive model. */
#include "unit.h"

#include "match.h"

static struct match match;

static int tear_down(void **state)
{
    match_clear(&match);
    return 0;
}

static struct match_key key(int64_t client, int64_t number)
{
    return (struct match_key){LOG_PAIR_QUERY, client, number, 5};
}

static void add_query(struct match_key of)
{
    match_add(&match, &(struct match_item){.key = of});
}

static void add_result(struct match_key of, bool transient)
{
    match_add(&match, &(struct match_item){.key = of, .is_result = true, .transient = transient});
}

/* The index of the counterpart of an item; -1: it has none. */
static int64_t other(size_t item)
{
    const struct match_item *found = match.item[item].other;
    return found ? found - match.item : -1;
}

static void the_first_query_is_matched_first(void **state)
{
    for (int i = 0; i < 3; i++)
        add_query(key(1, 2));
    for (int i = 0; i < 4; i++)
        add_result(key(1, 2), false);
    match_all(&match);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(other((size_t) i), 3 + i);
        assert_int_equal(other((size_t) (3 + i)), i);
        assert_false(match.item[3 + i].second);
    }
    assert_int_equal(other(6), 2);
    assert_true(match.item[6].second);
}

static void results_may_come_first(void **state)
{
    add_result(key(1, 2), true);
    add_result(key(1, 2), false);
    for (int i = 0; i < 3; i++)
        add_query(key(1, 2));
    match_all(&match);
    assert_int_equal(other(2), 0);
    assert_int_equal(other(3), 1);
    assert_int_equal(other(4), -1);
}

static void keys_differ_in_any_number(void **state)
{
    struct match_key keys[] = {key(1, 2), key(2, 1), key(INT64_MIN, 2), key(1, 2)};
    keys[3].kind = LOG_SCENE_QUERY;
    for (size_t i = 0; i < COUNT(keys); i++)
        add_query(keys[i]);
    for (size_t i = COUNT(keys); i-- > 0;)
        add_result(keys[i], false);
    match_all(&match);
    for (size_t i = 0; i < COUNT(keys); i++)
        assert_int_equal(other(i), 2 * COUNT(keys) - 1 - i);
}

/* A later result takes the place of a transient one, until the query is repeated. */
static void transient_results_are_replaced(void **state)
{
    add_query(key(1, 2));
    add_result(key(1, 2), true);
    add_result(key(1, 2), true);
    add_query(key(1, 2));
    add_result(key(1, 2), true);
    add_result(key(1, 2), false);
    add_result(key(1, 2), true);
    match_all(&match);
    const int64_t expected[] = {1, 0, 0, 5, 3, 3, 3};
    for (size_t i = 0; i < COUNT(expected); i++)
        assert_int_equal(other(i), expected[i]);
    assert_true(match.item[2].second && match.item[4].second && match.item[6].second);
    assert_false(match.item[1].second || match.item[5].second);
}

static void results_without_the_time_match(void **state)
{
    struct match_key of = key(1, 2);
    add_query(of);
    of.utime = 9;
    add_query(of);
    add_query(key(1, 3));
    for (int i = 0; i < 3; i++) {
        of.utime = 300 - i;
        add_result(of, i == 0);
    }
    match_all(&match);
    const int64_t expected[] = {3, 4, -1, 0, 1, -1};
    for (size_t i = 0; i < COUNT(expected); i++)
        assert_int_equal(other(i), expected[i]);
}

/* A log of one client whose numbers never change. */
static void many_queries_may_have_one_key(void **state)
{
    enum { MANY = 200000 };
    for (int i = 0; i < MANY; i++)
        add_query(key(1, 1));
    for (int i = 0; i < MANY; i++)
        add_result(key(1, 1), false);
    match_all(&match);
    for (size_t i = 0; i < MANY; i++)
        assert_int_equal(other(i), MANY + i);
}

/* ---- A naive model: searches through all items for each ---- */

enum { ITEMS = 60, ROUNDS = 3000 };

static struct {
    bool waits;
    int64_t other; /* -1: none */
} model[ITEMS];

/* The first item before `end` of the same key that waits; -1: none. */
static int64_t first_waiting(size_t end, bool is_result)
{
    for (size_t i = 0; i < end; i++)
        if (model[i].waits && match.item[i].is_result == is_result &&
            memcmp(&match.item[i].key, &match.item[end].key, sizeof match.item[i].key) == 0)
            return (int64_t) i;
    return -1;
}

static void model_query(size_t at)
{
    const int64_t answered = first_waiting(at, false), result = first_waiting(at, true);
    if (answered >= 0 && model[answered].other >= 0)
        model[answered].waits = false;
    model[at].waits = result < 0;
    if (result < 0)
        return;
    model[result].waits = false;
    model[result].other = (int64_t) at;
    model[at].other = result;
}

static void model_result(size_t at)
{
    const int64_t query = first_waiting(at, false), result = first_waiting(at, true);
    if (query >= 0) {
        if (model[query].other < 0 || !match.item[at].transient)
            model[query].other = (int64_t) at;
        model[at].other = query;
        model[query].waits = false;
        model[query].waits = match.item[at].transient && first_waiting(at, false) < 0;
        return;
    }
    for (size_t i = 0; i < at && result < 0; i++) /* the last query that had a result */
        if (!match.item[i].is_result && model[i].other >= 0 &&
            memcmp(&match.item[i].key, &match.item[at].key, sizeof match.item[i].key) == 0)
            model[at].other = (int64_t) i;
    model[at].waits = model[at].other < 0;
}

static void matching_agrees_with_a_model(void **state)
{
    srand(1);
    for (int round = 0; round < ROUNDS; round++) {
        const int keys = 1 + rand() % 5, results = 1 + rand() % 4;
        match_clear(&match);
        for (size_t i = 0; i < ITEMS; i++) {
            const struct match_key of = key(rand() % keys, rand() % 2);
            if (rand() % 5 < results)
                add_result(of, rand() % 3 == 0);
            else
                add_query(of);
            model[i].waits = false;
            model[i].other = -1;
            (match.item[i].is_result ? model_result : model_query)(i);
        }
        match_all(&match);
        for (size_t i = 0; i < ITEMS; i++)
            assert_int_equal(other(i), model[i].other);
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_teardown(name, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_first_query_is_matched_first), TEST(results_may_come_first),
        TEST(keys_differ_in_any_number),        TEST(transient_results_are_replaced),
        TEST(results_without_the_time_match),   TEST(many_queries_may_have_one_key),
        TEST(matching_agrees_with_a_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
