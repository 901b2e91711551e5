#include "oracle.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "rounded.h"
#include "world.h"

/* ---- Is an answer right? ---- */

/* Always false, so that a check can end with it. */
__attribute__((format(printf, 3, 4))) static bool wrong(char *why, size_t size, const char *format,
                                                        ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, size, format, arguments);
    va_end(arguments);
    return false;
}

/* The sign of a double minus a rational; the double may be infinite. */
static int compare(double number, const mpq_t exact)
{
    if (isinf(number))
        return number > 0 ? 1 : -1;
    mpq_t rational;
    mpq_init(rational);
    mpq_set_d(rational, number);
    int order = mpq_cmp(rational, exact);
    mpq_clear(rational);
    return order;
}

/* An end goes out by its sign: -1 for the lower one, +1 for the upper one. Contains: the true
 * end is not beyond it. */
static bool contains(double end, int sign, const mpq_t exact)
{
    return sign * compare(end, exact) >= 0;
}

/* The next double inwards would cut the true end off (or is no double of this world). */
static bool is_tightest(double end, int sign, const mpq_t exact)
{
    return !contains(nextafter(end, -sign * HUGE_VAL), sign, exact);
}

/* |end - exact| <= 1e-12 size. */
static bool is_close(double end, const mpq_t exact, const mpq_t size)
{
    mpq_t way, most;
    mpq_inits(way, most, NULL);
    mpq_set_d(way, end);
    mpq_sub(way, way, exact);
    mpq_abs(way, way);
    mpq_set_ui(most, 1, 1000000000000);
    mpq_mul(most, most, size);
    bool close = mpq_cmp(way, most) <= 0;
    mpq_clears(way, most, NULL);
    return close;
}

/* +1, -1: beyond the largest double, on that side; 0: not beyond. */
static int beyond_doubles(const mpq_t exact)
{
    if (compare(DBL_MAX, exact) < 0)
        return 1;
    return compare(-DBL_MAX, exact) > 0 ? -1 : 0;
}

/* What all ends have in common. sign as above. */
static bool end_agrees(const char *name, double end, int sign, const mpq_t exact, char *why,
                       size_t size)
{
    return contains(end, sign, exact) ||
           wrong(why, size, "%s: %a cuts the true %.17g off", name, end, mpq_get_d(exact));
}

static bool contact_agrees(const struct oracle_answer *truth, const struct pair *pair,
                           const struct fmb_answer *answer, enum oracle_limit limit, char *why,
                           size_t size)
{
    static const char *const names[2] = {"first contact", "last contact"};
    mpq_t duration;
    mpq_init(duration);
    mpq_set_d(duration, pair->duration);
    bool good = true;
    for (int e = 0; e < 2 && good; e++) {
        const double end = answer->contact[e];
        const int sign = e == 0 ? -1 : +1;
        if (!(end >= 0 && end <= pair->duration) || (end == 0 && signbit(end)))
            good = wrong(why, size, "%s: %a is out of the window", names[e], end);
        if (!good || truth->rounded)
            continue;
        good = end_agrees(names[e], end, sign, truth->contact[e], why, size);
        if (good && !is_tightest(end, sign, truth->contact[e]) &&
            (limit == ORACLE_TIGHTEST || !is_close(end, truth->contact[e], duration)))
            good = wrong(why, size, "%s: %a is too far out from %.17g", names[e], end,
                         mpq_get_d(truth->contact[e]));
    }
    const char *fault =
        good && truth->rounded ? rounded_contact_fault(pair, answer->contact) : NULL;
    mpq_clear(duration);
    return fault ? wrong(why, size, "%s", fault) : good;
}

/* scale: the size of the pair. */
static bool box_end_agrees(const char *name, double end, int sign, const mpq_t exact,
                           const mpq_t scale, enum oracle_limit limit, char *why, size_t size)
{
    const int beyond = beyond_doubles(exact);
    if (beyond != 0)
        return end == beyond * HUGE_VAL ||
               wrong(why, size, "%s: %a, and the true one is beyond the doubles", name, end);
    if (!end_agrees(name, end, sign, exact, why, size))
        return false;
    if (isinf(end))
        return wrong(why, size, "%s: infinite, and the true one is not", name);
    return is_tightest(end, sign, exact) ||
           (limit == ORACLE_DESIGN && is_close(end, exact, scale)) ||
           wrong(why, size, "%s: %a is too far out from %.17g", name, end, mpq_get_d(exact));
}

static bool box_agrees(const struct oracle_answer *truth, const struct pair *pair,
                       const struct fmb_answer *answer, enum oracle_limit limit, char *why,
                       size_t size)
{
    static const char *const names[2][FMB_DIM_MAX] = {{"lower x", "lower y", "lower z"},
                                                      {"upper x", "upper y", "upper z"}};
    const int dim = pair->a.body->dim;
    mpq_t scale;
    mpq_init(scale);
    world_size(pair, scale);
    bool good = true;
    for (int e = 0; e < 2 && good; e++)
        for (int axis = 0; axis < FMB_DIM_MAX && good; axis++) {
            const double end = answer->box[e][axis];
            const char *name = names[e][axis];
            if (isnan(end) || (end == 0 && signbit(end)))
                good = wrong(why, size, "%s: -0, or not a number", name);
            else if (axis < dim && !truth->rounded)
                good = box_end_agrees(name, end, e == 0 ? -1 : +1, truth->box[e][axis], scale,
                                      limit, why, size);
            else if (axis >= dim && end != 0)
                good = wrong(why, size, "%s: %a, and there is no such axis", name, end);
        }
    const char *fault =
        good && truth->rounded ? rounded_box_fault(pair, answer->contact, answer->box) : NULL;
    mpq_clear(scale);
    return fault ? wrong(why, size, "%s", fault) : good;
}

bool oracle_agrees(const struct oracle_answer *truth, const struct pair *pair,
                   const struct fmb_answer *answer, enum oracle_limit limit, char *why, size_t size)
{
    if (answer->verdict != truth->verdict)
        return wrong(why, size, "verdict: %d, the true one is %d", answer->verdict, truth->verdict);
    if (answer->has_contact != truth->has_contact)
        return wrong(why, size, "contact interval: there should be %s",
                     truth->has_contact ? "one" : "none");
    if (answer->has_box != truth->has_box)
        return wrong(why, size, "box: there should be %s", truth->has_box ? "one" : "none");
    if (truth->has_contact && !contact_agrees(truth, pair, answer, limit, why, size))
        return false;
    if (truth->has_box && !box_agrees(truth, pair, answer, limit, why, size))
        return false;
    const char *fault =
        answer->has_point ? rounded_point_fault(pair, truth->verdict, answer->point) : NULL;
    return !fault || wrong(why, size, "%s", fault);
}

static bool check(const struct pair *pair, unsigned want, const struct fmb_answer *answer,
                  enum oracle_limit limit, char *why, size_t size)
{
    struct oracle_answer truth;
    oracle_init(&truth);
    oracle_decide(pair, want, &truth);
    bool good = oracle_agrees(&truth, pair, answer, limit, why, size);
    oracle_clear(&truth);
    return good;
}

bool oracle_check(const struct pair *pair, unsigned want, const struct fmb_answer *answer,
                  char *why, size_t size)
{
    return check(pair, want, answer, ORACLE_DESIGN, why, size);
}

bool oracle_check_tightest(const struct pair *pair, unsigned want, const struct fmb_answer *answer,
                           char *why, size_t size)
{
    return check(pair, want, answer, ORACLE_TIGHTEST, why, size);
}

/* ---- How far off is an answer? ---- */

/* (end - exact) / scale, rounded; 0/0 is 0. An end that is infinite is right where the true one is
 * beyond the doubles. */
static double relative_error(double end, const mpq_t exact, const mpq_t scale)
{
    const int beyond = beyond_doubles(exact);
    if (beyond != 0)
        return end == beyond * HUGE_VAL ? 0 : -beyond * HUGE_VAL;
    if (isinf(end))
        return end;
    mpq_t error;
    mpq_init(error);
    mpq_set_d(error, end);
    mpq_sub(error, error, exact);
    double relative = mpq_sgn(error) == 0 ? 0 : mpq_sgn(error) * HUGE_VAL;
    if (mpq_sgn(scale) != 0) {
        mpq_div(error, error, scale);
        relative = mpq_get_d(error);
    }
    mpq_clear(error);
    return relative;
}

/* sign as for contains(). */
static void measure_end(double end, int sign, const mpq_t exact, const mpq_t scale,
                        struct oracle_excess *excess)
{
    excess->has = true;
    if (isnan(end) || !contains(end, sign, exact))
        excess->misses = true;
    if (isnan(end)) {
        excess->in = HUGE_VAL;
        return;
    }
    double out = sign * relative_error(end, exact, scale);
    excess->out = fmax(excess->out, out);
    excess->in = fmax(excess->in, -out);
}

void oracle_measure(const struct oracle_answer *truth, const struct pair *pair,
                    const struct fmb_answer *answer, struct oracle_excess *contact,
                    struct oracle_excess *box)
{
    mpq_t scale;
    mpq_init(scale);
    *contact = *box = (struct oracle_excess){0};
    if (truth->has_contact && answer->has_contact && !truth->rounded) {
        mpq_set_d(scale, pair->duration);
        for (int e = 0; e < 2; e++)
            measure_end(answer->contact[e], e == 0 ? -1 : +1, truth->contact[e], scale, contact);
    }
    if (truth->has_box && answer->has_box && !truth->rounded) {
        world_size(pair, scale);
        for (int e = 0; e < 2; e++)
            for (int axis = 0; axis < pair->a.body->dim; axis++)
                measure_end(answer->box[e][axis], e == 0 ? -1 : +1, truth->box[e][axis], scale,
                            box);
    }
    mpq_clear(scale);
}
