/* Families of turning bodies. Most families draw two bodies with arbitrary turns, move them
 * together along a direction at one time of the window, when their distance is often least, and
 * then move them a little apart or into each other. Bodies that rest, slide, hang, lift off, land
 * or graze have whole numbers, so that nothing rounds. */
#include "turn_family.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "posed.h"

static const double pi = 3.14159265358979323846;

/* ---- Turns ---- */

/* x y, both (w, x, y, z) or, in 2D, (w, z). */
static void multiply(int dim, const double *x, const double *y, double *out)
{
    const double p[4] = {x[0], dim == 2 ? 0 : x[1], dim == 2 ? 0 : x[2], x[dim == 2 ? 1 : 3]};
    const double q[4] = {y[0], dim == 2 ? 0 : y[1], dim == 2 ? 0 : y[2], y[dim == 2 ? 1 : 3]};
    double product[4] = {p[0] * q[0] - vector_dot(p + 1, q + 1)};
    vector_cross(p + 1, q + 1, product + 1);
    vector_add(product + 1, p[0], q + 1);
    vector_add(product + 1, q[0], p + 1);
    out[0] = product[0];
    memcpy(out + 1, dim == 2 ? product + 3 : product + 1, (dim == 2 ? 1 : 3) * sizeof *out);
}

/* Gives the solid an end that is turned by the angle. The quaternion of the end is ratio times as
 * long, and sometimes negated. */
static void turn_by(struct draw *draw, double angle, double ratio, struct solid *solid)
{
    double axis[3] = {0}, turn[4] = {cos(angle / 2)};
    do
        for (int i = 0; i < 3; i++)
            axis[i] = draw_uniform(draw, -1, 1);
    while (vector_length(axis) < 0.1);
    for (int i = 0; i < 3; i++)
        turn[1 + i] = sin(angle / 2) * axis[i] / vector_length(axis);
    if (solid->dim == 2)
        turn[1] = draw_coin(draw) ? sin(angle / 2) : -sin(angle / 2);
    multiply(solid->dim, turn, solid->orientation, solid->end_orientation);
    if (draw_int(draw, 0, 3) == 0)
        ratio = -ratio;
    for (int i = 0; i < solid->orientation_count; i++)
        solid->end_orientation[i] *= ratio;
    solid->ending = true;
}

static double draw_ratio(struct draw *draw)
{
    static const double known[] = {0.25, 4, 0x1.6a09e667f3bccp0, 0.5, 2};
    const int which = draw_int(draw, 0, 5);
    return which < 5 ? known[which] * (which < 2 ? 1 - 0x1p-48 * (which ? 1 : -1) : 1)
                     : exp2(draw_uniform(draw, -1.99, 1.99));
}

static void set_unit(struct solid *solid)
{
    double length = 0;
    for (int i = 0; i < solid->orientation_count; i++)
        length = hypot(length, solid->orientation[i]);
    for (int i = 0; i < solid->orientation_count; i++)
        solid->orientation[i] /= length;
}

void turn_point(const struct solid *solid, double share, const double *vertex, double *out)
{
    const bool end = solid->ending;
    double q[4] = {1}, dot = 0, norm = 0, u[3] = {0}, twice[3];
    for (int i = 0; i < solid->orientation_count && end; i++)
        dot += solid->orientation[i] * solid->end_orientation[i];
    for (int i = 0; i < solid->orientation_count; i++) {
        q[i] = solid->orientation[i];
        if (end)
            q[i] = (1 - share) * q[i] + share * (dot < 0 ? -1 : 1) * solid->end_orientation[i];
        norm += q[i] * q[i];
    }
    memcpy(u, q + 1, solid->dim == 2 ? 0 : sizeof u);
    if (solid->dim == 2)
        u[2] = solid->orientation_count ? q[1] : 0;
    norm = solid->orientation_count ? norm : 1;
    vector_cross(u, vertex, twice); /* v + 2 / norm (w (u x v) + u x (u x v)) */
    double again[3];
    vector_cross(u, twice, again);
    for (int axis = 0; axis < 3; axis++) {
        out[axis] =
            vertex[axis] + 2 / norm * (q[0] * twice[axis] + again[axis]) + solid->origin[axis];
        if (end)
            out[axis] += share * (solid->end_origin[axis] - solid->origin[axis]);
    }
}

/* ---- Bringing together ---- */

/* Returns the greatest sign * n . (a point of the body) at a time. point := a vertex where it is
 * attained, or the midpoint of two such vertices; may be NULL. */
static double farthest(struct draw *draw, const struct solid *solid, double share, const double *n,
                       int sign, double *point)
{
    double most = -HUGE_VAL, last[3], at[3];
    for (int f = 0; f < solid_frames(solid); f++) {
        const struct solid frame = solid_frame(solid, f);
        double vertex[SOLID_VERTICES_MAX][FMB_DIM_MAX] = {{0}};
        const int count = solid_vertices(&frame, vertex);
        for (int v = 0; v < count; v++) {
            turn_point(solid, share, vertex[v], at);
            const double height = sign * vector_dot(n, at);
            const bool level = height > most - 1e-9 && height < most + 1e-9;
            if (point && (height > most || level)) {
                memcpy(last, level ? point : at, sizeof last);
                for (int axis = 0; axis < FMB_DIM_MAX; axis++)
                    point[axis] =
                        level && draw_coin(draw) ? at[axis] / 2 + last[axis] / 2 : at[axis];
            }
            most = fmax(most, height);
        }
    }
    return most;
}

/* The least n . (b - a), less both radii. */
static double along(const struct question *question, double share, const double *n)
{
    return -farthest(NULL, &question->a, share, n, 1, NULL) - question->a.radius -
           farthest(NULL, &question->b, share, n, -1, NULL) - question->b.radius;
}

static void shift(struct question *question, double by, double more, const double *n)
{
    vector_add(question->b.origin, by, n);
    vector_add(question->b.end_origin, by + more, n);
}

/* n := a unit vector: perpendicular to two edges at that time, of capsules to both cores; or
 * random. */
static void draw_normal(struct draw *draw, struct question *question, double share, double *n)
{
    double edge[2][3] = {{0}, {0, 0, 1}}, from[3], to[3], length;
    const bool both_capsules = question->a.vertex_count == 2 && question->b.vertex_count == 2;
    const int who = both_capsules ? 2 : draw_int(draw, 0, 3);
    for (int i = 0; i < (question->a.dim == 2 ? 1 : 2); i++) {
        const struct solid *solid = question_solid(question, who == 2 ? i : who & 1);
        double vertex[SOLID_VERTICES_MAX][FMB_DIM_MAX] = {{0}};
        const int last = solid_vertices(solid, vertex) - 1;
        turn_point(solid, share, vertex[draw_int(draw, 0, last)], from);
        turn_point(solid, share, vertex[draw_int(draw, 0, last)], to);
        memcpy(edge[i], to, sizeof to);
        vector_add(edge[i], -1, from);
    }
    vector_cross(edge[0], edge[1], n);
    while (who == 3 || vector_length(n) == 0) {
        for (int axis = 0; axis < question->a.dim; axis++)
            n[axis] = draw_uniform(draw, -1, 1);
        if ((length = vector_length(n)) > 0.1)
            break;
    }
    length = vector_length(n) * (draw_coin(draw) ? 1 : -1);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] = axis < question->a.dim ? n[axis] / length : 0;
}

/* Moves B so that the bodies have the given distance along some direction at some time of the
 * window. Three times in four, this distance is least or greatest at that time. B gets an end if it
 * has none. */
static void bring_together(struct draw *draw, double distance, struct question *question)
{
    const double share =
        draw_int(draw, 0, 3) == 0 ? draw_int(draw, 0, 1) : draw_uniform(draw, 0.1, 0.9);
    double n[3], step = 1e-5;
    if (!question->b.ending) {
        question->b.ending = true;
        memcpy(question->b.end_orientation, question->b.orientation,
               sizeof question->b.orientation);
    }
    draw_normal(draw, question, share, n);
    if (draw_int(draw, 0, 3) > 0) {
        const double away =
            (along(question, share + step, n) - along(question, share - step, n)) / (2 * step);
        shift(question, away * share, -away, n);
    }
    double from[3], to[3];
    farthest(draw, &question->a, share, n, 1, to);
    farthest(draw, &question->b, share, n, -1, from);
    vector_add(to, -1, from);
    shift(question, 1, 0, to);
    for (int i = 0; i < 2; i++)
        shift(question, distance - along(question, share, n), 0, n);
}

/* ---- Shapes ---- */

static enum fmb_shape draw_kind(struct draw *draw, int dim, unsigned cells)
{
    if (cells & FAMILY_A_HULL)
        return FMB_HULL;
    enum fmb_shape shape;
    do
        shape = (enum fmb_shape) draw_int(draw, FMB_CUBOID, FMB_HULL);
    while (dim == 2 && shape == FMB_FACE);
    return shape;
}

static void begin(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    struct cell shapes = *cell;
    shapes.moving = false;
    for (int side = 0; side < 2; side++)
        shapes.shape[side] = draw_kind(draw, cell->dim, family->cells);
    posed_begin(&shapes, out);
    static const double windows[] = {0.25, 1, 3, 0.1};
    out->duration = windows[draw_int(draw, 0, 3)];
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        posed_draw_shape(draw, 1, solid);
        if (solid->vertex_count > 8)
            solid->vertex_count = 8;
        posed_draw_any(draw, solid);
    }
}

/* ---- Arbitrary turns ---- */

/* amount: the largest turn, in degrees. */
static void anyhow(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    begin(draw, family, cell, out);
    const int who = draw_int(draw, 1, 4); /* B, A, or both */
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        if (draw_coin(draw))
            set_unit(solid);
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] = draw_uniform(draw, -1.5, 1.5);
            solid->end_origin[axis] = draw_uniform(draw, -1.5, 1.5);
        }
        if (who != 1 + side)
            turn_by(draw, draw_uniform(draw, 0, family->amount) * pi / 180,
                    family->features.parallel ? draw_ratio(draw) : 1, solid);
        else
            memset(solid->end_origin, 0, sizeof solid->end_origin);
    }
}

/* Turns of up to 178 degrees, or small ones. */
static const struct family turning = {.amount = 178},
                           unequal = {.amount = 178, .features = {0, 0, true}};

static void any_turn(struct draw *draw, const struct family *family, const struct cell *cell,
                     struct question *out)
{
    struct family kind = draw_coin(draw) ? turning : unequal;
    kind.cells = family->cells;
    kind.amount = draw_int(draw, 0, 3) == 0 ? exp2(draw_uniform(draw, -40, 4)) : kind.amount;
    anyhow(draw, &kind, cell, out);
}

/* amount: the distance, or minus the depth. */
static void near(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    any_turn(draw, family, cell, out);
    bring_together(draw, family->amount, out);
}

static double draw_little(struct draw *draw)
{
    return exp2(draw_uniform(draw, -52, -8)) * (draw_coin(draw) ? 1 : -1);
}

/* amount: the ratio of length to thickness. */
static void thin(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const int axis = draw_int(draw, 0, cell->dim - 1);
        for (int i = 0; i < solid_count(solid); i++)
            if (solid->shape == FMB_BOX ? i == axis : i == 0)
                for (int k = 0; k < 3; k++)
                    solid->component[i][k] /= family->amount;
        for (int v = 0; v < solid->vertex_count; v++)
            solid->vertex[v][axis] /= family->amount;
    }
    bring_together(draw, draw_little(draw), out);
}

static void rows(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    any_turn(draw, family, cell, out);
    out->a.frames = draw_int(draw, 1, (int) family->amount);
    out->b.frames = draw_int(draw, 2, (int) family->amount);
    bring_together(draw, draw_little(draw), out);
}

/* amount: the largest number of vertices. */
static void clouds(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        solid->vertex_count = 0;
        solid->cloud = draw_int(draw, 13, (int) family->amount);
        solid->cloud_seed = draw_bits(draw);
    }
    bring_together(draw, draw_little(draw), out);
}

static void capsules(struct draw *draw, const struct family *family, const struct cell *cell,
                     struct question *out)
{
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        question_solid(out, side)->radius = draw_uniform(draw, 0.01, 1);
        question_solid(out, side)->vertex_count = 2;
    }
    bring_together(draw, draw_little(draw), out);
}

static void round_ones(struct draw *draw, const struct family *family, const struct cell *cell,
                       struct question *out)
{
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        solid->radius = draw_int(draw, 0, 3) == 0 ? 0 : draw_uniform(draw, 0, 1);
        if (solid->shape == FMB_HULL) /* balls and capsules are included */
            solid->vertex_count = draw_int(draw, 1, 3);
    }
    bring_together(draw, draw_little(draw), out);
}

/* amount: the largest exponent. */
static void sizes(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    const int most = (int) family->amount;
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const double length = ldexp(1, draw_int(draw, -300, 300));
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] = draw_log(draw, -most, most);
            solid->end_origin[axis] = solid->ending ? draw_log(draw, -most, most) : 0;
            for (int v = 0; v < solid->vertex_count; v++)
                solid->vertex[v][axis] = draw_log(draw, -most, most);
            for (int i = 0; i < solid_count(solid); i++)
                if (solid->shape != FMB_BOX || i == axis)
                    solid->component[i][axis] = fabs(draw_log(draw, -most, most));
        }
        for (int i = 0; i < 4; i++) {
            solid->orientation[i] *= length;
            solid->end_orientation[i] *= length;
        }
    }
}

/* ---- Whole numbers ---- */

/* Draws a valid turn between two quaternions of whole numbers. */
static void draw_whole_turn(struct draw *draw, int most, struct solid *solid)
{
    double dot, norm[2];
    posed_draw_whole(draw, most, solid);
    do {
        draw_integers(draw, solid->orientation_count, -most, most, solid->end_orientation);
        dot = norm[0] = norm[1] = 0;
        for (int i = 0; i < solid->orientation_count; i++) {
            dot += solid->orientation[i] * solid->end_orientation[i];
            norm[0] += solid->orientation[i] * solid->orientation[i];
            norm[1] += solid->end_orientation[i] * solid->end_orientation[i];
        }
    } while (dot == 0 || norm[1] > 16 * norm[0] || norm[0] > 16 * norm[1]);
    solid->ending = true;
}

static void nudge(struct draw *draw, struct question *out)
{
    double *number[QUESTION_NUMBERS_MAX];
    const int count = question_numbers(out, number);
    double *one = number[draw_int(draw, 0, count - 1)];
    if (*one != 0) /* also sizes: grown or shrunk */
        *one += (draw_coin(draw) ? 1 : -1) * ldexp(1, -draw_int(draw, 20, 44));
}

/* amount: the largest number; features.one 1: one number is changed a little. */
static void whole(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    const int most = (int) family->amount;
    begin(draw, family, cell, out);
    const int who = draw_int(draw, 1, 4);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        memset(solid->component, 0, sizeof solid->component);
        memset(solid->vertex, 0, sizeof solid->vertex);
        memset(solid->orientation, 0, sizeof solid->orientation);
        solid->orientation_count = 0;
        posed_draw_whole_shape(draw, 2, 1, solid);
        if (solid->vertex_count > 8)
            solid->vertex_count = 8;
        if (draw_coin(draw))
            draw_integers(draw, cell->dim, -2, 2, solid->origin);
        if (who == 1 + side)
            continue;
        draw_whole_turn(draw, most, solid);
        memcpy(solid->end_origin, solid->origin, sizeof solid->origin);
        if (draw_int(draw, 0, 3) == 0)
            draw_integers(draw, cell->dim, -2, 2, solid->end_origin);
    }
    if (family->features.one)
        nudge(draw, out);
}

/* Turns both bodies by the same half turn about an axis, or not at all, and moves both by the same
 * vector. Nothing rounds. */
static void carry(struct draw *draw, struct question *out)
{
    const int about = draw_int(draw, 0, 3);
    double by[3] = {0}, half[4] = {0};
    draw_integers(draw, 3, -4, 4, by);
    half[about] = 1;
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        if (solid->orientation_count == 0)
            solid->orientation[0] = 1;
        solid->orientation_count = 4;
        multiply(3, half, solid->orientation, solid->orientation);
        if (solid->ending)
            multiply(3, half, solid->end_orientation, solid->end_orientation);
        for (int axis = 0; axis < 3; axis++) {
            const double sign = about == 0 || axis == about - 1 ? 1 : -1;
            solid->origin[axis] = sign * solid->origin[axis] + by[axis];
            if (solid->ending)
                solid->end_origin[axis] = sign * solid->end_origin[axis] + by[axis];
        }
    }
}

/* Draws a solid with its lowest face at z = 0, whatever its yaw: a box, or one time in four a hull
 * or a tetrahedron. */
static void draw_standing(struct draw *draw, struct solid *solid)
{
    *solid = (struct solid){.dim = 3, .shape = FMB_BOX, .ending = true, .orientation_count = 4};
    for (int i = 0; i < 3; i++)
        solid->component[i][i] = 2 * draw_int(draw, 1, 3);
    if (draw_int(draw, 0, 3) == 0) { /* a hull or a tetrahedron on a face of whole numbers */
        solid->shape = draw_coin(draw) ? FMB_HULL : FMB_TETRAHEDRON;
        solid->vertex_count = solid->shape == FMB_HULL ? 7 : 0;
        for (int v = 0; v < solid->vertex_count; v++) {
            draw_integers(draw, 2, -3, 3, solid->vertex[v]);
            solid->vertex[v][2] = v < 4 ? 0 : draw_int(draw, 0, 3);
        }
    } else {
        solid->local[2] = solid->component[2][2] / 2;
    }
    solid->orientation[0] = draw_int(draw, 1, 9);
    solid->orientation[3] = draw_int(draw, -3, 3);
    solid->end_orientation[0] = draw_int(draw, 5, 9);
    solid->end_orientation[3] = draw_int(draw, -3, 3);
    if (solid->orientation[0] * solid->end_orientation[0] +
                solid->orientation[3] * solid->end_orientation[3] <=
            0 ||
        solid->orientation[0] < 3)
        memcpy(solid->orientation, (double[4]){5, 0, 0, 1}, sizeof solid->orientation);
}

/* A solid on a table; the table may yaw too. amount: the height above the table, in units of 2^-40;
 * features.one 1: the solid lifts off, 2: it lands. */
static void on_table(struct draw *draw, const struct family *family, const struct cell *cell,
                     struct question *out)
{
    (void) cell;
    *out = (struct question){.duration = draw_coin(draw) ? 1 : 3};
    draw_standing(draw, &out->a);
    draw_standing(draw, &out->b);
    draw_integers(draw, 2, -4, 4, out->b.origin);
    draw_integers(draw, 2, -4, 4, out->b.end_origin);
    if (draw_coin(draw)) {
        out->a.ending = false;
        memset(out->a.orientation, 0, sizeof out->a.orientation);
        memset(out->a.end_orientation, 0, sizeof out->a.end_orientation);
        out->a.orientation_count = 0;
    }
    memset(out->a.component, 0, sizeof out->a.component);
    out->a.shape = FMB_BOX;
    out->a.vertex_count = 0;
    out->a.component[0][0] = out->a.component[1][1] = 16;
    out->a.component[2][2] = 2;
    out->a.local[2] = -1;
    out->b.origin[2] = out->b.end_origin[2] = family->amount * 0x1p-40;
    if (family->features.one == 1)
        out->b.end_origin[2] += 0.25;
    if (family->features.one == 2)
        out->b.origin[2] += 0.25;
    carry(draw, out);
}

/* A box that turns about one of its edges. This edge stays on a table or on the edge of a door
 * frame. */
static void on_edge(struct draw *draw, const struct family *family, const struct cell *cell,
                    struct question *out)
{
    (void) cell;
    const bool door = family->features.one == 1;
    *out = (struct question){.duration = 1};
    out->b = (struct solid){.dim = 3, .shape = FMB_CUBOID, .ending = true, .orientation_count = 4};
    for (int i = 0; i < 3; i++)
        out->b.component[i][i] = draw_int(draw, 1, 4);
    out->a = (struct solid){.dim = 3,
                            .shape = FMB_BOX,
                            .component = {{16, 0, 0}, {0, 16, 0}, {0, 0, 2}},
                            .local = {0, 0, -1}};
    if (door) { /* the frame: it ends where the door begins */
        out->a = (struct solid){.dim = 3,
                                .shape = FMB_BOX,
                                .component = {{4, 0, 0}, {0, 2, 0}, {0, 0, 8}},
                                .local = {-2, 1, 0}};
        out->b.local[2] = draw_int(draw, -2, 2);
    }
    out->b.orientation[0] = out->b.end_orientation[0] = 3;
    const double turn[2] = {draw_int(draw, 0, 3), draw_int(draw, 0, 3)};
    out->b.orientation[door ? 3 : 2] = door ? -turn[0] : -turn[0];
    out->b.end_orientation[door ? 3 : 2] = door ? -turn[1] : -turn[1];
    const double off = draw_int(draw, -1, 1) * family->amount * 0x1p-40;
    out->b.origin[door ? 0 : 2] = out->b.end_origin[door ? 0 : 2] = off;
    carry(draw, out);
}

/* Two bodies with the same motion, side by side in body coordinates. */
static void carried(struct draw *draw, const struct family *family, const struct cell *cell,
                    struct question *out)
{
    begin(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        *solid = (struct solid){.dim = cell->dim,
                                .shape = draw_coin(draw) ? FMB_CUBOID : FMB_TETRAHEDRON};
        for (int i = 0; i < cell->dim; i++)
            solid->component[i][i] = draw_int(draw, 1, 3);
        draw_integers(draw, cell->dim, -1, 1, solid->local);
        posed_draw_any(draw, solid);
    }
    out->a.local[0] = 0;
    out->a.component[0][0] *= -1;
    out->b.local[0] = draw_int(draw, -1, 1) * family->amount * 0x1p-40;
    for (int axis = 0; axis < cell->dim; axis++) {
        out->a.origin[axis] = draw_uniform(draw, -3, 3);
        out->a.end_origin[axis] = draw_uniform(draw, -3, 3);
    }
    turn_by(draw, draw_uniform(draw, 0, 3.1), draw_ratio(draw), &out->a);
    memcpy(out->b.origin, out->a.origin, sizeof out->a.origin);
    memcpy(out->b.end_origin, out->a.end_origin, sizeof out->a.end_origin);
    memcpy(out->b.orientation, out->a.orientation, sizeof out->a.orientation);
    memcpy(out->b.end_orientation, out->a.end_orientation, sizeof out->a.end_orientation);
    out->b.ending = true;
}

/* A rod whose corner grazes a ceiling in passing. Half its diagonal is 5/2, by 3-4-5, or
 * irrational. The ceiling may be an ulp lower or higher. */
static void graze(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    (void) family;
    (void) cell;
    const bool whole = draw_coin(draw);
    const double height = whole ? 2.5 : 0x1.6a09e667f3bccp-1;
    *out = (struct question){.duration = 1};
    out->a = (struct solid){.dim = 3,
                            .shape = FMB_BOX,
                            .component = {{16, 0, 0}, {0, 2, 0}, {0, 0, 16}},
                            .local = {0, 1, 0}};
    out->b = (struct solid){.dim = 3,
                            .shape = FMB_BOX,
                            .component = {{whole ? 4 : 1, 0, 0}, {0, whole ? 3 : 1, 0}, {0, 0, 1}},
                            .ending = true,
                            .orientation_count = 4,
                            .orientation = {draw_int(draw, 3, 5)},
                            .end_orientation = {4, 0, 0, draw_int(draw, 3, 4)}};
    out->a.origin[1] = height + draw_int(draw, -1, 1) * (whole ? 0x1p-51 : 0x1p-53);
    if (draw_coin(draw)) { /* the ceiling turns about its normal, so that it stays level */
        out->a.ending = true;
        out->a.orientation_count = 4;
        memcpy(out->a.end_origin, out->a.origin, sizeof out->a.origin);
        out->a.orientation[0] = out->a.end_orientation[0] = 2;
        out->a.end_orientation[2] = 1;
    }
    carry(draw, out);
}

/* ---- Flat ---- */

static void flat(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    whole(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const int left = draw_int(draw, 0, 2);
        solid->shape = draw_coin(draw)              ? FMB_CUBOID
                       : cell->dim == 2 || left > 2 ? FMB_TETRAHEDRON
                                                    : FMB_FACE;
        solid->vertex_count = 0;
        for (int i = left; i < FMB_DIM_MAX; i++)
            memset(solid->component[i], 0, sizeof solid->component[i]);
        for (int i = 0; i < left && solid->component[i][0] == 0; i++)
            solid->component[i][draw_int(draw, 0, 1)] = draw_int(draw, 1, 4);
    }
    if (draw_coin(draw) || cell->dim == 2)
        return;
    for (int side = 0; side < 2; side++) { /* in one plane, except that B may move across it */
        struct solid *solid = question_solid(out, side);
        for (int i = 0; i < 3; i++)
            solid->component[i][2] = 0;
        solid->local[2] = solid->origin[2] = solid->end_origin[2] = 0;
        solid->orientation[1] = solid->orientation[2] = 0;
        solid->end_orientation[1] = solid->end_orientation[2] = 0;
        if (solid->ending)
            solid->orientation[0] = solid->end_orientation[0] = 4;
    }
    if (out->b.ending && draw_coin(draw))
        out->b.origin[2] = draw_int(draw, -1, 1), out->b.end_origin[2] = draw_int(draw, -1, 1);
}

static void flat_near(struct draw *draw, const struct family *family, const struct cell *cell,
                      struct question *out)
{
    any_turn(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const int left = draw_int(draw, 0, 2);
        solid->shape = FMB_CUBOID;
        solid->vertex_count = 0;
        for (int i = 0; i < FMB_DIM_MAX; i++)
            for (int axis = 0; axis < cell->dim; axis++)
                solid->component[i][axis] = i < left ? draw_uniform(draw, -1, 1) : 0;
    }
    bring_together(draw, draw_coin(draw) ? 0 : draw_little(draw), out);
}

/* Ends that do not turn: a velocity gives the same motion. */
static void straight(struct draw *draw, const struct family *family, const struct cell *cell,
                     struct question *out)
{
    whole(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        memcpy(solid->end_orientation, solid->orientation, sizeof solid->orientation);
        if (draw_int(draw, 0, 3) == 0)
            for (int i = 0; i < 4; i++)
                solid->end_orientation[i] *= -2;
    }
}

/* clang-format off */
static const struct family families[] = {
    {"turn-random", "turns up to 178 degrees, one or both", anyhow, .amount = 178},
    {"turn-lengths", "quaternions of unequal lengths", anyhow, .amount = 178, .features = {0, 0, true}},
    {"turn-17", "turns up to 17 degrees", anyhow, .amount = 17},
    {"turn-1e-6", "turns up to a millionth of a degree", anyhow, .amount = 1e-6},
    {"turn-gap-1e-3", "a clearance of 1e-3", near, .amount = 1e-3},
    {"turn-gap-1e-6", "a clearance of 1e-6", near, .amount = 1e-6},
    {"turn-gap-1e-9", "a clearance of 1e-9", near, .amount = 1e-9},
    {"turn-gap-1e-12", "a clearance of 1e-12", near, .amount = 1e-12},
    {"turn-gap-1e-15", "a clearance of 1e-15", near, .amount = 1e-15},
    {"turn-depth-1e-3", "a depth of 1e-3", near, .amount = -1e-3},
    {"turn-depth-1e-6", "a depth of 1e-6", near, .amount = -1e-6},
    {"turn-depth-1e-9", "a depth of 1e-9", near, .amount = -1e-9},
    {"turn-depth-1e-12", "a depth of 1e-12", near, .amount = -1e-12},
    {"turn-depth-1e-15", "a depth of 1e-15", near, .amount = -1e-15},
    {"turn-table", "yaws and slides on a table", on_table, .cells = FAMILY_3D},
    {"turn-table-above", "the same 2^-40 above", on_table, .amount = 1, .cells = FAMILY_3D, .verdict = FMB_SEPARATED},
    {"turn-table-below", "the same 2^-40 below", on_table, .amount = -1, .cells = FAMILY_3D},
    {"turn-lift", "lifts off a table", on_table, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"turn-land", "lands on a table", on_table, .features = {2, 0, false}, .cells = FAMILY_3D},
    {"turn-tumble", "tumbles over an edge on a table", on_edge, .cells = FAMILY_3D, .verdict = FMB_TOUCHING},
    {"turn-tumble-near", "the same, 2^-40 above or below, or exactly", on_edge, .amount = 1, .cells = FAMILY_3D},
    {"turn-door", "a door in its frame", on_edge, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"turn-door-near", "the same, offset by 2^-40 or not at all", on_edge, .amount = 1, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"turn-carried", "two bodies with the same motion, offset by 2^-40 or not at all", carried, .amount = 1},
    {"turn-whole-1", "quaternions of whole numbers up to 1", whole, .amount = 1},
    {"turn-whole-5", "quaternions of whole numbers up to 5", whole, .amount = 5},
    {"turn-whole-off", "whole numbers up to 3, one of them changed a little", whole, .amount = 3, .features = {1, 0, false}},
    {"turn-graze", "grazes a ceiling in passing, exactly or within an ulp", graze, .cells = FAMILY_3D},
    {"turn-flat", "plates, segments and points of whole numbers, in one plane or not", flat, .amount = 3},
    {"turn-flat-near", "the same with any numbers, touching or nearly touching", flat_near},
    {"turn-straight", "ends that do not turn", straight, .amount = 3},
    {"turn-thin-1e3", "plates and needles, aspect 1e3", thin, .amount = 1e3},
    {"turn-thin-1e9", "plates and needles, aspect 1e9", thin, .amount = 1e9},
    {"turn-rows", "bodies of up to 3 frames", rows, .amount = 3},
    {"turn-exponents-60", "numbers from 2^-60 to 2^60", sizes, .amount = 60},
    {"turn-exponents-500", "numbers from 2^-500 to 2^500", sizes, .amount = 500},
    {"turn-hull-8", "hulls of 1 to 8 vertices", near, .amount = 1e-7, .cells = FAMILY_A_HULL},
    {"turn-hull-100", "hulls of 13 to 100 vertices", clouds, .amount = 100, .cells = FAMILY_A_HULL},
    {"turn-round", "balls, capsules and padded shapes", round_ones},
    {"turn-capsule", "capsules that nearly touch", capsules, .cells = FAMILY_A_HULL},
};
/* clang-format on */

const struct family *family_turning_at(size_t index)
{
    return index < sizeof families / sizeof *families ? &families[index] : NULL;
}
