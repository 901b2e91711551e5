/* The first and last time of contact of a pair that is known to be in contact.
 *
 * Method. Each slab of the pair (of a face, or of an edge of each frame) contains the offset from
 * some time on until another: start + tau slope <= high and >= low. These two inequalities clip the
 * interval of tau (clip.h). The first time is the largest of the lower ends, and the last the
 * smallest of the upper ones: since the pair is in contact, some time satisfies all inequalities.
 * Each end therefore lies between its outer and its inner value. Slabs of the drift do not depend
 * on time: their slope is 0, and they clip nothing.
 *
 * If outer and inner are too far apart, the exact end is computed in fixed-width integers for each
 * slab whose inner end is beyond the outer end of all. The result is the tightest doubles,
 * whichever slab gives the end, since rounding preserves order. This does not hold for frames with
 * errors: a slab that is missing in the rounded list, because its edges are parallel there, might
 * give the end.
 *
 * The slabs do not give the times of two faces that stay in one plane: those along its normal are 0
 * at all times. If operations round, their errors are above 0, so that no inner value is good; then
 * doubles give no times, and only integers of fixed width must not be used (faces.h). */
#include "certified.h"

#include "clip.h"
#include "limbs.h"

/* Relative to the window; leaves a tenth of the limit of 1e-12 for the product with the duration.
 */
static const double limit = 0.9e-12;

/* In seconds. Below this, the distance of adjacent doubles is no longer small relative to the
 * window, and ends have to be the tightest doubles. */
static const double least_duration = 0x1p-1000;

struct times {
    struct clip outer, inner; /* of tau */
};

static void cut(struct times *times, const struct inequality side[2], bool rounds)
{
    clip_both(&times->outer, &times->inner, &side[0], rounds);
    clip_both(&times->outer, &times->inner, &side[1], rounds);
}

/* Whether a product is found to be no larger (side 0) or no smaller (side 1) than x y; its error
 * is a double where the product is not tiny. */
static bool on_side(double x, double y, double product, int side)
{
    const double error = fma(x, y, -product);
    return product >= 0x1p-900 && (side ? error <= 0 : error >= 0);
}

/* Seconds of a tau in [0,1], on the outer side: the tightest, or the double next to it. A tau below
 * 1 is at most 1 - 2^-53: its time is rounded to less than the duration, which is not subnormal,
 * and the next double is within the window. */
static double seconds(double tau, double duration, int side)
{
    const double time = tau * duration;
    if (tau == 0 || tau == 1 || on_side(tau, duration, time, side))
        return time + 0.0;
    return nextafter(time, side ? INFINITY : 0) + 0.0;
}

/* ---- Exact ends ---- */

struct exact_end {
    mpz_t low, high, start, slope, scratch[2];
};

static void exact_end_each(struct exact_end *end, void (*call)(mpz_ptr))
{
    call(end->low);
    call(end->high);
    call(end->start);
    call(end->slope);
    call(end->scratch[0]);
    call(end->scratch[1]);
}

/* The time at which the offset enters the slab (side 0) or leaves it, in seconds, rounded outward;
 * 0 or the duration where it does so before or after the window, or never. */
static double exact_time(struct exact_end *end, int side, double duration)
{
    int slope = mpz_sgn(end->slope);
    if (slope == 0)
        return side ? duration : 0;
    mpz_ptr bound = (slope > 0) == (side == 1) ? end->high : end->low;
    mpz_sub(bound, bound, end->start);
    if (slope < 0) {
        mpz_neg(bound, bound);
        mpz_neg(end->slope, end->slope);
    }
    if (mpz_sgn(bound) < 0)
        return side ? duration : 0; /* sides are chosen so that only 'before' comes here */
    if (mpz_cmp(bound, end->slope) > 0)
        return duration;
    const struct dyadic window = dyadic_of(duration);
    mpz_mul_si(bound, bound, window.mantissa);
    return integer_ratio_round(bound, end->slope, window.exponent, side ? ROUND_UP : ROUND_DOWN,
                               end->scratch);
}

/* Whether the end of a slab might be beyond the one that surely holds for all, by more than may be
 * neglected. */
static bool contends(const struct inequality slab[2], const struct times *times, int end)
{
    struct times own = {{0, 1}, {0, 1}};
    cut(&own, slab, true);
    return end ? own.inner.high < times->outer.high - limit
               : own.inner.low > times->outer.low + limit;
}

/* The slabs of a pair. */
struct slabs {
    int count;
    struct slab_normal normal[SLABS_MAX];
    struct inequality side[SLABS_MAX][2];
};

static void set_slabs(const struct slabs_pair *pair, bool rounds, struct slabs *out)
{
    struct slab_value slab[SLABS_MAX];
    out->count = slabs_list(pair, rounds, slab);
    for (int i = 0; i < out->count; i++) {
        out->normal[i] = slab[i].normal;
        slab_inequalities(&slab[i], out->side[i]);
    }
}

static void cut_all(const struct slabs *slabs, bool rounds, struct times *times)
{
    *times = (struct times){{0, 1}, {0, 1}};
    for (int i = 0; i < slabs->count; i++)
        cut(times, slabs->side[i], rounds);
}

static bool good_end(const struct times *times, int side)
{
    return side ? times->outer.high - times->inner.high <= limit
                : times->inner.low - times->outer.low <= limit;
}

/* Looks again, alone, at those slabs on which an end that is not good depends. */
static void refine(const struct slabs_pair *pair, const struct times *times, struct slabs *slabs)
{
    const bool open[2] = {!good_end(times, 0), !good_end(times, 1)};
    for (int i = 0; i < slabs->count; i++)
        if ((open[0] && contends(slabs->side[i], times, 0)) ||
            (open[1] && contends(slabs->side[i], times, 1)))
            slabs_refine(pair, slabs->normal[i], slabs->side[i]);
}

/* Moves an end to the exact time of each slab that might be beyond it. */
static void settle(const struct slabs *slabs, struct limbs_pair *limbs, const struct times *times,
                   int end, double duration, double *time)
{
    struct exact_end exact;
    exact_end_each(&exact, mpz_init);
    for (int i = 0; i < slabs->count; i++) {
        if (!contends(slabs->side[i], times, end))
            continue;
        limbs_slab(limbs, slabs->normal[i], exact.low, exact.high, exact.start, exact.slope);
        const double of_slab = exact_time(&exact, end, duration);
        if (end ? of_slab < *time : of_slab > *time)
            *time = of_slab;
    }
    exact_end_each(&exact, mpz_clear);
}

bool contact_of(const struct frame_pair *pair, const struct slabs_pair *slabs_pair, bool rounds,
                struct dyadic_span span, bool exact, double contact[2])
{
    struct slabs slabs;
    struct times times;
    struct limbs_pair limbs;
    if (pair->duration < least_duration)
        return false;
    set_slabs(slabs_pair, rounds, &slabs);
    cut_all(&slabs, rounds, &times);
    if (rounds && (!good_end(&times, 0) || !good_end(&times, 1))) {
        refine(slabs_pair, &times, &slabs);
        cut_all(&slabs, rounds, &times);
    }
    contact[0] = seconds(times.outer.low, pair->duration, 0);
    contact[1] = seconds(times.outer.high, pair->duration, 1);
    if (good_end(&times, 0) && good_end(&times, 1))
        return true;
    if (!exact || slabs_pair->inexact || !limbs_prepare(pair, span, &limbs))
        return false;
    for (int end = 0; end < 2; end++)
        if (!good_end(&times, end))
            settle(&slabs, &limbs, &times, end, pair->duration, &contact[end]);
    return true;
}
