/* What a recording counts: messages, those that cannot be read, and those that did not come. */
#include "hostile.h"
#include "record_report.h"
#include "record_tally.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Sequence numbers ------------------------------------------------------------------------ */

static struct gaps gaps;

static int clear_gaps(void **state)
{
    (void) state;
    memset(&gaps, 0, sizeof gaps);
    return 0;
}

static void test_numbers_that_are_skipped_are_missing(void **state)
{
    (void) state;
    static const struct {
        int64_t number, missing;
    } steps[] = {
        {1000, 0}, {1001, 0}, /* a client may begin anywhere */
        {1004, 2}, {1004, 2}, /* one that comes again is neither new nor missing */
        {1003, 1},            /* one that was overtaken has come */
        {1003, 1}, {1002, 0}, {1001, 0}, {1000, 0}, {999, 0}, {5, 0}, {1006, 1},
    };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        gaps_note(&gaps, 1, steps[i].number);
        assert_int_equal(gaps.missing, steps[i].missing);
    }
    gaps_note(&gaps, 2, 0); /* others do not matter */
    gaps_note(&gaps, 2, 2);
    gaps_note(&gaps, 1, 1007);
    assert_int_equal(gaps.missing, 2);
}

/* Against a list of all numbers: drawn ones out of order, each some times or not at all. */
static void test_numbers_in_any_order(void **state)
{
    (void) state;
    enum { COUNT = 100000, OVERTAKEN = GAPS_WINDOW / 2 };
    static bool came[COUNT];
    int64_t last = 0, missing = 0;
    srand(1);
    came[0] = true;
    gaps_note(&gaps, 7, 0);
    for (int i = 1; i < COUNT - OVERTAKEN; i++) {
        if (rand() % 10 == 0)
            continue;
        const int number = i + rand() % OVERTAKEN;
        came[number] = true;
        last = number > last ? number : last;
        gaps_note(&gaps, 7, number);
    }
    for (int i = 0; i < last; i++)
        missing += !came[i];
    assert_true(missing > COUNT / 20);
    assert_int_equal(gaps.missing, missing);
}

static void test_a_window_behind_it_is_too_late(void **state)
{
    (void) state;
    gaps_note(&gaps, 1, 0);
    gaps_note(&gaps, 1, GAPS_WINDOW + 1);
    assert_int_equal(gaps.missing, GAPS_WINDOW);
    gaps_note(&gaps, 1, 1); /* so far behind that it stays counted, however often it comes */
    gaps_note(&gaps, 1, 1);
    assert_int_equal(gaps.missing, GAPS_WINDOW);
    gaps_note(&gaps, 1, 2);
    gaps_note(&gaps, 1, 2);
    assert_int_equal(gaps.missing, GAPS_WINDOW - 1);
}

/* A place in the window that was seen is not taken for that of a number one window later. */
static void test_windows_are_not_confused(void **state)
{
    (void) state;
    for (int64_t number = 0; number < 2 * GAPS_WINDOW; number++)
        gaps_note(&gaps, 1, number);
    gaps_note(&gaps, 1, 3 * GAPS_WINDOW - 1);
    assert_int_equal(gaps.missing, GAPS_WINDOW - 1);
    for (int64_t number = 2 * GAPS_WINDOW; number < 3 * GAPS_WINDOW; number++)
        gaps_note(&gaps, 1, number);
    assert_int_equal(gaps.missing, 0);
    gaps_note(&gaps, 1, 5 * GAPS_WINDOW);
    assert_int_equal(gaps.missing, 2 * GAPS_WINDOW);
    gaps_note(&gaps, 1, 5 * GAPS_WINDOW - 5);
    assert_int_equal(gaps.missing, 2 * GAPS_WINDOW - 1);
}

static void test_what_is_missing_does_not_overflow(void **state)
{
    (void) state;
    for (int64_t client = 1; client <= 5000; client++) {
        gaps_note(&gaps, client, 0);
        gaps_note(&gaps, client, GAPS_MAX);
    }
    assert_true(gaps.missing <= GAPS_MAX && gaps.missing > GAPS_MAX - 5000);
}

static void test_clients_without_end(void **state)
{
    (void) state;
    for (int round = 0; round < 3; round++)
        for (int64_t client = 0; client < 100000; client++)
            gaps_note(&gaps, client, round);
    assert_int_equal(gaps.missing, 0);
}

/* ---- Results --------------------------------------------------------------------------------- */

static void come(struct answered *answered, int64_t server, int results)
{
    for (int i = 0; i < results; i++)
        answered_result(answered, server);
}

static void test_results_that_were_published_and_did_not_come(void **state)
{
    (void) state;
    struct answered answered = {.now = 0};
    come(&answered, 1, 5); /* before the first heartbeat nothing is known */
    answered_heartbeat(&answered, 1, 100);
    assert_int_equal(answered_missing(&answered), 0);
    come(&answered, 1, 8);
    answered_heartbeat(&answered, 1, 110);
    assert_int_equal(answered_missing(&answered), 2);
    come(&answered, 1, 4); /* one of them came late, behind the heartbeat */
    answered_heartbeat(&answered, 1, 113);
    assert_int_equal(answered_missing(&answered), 1);
    come(&answered, 1, 50); /* until it says how many it published, none is missing */
    assert_int_equal(answered_missing(&answered), 1);
}

static void test_every_service_counts_for_itself(void **state)
{
    (void) state;
    struct answered answered = {.now = 0};
    for (int64_t server = 1; server <= 1000; server++) {
        answered_heartbeat(&answered, server, 10);
        come(&answered, server, 2);
        answered_heartbeat(&answered, server, 15);
        assert_int_equal(answered_missing(&answered), 3 * server);
    }
}

static void test_a_service_that_comes_again_or_lies(void **state)
{
    (void) state;
    struct answered answered = {.now = 0};
    answered_heartbeat(&answered, 1, 1000);
    answered_heartbeat(&answered, 1, 3); /* a log that is played twice */
    answered_heartbeat(&answered, 1, -1);
    answered_heartbeat(&answered, 1, INT64_MIN);
    answered_heartbeat(&answered, 1, INT64_MAX);
    assert_int_equal(answered_missing(&answered), 0);
    for (int64_t server = 2; server < 5000; server++) {
        answered_heartbeat(&answered, server, 0);
        answered_heartbeat(&answered, server, INT64_C(1) << 53);
        assert_true(answered_missing(&answered) > 0);
    }
}

/* ---- Messages -------------------------------------------------------------------------------- */

static struct tally tally;

static int clear_tally(void **state)
{
    (void) state;
    memset(&tally, 0, sizeof tally);
    return 0;
}

static void note(void *kind, const char *what, const unsigned char *bytes, size_t size)
{
    (void) what;
    tally_note(&tally, *(enum log_kind *) kind, 10, bytes, (uint32_t) size);
}

static void test_good_and_damaged_messages_of_all_kinds(void **state)
{
    (void) state;
    static const char *const types[LOG_OTHER] = {"pair_query", "pair_result", "scene_query",
                                                 "scene_result", "status"};
    int64_t damaged = 0;
    for (int kind = 0; kind < LOG_OTHER; kind++) {
        unsigned char good[HOSTILE_BYTES_MAX];
        enum log_kind as = (enum log_kind) kind;
        const size_t size = hostile_good(types[kind], good);
        note(&as, NULL, good, size);
        assert_int_equal(tally.malformed, damaged);
        const int64_t more = (int64_t) hostile_each(types[kind], note, &as);
        assert_true(more > 100);
        assert_int_equal(tally.malformed, damaged += more);
        assert_int_equal(tally.heard[kind], 1 + more);
        as = LOG_OTHER; /* what others say is never malformed */
        hostile_each(types[kind], note, &as);
        assert_int_equal(tally.malformed, damaged);
    }
    assert_int_equal(tally_heard(&tally), 5 + 2 * damaged);
}

static void test_bytes_are_those_of_a_log(void **state)
{
    (void) state;
    tally_note(&tally, LOG_PAIR_QUERY, 14, "x", 1);
    assert_int_equal(tally.bytes, 28 + 14 + 1);
    tally_note(&tally, LOG_OTHER, 5, NULL, 0);
    assert_int_equal(tally.bytes, 28 + 14 + 1 + 28 + 5);
}

static void note_flood(const char *type, enum log_kind kind, int64_t number)
{
    unsigned char bytes[HOSTILE_BYTES_MAX];
    const size_t size = hostile_flood(type, 9, number, bytes);
    tally_note(&tally, kind, 14, bytes, (uint32_t) size);
}

/* Pairs and scenes of a client share its numbers. */
static void test_what_is_lost(void **state)
{
    (void) state;
    note_flood("pair_query", LOG_PAIR_QUERY, 1);
    note_flood("scene_query", LOG_SCENE_QUERY, 2);
    assert_int_equal(record_lost(&tally, 0, -1), 0);
    note_flood("pair_query", LOG_PAIR_QUERY, 6);
    assert_int_equal(record_lost(&tally, 0, -1), 3);
    assert_int_equal(record_lost(&tally, 10, -1), 13);
    assert_int_equal(record_lost(&tally, 10, 2), 13); /* they are among those that are missing */
    assert_int_equal(record_lost(&tally, 10, 5), 15);
    answered_heartbeat(&tally.answered, 1, 0);
    answered_heartbeat(&tally.answered, 1, 1);
    assert_int_equal(record_lost(&tally, 0, 2), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_numbers_that_are_skipped_are_missing, clear_gaps),
        cmocka_unit_test_setup(test_numbers_in_any_order, clear_gaps),
        cmocka_unit_test_setup(test_a_window_behind_it_is_too_late, clear_gaps),
        cmocka_unit_test_setup(test_windows_are_not_confused, clear_gaps),
        cmocka_unit_test_setup(test_what_is_missing_does_not_overflow, clear_gaps),
        cmocka_unit_test_setup(test_clients_without_end, clear_gaps),
        cmocka_unit_test(test_results_that_were_published_and_did_not_come),
        cmocka_unit_test(test_every_service_counts_for_itself),
        cmocka_unit_test(test_a_service_that_comes_again_or_lies),
        cmocka_unit_test_setup(test_good_and_damaged_messages_of_all_kinds, clear_tally),
        cmocka_unit_test_setup(test_bytes_are_those_of_a_log, clear_tally),
        cmocka_unit_test_setup(test_what_is_lost, clear_tally),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
