/* The bounds on rounding errors, by numbers that derive the bounds on their own errors, on a sample
 * of all families of hard pairs. */
#include "unit.h"

#include "checked_bounds.h"
#include "families.h"
#include "round.h"
#include "turn_family.h"

static void no_bound_is_below_what_its_arithmetic_derives(void **state)
{
    struct draw draw;
    draw_begin(&draw, "checked");
    const uint64_t seed = draw.state;
    for (size_t i = 0; family_checked_at(i); i++)
        check_family(family_checked_at(i), 1, seed);
    if (!check_report(stderr))
        fail_msg("a bound does not hold");
}

/* The first constant with which no bound has failed, or NULL. */
static const char *not_found(void)
{
    for (int i = 0; check_constant(i); i++)
        if (!check_failed(i))
            return check_constant(i);
    return NULL;
}

static void constants_that_are_too_small_are_found(void **state)
{
    check_begin();
    for (int i = 0; check_constant(i); i++)
        check_lower(i, 0.25);
    for (size_t f = 0; not_found() && family_checked_at(f); f++)
        check_family(family_checked_at(f), 1, 1);
    if (not_found())
        fail_msg("%s is not found", not_found());
    check_begin();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_bound_is_below_what_its_arithmetic_derives),
        cmocka_unit_test(constants_that_are_too_small_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
