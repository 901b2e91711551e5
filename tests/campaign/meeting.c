#include "meeting.h"

#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* ---- Changes ---- */

/* Calls change for every vector of the question that is not a normal. */
static void each_vector(struct meeting *meeting,
                        void (*change)(double *vector, const void *context), const void *context)
{
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(&meeting->question, side);
        change(solid->origin, context);
        change(solid->velocity, context);
        for (int i = 0; i < solid_count(solid); i++)
            change(solid->component[i], context);
        change(meeting->along[side], context);
    }
}

struct shear {
    int axis, from;
    double times;
};

static void stretch_vector(double *vector, const void *context)
{
    const struct shear *shear = context;
    vector[shear->axis] *= shear->times;
}

static void shear_vector(double *vector, const void *context)
{
    const struct shear *shear = context;
    vector[shear->axis] += shear->times * vector[shear->from];
}

/* A normal takes the inverse, transposed: what it says of vectors in its plane stays true. */
void meeting_stretch(struct meeting *meeting, int axis, double factor)
{
    const struct shear stretch = {axis, axis, factor};
    each_vector(meeting, stretch_vector, &stretch);
    meeting->normal[axis] /= factor;
}

void meeting_shear(struct meeting *meeting, int axis, int from, double times)
{
    const struct shear shear = {axis, from, times};
    each_vector(meeting, shear_vector, &shear);
    meeting->normal[from] -= times * meeting->normal[axis];
}

void meeting_tilt(struct draw *draw, struct meeting *meeting)
{
    const int dim = meeting->question.a.dim;
    for (int n = 0; n < dim; n++) {
        int axis = draw_int(draw, 0, dim - 1), from = (axis + draw_int(draw, 1, dim - 1)) % dim;
        meeting_shear(meeting, axis, from, draw_int(draw, -2, 2));
    }
}

void meeting_scale(struct meeting *meeting, double factor)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        meeting_stretch(meeting, axis, factor);
        meeting->normal[axis] *= factor; /* any length will do */
    }
}

void meeting_carry(struct meeting *meeting, const double by[FMB_DIM_MAX])
{
    vector_add(meeting->question.a.origin, 1, by);
    vector_add(meeting->question.b.origin, 1, by);
}

void meeting_carry_home(struct meeting *meeting)
{
    const double *origin = meeting->question.b.origin;
    const double back[FMB_DIM_MAX] = {-origin[0], -origin[1], -origin[2]};
    meeting_carry(meeting, back);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        meeting->question.b.origin[axis] = 0;
}

double meeting_size(const struct meeting *meeting)
{
    double most = 0;
    for (int side = 0; side < 2; side++) {
        const struct solid *solid = side == 0 ? &meeting->question.a : &meeting->question.b;
        for (int i = 0; i < solid_count(solid); i++)
            for (int axis = 0; axis < solid->dim; axis++)
                most = fmax(most, fabs(solid->component[i][axis]));
    }
    return most;
}

static void part_along(struct solid *b, const double *normal, double distance)
{
    const double length = vector_length(normal);
    for (int axis = 0; axis < b->dim; axis++) {
        const double old = b->origin[axis], step = distance * (normal[axis] / length);
        double new = old + step;
        if (step > 0 ? new - old < step : new - old > step)
            new = nextafter(new, step > 0 ? HUGE_VAL : -HUGE_VAL);
        b->origin[axis] = new;
    }
}

void meeting_part(struct meeting *meeting, double distance)
{
    struct solid *b = &meeting->question.b;
    double centre_a[FMB_DIM_MAX], way[FMB_DIM_MAX];
    if (distance >= 0) {
        if (vector_length(meeting->normal) > 0)
            part_along(b, meeting->normal, distance);
        return;
    }
    solid_centre(&meeting->question.a, centre_a);
    solid_centre(b, way);
    vector_add(way, -1, centre_a);
    const double length = vector_length(way);
    if (length > 0)
        vector_add(b->origin, distance / length, way);
}

void meeting_nudge(struct draw *draw, struct meeting *meeting, int ulps)
{
    struct solid *b = &meeting->question.b;
    int axis = draw_int(draw, 0, b->dim - 1);
    for (int tries = 0; meeting->normal[axis] == 0 && tries < b->dim; tries++)
        axis = (axis + 1) % b->dim;
    const double toward = (ulps > 0) == (meeting->normal[axis] > 0) ? HUGE_VAL : -HUGE_VAL;
    for (int n = ulps > 0 ? ulps : -ulps; n > 0; n--)
        b->origin[axis] = nextafter(b->origin[axis], toward);
}

/* ---- Motion ---- */

/* An exact vector of the pair's own size that clearly leads away from the parting plane. */
static void draw_away(struct draw *draw, const struct meeting *meeting, double *out)
{
    const struct question *question = &meeting->question;
    const double length = vector_length(meeting->normal);
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    for (int tries = 0; tries < 50; tries++) {
        const struct solid *solid = draw_coin(draw) ? &question->a : &question->b;
        const double *component = solid->component[draw_int(draw, 0, solid_count(solid) - 1)];
        double way = vector_dot(meeting->normal, component);
        if (!(fabs(way) > 1e-6 * length * vector_length(component)))
            continue;
        vector_add(out, way > 0 ? 1 : -1, component);
        return;
    }
}

static void draw_relative(struct draw *draw, const struct meeting *meeting, enum motion motion,
                          double *out)
{
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    double away[FMB_DIM_MAX];
    draw_away(draw, meeting, away);
    int first = draw_int(draw, -2, 2), second = draw_int(draw, -2, 2);
    if (motion == MOTION_TOGETHER)
        return;
    vector_add(out, first ? first : second ? 0 : 1, meeting->along[0]);
    vector_add(out, second, meeting->along[1]);
    if (motion != MOTION_ALONG)
        vector_add(out, motion == MOTION_LEAVING ? 1 : -1, away);
}

void meeting_move(struct draw *draw, struct meeting *meeting, enum motion motion)
{
    static const double windows[] = {0.25, 0.5, 1, 1, 2, 4};
    struct question *question = &meeting->question;
    struct solid *a = &question->a, *b = &question->b;
    double relative[FMB_DIM_MAX];
    draw_relative(draw, meeting, motion, relative);
    question->duration = windows[draw_int(draw, 0, COUNT(windows) - 1)];
    double time = question->duration * draw_int(draw, 0, 2) / 2;
    if (motion == MOTION_ARRIVING)
        time = question->duration;
    if (motion == MOTION_LEAVING)
        time = 0;

    const bool drift = draw_coin(draw); /* of both; exact, as it is a component */
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        b->velocity[axis] = drift ? b->component[0][axis] : 0;
        a->velocity[axis] = b->velocity[axis] - relative[axis];
        a->origin[axis] += time * relative[axis];
    }
    a->moving = true;
    b->moving = drift || draw_coin(draw);
}

void meeting_move_anyhow(struct draw *draw, const struct cell *cell, struct meeting *meeting)
{
    enum motion motion = (enum motion) draw_int(draw, 0, MOTION_KINDS - 1);
    if (cell->moving)
        meeting_move(draw, meeting, motion);
}
