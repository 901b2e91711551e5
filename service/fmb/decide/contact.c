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
 * slab whose inner end is beyond the outer end of all by more than the limit. Where one of these
 * gives the end, the result is the tightest double, since rounding preserves order; otherwise the
 * outer end is within the limit. Edges of frames with errors that are parallel as rounded need not
 * be so as given, and any end may be that of their slab: its exact end is always computed.
 *
 * The slabs do not give the times of two faces that stay in one plane: those along its normal are 0
 * at all times. If operations round, their errors are above 0, so that no inner value is good; then
 * doubles give no times, and only integers must not be used (faces.h). */
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

static void cut(struct times *times, const struct slab_value *slab, bool rounds)
{
    struct inequality side[2];
    slab_inequalities(slab, side);
    for (int i = 0; i < 2; i++)
        clip_both(&times->outer, &times->inner, &side[i], rounds);
}

static bool good_end(const struct times *times, int end)
{
    return end ? times->outer.high - times->inner.high <= limit
               : times->inner.low - times->outer.low <= limit;
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

/* Whether the end of a slab might be beyond the one that surely holds for all, by more than may be
 * neglected. inexact: as in struct slabs_pair. */
static bool contends(const struct slab_value *slab, bool inexact, const struct times *times,
                     int end)
{
    struct times own = {{0, 1}, {0, 1}};
    if (slab->error == 0 && inexact)
        return true;
    cut(&own, slab, true);
    return end ? own.inner.high < times->outer.high - limit
               : own.inner.low > times->outer.low + limit;
}

/* Moves the ends that are not good to the exact times of the slabs that might be beyond them. */
static void settle(const struct slab_value *slabs, int count, bool inexact,
                   const struct limbs_question *question, const struct times *times,
                   double contact[2])
{
    struct slab_normal normal[SLABS_MAX];
    bool open[SLABS_MAX][2];
    int opened = 0;
    for (int i = 0; i < count; i++) {
        for (int end = 0; end < 2; end++)
            open[opened][end] = !good_end(times, end) && contends(&slabs[i], inexact, times, end);
        normal[opened] = slabs[i].normal;
        opened += open[opened][0] || open[opened][1];
    }
    limbs_slabs(question, normal, open, opened, contact);
}

bool contact_of(const struct frame_pair *pair, const struct slabs_pair *slabs_pair, bool rounds,
                struct dyadic_span span, bool exact, double contact[2])
{
    struct slab_value slabs[SLABS_MAX];
    struct times times = {{0, 1}, {0, 1}};
    struct limbs_question question;
    if (pair->duration < least_duration)
        return false;
    const int count = slabs_list(slabs_pair, rounds, slabs);
    for (int i = 0; i < count; i++)
        cut(&times, &slabs[i], rounds);
    contact[0] = seconds(times.outer.low, pair->duration, 0);
    contact[1] = seconds(times.outer.high, pair->duration, 1);
    if (good_end(&times, 0) && good_end(&times, 1))
        return true;
    if (!exact)
        return false;
    limbs_question_set(pair, span, LIMBS_SLABS, &question);
    if (!limbs_suffice(&question))
        return false;
    settle(slabs, count, slabs_pair->inexact, &question, &times, contact);
    return true;
}
