/* Families of exact contacts, and of what is close to one. */
#include "family.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* Tilts an exact contact, carries it off and scales it, exactly: at most 20 bits are added to its
 * numbers' 30. */
static void settle(struct draw *draw, struct meeting *meeting)
{
    double by[FMB_DIM_MAX] = {0};
    if (draw_coin(draw))
        meeting_tilt(draw, meeting);
    const double far = ldexp(1, draw_int(draw, 0, 30));
    for (int axis = 0; axis < meeting->question.a.dim; axis++)
        by[axis] = far * draw_int(draw, -9, 9);
    meeting_carry(meeting, by);
    meeting_scale(meeting, ldexp(1, draw_int(draw, -20, 20)));
}

/* ---- Touching ---- */

void touching(struct draw *draw, const struct family *family, const struct cell *cell,
              struct question *out)
{
    struct meeting meeting = meet_exactly(draw, cell, family->features, meeting_draw_most(draw), 1);
    settle(draw, &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

static void touch_and_move(struct draw *draw, const struct cell *cell, struct features features,
                           enum motion motion, struct question *out)
{
    struct meeting meeting = meet_exactly(draw, cell, features, meeting_draw_most(draw), 1);
    settle(draw, &meeting);
    meeting_move(draw, &meeting, motion);
    *out = meeting.question;
}

void sliding(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    (void) family;
    struct features features;
    do
        features = meeting_draw_features(draw, cell->dim);
    while (features.one < cell->dim - 1);
    touch_and_move(draw, cell, features, MOTION_ALONG, out);
}

void grazing(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    (void) family;
    struct features features = {cell->dim == 3 && draw_coin(draw), 0, false};
    touch_and_move(draw, cell, features, MOTION_ALONG, out);
}

void arriving(struct draw *draw, const struct family *family, const struct cell *cell,
              struct question *out)
{
    (void) family;
    touch_and_move(draw, cell, meeting_draw_features(draw, cell->dim), MOTION_ARRIVING, out);
}

void leaving(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    (void) family;
    touch_and_move(draw, cell, meeting_draw_features(draw, cell->dim), MOTION_LEAVING, out);
}

/* ---- Nearly touching ---- */

/* An exact contact far from B's origin or at it, or one of rounded numbers. */
static struct meeting meet_somehow(struct draw *draw, const struct cell *cell)
{
    struct meeting meeting;
    int how = draw_int(draw, 0, 2);
    if (how == 0)
        return meet_nearly(draw, cell, 100);
    meeting = meet_anyhow(draw, cell);
    if (draw_coin(draw))
        meeting_tilt(draw, &meeting);
    if (how == 1)
        meeting_carry_home(&meeting);
    return meeting;
}

/* 1e-3 to 1e-16. Not by pow(), whose last bit is the machine's. */
static double draw_little(struct draw *draw)
{
    static const double little[] = {1e-3,  1e-4,  1e-5,  1e-6,  1e-7,  1e-8,  1e-9,
                                    1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16};
    return little[draw_int(draw, 0, COUNT(little) - 1)];
}

/* Leaves it touching, or moves it apart or together by ulps or a little of the size. */
static void disturb(struct draw *draw, double size, struct meeting *meeting)
{
    const int sign = draw_coin(draw) ? 1 : -1, ulps = draw_int(draw, 1, 3);
    const double little = draw_little(draw);
    switch (draw_int(draw, 0, 3)) {
    case 0: break;
    case 1: meeting_nudge(draw, meeting, sign * ulps); break;
    default: meeting_part(meeting, sign * little * size); break;
    }
}

void apart(struct draw *draw, const struct family *family, const struct cell *cell,
           struct question *out)
{
    struct meeting meeting = meet_somehow(draw, cell);
    meeting_part(&meeting, family->amount * meeting_size(&meeting));
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

void ulps_apart(struct draw *draw, const struct family *family, const struct cell *cell,
                struct question *out)
{
    struct meeting meeting = meet_anyhow(draw, cell);
    settle(draw, &meeting);
    meeting_nudge(draw, &meeting, (int) family->amount * draw_int(draw, 1, 3));
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

/* The overlap is so small that the last contact comes soon, or lasts for the window. */
void receding(struct draw *draw, const struct family *family, const struct cell *cell,
              struct question *out)
{
    (void) family;
    struct meeting meeting = meet_somehow(draw, cell);
    meeting_part(&meeting, -draw_little(draw) * meeting_size(&meeting));
    meeting_move(draw, &meeting, MOTION_LEAVING);
    *out = meeting.question;
}

void zero_window(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    (void) family;
    (void) cell;
    struct meeting meeting = meet_somehow(draw, cell);
    disturb(draw, meeting_size(&meeting), &meeting);
    meeting_move(draw, &meeting, MOTION_LEAVING); /* at t = 0, as they were */
    meeting.question.duration = draw_coin(draw) ? 0.0 : -0.0;
    *out = meeting.question;
}

/* ---- Thin ---- */

/* Both stretched alike: the contact stays exact. */
static struct meeting stretched(struct draw *draw, const struct cell *cell, double aspect, int axes)
{
    struct meeting meeting = meet_exactly(draw, cell, meeting_draw_features(draw, cell->dim), 3, 1);
    const int first = draw_int(draw, 0, cell->dim - 1);
    for (int n = 0; n < axes && n < cell->dim - 1; n++)
        meeting_stretch(&meeting, (first + n) % cell->dim, aspect);
    meeting_tilt(draw, &meeting);
    return meeting;
}

/* Components that nearly depend on the first ones, so many of which are independent. */
static void thin_out(struct draw *draw, struct solid *solid, double aspect, int long_ones)
{
    const bool leaning = draw_coin(draw);
    for (int i = long_ones; i < solid->dim; i++) {
        double along = leaning ? draw_uniform(draw, -1, 1) : 0;
        for (int axis = 0; axis < solid->dim; axis++)
            solid->component[i][axis] = along * solid->component[i - long_ones][axis] +
                                        draw_uniform(draw, -100, 100) / aspect;
    }
}

void slivers(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    const int axes = family->features.one < cell->dim ? family->features.one : cell->dim - 1;
    struct meeting meeting;
    if (draw_coin(draw)) {
        meeting = stretched(draw, cell, family->amount, axes);
    } else {
        meeting = meet_nearly(draw, cell, 100);
        int who = draw_int(draw, 1, 3);
        if (who & 1)
            thin_out(draw, &meeting.question.a, family->amount, axes);
        if (who & 2)
            thin_out(draw, &meeting.question.b, family->amount, axes);
        meeting_bring_together(draw, &meeting);
    }
    const double size = meeting_size(&meeting);
    disturb(draw, draw_coin(draw) ? size : size / family->amount, &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

/* ---- Parallel but for a little ---- */

void parallel(struct draw *draw, const struct family *family, const struct cell *cell,
              struct question *out)
{
    struct meeting meeting = meet_exactly(draw, cell, family->features, meeting_draw_most(draw), 1);
    struct solid *b = &meeting.question.b;
    const double angle = ldexp(1, -draw_int(draw, 10, 52));
    settle(draw, &meeting);
    for (int i = 0; i < cell->dim; i++)
        for (int axis = 0; axis < cell->dim; axis++)
            b->component[i][axis] *= 1 + angle * draw_int(draw, -1, 1);
    disturb(draw, meeting_size(&meeting), &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

/* ---- Far out, small, large ---- */

void far_out(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    struct meeting meeting = meet_somehow(draw, cell);
    double by[FMB_DIM_MAX] = {0};
    const bool exactly = draw_coin(draw);
    for (int axis = 0; axis < cell->dim; axis++)
        by[axis] = family->amount * (exactly ? draw_int(draw, -3, 3) : draw_uniform(draw, -3, 3));
    meeting_carry(&meeting, by);
    disturb(draw, meeting_size(&meeting), &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

void of_size(struct draw *draw, const struct family *family, const struct cell *cell,
             struct question *out)
{
    struct meeting meeting = meet_exactly(draw, cell, meeting_draw_features(draw, cell->dim), 9, 1);
    if (draw_coin(draw))
        meeting_scale(&meeting, family->amount / 8);
    else
        meeting = meet_nearly(draw, cell, family->amount);
    disturb(draw, meeting_size(&meeting), &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

void of_two_sizes(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    struct meeting meeting =
        meet_exactly(draw, cell, meeting_draw_features(draw, cell->dim), 9, family->amount);
    if (draw_coin(draw))
        meeting_carry_home(&meeting);
    const double size = meeting_size(&meeting);
    disturb(draw, draw_coin(draw) ? size : size / family->amount, &meeting);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

/* ---- Hardly any relative velocity ---- */

/* Both have one velocity, not a nice one; B a little more, along the normal or nearly. */
void no_drift(struct draw *draw, const struct family *family, const struct cell *cell,
              struct question *out)
{
    struct meeting meeting = meet_somehow(draw, cell);
    struct question *question = &meeting.question;
    const double *n = meeting.normal;
    double length = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    if (!(length > 0))
        length = 1;
    if (draw_coin(draw))
        disturb(draw, meeting_size(&meeting), &meeting);
    else /* a gap or an overlap that the motion closes, or not */
        meeting_part(&meeting, family->amount * draw_uniform(draw, -2, 2));
    const double sign = draw_coin(draw) ? 1 : -1;
    for (int axis = 0; axis < cell->dim; axis++) {
        double both = draw_coin(draw) ? draw_uniform(draw, -100, 100) : 0;
        question->a.velocity[axis] = both;
        question->b.velocity[axis] = both + sign * family->amount * (n[axis] / length);
    }
    question->a.moving = question->b.moving = true;
    *out = *question;
}
