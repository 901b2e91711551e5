#include "climb.h"

#include <math.h>
#include <string.h>

/* ---- Numbers ---- */

/* Any exponent, with a mantissa of 53 bits, of a few, or of one. */
static double draw_number(struct climber *climber)
{
    static const int bits[] = {52, 52, 52, 4, 0};
    const int kept = bits[draw_int(climber->draw, 0, 4)];
    const double mantissa =
        ldexp(1 + floor(ldexp(draw_uniform(climber->draw, 0, 1), kept)) / ldexp(1, kept),
              draw_int(climber->draw, climber->least, climber->most));
    return draw_coin(climber->draw) ? mantissa : -mantissa;
}

/* At one end of the exponents or the other: these make the widest integers. */
static double draw_end(struct climber *climber)
{
    const double number = draw_coin(climber->draw)
                              ? ldexp(draw_uniform(climber->draw, 1, 2), climber->most)
                              : ldexp(draw_uniform(climber->draw, 1, 2),
                                      climber->least < -1022 ? -1022 : climber->least);
    return draw_coin(climber->draw) ? number : -number;
}

static struct solid *any_solid(struct climber *climber, struct question *question)
{
    return draw_coin(climber->draw) ? &question->a : &question->b;
}

/* The origin, the velocity or a component. */
static double *any_vector(struct climber *climber, struct solid *solid)
{
    const int which = draw_int(climber->draw, -2, solid_count(solid) - 1);
    return which == -2 ? solid->origin : which == -1 ? solid->velocity : solid->component[which];
}

static double *any_number(struct climber *climber, struct question *question)
{
    struct solid *solid = any_solid(climber, question);
    return &any_vector(climber, solid)[draw_int(climber->draw, 0, solid->dim - 1)];
}

/* ---- Contact ---- */

/* A point of the solid from its origin: a vertex, or one inside. */
static void draw_point(struct climber *climber, const struct solid *solid, double *point)
{
    const bool vertex = draw_coin(climber->draw);
    const int count = solid_count(solid);
    memset(point, 0, FMB_DIM_MAX * sizeof *point);
    for (int i = 0; i < count; i++) {
        const double x = vertex ? draw_int(climber->draw, 0, 1) : 0.25;
        for (int axis = 0; axis < solid->dim; axis++)
            point[axis] += x * solid->component[i][axis];
        if (x == 1 && solid->shape != FMB_CUBOID)
            break;
    }
}

/* Moves B to where a point of A and one of B coincide at the time, but for rounding. */
static void bring_together(struct climber *climber, struct question *question)
{
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    const double time = question->duration * draw_int(climber->draw, 0, 2) / 2;
    draw_point(climber, &question->a, a);
    draw_point(climber, &question->b, b);
    for (int axis = 0; axis < question->a.dim; axis++) {
        const double way = question->a.moving * question->a.velocity[axis] -
                           question->b.moving * question->b.velocity[axis];
        const double at = question->a.origin[axis] + (a[axis] - b[axis]) + time * way;
        question->b.origin[axis] = isfinite(at) ? at : question->a.origin[axis];
    }
}

/* ---- Steps ---- */

static void draw_shape(struct climber *climber, struct solid *solid)
{
    solid->shape = question_draw_shape(climber->draw, solid->dim);
}

static void begin(struct climber *climber, struct question *out)
{
    struct solid *solids[2] = {&out->a, &out->b};
    double (*number)(struct climber *) = draw_coin(climber->draw) ? draw_number : draw_end;
    memset(out, 0, sizeof *out);
    out->duration = draw_coin(climber->draw) ? 1 : fabs(number(climber));
    const int dim = draw_int(climber->draw, 0, 3) ? 3 : 2;
    for (int f = 0; f < 2; f++) {
        struct solid *solid = solids[f];
        solid->dim = dim;
        solid->moving = draw_coin(climber->draw);
        draw_shape(climber, solid);
        for (int axis = 0; axis < dim; axis++) {
            solid->origin[axis] = number(climber);
            solid->velocity[axis] = number(climber);
            for (int i = 0; i < solid_count(solid); i++)
                solid->component[i][axis] = number(climber);
        }
    }
    bring_together(climber, out);
}

static void nudge(struct climber *climber, double *number)
{
    switch (draw_int(climber->draw, 0, 2)) {
    case 0: *number = ldexp(*number, draw_int(climber->draw, -60, 60)); break;
    case 1: *number = nextafter(*number, draw_coin(climber->draw) ? INFINITY : -INFINITY); break;
    default: *number = -*number; break;
    }
}

static void copy_vector(struct climber *climber, struct question *question)
{
    double *to = any_vector(climber, any_solid(climber, question));
    const double *from = any_vector(climber, any_solid(climber, question));
    memmove(to, from, (size_t) question->a.dim * sizeof *to);
}

/* A frame that is far smaller or larger than the other, as thin as before. */
static void scale_solid(struct climber *climber, struct solid *solid)
{
    const int exponent = draw_int(climber->draw, -1100, 1100);
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < solid->dim; axis++)
            solid->component[i][axis] = ldexp(solid->component[i][axis], exponent);
}

/* Frames whose edges are parallel, and may coincide. */
static void copy_solid(struct question *question)
{
    question->b.shape = question->a.shape;
    memcpy(question->b.component, question->a.component, sizeof question->b.component);
}

static void step(struct climber *climber, struct question *question)
{
    double *number = any_number(climber, question);
    switch (draw_int(climber->draw, 0, 12)) {
    case 0:
    case 1: *number = draw_number(climber); break;
    case 2:
    case 3: *number = draw_end(climber); break;
    case 4: *number = *any_number(climber, question); break;
    case 5:
        *number =
            draw_int(climber->draw, 0, 2) ? ldexp(*number, draw_int(climber->draw, -60, 60)) : 0;
        break;
    case 6: nudge(climber, number); break;
    case 7: copy_vector(climber, question); break;
    case 8:
        question->duration =
            fabs(draw_coin(climber->draw) ? draw_number(climber) : draw_end(climber));
        break;
    case 9: {
        struct solid *solid = any_solid(climber, question);
        if (draw_coin(climber->draw))
            solid->moving = !solid->moving;
        else
            draw_shape(climber, solid);
        break;
    }
    case 10: scale_solid(climber, any_solid(climber, question)); break;
    case 11: copy_solid(question); break;
    default: break;
    }
    if (draw_coin(climber->draw))
        bring_together(climber, question);
}

/* What went beyond the doubles comes back to the last one; components that a shape does not have
 * are 0. */
static void make_legal(struct question *question)
{
    struct solid *solids[2] = {&question->a, &question->b};
    for (int f = 0; f < 2; f++) {
        double *vectors[] = {solids[f]->origin, solids[f]->velocity, solids[f]->component[0],
                             solids[f]->component[1], solids[f]->component[2]};
        for (int v = 0; v < 5; v++)
            for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
                double *number = &vectors[v][axis];
                if (!isfinite(*number))
                    *number = copysign(0x1.fffffffffffffp+1023, *number);
            }
    }
}

double climb(struct climber *climber, int climbs, int steps, struct question *out)
{
    double most = -1;
    for (int c = 0; c < climbs; c++) {
        struct question best;
        begin(climber, &best);
        make_legal(&best);
        double height = climber->cost(&best);
        for (int s = 0; s < steps; s++) {
            struct question next = best;
            for (int changes = draw_int(climber->draw, 1, 3); changes > 0; changes--)
                step(climber, &next);
            make_legal(&next);
            const double other = climber->cost(&next);
            if (other >= height) {
                height = other;
                best = next;
            }
        }
        if (height > most) {
            most = height;
            *out = best;
        }
    }
    return most;
}
