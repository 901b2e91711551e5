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

static void a_constant_that_is_too_small_is_found(void **state)
{
    for (int i = 0; check_constant(i); i++) {
        check_begin();
        check_lower(i, 0.25);
        for (size_t f = 0; !check_failed(i) && family_all_at(f); f++) {
            check_family(family_all_at(f), 1, 1);
            if (family_turning_at(f))
                check_family(family_turning_at(f), 1, 1);
        }
        if (!check_failed(i))
            fail_msg("%s is not found", check_constant(i));
    }
    check_begin();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_bound_is_below_what_its_arithmetic_derives),
        cmocka_unit_test(a_constant_that_is_too_small_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
