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

/* ---- Poses ---- */

static int orientation_count(const struct solid *solid)
{
    return solid->dim == 2 ? 2 : 4;
}

/* Of any length, components up to 2^200 apart: 0, of few bits or of many. */
static void draw_orientation(struct climber *climber, struct solid *solid)
{
    const int most = draw_int(climber->draw, climber->least + 200, climber->most);
    const int apart = draw_coin(climber->draw) ? 199 : 2;
    solid->orientation_count = orientation_count(solid);
    for (int i = 0; i < solid->orientation_count; i++) {
        const int exponent = draw_coin(climber->draw) ? most : most - apart;
        solid->orientation[i] = draw_int(climber->draw, 0, 7) == 0
                                    ? 0
                                    : ldexp(draw_uniform(climber->draw, 1, 2), exponent);
        if (draw_coin(climber->draw))
            solid->orientation[i] = -solid->orientation[i];
    }
}

static void draw_pose(struct climber *climber, double (*number)(struct climber *),
                      struct solid *solid)
{
    for (int axis = 0; axis < solid->dim; axis++)
        solid->local[axis] = draw_coin(climber->draw) ? number(climber) : 0;
    draw_orientation(climber, solid);
    if (draw_int(climber->draw, 0, 3) == 0)
        solid->shape = FMB_BOX;
}

/* A change to the pose of one of them. */
static void step_pose(struct climber *climber, struct question *question)
{
    struct solid *solid = draw_coin(climber->draw) ? &question->a : &question->b;
    const struct solid *other = solid == &question->a ? &question->b : &question->a;
    double *q = &solid->orientation[draw_int(climber->draw, 0, orientation_count(solid) - 1)];
    const int axis = draw_int(climber->draw, 0, solid->dim - 1);
    switch (draw_int(climber->draw, 0, 8)) {
    case 0: draw_orientation(climber, solid); break;
    case 1: *q = nextafter(*q, draw_coin(climber->draw) ? INFINITY : -INFINITY); break;
    case 2: *q = ldexp(*q, draw_int(climber->draw, -100, 100)); break;
    case 3:
        memcpy(solid->orientation, other->orientation, sizeof solid->orientation);
        solid->orientation_count = other->orientation_count;
        break;
    case 4: solid->shape = draw_coin(climber->draw) ? FMB_BOX : FMB_CUBOID; break;
    case 5: solid->local[axis] = draw_number(climber); break;
    case 6: solid->local[axis] = draw_end(climber); break;
    case 7: solid->by_vertices = !solid->by_vertices; break;
    default: *q = -*q; break;
    }
}

/* The matrix of fmb.h times a vector, in doubles. */
static void turn(const struct solid *solid, double *vector)
{
    const double *p = solid->orientation;
    double q[4], most = 0;
    for (int i = 0; i < 4; i++)
        most = fmax(most, fabs(p[i]));
    if (solid->orientation_count == 0 || most == 0)
        return;
    for (int i = 0; i < 4; i++)
        q[i] = p[i] / most;
    const bool plane = solid->orientation_count == 2;
    const double w = q[0], x = plane ? 0 : q[1], y = plane ? 0 : q[2], z = plane ? q[1] : q[3];
    const double n = w * w + x * x + y * y + z * z, v[3] = {vector[0], vector[1], vector[2]};
    vector[0] = ((w * w + x * x - y * y - z * z) / n) * v[0] + (2 * (x * y - w * z) / n) * v[1] +
                (2 * (x * z + w * y) / n) * v[2];
    vector[1] = (2 * (x * y + w * z) / n) * v[0] + ((w * w - x * x + y * y - z * z) / n) * v[1] +
                (2 * (y * z - w * x) / n) * v[2];
    vector[2] = (2 * (x * z - w * y) / n) * v[0] + (2 * (y * z + w * x) / n) * v[1] +
                ((w * w - x * x - y * y + z * z) / n) * v[2];
}

/* ---- Contact ---- */

/* A point of the solid from its position: a vertex, or one inside. */
static void draw_point(struct climber *climber, const struct solid *solid, double *point)
{
    const bool vertex = draw_coin(climber->draw);
    const int count = solid_count(solid);
    memset(point, 0, FMB_DIM_MAX * sizeof *point);
    for (int i = 0; i < count; i++) {
        const double x = vertex ? draw_int(climber->draw, 0, 1) : 0.25;
        for (int axis = 0; axis < solid->dim; axis++)
            point[axis] +=
                x * (solid->component[i][axis] - (solid->by_vertices ? solid->local[axis] : 0));
        if (x == 1 && solid->shape != FMB_CUBOID && solid->shape != FMB_BOX)
            break;
    }
    for (int axis = 0; axis < solid->dim; axis++)
        point[axis] +=
            solid->local[axis] - (solid->shape == FMB_BOX ? 0.5 * solid->component[axis][axis] : 0);
    turn(solid, point);
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
        if (climber->posed)
            draw_pose(climber, number, solid);
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
    if (climber->posed && draw_int(climber->draw, 0, 2) == 0)
        step_pose(climber, question);
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

/* A box has a size along the axes, not negative. */
static void make_legal_box(struct solid *solid)
{
    for (int i = 0; i < FMB_DIM_MAX && solid->shape == FMB_BOX; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            solid->component[i][axis] = i == axis ? fabs(solid->component[i][axis]) : 0;
}

/* Only a simplex has vertices, and their differences are doubles or rounded to one. */
static void make_legal_vertices(struct solid *solid)
{
    if (solid->shape != FMB_TETRAHEDRON && solid->shape != FMB_FACE)
        solid->by_vertices = false;
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < solid->dim; axis++)
            if (!isfinite(solid->component[i][axis] - solid->local[axis]))
                solid->by_vertices = false;
}

/* An orientation that is none goes. */
static void make_legal_orientation(struct solid *solid)
{
    struct fmb_body body = {.dim = solid->dim, .frame_count = 1};
    const struct fmb_placement placement = solid_placement(solid, &body);
    if (fmb_placement_check(&placement) == FMB_OK)
        return;
    memset(solid->orientation, 0, sizeof solid->orientation);
    solid->orientation_count = 0;
}

/* What went beyond the doubles comes back to the last one. */
static void make_legal(struct question *question)
{
    struct solid *solids[2] = {&question->a, &question->b};
    for (int f = 0; f < 2; f++) {
        double *vectors[] = {solids[f]->origin,       solids[f]->velocity,
                             solids[f]->component[0], solids[f]->component[1],
                             solids[f]->component[2], solids[f]->local};
        for (int v = 0; v < 6; v++)
            for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
                double *number = &vectors[v][axis];
                if (!isfinite(*number))
                    *number = copysign(0x1.fffffffffffffp+1023, *number);
            }
        make_legal_box(solids[f]);
        make_legal_vertices(solids[f]);
        make_legal_orientation(solids[f]);
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
