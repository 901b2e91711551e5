/* Families of flat frames, and of numbers of every size. */
#include "family.h"

#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

static void begin(const struct cell *cell, struct question *out)
{
    *out = (struct question){.duration = 1};
    out->a = (struct solid){.dim = cell->dim, .shape = cell->shape[0]};
    out->b = (struct solid){.dim = cell->dim, .shape = cell->shape[1]};
}

/* A point of the shape, relative to its origin: a vertex, or parameters that are eighths, often at
 * their bounds, so that small integers give an exact point. */
static void draw_point(struct draw *draw, const struct solid *solid, double *point)
{
    static const double eighths[] = {0, 1, 0, 1, 0.5, 0.25, 0.125};
    const int last = draw_coin(draw) ? 1 : COUNT(eighths) - 1; /* a vertex, or any */
    double left = 1;                                           /* what a tetrahedron may take */
    memset(point, 0, FMB_DIM_MAX * sizeof *point);
    for (int i = 0; i < solid_count(solid); i++) {
        double x = eighths[draw_int(draw, 0, last)];
        if (solid->shape != FMB_CUBOID) {
            x = fmin(x, left);
            left -= x;
        }
        for (int axis = 0; axis < solid->dim; axis++)
            point[axis] += x * solid->component[i][axis];
    }
}

/* Moves B so that a point of A and one of B coincide at the time, if nothing rounds. */
static void bring_into_contact(struct draw *draw, double time, struct question *question)
{
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    draw_point(draw, &question->a, a);
    draw_point(draw, &question->b, b);
    for (int axis = 0; axis < question->a.dim; axis++)
        question->b.origin[axis] = question->a.origin[axis] + (a[axis] - b[axis]) +
                                   time * (question->a.velocity[axis] - question->b.velocity[axis]);
}

static void draw_velocities(struct draw *draw, const struct cell *cell, struct question *question)
{
    if (!cell->moving)
        return;
    const int who = draw_int(draw, 1, 3);
    question->a.moving = who & 1;
    question->b.moving = who & 2;
    if (question->a.moving)
        draw_integers(draw, cell->dim, -2, 2, question->a.velocity);
    if (question->b.moving)
        draw_integers(draw, cell->dim, -2, 2, question->b.velocity);
}

/* ---- Flat ---- */

/* Components from a space of the rank, with integer coefficients. */
static void draw_of_rank(struct draw *draw, int rank, struct solid *solid)
{
    double basis[FMB_DIM_MAX][FMB_DIM_MAX] = {{0}};
    for (int r = 0; r < rank; r++)
        draw_integers(draw, solid->dim, -4, 4, basis[r]);
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < solid->dim; axis++) {
            solid->component[i][axis] = 0;
            for (int r = 0; r < rank; r++)
                solid->component[i][axis] += draw_int(draw, -2, 2) * basis[r][axis];
        }
}

/* Ranks up to these, in contact at a time in the window more often than not. */
static void draw_flat(struct draw *draw, const struct cell *cell, int rank_a, int rank_b,
                      struct question *out)
{
    begin(cell, out);
    draw_of_rank(draw, rank_a, &out->a);
    draw_of_rank(draw, rank_b, &out->b);
    draw_integers(draw, cell->dim, -5, 5, out->a.origin);
    draw_velocities(draw, cell, out);
    const double time = draw_int(draw, 0, 2) / 2.0;
    bring_into_contact(draw, time, out);
    if (draw_int(draw, 0, 3) > 0)
        return;
    double *number = &out->b.origin[draw_int(draw, 0, cell->dim - 1)];
    *number = nextafter(*number, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
}

/* At least one is flat. */
void dependent(struct draw *draw, const struct family *family, const struct cell *cell,
               struct question *out)
{
    (void) family;
    int flat = draw_int(draw, 0, cell->dim - 1), any = draw_int(draw, 1, cell->dim);
    bool first = draw_coin(draw);
    draw_flat(draw, cell, first ? flat : any, first ? any : flat, out);
}

void points_and_segments(struct draw *draw, const struct family *family, const struct cell *cell,
                         struct question *out)
{
    (void) family;
    const int rank_b = draw_int(draw, 0, 1), rank_a = draw_int(draw, 0, 1);
    draw_flat(draw, cell, rank_a, rank_b, out);
}

/* One axis is the same for all points of both, at one time or always. */
void in_one_plane(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    (void) family;
    const int axis = draw_int(draw, 0, cell->dim - 1), from = (axis + 1) % cell->dim;
    const double lean = draw_int(draw, -2, 2);
    draw_flat(draw, cell, cell->dim, cell->dim, out);
    out->b.origin[axis] = out->a.origin[axis];
    if (draw_coin(draw))
        out->b.velocity[axis] = out->a.velocity[axis];
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        for (int i = 0; i < solid_count(solid); i++)
            solid->component[i][axis] = lean * solid->component[i][from];
        solid->origin[axis] += lean * solid->origin[from];
    }
}

/* A face of general position, in contact or nearly. */
void faces(struct draw *draw, const struct family *family, const struct cell *cell,
           struct question *out)
{
    (void) family;
    begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const bool integers = draw_coin(draw);
        for (int axis = 0; axis < cell->dim; axis++)
            for (int i = 0; i < solid_count(solid); i++)
                solid->component[i][axis] =
                    integers ? draw_int(draw, -9, 9) : draw_uniform(draw, -100, 100);
    }
    draw_velocities(draw, cell, out);
    bring_into_contact(draw, draw_int(draw, 0, 2) / 2.0, out);
}

/* ---- Sizes ---- */

/* Every number with an exponent of its own. */
void exponents(struct draw *draw, const struct family *family, const struct cell *cell,
               struct question *out)
{
    const int most = (int) family->amount;
    begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        solid->moving = cell->moving;
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] = draw_log(draw, -most, most);
            if (cell->moving)
                solid->velocity[axis] = draw_log(draw, -most, most);
            for (int i = 0; i < solid_count(solid); i++)
                solid->component[i][axis] = draw_log(draw, -most, most);
        }
    }
    if (draw_coin(draw))
        bring_into_contact(draw, 0, out);
    if (cell->moving && draw_coin(draw))
        out->duration = fabs(draw_log(draw, -most, most));
}
