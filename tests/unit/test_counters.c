/* The quantiles of the heartbeat. */
#include "unit.h"

#include "histogram.h"

static int compare(const void *a, const void *b)
{
    int64_t x = *(const int64_t *) a, y = *(const int64_t *) b;
    return (x > y) - (x < y);
}

static void quantiles_are_within_a_bucket(void **state)
{
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
    for (size_t i = 0; i < COUNT(shares); i++) {
        int64_t exact = value[(int) (shares[i] * COUNT + 0.999999) - 1];
        int64_t reported = histogram_quantile(&histogram, shares[i]);
        assert_true(reported >= exact);
        assert_true((double) reported <= 1.13 * (double) exact);
    }
    assert_true(histogram_quantile(&histogram, 1) == value[COUNT - 1]);
    assert_true(histogram.max == value[COUNT - 1]);
}

static void quantiles_at_the_edges_are_exact(void **state)
{
    static struct histogram histogram;
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
    histogram_add(&histogram, 0);
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
    histogram_add(&histogram, INT64_MIN);
    histogram_add(&histogram, -1);
    assert_int_equal(histogram.bucket[0], 3);
    histogram_add(&histogram, INT64_MAX);
    assert_true(histogram_quantile(&histogram, 1) == INT64_MAX);
    assert_int_equal(histogram_quantile(&histogram, 0.5), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_within_a_bucket),
        cmocka_unit_test(quantiles_at_the_edges_are_exact),
    };
    return cmocka_run_group_tests_name("counters", tests, NULL, NULL);
}
