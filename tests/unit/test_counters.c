/* The counters of the heartbeat: what sequence numbers tell, and the times' quantiles. */
#include "histogram.h"
#include "senders.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static void test_gaps_and_repeats(void **state)
{
    (void) state;
    static struct senders senders;
    const int64_t order[] = {5, 6, 9, 9, 7, 10};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++)
        senders_note(&senders, 1, order[i]);
    assert_int_equal(senders.gaps, 2);     /* 7 and 8, when 9 came */
    assert_int_equal(senders.repeated, 2); /* 9 again, and 7 late */
    senders_note(&senders, 2, 1000);       /* a client may start anywhere */
    senders_note(&senders, 2, 1001);
    assert_int_equal(senders.gaps, 2);
}

static void test_gaps_do_not_overflow(void **state)
{
    (void) state;
    static struct senders senders;
    for (int64_t client = 1; client <= 5000; client++) {
        senders_note(&senders, client, 0);
        senders_note(&senders, client, SENDERS_GAPS_MAX);
    }
    assert_true(senders.gaps == SENDERS_GAPS_MAX);
}

/* As many clients as there are places, at most, are told apart; more never count wrongly. */
static void test_many_clients(void **state)
{
    (void) state;
    static struct senders senders;
    for (int round = 0; round < 3; round++)
        for (int64_t client = 0; client < 100000; client++)
            senders_note(&senders, client, round);
    assert_int_equal(senders.gaps, 0);
    assert_int_equal(senders.repeated, 0);
}

static int compare(const void *a, const void *b)
{
    int64_t x = *(const int64_t *) a, y = *(const int64_t *) b;
    return (x > y) - (x < y);
}

static void test_quantiles(void **state)
{
    (void) state;
    enum { COUNT = 10007 };
    static int64_t value[COUNT];
    static struct histogram histogram;
    const double shares[] = {0.001, 0.01, 0.5, 0.9, 0.99, 0.999, 1};
    srand(1);
    for (int i = 0; i < COUNT; i++) {
        value[i] = rand() >> rand() % 31;
        histogram_add(&histogram, value[i]);
    }
    qsort(value, COUNT, sizeof *value, compare);
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        int64_t exact = value[(int) (shares[i] * COUNT + 0.999999) - 1];
        int64_t told = histogram_quantile(&histogram, shares[i]);
        assert_true(told >= exact);
        assert_true((double) told <= 1.13 * (double) exact);
    }
    assert_true(histogram_quantile(&histogram, 1) == value[COUNT - 1]);
    assert_true(histogram.max == value[COUNT - 1]);
}

static void test_quantiles_at_the_edges(void **state)
{
    (void) state;
    static struct histogram histogram;
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
    histogram_add(&histogram, 0);
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
    histogram_add(&histogram, INT64_MAX);
    assert_true(histogram_quantile(&histogram, 1) == INT64_MAX);
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gaps_and_repeats),       cmocka_unit_test(test_gaps_do_not_overflow),
        cmocka_unit_test(test_many_clients),           cmocka_unit_test(test_quantiles),
        cmocka_unit_test(test_quantiles_at_the_edges),
    };
    return cmocka_run_group_tests_name("counters", tests, NULL, NULL);
}
