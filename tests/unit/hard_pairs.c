#include "hard_pairs.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "posed.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static struct solid draw_integer_solid(struct draw *draw, int dim, int most)
{
    struct solid solid = {.dim = dim, .shape = question_draw_shape(draw, dim)};
    for (int i = 0; i < solid_count(&solid); i++)
        draw_integers(draw, dim, -most, most, solid.component[i]);
    return solid;
}

static double draw_duration(struct draw *draw)
{
    static const double durations[] = {0, -0.0, 0x1p-1074, 1e-300, 0.5, 1, 3, 1e300, DBL_MAX};
    return durations[draw_int(draw, 0, (int) COUNT(durations) - 1)];
}

static int draw_dim(struct draw *draw)
{
    return draw_int(draw, 2, 3);
}

/* ---- Small numbers ---- */

/* Small whole numbers throughout, the window included. */
static void small_world(struct draw *draw, struct question *question)
{
    const int dim = draw_dim(draw), most = draw_int(draw, 1, 3);
    *question = (struct question){draw_integer_solid(draw, dim, most),
                                  draw_integer_solid(draw, dim, most), draw_int(draw, 0, 2)};
    question_draw_movers(draw, question);
    draw_integers(draw, dim, -most, most, question->a.origin);
    draw_integers(draw, dim, -most, most, question->b.origin);
    draw_integers(draw, dim, -most, most, question->a.velocity);
    draw_integers(draw, dim, -most, most, question->b.velocity);
}

static void scale(double *vector, int exponent)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        vector[axis] = ldexp(vector[axis], exponent);
}

/* All lengths by one power of two, and velocities by another. */
static void scale_lengths(struct question *question, int exponent, int of_velocities)
{
    struct solid *solids[2] = {&question->a, &question->b};
    for (int side = 0; side < 2; side++) {
        scale(solids[side]->origin, exponent);
        scale(solids[side]->velocity, of_velocities);
        for (int i = 0; i < FMB_DIM_MAX; i++)
            scale(solids[side]->component[i], exponent);
    }
}

/* Windows so short or long that a velocity, or what it is multiplied with, may vanish. */
static void windows_of_any_length(struct draw *draw, struct question *question)
{
    const int exponent = draw_int(draw, -900, 900);
    small_world(draw, question);
    question->duration = ldexp(question->duration, exponent);
    scale_lengths(question, 0, -exponent);
}

/* Windows of a few subnormals, in which frames come as far as they are wide. */
static void windows_of_subnormals(struct draw *draw, struct question *question)
{
    const int exponent = draw_int(draw, 0, 30);
    small_world(draw, question);
    question->duration = draw_int(draw, 1, 9) * ldexp(0x1p-1074, exponent);
    scale_lengths(question, exponent - 74, 1000 - draw_int(draw, 0, 4));
}

/* A speed over a window of 2^-500 s: some make a way of about 1, of others the way is less than any
 * double. */
static double draw_speed(struct draw *draw)
{
    return ldexp(draw_int(draw, -3, 3), draw_coin(draw) ? 499 : draw_int(draw, -590, -570));
}

/* A coordinate of the drift that is 0 as a double and not in truth makes the normals of its slabs
 * vanish where an edge is parallel to what is left of the drift; and of 0 along an axis. */
static void drifts_that_vanish_along_an_axis(struct draw *draw, struct question *question)
{
    small_world(draw, question);
    question->duration = 0x1p-500;
    question->a.moving = question->b.moving = true;
    for (int axis = 0; axis < question->a.dim; axis++) {
        question->a.origin[axis] = question->a.velocity[axis] = 0;
        question->b.origin[axis] = draw_int(draw, -2, 2) +
                                   (draw_coin(draw) ? 0 : ldexp(draw_int(draw, -2, 2), -1074)) +
                                   (draw_coin(draw) ? 0 : draw_int(draw, -2, 2) * 0x1p-52);
        question->b.velocity[axis] = draw_speed(draw);
    }
}

/* ---- Numbers of every size ---- */

static double of_every_kind(struct draw *draw)
{
    switch (draw_int(draw, 0, 7)) {
    case 0: return draw_coin(draw) ? 0 : -0.0;
    case 1: return draw_int(draw, -2, 2);
    case 2: return draw_int(draw, -9, 9) * 0x1p-1074;
    case 3: return draw_uniform(draw, -1, 1) * DBL_MAX;
    case 4: return draw_coin(draw) ? DBL_MAX : -DBL_MAX;
    case 5: return draw_log(draw, -1000, 1000);
    default: return draw_finite(draw);
    }
}

/* In half of the pairs, origins and components are small multiples of the least positive double.
 * All other numbers are of every kind. */
static void numbers_of_every_kind(struct draw *draw, struct question *question)
{
    const int dim = draw_dim(draw), kind = draw_int(draw, 0, 1);
    struct solid *solids[2] = {&question->a, &question->b};
    *question = (struct question){{.dim = dim}, {.dim = dim}, draw_duration(draw)};
    question_draw_movers(draw, question);
    for (int f = 0; f < 2; f++) {
        struct solid *solid = solids[f];
        solid->shape = question_draw_shape(draw, dim);
        for (int axis = 0; axis < dim; axis++) {
            solid->origin[axis] = kind ? of_every_kind(draw) : draw_int(draw, -9, 9) * 0x1p-1074;
            solid->velocity[axis] = of_every_kind(draw);
            for (int i = 0; i < solid_count(solid); i++)
                solid->component[i][axis] =
                    kind ? of_every_kind(draw) : draw_int(draw, -9, 9) * 0x1p-1074;
        }
    }
    if (draw_coin(draw))
        question->duration = fabs(of_every_kind(draw));
}

/* ---- The families ---- */

static const struct hard_family own[] = {
    {"small_world", small_world, 0, 6000},
    {"windows_of_any_length", windows_of_any_length, 0, 3000},
    {"windows_of_subnormals", windows_of_subnormals, 0, 2000},
    {"drifts_that_vanish_along_an_axis", drifts_that_vanish_along_an_axis, 0, 4000},
    {"numbers_of_every_kind", numbers_of_every_kind, -1, 3000},
};

/* The families of the campaigns whose bodies have one frame, not given by vertices. */
static const struct family *campaign_at(size_t index)
{
    const struct family *family;
    for (size_t i = 0; (family = family_any_at(i)); i++)
        if (strncmp(family->name, "hull-", 5) != 0 &&
            strncmp(family->name, "pose-frames", 11) != 0 &&
            strcmp(family->name, "pose-vertices") != 0 && index-- == 0)
            break;
    return family;
}

const struct hard_family *hard_family_at(size_t index)
{
    static struct hard_family families[HARD_FAMILIES_MAX];
    const struct family *family;
    if (index < COUNT(own))
        return &own[index];
    if (index >= HARD_FAMILIES_MAX || !(family = campaign_at(index - COUNT(own))))
        return NULL;
    families[index] = (struct hard_family){.name = family->name,
                                           .verdict = family->verdict ? family->verdict : -1,
                                           .usual = 400,
                                           .family = family};
    return &families[index];
}

void hard_draw(struct draw *draw, const struct hard_family *family, struct question *question)
{
    if (!family->family) {
        family->draw_question(draw, question);
        return;
    }
    struct cell cells[CELL_OF_ALL_SHAPES];
    const int count = family_cells(family->family, cells);
    family_draw(family->family, &cells[draw_int(draw, 0, count - 1)], draw, question);
}
