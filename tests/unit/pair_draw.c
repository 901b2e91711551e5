#include "pair_draw.h"

#include "family.h"

#include <math.h>
#include <string.h>

typedef double number_function(struct draw *draw);

static double whole(struct draw *draw)
{
    return draw_int(draw, -3, 3);
}

/* Multiples of 0.1, as they round. */
static double tenth(struct draw *draw)
{
    return 0.1 * draw_int(draw, -9, 9);
}

static void draw_vector(struct draw *draw, int dim, number_function *number, double *vector)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = number(draw);
}

/* ---- Solids in a frame of axes of their own ---- */

static void draw_integers_in(struct draw *draw, struct solid *solid)
{
    for (int i = 0; i < solid_count(solid); i++)
        draw_vector(draw, solid->dim, whole, solid->component[i]);
    draw_vector(draw, solid->dim, whole, solid->origin);
    draw_vector(draw, solid->dim, whole, solid->velocity);
}

/* An edge along each of the axes in turn; one in four components is any. */
static void draw_upright(struct draw *draw, struct solid *solid)
{
    const int first = draw_int(draw, 0, solid->dim - 1);
    for (int i = 0; i < solid_count(solid); i++) {
        if (draw_int(draw, 0, 3) == 0)
            draw_vector(draw, solid->dim, tenth, solid->component[i]);
        else
            solid->component[i][(first + i) % solid->dim] =
                0.1 * (draw_coin(draw) ? draw_int(draw, 1, 9) : -draw_int(draw, 1, 9));
    }
    draw_vector(draw, solid->dim, tenth, solid->origin);
    if (draw_coin(draw)) /* along an axis */
        solid->velocity[draw_int(draw, 0, solid->dim - 1)] = tenth(draw);
    else
        draw_vector(draw, solid->dim, tenth, solid->velocity);
}

/* ---- Turned ---- */

static void turn(double *vector, int p, int q, double cosine, double sine)
{
    const double x = vector[p], y = vector[q];
    vector[p] = cosine * x - sine * y;
    vector[q] = sine * x + cosine * y;
}

/* Both by the same: parallel boxes, but for rounding. */
static void turn_both(struct draw *draw, struct question *question)
{
    struct solid *solids[2] = {&question->a, &question->b};
    for (int p = 0; p < question->a.dim - 1; p++) {
        const double angle = draw_uniform(draw, 0, 6);
        const double cosine = cos(angle), sine = sin(angle);
        for (int f = 0; f < 2; f++) {
            turn(solids[f]->origin, p, p + 1, cosine, sine);
            turn(solids[f]->velocity, p, p + 1, cosine, sine);
            for (int i = 0; i < solid_count(solids[f]); i++)
                turn(solids[f]->component[i], p, p + 1, cosine, sine);
        }
    }
}

/* ---- Pairs ---- */

static struct question draw_scene(struct draw *draw, const struct cell *cell,
                                  void (*solid)(struct draw *draw, struct solid *solid))
{
    struct question question = {{.dim = cell->dim, .shape = cell->shape[0]},
                                {.dim = cell->dim, .shape = cell->shape[1]},
                                1};
    solid(draw, &question.a);
    solid(draw, &question.b);
    question.b.moving = cell->moving;
    question.a.moving = cell->moving && draw_coin(draw);
    return question;
}

static bool has_cell(const struct family *family, const struct cell *cell)
{
    struct cell cells[CELL_WITH_FACES];
    for (int i = family_cells(family, cells) - 1; i >= 0; i--)
        if (cells[i].dim == cell->dim && cells[i].moving == cell->moving &&
            cells[i].shape[0] == cell->shape[0] && cells[i].shape[1] == cell->shape[1])
            return true;
    return false;
}

static void draw_family(struct draw *draw, const struct cell *cell, struct question *out)
{
    int count = 0;
    while (family_at((size_t) count))
        count++;
    for (;;) {
        const struct family *family = family_at((size_t) draw_int(draw, 0, count - 1));
        if (has_cell(family, cell)) {
            family_draw(family, cell, draw, out);
            return;
        }
    }
}

void pair_draw(struct draw *draw, const struct cell *cell, struct question *out)
{
    switch (draw_int(draw, 0, 7)) {
    case 0: *out = draw_scene(draw, cell, draw_integers_in); break;
    case 1: *out = draw_scene(draw, cell, draw_upright); break;
    case 2:
        *out = draw_scene(draw, cell, draw_upright);
        turn_both(draw, out);
        break;
    default: draw_family(draw, cell, out); break;
    }
}

/* The same number on some axis of both, of either sign; or of one. */
static void carry_away(struct draw *draw, int axis, double far, struct question *question)
{
    question->a.origin[axis] = far;
    if (draw_coin(draw))
        question->b.origin[axis] = draw_coin(draw) ? far : -far;
}

void pair_draw_stretched(struct draw *draw, const struct cell *cell, struct question *out)
{
    pair_draw(draw, cell, out);
    struct solid *solid = draw_coin(draw) ? &out->a : &out->b;
    const int axis = draw_int(draw, 0, cell->dim - 1);
    const double far = draw_coin(draw) ? draw_log(draw, 190, 210) : draw_log(draw, 900, 1022);
    const double tiny = draw_coin(draw) ? draw_log(draw, -420, -190) : draw_log(draw, -1074, -190);
    switch (draw_int(draw, 0, 3)) {
    case 0: carry_away(draw, axis, far, out); break;
    case 1: solid->velocity[axis] = far; break;
    case 2:
        memset(out->a.velocity, 0, sizeof out->a.velocity);
        memset(out->b.velocity, 0, sizeof out->b.velocity);
        solid->velocity[axis] = tiny;
        break;
    default: out->b.velocity[axis] = out->a.velocity[axis] + tiny; break;
    }
}

struct cell pair_draw_cell(struct draw *draw)
{
    struct cell cells[CELL_WITH_FACES];
    return cells[draw_int(draw, 0, cell_list(true, cells) - 1)];
}

void pair_set_duration(struct question *question, double duration)
{
    const double times = question->duration / duration;
    struct solid *solids[2] = {&question->a, &question->b};
    question->duration = duration;
    for (int f = 0; f < 2; f++) {
        double velocity[FMB_DIM_MAX];
        bool finite = true;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            velocity[axis] = solids[f]->velocity[axis] * times;
            finite = finite && isfinite(velocity[axis]);
        }
        if (finite)
            memcpy(solids[f]->velocity, velocity, sizeof velocity);
    }
}
