/* How much exact arithmetic a pair can take, counted and not timed: a search for the pair that
 * takes most stays below the bounds that the service is built on. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "climb.h"
#include "gmp_work.h"
#include "referee.h"

enum { TEXT_SIZE = FMB_CERTIFICATE_MAX };

/* Products of limbs, half a nanosecond each: 2 ms for an answer, and 10 ms with a certificate, 2 of
 * them for the answer beside it; 0.1 ms for a gap. */
static const double most_work = 4e6, most_work_certified = 16e6, most_work_of_gap = 2e5;

static double work_of(const struct question *question, unsigned want)
{
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    const double before = gmp_work;
    assert_int_equal(pair_decide(fmb_method_default(), &ready.pair, want, &answer), FMB_OK);
    return gmp_work - before;
}

static double work_of_box(const struct question *question)
{
    return work_of(question, FMB_WANT_BOX);
}

static double work_of_gap(const struct question *question)
{
    return work_of(question, FMB_WANT_GAP) - work_of(question, 0);
}

static double work_of_body(const struct question *question)
{
    const double before = gmp_work;
    struct ready ready;
    referee_ready(question, &ready);
    return gmp_work - before;
}

static double work_of_certificate(const struct question *question)
{
    static char text[TEXT_SIZE];
    struct ready ready;
    size_t length;
    referee_ready(question, &ready);
    const double before = gmp_work;
    assert_int_equal(pair_certificate(&ready.pair, text, sizeof text, &length), FMB_OK);
    return gmp_work - before;
}

struct search {
    const char *name;
    climb_cost *cost;
    double most;
    int climbs;
};

/* Numbers of all exponents; and those with which certificates reduce fractions, near the widest. */
static void work_is_bounded(void **state)
{
    static const int ranges[][2] = {{-1074, 1023}, {-230, 230}};
    const struct search *search = *state;
    struct draw draw;
    draw_begin(&draw, search->name);
    for (int r = 0; r < 2; r++) {
        struct climber climber = {&draw, search->cost, ranges[r][0], ranges[r][1]};
        struct question worst;
        const double work = climb(&climber, (int) draw_sample(search->climbs), 200, &worst);
        printf("# %s, 2^%d to 2^%d: at most %.0f products of limbs\n", search->name, ranges[r][0],
               ranges[r][1], work);
        assert_true(work > 0);
        if (work > search->most)
            referee_fail(&worst, "more work than is promised");
    }
}

int main(void)
{
    static struct search searches[] = {
        {"bodies", work_of_body, 2e4, 8},
        {"boxes", work_of_box, most_work, 16},
        {"gaps", work_of_gap, most_work_of_gap, 8},
        {"certificates", work_of_certificate, most_work_certified, 8}};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(work_is_bounded, &searches[0]),
        cmocka_unit_test_prestate(work_is_bounded, &searches[1]),
        cmocka_unit_test_prestate(work_is_bounded, &searches[2]),
        cmocka_unit_test_prestate(work_is_bounded, &searches[3]),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
