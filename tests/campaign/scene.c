/* Families of contacts as scenes have them: stacks, grids, a bullet and a plate. */
#include "family.h"

#include <math.h>
#include <string.h>

/* ---- Stacks ---- */

static void draw_direction(struct draw *draw, int dim, double *out)
{
    double square;
    do {
        square = 0;
        for (int axis = 0; axis < dim; axis++) {
            out[axis] = draw_uniform(draw, -1, 1);
            square += out[axis] * out[axis];
        }
    } while (square > 1 || square < 0.01);
    for (int axis = 0; axis < dim; axis++)
        out[axis] /= sqrt(square);
}

/* Components at right angles, but for rounding: a tilted box, edges from 1/2 to 4. */
static void draw_tilted(struct draw *draw, struct solid *solid)
{
    double axis_of[3][3] = {{0}}, any[3] = {0};
    draw_direction(draw, solid->dim, axis_of[0]);
    if (solid->dim == 2) {
        axis_of[1][0] = -axis_of[0][1];
        axis_of[1][1] = axis_of[0][0];
    } else {
        draw_direction(draw, 3, any);
        vector_cross(axis_of[0], any, axis_of[1]);
        const double length = sqrt(vector_dot(axis_of[1], axis_of[1]));
        for (int axis = 0; axis < 3; axis++)
            axis_of[1][axis] /= length;
        vector_cross(axis_of[0], axis_of[1], axis_of[2]);
    }
    for (int i = 0; i < solid->dim; i++) {
        const double edge = draw_coin(draw) ? 1 : draw_uniform(draw, 0.5, 4);
        for (int axis = 0; axis < solid->dim; axis++)
            solid->component[i][axis] = edge * axis_of[i][axis];
    }
}

/* One velocity for both, or B along the face that they share. */
static void slip(struct draw *draw, int up, struct question *question)
{
    const int dim = question->a.dim;
    const double *along = question->a.component[(up + 1) % dim];
    const double speed = draw_coin(draw) ? 0 : draw_uniform(draw, -1, 1);
    for (int axis = 0; axis < dim; axis++) {
        const double both = draw_uniform(draw, -10, 10);
        question->a.velocity[axis] = both;
        question->b.velocity[axis] = both + speed * along[axis];
    }
    question->a.moving = question->b.moving = true;
}

/* Same components, bit for bit; B stands on A, up to 3 ulps off on each axis (FCL, issues 493 and
 * 495). */
void tilted_stack(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    (void) family;
    const int up = draw_int(draw, 0, cell->dim - 1);
    const bool level = draw_coin(draw); /* exactly as the origin rounds */
    *out = (struct question){.duration = 1};
    out->a = (struct solid){.dim = cell->dim, .shape = cell->shape[0]};
    draw_tilted(draw, &out->a);
    for (int axis = 0; axis < cell->dim; axis++)
        out->a.origin[axis] = draw_uniform(draw, -10, 10);
    out->b = out->a;
    out->b.shape = cell->shape[1];
    for (int axis = 0; axis < cell->dim; axis++) {
        double *origin = &out->b.origin[axis];
        *origin += out->a.component[up][axis];
        int ulps = draw_int(draw, -3, 3);
        for (int n = level ? 0 : ulps > 0 ? ulps : -ulps; n > 0; n--)
            *origin = nextafter(*origin, ulps > 0 ? HUGE_VAL : -HUGE_VAL);
    }
    if (cell->moving)
        slip(draw, up, out);
}

/* ---- Grids ---- */

/* Edges along the axes, in any order and direction, so many pitches long. */
static void draw_upright(struct draw *draw, double pitch, int most, struct solid *solid)
{
    const int first = draw_int(draw, 0, solid->dim - 1), step = draw_int(draw, 1, solid->dim - 1);
    for (int i = 0; i < solid->dim; i++) {
        const int axis = (first + i * step) % solid->dim;
        const int edge = draw_int(draw, 1, most);
        solid->component[i][axis] = pitch * (draw_coin(draw) ? edge : -edge);
    }
}

/* From where to where a solid of upright edges reaches on an axis, relative to its origin. */
static void reach(const struct solid *solid, int axis, double out[2])
{
    out[0] = out[1] = 0;
    for (int i = 0; i < solid->dim; i++) {
        out[0] = fmin(out[0], solid->component[i][axis]);
        out[1] = fmax(out[1], solid->component[i][axis]);
    }
}

/* A at a point of the grid, B beside it: above, below or level with it on each axis, and on some
 * axis not level. Returns that axis. numbers: of pitches; origins are computed as number * pitch.
 */
static int set_beside(struct draw *draw, double pitch, struct question *question)
{
    const int dim = question->a.dim, beside = draw_int(draw, 0, dim - 1);
    for (int axis = 0; axis < dim; axis++) {
        double a[2], b[2];
        reach(&question->a, axis, a);
        reach(&question->b, axis, b);
        const int at = draw_int(draw, -1000, 1000);
        const int side = axis == beside ? 2 * draw_int(draw, 0, 1) - 1 : draw_int(draw, -1, 1);
        double offset = draw_int(draw, -1, 1); /* in pitches */
        if (side > 0)
            offset = round((a[1] - b[0]) / pitch);
        if (side < 0)
            offset = round((a[0] - b[1]) / pitch);
        question->a.origin[axis] = at * pitch;
        question->b.origin[axis] = (at + offset) * pitch;
    }
    return beside;
}

/* Velocities of whole pitches; A starts so much earlier, and is where it was at a time in the
 * window. Sliding beside each other as often as not. */
static void move_in_grid(struct draw *draw, double pitch, int beside, struct question *question)
{
    static const double times[] = {0, 0.25, 0.5, 1};
    const double time = times[draw_int(draw, 0, 3)];
    const bool beside_only = draw_coin(draw);
    for (int axis = 0; axis < question->a.dim; axis++) {
        const int a = draw_int(draw, -3, 3), b = draw_int(draw, -3, 3);
        question->a.velocity[axis] = pitch * a;
        question->b.velocity[axis] = pitch * (axis == beside && beside_only ? a : b);
        question->a.origin[axis] -= time * question->a.velocity[axis];
        question->b.origin[axis] -= time * question->b.velocity[axis];
    }
    question->a.moving = question->b.moving = true;
}

static void grid(struct draw *draw, const struct cell *cell, double pitch, int most,
                 struct question *out)
{
    *out = (struct question){.duration = 1};
    out->a = (struct solid){.dim = cell->dim, .shape = cell->shape[0]};
    out->b = (struct solid){.dim = cell->dim, .shape = cell->shape[1]};
    draw_upright(draw, pitch, most, &out->a);
    draw_upright(draw, pitch, most, &out->b);
    const int beside = set_beside(draw, pitch, out);
    if (cell->moving)
        move_in_grid(draw, pitch, beside, out);
}

void integer_grid(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    (void) family;
    grid(draw, cell, 1, 3, out);
}

/* An ulp decides: i * 0.1 + 0.1 is not always (i + 1) * 0.1. */
void decimal_grid(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    grid(draw, cell, family->amount, draw_coin(draw) ? 1 : 3, out);
}

/* ---- A bullet and a plate ---- */

/* A plate around 0: thin along one axis, up to 10 along the others, a little askew. */
static void draw_plate(struct draw *draw, int thin, struct solid *plate)
{
    static const double thicknesses[] = {1e-3, 1e-4, 1e-5, 1e-6};
    const double thickness = thicknesses[draw_int(draw, 0, 3)];
    for (int i = 0; i < plate->dim; i++)
        for (int axis = 0; axis < plate->dim; axis++)
            plate->component[i][axis] =
                i == axis ? draw_uniform(draw, 1, 10) : draw_uniform(draw, -0.1, 0.1);
    for (int axis = 0; axis < plate->dim; axis++)
        plate->component[thin][axis] *= thickness;
}

/* The bullet is at a point of the plate, or just off its rim, at a time in the window: early, late,
 * or as the window ends. */
void fast_and_thin(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    const int thin = draw_int(draw, 0, cell->dim - 1), fast = draw_coin(draw);
    *out = (struct question){.duration = 1};
    struct solid *plate = fast ? &out->a : &out->b, *bullet = fast ? &out->b : &out->a;
    *plate = (struct solid){.dim = cell->dim, .shape = cell->shape[!fast], .moving = true};
    *bullet = (struct solid){.dim = cell->dim, .shape = cell->shape[fast], .moving = true};
    draw_plate(draw, thin, plate);
    const double time = draw_int(draw, 0, 3) == 0 ? 1 : draw_uniform(draw, 0, 1);
    const double past = draw_coin(draw) ? 0 : draw_uniform(draw, -2, 2) / family->amount;
    for (int i = 0; i < cell->dim; i++)
        for (int axis = 0; axis < cell->dim; axis++)
            bullet->component[i][axis] = draw_uniform(draw, -1, 1);
    for (int axis = 0; axis < cell->dim; axis++) {
        const double fastest = axis == thin ? family->amount : family->amount / 10;
        bullet->velocity[axis] = draw_uniform(draw, -fastest, fastest);
        plate->velocity[axis] = draw_coin(draw) ? 0 : draw_uniform(draw, -1, 1);
        bullet->origin[axis] = -(time + past) * bullet->velocity[axis];
        for (int i = 0; i < cell->dim; i++)
            bullet->origin[axis] += draw_uniform(draw, -0.2, 1.2) * plate->component[i][axis];
    }
}
