/* The campaign of turning bodies. It decides families of pairs by the default method and compares
 * the answers with the oracle, which shares no code with the engine. It also compares them with the
 * static oracle at some times, because the oracle leaves rounded shapes and hulls of many vertices
 * open. */
#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign_options.h"
#include "gap_check.h"
#include "memory.h"
#include "oracle.h"
#include "trial.h"
#include "turn_family.h"
#include "turning.h"
#include "workers.h"
#include "world.h"

enum { ALL = FMB_WANT_TIMES | FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT, LOOKS = 8, WHY = 120 };

static const long usual_pairs = 1000;

static const struct option option_list[] = {{"pairs", required_argument, NULL, OPTION_PAIRS},
                                            {"family", required_argument, NULL, OPTION_FAMILY},
                                            {"seed", required_argument, NULL, OPTION_SEED},
                                            {"workers", required_argument, NULL, OPTION_WORKERS},
                                            {"help", no_argument, NULL, OPTION_HELP},
                                            {NULL, 0, NULL, 0}};

static void help(void)
{
    printf(
        "usage: turning [OPTIONS]\n"
        "\n"
        "Draws pairs in which at least one body turns within the window, and counts the wrong\n"
        "answers of the engine. The oracle shares no code with the engine.\n"
        "\n"
        "  --pairs N      pairs of each family, in 3D and in 2D (%ld)\n"
        "  --family NAME  this family; if NAME ends with a dash, all families whose names begin\n"
        "                 with it; may be repeated (all)\n"
        "  --seed S       seed of the random numbers\n"
        "  --workers N    threads (one a processor); the counts do not depend on it\n"
        "  --help\n"
        "\n"
        "Exit codes: 0 no answer was wrong, 1 an answer was wrong, 2 wrong usage.\n"
        "\n"
        "Families:\n",
        usual_pairs);
    for (size_t i = 0; family_turning_at(i); i++)
        printf("  %-20s  %s\n", family_turning_at(i)->name, family_turning_at(i)->summary);
}

/* The counts of a family in one dimension. */
struct count {
    const struct family *family;
    struct cell cell;
    long pairs, truth[FMB_OVERLAPPING + 1], open, undecided, wrong;
    long lacking;                  /* decided, without gap or box */
    long wide;                     /* decided, with a gap wider than the usual bound */
    double contact_most, gap_most; /* largest error of an end, and width, each over its bound */
    double seconds[2];             /* of the engine, of the oracle */
    struct question question;      /* the first with a wrong answer */
    char why[WHY];
};

static double seconds_spent(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double) now.tv_sec + 1e-9 * (double) now.tv_nsec;
}

/* ---- One answer ---- */

/* out := a time in seconds as a share of the window. */
static void share_of(double time, double duration, mpq_t out)
{
    mpq_t window;
    mpq_init(window);
    mpq_set_d(out, time);
    mpq_set_d(window, duration);
    mpq_div(out, out, window);
    mpq_clear(window);
}

/* The largest coordinate at nine times; if upper, an upper bound of it over the window. */
static double size_of(const struct pair *pair, bool upper)
{
    struct pair moment = *pair;
    mpq_t at, size;
    double most = 0;
    mpq_inits(at, size, NULL);
    moment.at = at;
    for (unsigned long i = 0; i <= 64; i += 8) {
        mpq_set_ui(at, i, 64);
        mpq_canonicalize(at);
        world_size(&moment, size);
        most = fmax(most, mpq_get_d(size));
    }
    mpq_clears(at, size, NULL);
    if (!upper)
        return most;
    double reach = 0;
    for (int axis = 0; axis < pair->a.body->dim; axis++) {
        reach = fmax(reach, fmax(fabs(pair->a.position[axis]), fabs(pair->a.end_position[axis])) +
                                pair->a.body->reach);
        reach = fmax(reach, fmax(fabs(pair->b.position[axis]), fabs(pair->b.end_position[axis])) +
                                pair->b.body->reach);
    }
    return reach;
}

/* The sign of the gap of the bodies at a time minus the bound. Where the bodies are apart, a
 * relative difference up to 1e-14 counts as 0. */
static int compare_gap(const struct pair *moment, double bound)
{
    int least = 1;
    mpq_t square, limit;
    mpq_inits(square, limit, NULL);
    for (unsigned k = 0; k < moment->a.body->frame_count * moment->b.body->frame_count; k++) {
        struct world world;
        world_init(&world, moment, k / moment->b.body->frame_count,
                   k % moment->b.body->frame_count);
        difference_nearest(&world.difference, square, NULL);
        world_length(&world, fmax(-DBL_MAX, fmin(bound, DBL_MAX)), limit);
        mpq_add(limit, limit, world.radius);
        int sign;
        if (mpq_sgn(square) == 0) {
            sign = difference_compare_facets(&world.difference, limit);
        } else {
            mpq_div(square, square, world.scale);
            mpq_div(square, square, world.scale);
            mpq_div(limit, limit, world.scale);
            const double distance = sqrt(mpq_get_d(square)), other = mpq_get_d(limit);
            const double slack = 1e-14 * (distance + fabs(other));
            sign = (distance > other + slack) - (distance < other - slack);
        }
        least = sign < least ? sign : least;
        world_clear(&world);
    }
    mpq_clears(square, limit, NULL);
    return least;
}

static double gap_of_moment(const struct trial *trial, double share)
{
    const struct pair *pair = &trial->pair[0];
    struct fmb_placement at[2];
    struct fmb_answer answer;
    fmb_pose_at(&pair->a, pair->duration, fmin(share, 1) * pair->duration, &at[0]);
    fmb_pose_at(&pair->b, pair->duration, fmin(share, 1) * pair->duration, &at[1]);
    return fmb_decide(fmb_method_default(), &at[0], &at[1], 0, FMB_WANT_GAP, &answer) == FMB_OK
               ? answer.gap.bounds[0]
               : HUGE_VAL;
}

/* Narrows the interval around the least of five gaps until its length is at most 2^-48. Returns the
 * time of the least gap. */
static double close_in(const struct trial *trial, double from, double to)
{
    double found = from;
    while (to - from > 0x1p-48) {
        const double step = (to - from) / 4, start = from;
        double least = HUGE_VAL;
        for (int i = 0; i <= 4; i++) {
            const double gap = gap_of_moment(trial, start + i * step);
            found = gap < least ? start + i * step : found;
            least = fmin(least, gap);
        }
        from = fmax(start, found - step);
        to = fmin(to, found + step);
    }
    return found;
}

/* Estimates the time of the least gap within a part of the window, from static answers of the
 * engine at rounded poses. The estimate need not be right: it only chooses a time to check. */
static double seek_least(const struct trial *trial, double from, double to)
{
    enum { STEPS = 128 };
    double gap[STEPS + 1], best = 0, least = HUGE_VAL;
    const double step = (to - from) / STEPS;
    for (int i = 0; i <= STEPS; i++)
        gap[i] = gap_of_moment(trial, from + i * step);
    for (int i = 0; i <= STEPS; i++) {
        const int before = i ? i - 1 : 0, after = i < STEPS ? i + 1 : STEPS;
        if (gap[i] > gap[before] || gap[i] > gap[after])
            continue;
        const double found = close_in(trial, from + before * step, from + after * step);
        const double one = gap_of_moment(trial, found);
        best = one < least ? found : best;
        least = fmin(least, one);
    }
    return best;
}

/* Whether the point is within the limit of both bodies at its time. */
static bool is_common(const struct pair *pair, const double point[1 + FMB_DIM_MAX], double limit)
{
    struct pair moment = *pair;
    mpq_t at, square, none;
    double least = HUGE_VAL;
    mpq_inits(at, square, none, NULL);
    share_of(point[0], pair->duration, at);
    moment.at = at;
    for (unsigned k = 0; k < pair->a.body->frame_count * pair->b.body->frame_count; k++) {
        struct world world;
        rational_vector exact;
        double far = 0;
        rational_vector_init(exact);
        world_init(&world, &moment, k / pair->b.body->frame_count, k % pair->b.body->frame_count);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            world_length(&world, point[1 + axis], exact[axis]);
        for (int side = 0; side < 2; side++) {
            world_from_core(&world, side, none, exact, square, NULL);
            mpq_div(square, square, world.scale);
            mpq_div(square, square, world.scale);
            mpq_div(world.solid[side].radius, world.solid[side].radius, world.scale);
            far = fmax(far, sqrt(mpq_get_d(square)) - mpq_get_d(world.solid[side].radius));
        }
        least = fmin(least, far);
        world_clear(&world);
        rational_vector_clear(exact);
    }
    mpq_clears(at, square, none, NULL);
    return least <= limit;
}

/* Returns the fault of a contact, or NULL. Raises *most to the largest error of an end, over the
 * promised bound. */
static const char *contact_fault(const struct pair *pair, struct turning_truth *truth,
                                 const double contact[2], double *most)
{
    const double T = pair->duration;
    const char *fault = NULL;
    mpq_t time, out;
    if (!(contact[0] >= 0 && contact[0] <= contact[1] && contact[1] <= T))
        return "the contact is not within the window";
    mpq_inits(time, out, NULL);
    for (int end = 0; end < 2 && !fault; end++) {
        mpq_t *const far = end == 0 ? &truth->first[0] : &truth->last[1];
        mpq_t *const sure = end == 0 ? &truth->first[1] : &truth->last[0];
        const int sign = end == 0 ? 1 : -1;
        share_of(contact[end], T, time);
        if (sign * mpq_cmp(time, *sure) > 0)
            fault = end == 0 ? "they meet before the contact" : "they meet after the contact";
        mpq_sub(out, *far, time);
        const double excess = sign * mpq_get_d(out) / 1e-12;
        share_of(nextafter(contact[end], end == 0 ? T : 0), T, time);
        if (!truth->whole || excess <= 0 || sign * mpq_cmp(time, *far) >= 0)
            continue; /* the next double would be too far in */
        *most = fmax(*most, excess);
        if (excess > 1)
            fault = end == 0 ? "first contact: too far out" : "last contact: too far out";
    }
    mpq_clears(time, out, NULL);
    return fault;
}

/* Returns the fault of a gap, or NULL. Counts a gap that is wider than the usual bound as wide;
 * raises gap_most to the width of any other gap, divided by this bound. */
static const char *gap_fault(const struct pair *pair, enum fmb_verdict verdict,
                             const struct fmb_gap *gap, struct count *count)
{
    struct pair moment = *pair;
    const char *fault = NULL;
    mpq_t at;
    if (!(gap->bounds[0] <= gap->bounds[1]) || !(gap->time >= 0 && gap->time <= pair->duration))
        return "gap: bounds or time";
    if (verdict == FMB_TOUCHING && (gap->bounds[0] != 0 || gap->bounds[1] != 0))
        return "gap: not 0 for a touching pair";
    const double limit = 1e-12 * size_of(pair, false) + 32 * 0x1p-1074;
    const double relative =
        (fmin(gap->bounds[1], DBL_MAX) - fmax(gap->bounds[0], -DBL_MAX)) / limit;
    if (relative > 1 && relative > 1e-12 * size_of(pair, true) / limit)
        count->wide++;
    else
        count->gap_most = fmax(count->gap_most, relative);
    mpq_init(at);
    share_of(gap->time, pair->duration, at);
    moment.at = at;
    if (verdict != FMB_TOUCHING && !gap_check_lower(&moment, gap->frame[0], gap->frame[1], gap))
        fault = "gap: the direction does not prove the lower bound at its time";
    else if (verdict == FMB_SEPARATED &&
             !gap_check_upper(&moment, gap->frame[0], gap->frame[1], gap))
        fault = "gap: the upper bound is not proven at its time";
    mpq_clear(at);
    return fault;
}

static const char *box_fault(const struct pair *moment, const double box[2][FMB_DIM_MAX])
{
    struct oracle_answer truth;
    const char *fault = NULL;
    mpq_t end;
    mpq_init(end);
    oracle_init(&truth);
    oracle_decide(moment, FMB_WANT_BOX, &truth);
    for (int i = 0; i < 2 && truth.has_box && !truth.rounded; i++)
        for (int axis = 0; axis < moment->a.body->dim; axis++) {
            if (!isfinite(box[i][axis]))
                continue;
            mpq_set_d(end, box[i][axis]);
            if ((i ? -1 : 1) * mpq_cmp(end, truth.box[i][axis]) > 0)
                fault = "the box does not contain the intersection";
        }
    oracle_clear(&truth);
    mpq_clear(end);
    return fault;
}

/* Compares the answer with the static oracle at some times. */
static const char *look(struct draw *draw, const struct trial *trial,
                        const struct fmb_answer *answer, struct turning_truth *truth)
{
    const struct pair *pair = &trial->pair[0];
    const bool deep = answer->has_gap && answer->verdict == FMB_OVERLAPPING;
    const double T = pair->duration;
    const double least = !answer->has_gap ? 0
                         : deep ? seek_least(trial, answer->contact[0] / T, answer->contact[1] / T)
                                : seek_least(trial, 0, 1);
    struct pair moment = *pair;
    /* The static oracle samples the facets of large hulls, so that their depth is not certain. */
    const bool large = fmb_body_frame(pair->a.body, 0)->vertex_count > 20 ||
                       fmb_body_frame(pair->b.body, 0)->vertex_count > 20;
    const char *fault = NULL;
    mpq_t at;
    mpq_init(at);
    moment.at = at;
    for (int i = 0; i < LOOKS && !fault; i++) {
        mpq_set_si(at, draw_int(draw, 0, 1024), 1024);
        mpq_canonicalize(at);
        if (i < 2)
            mpq_set_si(at, i, 1);
        else if (i < 5 && answer->has_contact)
            share_of(i == 2   ? answer->contact[0]
                     : i == 3 ? answer->contact[1]
                              : (answer->contact[0] + answer->contact[1]) / 2,
                     pair->duration, at);
        else if (i == 2 && answer->has_gap)
            share_of(answer->gap.time, pair->duration, at);
        else if (i == 5)
            mpq_set_d(at, least);
        else if (deep && i == 6)
            share_of(answer->gap.time, T, at);
        struct turning_truth one;
        turning_init(&one);
        const enum fmb_verdict verdict = turning_look(pair, at, truth->whole ? &one : truth);
        turning_clear(&one);
        if (truth->whole && (verdict > truth->most ||
                             (verdict != FMB_SEPARATED && (mpq_cmp(at, truth->first[0]) < 0 ||
                                                           mpq_cmp(at, truth->last[1]) > 0))))
            fault = "the oracles contradict each other";
        if (verdict > answer->verdict)
            fault = "a stronger verdict at some time";
        if (answer->has_gap && !fault && !(large && verdict == FMB_OVERLAPPING) &&
            compare_gap(&moment, answer->gap.bounds[0]) < 0 && answer->verdict != FMB_TOUCHING)
            fault = "a smaller gap at some time";
        /* The time is rounded, so that the depth may be less by 1e-12 of the size. */
        if (deep && i == 6 && !large && !fault &&
            compare_gap(&moment, answer->gap.bounds[1] + 1e-12 * size_of(pair, true)) > 0)
            fault = "gap: they are not as deep at its time";
        if (answer->has_box && verdict != FMB_SEPARATED && !large && !fault)
            fault = box_fault(&moment, answer->box);
    }
    mpq_clear(at);
    return fault;
}

static bool has_nan(const double *number, int count)
{
    bool has = false;
    for (int i = 0; i < count; i++)
        has = has || isnan(number[i]);
    return has;
}

static const char *answer_fault(struct draw *draw, struct count *count, const struct trial *trial,
                                const struct fmb_answer *answer, struct turning_truth *truth)
{
    const struct pair *const pair = &trial->pair[0];
    const struct fmb_gap *const gap = &answer->gap;
    if (has_nan(answer->contact, 2) || has_nan(answer->point, 1 + FMB_DIM_MAX) ||
        has_nan(gap->bounds, 2) || has_nan(gap->direction, FMB_DIM_MAX) ||
        has_nan(gap->witness[0], 2 * FMB_DIM_MAX) || isnan(gap->time))
        return "a number is NaN";
    const char *fault = look(draw, trial, answer, truth);
    if (fault)
        return fault;
    if (answer->verdict < truth->least)
        return "the verdict is too weak";
    if (answer->verdict > truth->most)
        return "the verdict is too strong";
    if (answer->has_contact != (answer->verdict != FMB_SEPARATED) ||
        answer->has_point != answer->has_contact || (answer->has_box && !answer->has_contact))
        return "a part is missing or unexpected";
    count->lacking += !answer->has_gap || answer->has_box != answer->has_contact ||
                      (answer->has_box && has_nan(answer->box[0], pair->a.body->dim));
    if (answer->has_contact &&
        (fault = contact_fault(pair, truth, answer->contact, &count->contact_most)))
        return fault;
    if (answer->has_gap && (fault = gap_fault(pair, answer->verdict, &answer->gap, count)))
        return fault;
    if (answer->has_point &&
        !is_common(pair, answer->point, 8e-12 * size_of(pair, true) + 32 * 0x1p-1074))
        return "the point is not common";
    return NULL;
}

/* ---- Equivalent questions ---- */

static struct reply ask(const struct question *question)
{
    struct trial trial;
    trial_begin(question, &trial);
    const struct reply reply = trial_decide(&trial, fmb_method_default(), 0, FMB_WANT_TIMES);
    trial_end(&trial);
    return reply;
}

/* Turns the world by 180 degrees about its first axis, in 2D about the origin. Nothing rounds. */
static void turn_world(struct solid *solid)
{
    const int dim = solid->dim;
    if (solid->orientation_count == 0)
        solid->orientation[0] = solid->end_orientation[0] = 1;
    solid->orientation_count = dim == 2 ? 2 : 4;
    for (int end = 0; end < 2; end++) {
        double *const p = end ? solid->end_origin : solid->origin;
        double *const q = end ? solid->end_orientation : solid->orientation;
        const double was[4] = {q[0], q[1], q[2], q[3]};
        for (int axis = dim == 2 ? 0 : 1; axis < dim; axis++)
            p[axis] = 0 - p[axis];
        memcpy(
            q,
            dim == 2 ? (double[4]){-was[1], was[0]} : (double[4]){-was[1], was[0], -was[3], was[2]},
            sizeof was);
    }
    if (!solid->ending)
        memset(solid->end_orientation, 0, sizeof solid->end_orientation);
}

/* out := (x + y) * scale. Returns whether nothing rounds. */
static bool halve(double x, double y, double scale, double *out)
{
    const double sum = x + y;
    *out = sum * scale;
    return sum - x == y && sum - y == x && *out / scale == sum;
}

/* Keeps the first or the second half of the window. Returns whether nothing rounds. */
static bool take_half(int which, struct solid *solid)
{
    double dot = 0, middle[2][4] = {{0}};
    bool exact = true;
    if (!solid->ending)
        return true;
    for (int i = 0; i < solid->orientation_count; i++)
        dot += solid->orientation[i] * solid->end_orientation[i];
    for (int axis = 0; axis < solid->dim; axis++)
        exact = halve(solid->origin[axis], solid->end_origin[axis], 0.5, &middle[0][axis]) && exact;
    for (int i = 0; i < solid->orientation_count; i++)
        exact = halve(solid->orientation[i], (dot < 0 ? -1 : 1) * solid->end_orientation[i], 0.5,
                      &middle[1][i]) &&
                exact;
    memcpy(which ? solid->origin : solid->end_origin, middle[0], sizeof solid->origin);
    memcpy(which ? solid->orientation : solid->end_orientation, middle[1], sizeof middle[1]);
    return exact;
}

/* Replaces an end by a velocity. Returns whether the end does not turn and nothing rounds. */
static bool take_velocity(double duration, struct solid *solid)
{
    int exponent;
    bool exact = frexp(duration, &exponent) == 0.5;
    for (int i = 0; i < solid->orientation_count && solid->ending; i++)
        exact = exact && solid->orientation[i] == solid->end_orientation[i];
    for (int axis = 0; axis < solid->dim && solid->ending; axis++)
        exact = halve(solid->end_origin[axis], -solid->origin[axis], 1 / duration,
                      &solid->velocity[axis]) &&
                exact;
    solid->moving = solid->ending;
    solid->ending = false;
    return exact;
}

static const char *other_ways_fault(const struct question *question,
                                    const struct fmb_answer *answer)
{
    const double T = question->duration, close = 2e-12 * T + 0x1p-1070;
    struct question other = question_reversed(question);
    struct reply reply = ask(&other);
    if (reply.status == FMB_OK && reply.answer.verdict != answer->verdict)
        return "another verdict with time reversed";
    if (reply.status == FMB_OK && answer->has_contact &&
        !(fabs(reply.answer.contact[0] - (T - answer->contact[1])) <= close &&
          fabs(reply.answer.contact[1] - (T - answer->contact[0])) <= close))
        return "another contact with time reversed";
    other = *question;
    turn_world(&other.a), turn_world(&other.b);
    reply = ask(&other);
    if (reply.status == FMB_OK && reply.answer.verdict != answer->verdict)
        return "another verdict after half a turn of the world";
    other = *question;
    if (take_velocity(T, &other.a) && take_velocity(T, &other.b)) {
        reply = ask(&other);
        if (reply.status != FMB_OK || reply.answer.verdict != answer->verdict ||
            (answer->has_contact &&
             !(fabs(reply.answer.contact[0] - answer->contact[0]) <= close / 2 &&
               fabs(reply.answer.contact[1] - answer->contact[1]) <= close / 2)))
            return "another verdict or contact as a velocity";
    }
    enum fmb_verdict strongest = FMB_SEPARATED;
    bool decided = T / 2 * 2 == T;
    for (int half = 0; half < 2 && decided; half++) {
        other = *question;
        other.duration = T / 2;
        const bool exact[2] = {take_half(half, &other.a), take_half(half, &other.b)};
        decided = exact[0] && exact[1];
        if (!decided)
            break;
        reply = ask(&other);
        decided = reply.status == FMB_OK;
        if (decided && reply.answer.verdict > strongest)
            strongest = reply.answer.verdict;
    }
    return decided && strongest != answer->verdict ? "another verdict of the two halves" : NULL;
}

static const char *order_fault(const struct question *question, const struct reply reply[2])
{
    const struct fmb_answer *x = &reply[0].answer, *y = &reply[1].answer;
    if (!reply_same(&reply[0], &reply[1]))
        return "another answer in the other order";
    if (reply[0].status == FMB_OK &&
        !gap_check_swapped(question_is_symmetric(question), &x->gap, &y->gap))
        return "another gap in the other order";
    if (reply[0].status == FMB_OK && memcmp(x->point, y->point, sizeof x->point) != 0)
        return "another point in the other order";
    return NULL;
}

static void judge(struct count *count, struct draw *draw, const struct question *question)
{
    struct trial trial;
    struct reply reply[2], verdict;
    struct turning_truth truth;
    const char *fault = NULL;
    trial_begin(question, &trial);
    double start = seconds_spent();
    verdict = trial_decide(&trial, fmb_method_default(), 0, FMB_WANT_TIMES);
    count->seconds[0] += seconds_spent() - start;
    for (int order = 0; order < 2; order++)
        reply[order] = trial_decide(&trial, fmb_method_default(), order, ALL);
    start = seconds_spent();
    turning_init(&truth);
    turning_decide(&trial.pair[0], &truth);
    count->seconds[1] += seconds_spent() - start;
    count->pairs++;
    const bool known = truth.least == truth.most;
    count->truth[truth.least] += known;
    count->open += !known;
    if (known && count->family->verdict && (int) truth.least != count->family->verdict)
        fault = "not the verdict of the family";
    else if ((fault = order_fault(question, reply)))
        ;
    else if (reply[0].status != FMB_OK && reply[0].status != FMB_CANNOT_DECIDE)
        fault = fmb_status_text(reply[0].status);
    else if (verdict.status != reply[0].status)
        fault = "another status with gap, box and point";
    else if (verdict.status == FMB_OK && !(verdict.answer.verdict == reply[0].answer.verdict &&
                                           memcmp(verdict.answer.contact, reply[0].answer.contact,
                                                  sizeof verdict.answer.contact) == 0))
        fault = "another verdict or contact with gap, box and point";
    else if (reply[0].status == FMB_OK &&
             !(fault = answer_fault(draw, count, &trial, &reply[0].answer, &truth)))
        fault = other_ways_fault(question, &reply[0].answer);
    else if (reply[0].status != FMB_OK) {
        count->undecided++;
        const struct fmb_answer any = {.verdict = FMB_OVERLAPPING};
        fault = look(draw, &trial, &any, &truth);
    }
    if (fault && count->wrong++ == 0) {
        count->question = *question;
        snprintf(count->why, sizeof count->why, "%s", fault);
    }
    turning_clear(&truth);
    trial_end(&trial);
}

/* ---- The campaign ---- */

struct campaign {
    const struct options *options;
    struct count *count;
    size_t counts;
};

static void run(void *context, size_t job)
{
    const struct campaign *campaign = context;
    struct count *count = &campaign->count[job];
    struct draw draw = cell_draw(campaign->options->seed, count->family->name, &count->cell, 0);
    struct draw looks = draw;
    for (long i = 0; i < campaign->options->pairs; i++) {
        struct question question;
        family_draw(count->family, &count->cell, &draw, &question);
        judge(count, &looks, &question);
    }
}

static void add(struct campaign *campaign, const struct family *family)
{
    for (int dim = 3; dim >= (family->cells & FAMILY_3D ? 3 : 2); dim--)
        campaign->count[campaign->counts++] =
            (struct count){.family = family, .cell = {dim, true, {FMB_CUBOID, FMB_CUBOID}}};
}

static void print_count(const struct count *count)
{
    const double pairs = (double) count->pairs;
    printf(
        "%-20s %dD %6ld %6ld %6ld %6ld %5ld | %5ld %6ld %6ld %6ld %8.2g %8.2g | %8.1f "
        "%8.1f\n",
        count->family->name, count->cell.dim, count->pairs, count->truth[1], count->truth[2],
        count->truth[3], count->open, count->wrong, count->undecided, count->lacking, count->wide,
        count->contact_most, count->gap_most, 1e6 * count->seconds[0] / pairs,
        1e3 * count->seconds[1] / pairs);
    if (count->wrong == 0)
        return;
    printf("# %s, first: %s\n", count->family->name, count->why);
    question_print(&count->question);
}

int main(int argc, char **argv)
{
    static const struct options_program program = {"turning", option_list, help, usual_pairs,
                                                   family_turning_at};
    struct options options;
    struct campaign campaign = {.options = &options};
    long wrong = 0, pairs = 0, undecided = 0;
    const int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    campaign.count = memory_get(2 * OPTIONS_FAMILIES_MAX * sizeof *campaign.count);
    for (size_t i = 0; options.families ? (int) i < options.families : family_turning_at(i) != NULL;
         i++)
        add(&campaign, options.families ? options.family[i] : family_turning_at(i));
    workers_do("turning", options.workers, campaign.counts, run, &campaign);
    printf("seed %" PRIu64
           "; wide: gaps wider than 1e-12; contact: largest error, over 1e-12; gap: largest "
           "width of the other gaps, over 1e-12; times: us of a "
           "verdict with contact, ms of the oracle\n"
           "%-20s    %6s %6s %6s %6s %5s | %5s %6s %6s %6s %8s %8s | %8s %8s\n",
           options.seed, "", "pairs", "apart", "touch", "over", "open", "wrong", "undec.", "lacks",
           "wide", "contact", "gap", "engine", "oracle");
    for (size_t i = 0; i < campaign.counts; i++) {
        print_count(&campaign.count[i]);
        wrong += campaign.count[i].wrong;
        pairs += campaign.count[i].pairs;
        undecided += campaign.count[i].undecided;
    }
    printf("%ld pairs, %ld wrong, %ld undecided\n", pairs, wrong, undecided);
    free(campaign.count);
    return wrong ? EXIT_FOUND : EXIT_NONE_WRONG;
}
