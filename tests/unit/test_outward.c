/* What is rounded outward is outside, and what is inward inside: sums, quotients and cuts against
 * rational numbers. */

#include "unit.h"

#include <math.h>

#include "clip.h"
#include "draw.h"
#include "interval.h"
#include "pair_draw.h"
#include "placed_pair.h"
#include "prepared.h"
#include "referee.h"
#include "slabs.h"

static mpq_t exact, scratch[2];

static int set_up(void **state)
{
    mpq_inits(exact, scratch[0], scratch[1], NULL);
    return 0;
}

static int tear_down(void **state)
{
    mpq_clears(exact, scratch[0], scratch[1], NULL);
    return 0;
}

/* The sign of x - exact. */
static int side_of(double x)
{
    mpq_set_d(scratch[0], x);
    return mpq_cmp(scratch[0], exact);
}

/* Mantissas of ones, an ulp beside a power of two, of few bits, any. */
static double draw_mantissa(struct draw *draw)
{
    switch (draw_int(draw, 0, 4)) {
    case 0: return 2 - draw_int(draw, 1, 3) * 0x1p-52;
    case 1: return 1 + draw_int(draw, 0, 3) * 0x1p-52;
    case 2: return 1 + draw_int(draw, 0, 15) / 16.0;
    case 3: return 1.5 + draw_int(draw, -2, 2) * 0x1p-52;
    default: return draw_uniform(draw, 1, 2);
    }
}

static double draw_between(struct draw *draw, int least, int most)
{
    const double x = ldexp(draw_mantissa(draw), draw_int(draw, least, most));
    return draw_int(draw, 0, 30) == 0 ? 0 : draw_coin(draw) ? x : -x;
}

/* A number of any size, or one that is near another as sums go: an ulp of half of it, say. */
static double draw_beside(struct draw *draw, double other)
{
    int e = 0;
    frexp(other, &e);
    const int least = e - 110 < -1074 ? -1074 : e - 110, most = e + 2 < least ? least : e + 2;
    switch (draw_int(draw, 0, 3)) {
    case 0: return draw_between(draw, -1074, 990);
    case 1: return -other * (1 + draw_int(draw, -3, 3) * 0x1p-52);
    default: return draw_between(draw, least, most);
    }
}

/* ---- Sums ---- */

static void expect_range(struct interval range, double x, double y, double rounded)
{
    if (side_of(range.low) > 0 || side_of(range.high) < 0)
        fail_msg("%a and %a: [%a, %a] does not hold it", x, y, range.low, range.high);
    if (side_of(rounded) == 0 && (range.low != rounded || range.high != rounded))
        fail_msg("%a and %a: exact, and [%a, %a]", x, y, range.low, range.high);
    if (range.high - range.low > 0x1p-51 * fabs(rounded))
        fail_msg("%a and %a: [%a, %a] is wide", x, y, range.low, range.high);
}

static void sums_hold_the_exact_one(void **state)
{
    struct draw draw;
    long exact_ones = 0;
    draw_begin(&draw, "sums_hold_the_exact_one");
    for (long n = draw_sample(500000); n > 0; n--) {
        const double x = draw_between(&draw, -1074, 990), y = draw_beside(&draw, x);
        mpq_set_d(exact, x);
        mpq_set_d(scratch[0], y);
        mpq_add(exact, exact, scratch[0]);
        expect_range(interval_sum(interval_of(x), interval_of(y)), x, y, x + y);
        exact_ones += side_of(x + y) == 0;
    }
    printf("# %ld sums were exact\n", exact_ones);
    assert_true(exact_ones > 0);
}

static void sums_of_ranges_hold_those_of_their_ends(void **state)
{
    struct draw draw;
    draw_begin(&draw, "sums_of_ranges_hold_those_of_their_ends");
    for (long n = draw_sample(200000); n > 0; n--) {
        const double a = draw_between(&draw, -1074, 990), b = draw_beside(&draw, a);
        const double c = draw_beside(&draw, a), d = draw_beside(&draw, c);
        const struct interval x = {fmin(a, b), fmax(a, b)}, y = {fmin(c, d), fmax(c, d)};
        const struct interval sum = interval_sum(x, y);
        mpq_set_d(exact, x.low);
        mpq_set_d(scratch[0], y.low);
        mpq_add(exact, exact, scratch[0]);
        assert_true(side_of(sum.low) <= 0);
        mpq_set_d(exact, x.high);
        mpq_set_d(scratch[0], y.high);
        mpq_add(exact, exact, scratch[0]);
        assert_true(side_of(sum.high) >= 0);
    }
}

/* ---- Quotients and cuts ---- */

static void expect_quotients(double x, double y, bool rounds)
{
    const double below = quotient_bound(x, y, false, rounds);
    const double above = quotient_bound(x, y, true, rounds);
    const double q = x / y;
    mpq_set_d(exact, x);
    mpq_set_d(scratch[0], y);
    mpq_div(exact, exact, scratch[0]);
    if (side_of(below) > 0 || side_of(above) < 0)
        fail_msg("%a / %a: not between %a and %a", x, y, below, above);
    if (q >= 0x1p-899 && above - below > 0x1p-49 * q)
        fail_msg("%a / %a: %a and %a are far apart", x, y, below, above);
    if (rounds || (q < 0x1p-100 && q != 0))
        return;
    if (side_of(q) == 0 ? below != q || above != q : nextafter(below, 3) != above)
        fail_msg("%a / %a: %a and %a are not the tightest", x, y, below, above);
}

static void quotients_hold_the_exact_one(void **state)
{
    struct draw draw;
    draw_begin(&draw, "quotients_hold_the_exact_one");
    for (long n = draw_sample(300000); n > 0; n--) {
        /* In [0,2], and exact ones among them. */
        double y = fabs(draw_between(&draw, -700, 900)), x = y * draw_uniform(&draw, 0, 2);
        switch (draw_int(&draw, 0, 4)) {
        case 0: x = fabs(draw_beside(&draw, y)); break;
        case 1: x = y * draw_int(&draw, 0, 8) / 8; break;
        case 2: x = fabs(draw_between(&draw, -1074, 900)); break;
        default: break;
        }
        if (y == 0 || !(x <= y * 1.5))
            continue;
        expect_quotients(x, y, true);
        if (x == 0 || x >= 0x1p-750)
            expect_quotients(x, y, false);
        expect_quotients(ldexp(x, -300), ldexp(y, -300), true); /* where bits go astray */
    }
}

/* Whether [low, high] (nothing where low > high) lies in the part of [0,1] where c + s g >= 0; or,
 * for part_within = true, that part in it. */
static bool holds(struct clip clip, double c, double g, bool part_within)
{
    mpq_set_d(exact, c);
    mpq_set_d(scratch[0], g);
    mpq_add(exact, exact, scratch[0]); /* at s = 1 */
    const bool at_start = c >= 0, at_end = mpq_sgn(exact) >= 0;
    const bool nothing = clip.low > clip.high;
    if (!at_start && !at_end)
        return part_within || nothing;
    if (nothing && !part_within)
        return true;
    bool good = true;
    if (at_start) /* 0 is in the part */
        good = part_within ? clip.low <= 0 : clip.low >= 0;
    if (at_end)
        good = good && (part_within ? clip.high >= 1 : clip.high <= 1);
    if (at_start && at_end)
        return good;
    mpq_set_d(exact, -c);
    mpq_div(exact, exact, scratch[0]); /* the end of the part: upper if at_start */
    const int side = side_of(at_start ? clip.high : clip.low) * (at_start ? 1 : -1);
    return good && (part_within ? side >= 0 : side <= 0);
}

static void cuts_are_outside_and_inside(void **state)
{
    struct draw draw;
    draw_begin(&draw, "cuts_are_outside_and_inside");
    for (long n = draw_sample(300000); n > 0; n--) {
        const double c = draw_between(&draw, -600, 600), g = draw_beside(&draw, c);
        const bool rounds = draw_coin(&draw) || fabs(g) < 0x1p-700;
        struct clip outer = {0, 1}, inner = {0, 1};
        clip_cut(&outer, c, g, true, rounds);
        clip_cut(&inner, c, g, false, rounds);
        if (!holds(outer, c, g, true) || !holds(inner, c, g, false))
            fail_msg("%a + s %a: outer [%a, %a], inner [%a, %a]", c, g, outer.low, outer.high,
                     inner.low, inner.high);
    }
}

/* Of an inequality known within errors: whichever of those within is the true one. */
static void cuts_within_errors_are_outside_and_inside(void **state)
{
    struct draw draw;
    draw_begin(&draw, "cuts_within_errors_are_outside_and_inside");
    for (long n = draw_sample(100000); n > 0; n--) {
        struct inequality x = {.c = draw_between(&draw, -100, 100)};
        x.g = draw_beside(&draw, x.c);
        x.error = fabs(ldexp(draw_coin(&draw) ? x.c : x.g, -draw_int(&draw, 0, 60)));
        struct clip outer = {0, 1}, inner = {0, 1};
        clip_both(&outer, &inner, &x, true);
        const double c[] = {x.c - x.error, x.c, x.c + x.error};
        const double g[] = {x.g - x.error, x.g, x.g + x.error};
        for (int i = 0; i < 9; i++) {
            const double of_c = c[i % 3], of_g = g[i / 3];
            if (!holds(outer, of_c, of_g, true) || !holds(inner, of_c, of_g, false))
                fail_msg("%a + s %a (%a): outer [%a, %a], inner [%a, %a], not of %a, %a", x.c, x.g,
                         x.error, outer.low, outer.high, inner.low, inner.high, of_c, of_g);
            if (always_holds(&x) && !holds((struct clip){0, 1}, of_c, of_g, false))
                fail_msg("%a + s %a (%a) does not hold", x.c, x.g, x.error);
        }
    }
}

/* ---- Slabs ---- */

static bool prepare_slabs(const struct pair *pair, struct slabs_pair *out)
{
    const struct frame_pair frames = pair_frames(pair);
    struct fmb_prepared a, b;
    prepared_set(frames.a, &a);
    prepared_set(frames.b, &b);
    return slabs_prepare(&a, &b, pair->duration, out);
}

/* The slabs of a pair depend on nothing that was in memory before. */
static void slabs_are_set_whole(void **state)
{
    struct draw draw;
    draw_begin(&draw, "slabs_are_set_whole");
    for (long n = draw_sample(2000); n > 0; n--) {
        const struct cell cell = pair_draw_cell(&draw);
        struct question question;
        struct ready ready;
        struct slabs_pair pair[2];
        static struct slab_value slab[2][SLABS_MAX];
        int count[2];
        pair_draw(&draw, &cell, &question);
        referee_ready(&question, &ready);
        for (int i = 0; i < 2; i++) {
            memset(&pair[i], i ? 0x3f : 0xff, sizeof pair[i]);
            memset(slab[i], i ? 0x3f : 0xff, sizeof slab[i]);
            count[i] =
                prepare_slabs(&ready.pair, &pair[i]) ? slabs_list(&pair[i], true, slab[i]) : 0;
        }
        assert_int_equal(count[0], count[1]);
        for (int k = 0; k < count[0]; k++) {
            const struct slab_value *one = &slab[0][k], *other = &slab[1][k];
            assert_true(one->low == other->low && one->high == other->high &&
                        one->middle == other->middle && one->swing == other->swing &&
                        one->error == other->error && slab_gap(one) == slab_gap(other));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_hold_the_exact_one),
        cmocka_unit_test(sums_of_ranges_hold_those_of_their_ends),
        cmocka_unit_test(quotients_hold_the_exact_one),
        cmocka_unit_test(cuts_are_outside_and_inside),
        cmocka_unit_test(cuts_within_errors_are_outside_and_inside),
        cmocka_unit_test(slabs_are_set_whole),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
