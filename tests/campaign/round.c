/* Families of shapes with a radius. They are made in two ways. Either two cores of integers are put
 * on both sides of a plane whose normal has an integer length, then moved apart along the normal by
 * the sum of the radii, so that they touch. Or the distance of any two cores is computed in
 * rational numbers, and the sum of the radii is that distance up to rounding. */
#include "round.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gap_check.h"
#include "memory.h"
#include "posed.h"
#include "trial.h"

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* ---- Cores ---- */

/* Reduces a core to a point, a segment or, if it has more than two components, a plate; or leaves
 * it unchanged. */
static void flatten(struct draw *draw, struct solid *solid)
{
    const int left = draw_int(draw, 0, solid_count(solid) + 2);
    if (left >= solid_count(solid))
        return;
    if (solid->vertex_count > left)
        solid->vertex_count = left + 1;
    for (int i = left; i < solid_count(solid); i++)
        memset(solid->component[i], 0, sizeof solid->component[i]);
}

/* ---- Exactly touching ---- */

/* Draws a vector of integers whose length is an integer. Returns the length. */
static double draw_whole_normal(struct draw *draw, const struct question *question, double *out)
{
    static const double known[][3] = {{1, 0, 0}, {3, 4, 0}, {5, 12, 0}, {1, 2, 2}, {2, 3, 6},
                                      {1, 4, 8}, {4, 4, 7}, {2, 6, 9},  {6, 6, 7}, {12, 15, 16}};
    for (int tries = 0; tries < 30; tries++) {
        posed_draw_direction(draw, question, out);
        const double square = vector_dot(out, out), length = sqrt(square);
        if (square < 0x1p50 && length == rint(length) && length * length == square)
            return length;
    }
    const int dim = question->a.dim;
    const int which = draw_int(draw, 0, dim == 2 ? 2 : COUNT(known) - 1);
    const int first = draw_int(draw, 0, dim - 1);
    for (int i = 0; i < FMB_DIM_MAX; i++)
        out[i] = 0;
    for (int i = 0; i < dim; i++)
        out[(first + i) % dim] = known[which][i] * (draw_coin(draw) ? 1 : -1);
    return vector_length(known[which]);
}

/* Divides an integer sum between both radii, in integers; or gives all of it to one. */
static void share_radius(struct draw *draw, double radius, struct question *question)
{
    const int how = draw_int(draw, 0, 3);
    const double part = how == 0 ? 0 : how == 1 ? radius : floor(radius * draw_uniform(draw, 0, 1));
    question->a.radius = part;
    question->b.radius = radius - part;
}

/* Multiplies all lengths of a question by a factor. */
static void scale(double factor, struct question *question)
{
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(question, side);
        solid->radius *= factor;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            solid->origin[axis] *= factor;
            solid->velocity[axis] *= factor;
            solid->local[axis] *= factor;
            for (int i = 0; i < FMB_DIM_MAX; i++)
                solid->component[i][axis] *= factor;
            for (int v = 0; v < solid->vertex_count; v++)
                solid->vertex[v][axis] *= factor;
        }
    }
}

/* Relative velocities across the direction. */
static void draw_across(struct draw *draw, const double *direction, struct question *question)
{
    double with[FMB_DIM_MAX] = {0, 0, 1}, across[FMB_DIM_MAX];
    if (question->a.dim == 3)
        draw_integers(draw, 3, -2, 2, with);
    vector_cross(direction, with, across);
    memcpy(question->b.velocity, question->a.velocity, sizeof question->b.velocity);
    vector_add(question->b.velocity, draw_coin(draw) ? 1 : 0.25, across);
}

static void touch(struct draw *draw, int most, bool slide, const struct cell *cell,
                  struct question *out)
{
    static const int mosts[] = {1, 3, 9};
    double direction[FMB_DIM_MAX];
    const int size = mosts[draw_int(draw, 0, COUNT(mosts) - 1)];
    posed_begin(cell, out);
    posed_draw_velocities(draw, true, out);
    draw_integers(draw, cell->dim, -100, 100, out->a.origin);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        posed_draw_whole(draw, most, solid);
        posed_draw_whole_shape(draw, size, posed_norm(solid), solid);
        flatten(draw, solid);
    }
    const double length = draw_whole_normal(draw, out, direction);
    if (slide)
        draw_across(draw, direction, out);
    posed_meet_exactly(draw, direction, out);
    const double times = ldexp(draw_int(draw, 1, 5), draw_int(draw, -2, 3));
    vector_add(out->b.origin, times, direction);
    share_radius(draw, times * length, out);
    scale(ldexp(1, draw_int(draw, -30, 30)), out);
}

/* Orientations of whole numbers up to the amount. */
static void round_touch(struct draw *draw, const struct family *family, const struct cell *cell,
                        struct question *out)
{
    touch(draw, (int) family->amount, false, cell, out);
}

static void round_slide(struct draw *draw, const struct family *family, const struct cell *cell,
                        struct question *out)
{
    touch(draw, (int) family->amount, true, cell, out);
}

static void but_an_ulp(struct draw *draw, const struct family *family, const struct cell *cell,
                       struct question *out)
{
    touch(draw, (int) family->amount, draw_coin(draw), cell, out);
    struct solid *solid = question_solid(out, draw_int(draw, 0, 1));
    const double to = draw_coin(draw) ? HUGE_VAL : -HUGE_VAL;
    double *number =
        draw_coin(draw) ? &solid->origin[draw_int(draw, 0, cell->dim - 1)] : &solid->radius;
    *number = number == &solid->radius ? fabs(nextafter(*number, to)) : nextafter(*number, to);
}

/* ---- Pairs of the other families ---- */

static bool has(const struct family *family, const struct cell *cell)
{
    struct cell all[CELL_OF_ALL_SHAPES];
    for (int i = family_cells(family, all) - 1; i >= 0; i--)
        if (all[i].dim == cell->dim && all[i].moving == cell->moving &&
            all[i].shape[0] == cell->shape[0] && all[i].shape[1] == cell->shape[1])
            return true;
    return false;
}

/* Draws a question of a family of this amount that has the cell; amount 0: of any amount. */
static void draw_other(struct draw *draw, double amount, const struct cell *cell,
                       struct question *out)
{
    const struct family *other;
    int all = 0;
    while (family_any_at((size_t) all))
        all++;
    do
        other = family_any_at((size_t) draw_int(draw, 0, all - 1));
    while ((amount != 0 && other->amount != amount) || !has(other, cell) ||
           strcmp(other->name, "hull-cloud-1000") == 0); /* slow by an oracle */
    family_draw(other, cell, draw, out);
}

static double greatest(const double *vector)
{
    return fmax(fabs(vector[0]), fmax(fabs(vector[1]), fabs(vector[2])));
}

static double size_of(const struct question *question)
{
    double size = 0;
    for (int side = 0; side < 2; side++) {
        const struct solid *solid = side ? &question->b : &question->a;
        for (int i = 0; i < FMB_DIM_MAX; i++)
            size = fmax(size, greatest(solid->component[i]));
        for (int v = 0; v < solid->vertex_count; v++)
            size = fmax(size, greatest(solid->vertex[v]));
    }
    return size;
}

/* low + high := the distance of the cores of the first frames, but for 2^-100 of it. */
static void find_distance(const struct question *question, double *high, double *low)
{
    struct trial *trial = memory_get(sizeof *trial);
    mpq_t square;
    mpf_t root, part;
    mpq_init(square);
    mpf_init2(root, 512);
    mpf_init2(part, 512);
    trial_begin(question, trial);
    gap_check_distance(&trial->pair[0], square);
    trial_end(trial);
    free(trial);
    mpf_set_q(root, square);
    mpf_sqrt(root, root);
    *high = mpf_get_d(root);
    mpf_set_d(part, isfinite(*high) ? *high : 0);
    mpf_sub(part, root, part);
    *low = mpf_get_d(part);
    mpq_clear(square);
    mpf_clear(root);
    mpf_clear(part);
}

static double ulps(double number, int count)
{
    for (; count != 0; count -= count > 0 ? 1 : -1)
        number = nextafter(number, count > 0 ? HUGE_VAL : 0);
    return number;
}

/* Two radii whose sum is the distance but for rounding: in the last place of one, or much less. */
static void fit_radii(struct draw *draw, const struct question *core, struct question *out)
{
    double high, low;
    find_distance(core, &high, &low);
    if (high == 0 || high > DBL_MAX / 2)
        high = fmin(DBL_MAX / 4, size_of(core) * exp2(-draw_uniform(draw, 0, 60)));
    const int how = draw_int(draw, 0, 3);
    double part = how == 0   ? 0
                  : how == 1 ? high * exp2(-draw_uniform(draw, 1, 70))
                  : how == 2 ? high * draw_uniform(draw, 0, 1)
                             : low;
    if (part == low) {
        part = ulps(part, draw_int(draw, -1, 1));
    } else {
        high = ulps(high - part, draw_int(draw, -2, 2));
    }
    const bool first = draw_coin(draw);
    out->a.radius = first ? part : high;
    out->b.radius = first ? high : part;
}

/* The cores as they are, or farther apart, or flat. */
static void near_others(struct draw *draw, const struct family *family, const struct cell *cell,
                        struct question *out)
{
    draw_other(draw, family->amount, cell, out);
    if (draw_coin(draw))
        flatten(draw, question_solid(out, draw_int(draw, 0, 1)));
    const double size = size_of(out) * exp2(draw_uniform(draw, -10, 4));
    for (int axis = 0; axis < cell->dim && draw_int(draw, 0, 3) > 0; axis++)
        out->b.origin[axis] += size * draw_uniform(draw, -1, 1);
    struct question core = *out;
    family_pull_back(&core);
    *out = core;
    fit_radii(draw, &core, out);
}

/* Radii of any size beside that of the cores. */
static void padded_others(struct draw *draw, const struct family *family, const struct cell *cell,
                          struct question *out)
{
    draw_other(draw, family->amount, cell, out);
    const double size = size_of(out);
    for (int side = 0; side < 2; side++)
        question_solid(out, side)->radius =
            draw_int(draw, 0, 3) == 0 ? 0 : size * exp2(draw_uniform(draw, -70, 10));
}

/* ---- One inside of the other ---- */

static void inside(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    (void) family;
    family_draw_posed(draw, cell, out);
    const int outer = draw_int(draw, 0, 1);
    struct solid *solid[2] = {question_solid(out, outer), question_solid(out, 1 - outer)};
    flatten(draw, solid[1]);
    memcpy(solid[1]->origin, solid[0]->origin, sizeof solid[1]->origin);
    memcpy(solid[1]->velocity, solid[0]->velocity, sizeof solid[1]->velocity);
    if (draw_coin(draw)) /* it flies through the other, or out of it */
        vector_add(solid[1]->velocity, 1, (const double[]){100, -100, 0});
    solid[0]->radius = draw_uniform(draw, 1000, 2000);
    solid[1]->radius = draw_uniform(draw, 0, 10);
    if (draw_coin(draw)) { /* the larger one is a ball about the origin */
        memset(solid[0]->component, 0, sizeof solid[0]->component);
        memset(solid[0]->local, 0, sizeof solid[0]->local);
        memset(solid[0]->vertex, 0, sizeof solid[0]->vertex);
        memset(solid[0]->origin, 0, sizeof solid[0]->origin);
        draw_integers(draw, cell->dim, -9, 9, solid[1]->origin);
    }
    for (int side = 0; side < 2; side++)
        solid[side]->moving = cell->moving;
}

/* clang-format off */
static const struct family families[] = {
    {"round-touch-1", "quarter, half and third turns, touching", round_touch,
     .amount = 1, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"round-touch-3", "quaternions of whole numbers up to 3, touching", round_touch,
     .amount = 3, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"round-touch-31", "quaternions of whole numbers up to 31, touching", round_touch,
     .amount = 31, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"round-slide", "touching while they slide, or in passing", round_slide,
     .amount = 3, .cells = FAMILY_POSED | FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"round-ulp", "touching or sliding but for an ulp", but_an_ulp,
     .amount = 3, .cells = FAMILY_POSED},
    {"round-near", "pairs of the other families, touching but for rounding", near_others,
     .cells = FAMILY_POSED},
    {"round-1e12", "1e12 from the origin, or slivers of that aspect, touching but for rounding", near_others,
     .amount = 0x1p40, .cells = FAMILY_POSED},
    {"round-padded", "pairs of the other families, with radii of any size", padded_others,
     .cells = FAMILY_POSED},
    {"round-inside", "one inside of the other", inside,
     .cells = FAMILY_POSED, .verdict = FMB_OVERLAPPING},

    {"round-hull-touch", "hulls, balls and capsules by vertices, touching", round_touch,
     .amount = 3, .cells = FAMILY_A_HULL, .verdict = FMB_TOUCHING},
    {"round-hull-slide", "touching while they slide, or in passing", round_slide,
     .amount = 3, .cells = FAMILY_A_HULL | FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"round-hull-ulp", "touching or sliding but for an ulp", but_an_ulp,
     .amount = 3, .cells = FAMILY_A_HULL},
    {"round-hull-near", "pairs of the other families, touching but for rounding", near_others,
     .cells = FAMILY_A_HULL},
    {"round-hull-200", "numbers from 2^-100 to 2^100, touching but for rounding", near_others,
     .amount = 100, .cells = FAMILY_A_HULL},
    {"round-hull-all", "numbers from 2^-1000 to 2^1000, touching but for rounding", near_others,
     .amount = 1000, .cells = FAMILY_A_HULL},
    {"round-hull-padded", "pairs of the other families, with radii of any size", padded_others,
     .cells = FAMILY_A_HULL},
    {"round-hull-inside", "one inside of the other", inside,
     .cells = FAMILY_A_HULL, .verdict = FMB_OVERLAPPING},
    {"round-200", "numbers from 2^-100 to 2^100, touching but for rounding", near_others,
     .amount = 100},
    {"round-all", "numbers from 2^-1000 to 2^1000, touching but for rounding", near_others,
     .amount = 1000},
};
/* clang-format on */

const struct family *family_round_at(size_t index)
{
    return index < sizeof families / sizeof *families ? &families[index] : NULL;
}

const struct family *family_all_at(size_t index)
{
    size_t others = 0;
    while (family_any_at(others))
        others++;
    return index < others ? family_any_at(index) : family_round_at(index - others);
}
