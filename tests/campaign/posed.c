/* Families of placed bodies. Most are made the same way: a direction is chosen, and B is put where
 * one of its points farthest against the direction meets one of A farthest along it. In doubles
 * that is a contact but for rounding. With whole-number quaternions, and body coordinates that are
 * whole multiples of their squared lengths, nothing rounds: the plane through the contact separates
 * the interiors, so they touch. */
#include "posed.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solids.h"

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* ---- Orientations ---- */

/* The matrix of fmb.h without its divisor. Returns that; 1 for no orientation. */
static double matrix_of(const struct solid *solid, double m[3][3])
{
    const double *q = solid->orientation;
    const bool turned = solid->orientation_count != 0, plane = solid->orientation_count == 2;
    const double w = turned ? q[0] : 1, x = plane ? 0 : q[1], y = plane ? 0 : q[2],
                 z = plane ? q[1] : q[3];
    const double rows[3][3] = {
        {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    memcpy(m, rows, sizeof rows);
    return w * w + x * x + y * y + z * z;
}

static double norm_of(const struct solid *solid)
{
    double m[3][3];
    return matrix_of(solid, m);
}

static void turn(const struct solid *solid, const double *vector, double *out)
{
    double m[3][3];
    const double norm = matrix_of(solid, m);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = vector_dot(m[axis], vector) / norm;
}

static void set_count(struct solid *solid)
{
    solid->orientation_count = solid->dim == 2 ? 2 : 4;
}

void posed_draw_any(struct draw *draw, struct solid *solid)
{
    set_count(solid);
    for (int i = 0; i < solid->orientation_count; i++)
        solid->orientation[i] = draw_uniform(draw, -1, 1);
}

void posed_draw_whole(struct draw *draw, int most, struct solid *solid)
{
    set_count(solid);
    do
        draw_integers(draw, solid->orientation_count, -most, most, solid->orientation);
    while (norm_of(solid) == 0);
}

static void scale_orientation(double factor, struct solid *solid)
{
    for (int i = 0; i < solid->orientation_count; i++)
        solid->orientation[i] *= factor;
}

/* ---- Solids ---- */

void posed_begin(const struct cell *cell, struct question *out)
{
    *out = (struct question){.duration = 1};
    for (int side = 0; side < 2; side++)
        *question_solid(out, side) =
            (struct solid){.dim = cell->dim, .shape = cell->shape[side], .moving = cell->moving};
}

/* Uniform, or where there is a unit whole multiples of it. */
static double draw_number(struct draw *draw, double most, double unit)
{
    return unit == 0 ? draw_uniform(draw, -most, most)
                     : unit * draw_int(draw, -(int) most, (int) most);
}

/* Of few or many vertices; one hull in four has some that are middles of others, or repeat them. */
static void draw_vertices(struct draw *draw, double most, double unit, struct solid *solid)
{
    const bool redundant = draw_int(draw, 0, 3) == 0;
    solid->vertex_count = draw_int(draw, draw_coin(draw) ? solid->dim + 1 : 1, SOLID_LISTED_MAX);
    for (int v = 0; v < solid->vertex_count; v++) {
        double *vertex = solid->vertex[v];
        const bool middle = v > 0 && redundant && draw_coin(draw);
        for (int part = 0; part < 2 && middle; part++)
            vector_add(vertex, 0.5, solid->vertex[draw_int(draw, 0, v - 1)]);
        for (int axis = 0; axis < solid->dim && !middle; axis++)
            vertex[axis] = draw_number(draw, most, unit);
    }
}

/* The size of a box is positive, and in whole numbers even. The components of a hull are the steps
 * of a row of frames. */
static void draw_shape(struct draw *draw, double most, double unit, struct solid *solid)
{
    const bool box = solid->shape == FMB_BOX;
    if (solid->shape == FMB_HULL)
        draw_vertices(draw, most, unit, solid);
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->local[axis] = draw_number(draw, most, unit);
        for (int i = 0; i < solid_count(solid); i++)
            if (!box)
                solid->component[i][axis] = draw_number(draw, most, unit);
            else if (axis == i)
                solid->component[i][axis] = unit == 0 ? draw_uniform(draw, 0, most)
                                                      : unit * 2 * draw_int(draw, 1, (int) most);
    }
}

void posed_draw_shape(struct draw *draw, double most, struct solid *solid)
{
    draw_shape(draw, most, 0, solid);
}

void posed_draw_whole_shape(struct draw *draw, int most, double unit, struct solid *solid)
{
    draw_shape(draw, most, unit, solid);
}

void posed_draw_velocities(struct draw *draw, bool whole, struct question *question)
{
    static const double windows[] = {0.25, 0.5, 1, 1, 2, 4};
    if (!question->a.moving)
        return;
    question->duration = windows[draw_int(draw, 0, COUNT(windows) - 1)];
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < question->a.dim; axis++)
            question_solid(question, side)->velocity[axis] =
                whole ? draw_int(draw, -3, 3) : draw_uniform(draw, -100, 100);
}

/* ---- Contact ---- */

/* Rows of frames have no clouds. */
enum { POINTS_MAX = SOLID_VERTICES_MAX };

/* The vertices of a body, turned, from its position. */
struct points {
    int count;
    double at[POINTS_MAX][FMB_DIM_MAX];
};

static void points_of(const struct solid *solid, struct points *out)
{
    out->count = 0;
    for (int f = 0; f < solid_frames(solid); f++) {
        const struct solid frame = solid_frame(solid, f);
        double vertex[SOLID_VERTICES_MAX][FMB_DIM_MAX] = {{0}};
        const int count = solid_vertices(&frame, vertex);
        for (int v = 0; v < count; v++)
            turn(solid, vertex[v], out->at[out->count++]);
    }
}

static double greatest(const double *vector)
{
    return fmax(fabs(vector[0]), fmax(fabs(vector[1]), fabs(vector[2])));
}

static double size_of(const struct points *points)
{
    double size = 0;
    for (int v = 0; v < points->count; v++)
        size = fmax(size, greatest(points->at[v]));
    return size;
}

/* One of the points farthest along sign * direction, or the middle of two or four of them. Returns
 * whether there are others. */
static bool farthest(struct draw *draw, const struct points *points, const double *direction,
                     int sign, double *out)
{
    int found[POINTS_MAX], count = 0;
    double most = -HUGE_VAL;
    for (int v = 0; v < points->count; v++) {
        const double at = sign * vector_dot(direction, points->at[v]);
        if (at > most)
            count = 0;
        if (at >= most)
            found[count++] = v;
        most = fmax(most, at);
    }
    const int parts = 1 << draw_int(draw, 0, 2);
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    for (int i = 0; i < parts && count > 0; i++)
        vector_add(out, 1.0 / parts, points->at[found[draw_int(draw, 0, count - 1)]]);
    return count < points->count;
}

static void draw_edge(struct draw *draw, const struct solid *solid, double *out)
{
    const int count = solid_count(solid), i = draw_int(draw, 0, count - 1);
    double edge[FMB_DIM_MAX];
    if (solid->shape == FMB_HULL) {
        double vertex[SOLID_VERTICES_MAX][FMB_DIM_MAX] = {{0}};
        const int last = solid_vertices(solid, vertex) - 1;
        memcpy(edge, vertex[draw_int(draw, 0, last)], sizeof edge);
        vector_add(edge, -1, vertex[draw_int(draw, 0, last)]);
        turn(solid, edge, out);
        return;
    }
    memcpy(edge, solid->component[i], sizeof edge);
    if ((solid->shape == FMB_TETRAHEDRON || solid->shape == FMB_FACE) && draw_coin(draw))
        vector_add(edge, -1, solid->component[(i + 1) % count]);
    turn(solid, edge, out);
}

static double common_divisor(double x, double y)
{
    while (y != 0) {
        const double rest = fmod(x, y);
        x = y;
        y = rest;
    }
    return x;
}

/* Divides a whole vector by its greatest divisor. */
static void shorten(double *vector)
{
    const double divisor =
        common_divisor(fabs(vector[0]), common_divisor(fabs(vector[1]), fabs(vector[2])));
    for (int axis = 0; axis < 3 && divisor > 0; axis++)
        vector[axis] /= divisor;
}

/* A normal of two edges, of one body or one of each; or any small vector. Where whole, products
 * with points up to the size do not round. */
static void draw_direction(struct draw *draw, const struct question *question, bool whole,
                           double size, double *out)
{
    double edge[2][FMB_DIM_MAX] = {{0}, {0, 0, 1}};
    const int dim = question->a.dim, who = draw_int(draw, 0, 2);
    draw_edge(draw, who == 0 ? &question->b : &question->a, edge[0]);
    if (dim == 3)
        draw_edge(draw, who == 1 ? &question->a : &question->b, edge[1]);
    const bool exact = greatest(edge[0]) * greatest(edge[1]) < 0x1p52;
    vector_cross(edge[0], edge[1], out);
    if (whole && exact)
        shorten(out);
    if (draw_int(draw, 0, 3) > 0 && greatest(out) > 0 &&
        (!whole || (exact && greatest(out) * size < 0x1p51)))
        return;
    do
        draw_integers(draw, dim, -3, 3, out);
    while (greatest(out) == 0);
}

/* When they are brought together: such that they do not overlap before or after. */
static double draw_time(struct draw *draw, bool whole, const struct question *question,
                        const double *direction)
{
    const double time = question->duration * draw_int(draw, 0, 2) / 2;
    const double away =
        vector_dot(direction, question->b.velocity) - vector_dot(direction, question->a.velocity);
    if (!whole || away == 0)
        return time;
    return away > 0 ? 0 : question->duration;
}

/* Gives B the position in which its points a and b, farthest along a direction, meet. whole:
 * nothing rounds. */
static void put_together(struct draw *draw, bool whole, const double *a, const double *b,
                         const double *direction, struct question *question)
{
    const double time = draw_time(draw, whole, question, direction);
    for (int axis = 0; axis < question->a.dim; axis++)
        question->b.origin[axis] = question->a.origin[axis] + (a[axis] - b[axis]) +
                                   time * (question->a.velocity[axis] - question->b.velocity[axis]);
}

/* Gives B its position. direction: from A to B, of the plane between them. whole: nothing rounds,
 * and they touch. Returns whether one of the bodies is not all in that plane: two points, and
 * segments on one line, are whatever is tried. */
static bool bring_together(struct draw *draw, bool whole, struct question *question,
                           double *direction)
{
    struct points of_a, of_b;
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    bool thick = false;
    points_of(&question->a, &of_a);
    points_of(&question->b, &of_b);
    for (int tries = 0; !thick && tries < 100; tries++) {
        draw_direction(draw, question, whole, fmax(size_of(&of_a), size_of(&of_b)), direction);
        const bool thick_a = farthest(draw, &of_a, direction, +1, a);
        thick = farthest(draw, &of_b, direction, -1, b) || thick_a;
    }
    put_together(draw, whole, a, b, direction, question);
    return thick;
}

/* Leaves B where it is, moves it by ulps, or by 1e-3 to 1e-16 of the size, away from A or into it.
 */
static void disturb(struct draw *draw, const double *direction, double size,
                    struct question *question)
{
    static const double little[] = {1e-3,  1e-4,  1e-5,  1e-6,  1e-7,  1e-8,  1e-9,
                                    1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16};
    const double way = little[draw_int(draw, 0, COUNT(little) - 1)] * size;
    const double sign = draw_coin(draw) ? 1 : -1;
    const int ulps = draw_int(draw, 1, 3), axis = draw_int(draw, 0, question->a.dim - 1);
    double *position = question->b.origin;
    switch (draw_int(draw, 0, 3)) {
    case 0: break;
    case 1:
        for (int n = 0; n < ulps; n++)
            position[axis] = nextafter(position[axis], sign * HUGE_VAL);
        break;
    default: vector_add(position, sign * way / vector_length(direction), direction); break;
    }
}

/* ---- Families ---- */

static void draw_position(struct draw *draw, double far, struct question *question)
{
    for (int axis = 0; axis < question->a.dim; axis++)
        question->a.origin[axis] = draw_uniform(draw, -100, 100) + far * draw_uniform(draw, -3, 3);
}

void posed_meet_nearly(struct draw *draw, double size, struct question *question)
{
    double direction[FMB_DIM_MAX];
    bring_together(draw, false, question, direction);
    disturb(draw, direction, size, question);
}

void posed_draw_direction(struct draw *draw, const struct question *question, double *direction)
{
    struct points of_a, of_b;
    points_of(&question->a, &of_a);
    points_of(&question->b, &of_b);
    draw_direction(draw, question, true, fmax(size_of(&of_a), size_of(&of_b)), direction);
}

void posed_meet_exactly(struct draw *draw, const double *direction, struct question *question)
{
    struct points points;
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    points_of(&question->a, &points);
    farthest(draw, &points, direction, +1, a);
    points_of(&question->b, &points);
    farthest(draw, &points, direction, -1, b);
    put_together(draw, true, a, b, direction, question);
}

double posed_norm(const struct solid *solid)
{
    return norm_of(solid);
}

/* Solids that have their orientation get all else, and meet but for rounding and a little. */
static void meet_nearly_posed(struct draw *draw, double far, struct question *out)
{
    posed_draw_shape(draw, 100, &out->a);
    posed_draw_shape(draw, 100, &out->b);
    posed_draw_velocities(draw, false, out);
    draw_position(draw, far, out);
    posed_meet_nearly(draw, 100, out);
}

/* Solids that have a whole orientation get all else, and touch. */
static void meet_exactly_posed(struct draw *draw, double far, struct question *out)
{
    static const int mosts[] = {1, 3, 9};
    double direction[FMB_DIM_MAX];
    const int most = mosts[draw_int(draw, 0, COUNT(mosts) - 1)];
    posed_draw_velocities(draw, true, out);
    for (int axis = 0; axis < out->a.dim; axis++)
        out->a.origin[axis] = draw_int(draw, -100, 100) + far * draw_int(draw, -3, 3);
    do {
        posed_draw_whole_shape(draw, most, norm_of(&out->a), &out->a);
        posed_draw_whole_shape(draw, most, norm_of(&out->b), &out->b);
    } while (!bring_together(draw, true, out, direction));
}

static void random_poses(struct draw *draw, const struct family *family, const struct cell *cell,
                         struct question *out)
{
    (void) family;
    family_draw_posed(draw, cell, out);
}

/* In any poses, nearly touching. */
static void draw_near(struct draw *draw, double amount, struct question *out)
{
    posed_draw_any(draw, &out->a);
    posed_draw_any(draw, &out->b);
    meet_nearly_posed(draw, amount, out);
}

/* Turned by whole numbers up to most. */
static void draw_exact(struct draw *draw, int most, double amount, struct question *out)
{
    posed_draw_whole(draw, most, &out->a);
    posed_draw_whole(draw, most, &out->b);
    meet_exactly_posed(draw, amount, out);
}

static void near_poses(struct draw *draw, const struct family *family, const struct cell *cell,
                       struct question *out)
{
    posed_begin(cell, out);
    draw_near(draw, family->amount, out);
}

/* Quaternions of whole numbers up to the amount. */
static void whole(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    posed_begin(cell, out);
    draw_exact(draw, (int) family->amount, 0, out);
}

static void whole_but_an_ulp(struct draw *draw, const struct family *family,
                             const struct cell *cell, struct question *out)
{
    whole(draw, family, cell, out);
    double *position = &out->b.origin[draw_int(draw, 0, cell->dim - 1)];
    *position = nextafter(*position, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
}

/* Shapes of any whole numbers: world coordinates are fractions. */
static void fractions(struct draw *draw, const struct family *family, const struct cell *cell,
                      struct question *out)
{
    double direction[FMB_DIM_MAX];
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        posed_draw_whole(draw, (int) family->amount, question_solid(out, side));
        posed_draw_whole_shape(draw, 9, 1, question_solid(out, side));
    }
    posed_draw_velocities(draw, true, out);
    draw_integers(draw, cell->dim, -9, 9, out->a.origin);
    bring_together(draw, false, out, direction);
    if (draw_coin(draw))
        disturb(draw, direction, 9, out);
}

/* Quarter turns in doubles: equal components that are no whole numbers are exact, those of cosine
 * and sine are not equal. */
static void quarters_of_libm(struct draw *draw, const struct family *family,
                             const struct cell *cell, struct question *out)
{
    static const double cosine = 0x1.6a09e667f3bcdp-1, sine = 0x1.6a09e667f3bccp-1;
    (void) family;
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        set_count(solid);
        solid->orientation[0] = 1;
        solid->orientation[draw_int(draw, 1, solid->orientation_count - 1)] =
            draw_coin(draw) ? 1 : -1;
    }
    meet_exactly_posed(draw, 0, out);
    for (int side = 0; side < 2; side++) {
        double *q = question_solid(out, side)->orientation;
        for (int i = 1; i < 4; i++)
            q[i] *= sine;
        q[0] *= cosine;
    }
}

/* They touch in body coordinates that they share: any orientation, any position. */
static void shared_pose(struct draw *draw, const struct family *family, const struct cell *cell,
                        struct question *out)
{
    struct solid *a = &out->a, *b = &out->b;
    posed_begin(cell, out);
    a->moving = b->moving = false;
    a->frames = b->frames = (int) family->amount;
    meet_exactly_posed(draw, 0, out);
    vector_add(a->local, 1, a->origin);
    vector_add(b->local, 1, b->origin);
    posed_draw_any(draw, a);
    draw_position(draw, 0, out);
    for (int axis = 0; axis < cell->dim; axis++)
        a->velocity[axis] = draw_uniform(draw, -100, 100);
    memcpy(b->orientation, a->orientation, sizeof b->orientation);
    memcpy(b->origin, a->origin, sizeof b->origin);
    memcpy(b->velocity, a->velocity, sizeof b->velocity);
    b->orientation_count = a->orientation_count;
    a->moving = b->moving = cell->moving;
}

/* One orientation for both, or nearly: they differ by the amount, or by less. */
static void stacked(struct draw *draw, const struct family *family, const struct cell *cell,
                    struct question *out)
{
    posed_begin(cell, out);
    posed_draw_any(draw, &out->a);
    out->b.orientation_count = out->a.orientation_count;
    for (int i = 0; i < out->a.orientation_count; i++)
        out->b.orientation[i] = out->a.orientation[i] + family->amount * draw_uniform(draw, -1, 1);
    meet_nearly_posed(draw, 0, out);
}

static void an_ulp_apart(struct draw *draw, const struct family *family, const struct cell *cell,
                         struct question *out)
{
    stacked(draw, family, cell, out);
    double *q = &out->b.orientation[draw_int(draw, 0, out->b.orientation_count - 1)];
    *q = nextafter(*q, draw_coin(draw) ? 2 : -2);
}

/* Lengths that are no powers of two turn by another angle, or by the same but for rounding. */
static void of_any_length(struct draw *draw, const struct family *family, const struct cell *cell,
                          struct question *out)
{
    posed_begin(cell, out);
    if (draw_coin(draw)) {
        draw_exact(draw, 3, 0, out);
    } else {
        draw_near(draw, 0, out);
    }
    const int most = (int) family->amount;
    scale_orientation(draw_log(draw, -most, most), &out->a);
    scale_orientation(ldexp(1, draw_int(draw, -most, most)), &out->b);
}

static void far_poses(struct draw *draw, const struct family *family, const struct cell *cell,
                      struct question *out)
{
    posed_begin(cell, out);
    if (draw_coin(draw)) {
        draw_exact(draw, 3, family->amount, out);
    } else {
        draw_near(draw, family->amount, out);
    }
}

/* Bodies of several frames that share faces; one of them may have a single frame. */
static void rows(struct draw *draw, const struct family *family, const struct cell *cell,
                 struct question *out)
{
    posed_begin(cell, out);
    out->a.frames = draw_int(draw, 2, (int) family->amount);
    out->b.frames = draw_int(draw, 1, (int) family->amount);
    if (draw_coin(draw)) {
        draw_exact(draw, 3, 0, out);
    } else {
        draw_near(draw, 0, out);
    }
}

/* By vertices of one cloud, as those of a mesh, in one pose: they share as many as it happens. */
static void shared_vertices(struct draw *draw, const struct family *family, const struct cell *cell,
                            struct question *out)
{
    enum { CLOUD = 6 };
    double cloud[CLOUD][FMB_DIM_MAX] = {{0}};
    (void) family;
    posed_begin(cell, out);
    for (int i = 0; i < CLOUD; i++)
        for (int axis = 0; axis < cell->dim; axis++)
            cloud[i][axis] = 50 + draw_uniform(draw, -100, 100);
    posed_draw_any(draw, &out->a);
    draw_position(draw, 0, out);
    posed_draw_velocities(draw, false, out);
    memcpy(out->b.orientation, out->a.orientation, sizeof out->b.orientation);
    memcpy(out->b.origin, out->a.origin, sizeof out->b.origin);
    memcpy(out->b.velocity, out->a.velocity, sizeof out->b.velocity);
    out->b.orientation_count = out->a.orientation_count;
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        const int first = draw_int(draw, 0, CLOUD - 1);
        solid->by_vertices = true;
        memcpy(solid->local, cloud[first], sizeof solid->local);
        for (int i = 0; i < solid_count(solid); i++)
            memcpy(solid->component[i], cloud[(first + 1 + i) % CLOUD], sizeof solid->local);
    }
}

/* The top in the plane z = 0, 4 wide and more on all sides. */
static void set_table(struct draw *draw, struct solid *table)
{
    const double thick = draw_uniform(draw, 0.01, 1);
    const bool box = table->shape == FMB_BOX;
    const double wide = table->shape == FMB_CUBOID || box ? 8 : 16;
    for (int axis = 0; axis < 2; axis++) {
        table->component[axis][axis] = wide;
        table->local[axis] = box ? 0 : -4;
    }
    table->component[2][2] = table->shape == FMB_FACE ? 0 : box ? thick : -thick;
    table->local[2] = box ? -0.5 * thick : 0;
}

/* Stands on z = 0, no higher and wider than 1: only face to face where it is no upright face. */
static void set_standing(struct draw *draw, struct solid *solid)
{
    const double edge = draw_uniform(draw, 0.1, 1);
    for (int i = 0; i < 3; i++)
        solid->component[i][i] =
            solid->shape == FMB_BOX || draw_coin(draw) ? edge : draw_uniform(draw, 0.1, 1);
    if (solid->shape == FMB_BOX)
        solid->origin[2] = 0.5 * edge;
    if (solid->shape != FMB_FACE)
        return;
    memcpy(solid->component[1], solid->component[2], sizeof solid->component[1]);
    memset(solid->component[2], 0, sizeof solid->component[2]);
}

/* At rest on a table, turned by any yaw; cubes rolled by quarters before: the product of the
 * quaternions does not round. */
static void yaw_on_table(struct draw *draw, const struct family *family, const struct cell *cell,
                         struct question *out)
{
    static const double rolls[4][2] = {{1, 0}, {1, 1}, {0, 1}, {1, -1}};
    (void) family;
    posed_begin(cell, out);
    const double *roll = rolls[cell->shape[1] == FMB_BOX ? draw_int(draw, 0, 3) : 0];
    const double w = draw_uniform(draw, -1, 1), z = draw_uniform(draw, -1, 1);
    set_table(draw, &out->a);
    set_standing(draw, &out->b);
    set_count(&out->b);
    for (int i = 0; i < 2; i++) {
        out->b.orientation[i] = w * roll[i];
        out->b.orientation[3 - i] = z * roll[i];
        out->b.origin[i] = draw_uniform(draw, -1, 1);
    }
    for (int axis = 0; axis < 2 && cell->moving; axis++) {
        out->a.velocity[axis] = draw_uniform(draw, -1, 1);
        out->b.velocity[axis] = draw_uniform(draw, -1, 1);
    }
    out->a.velocity[2] = out->b.velocity[2] = draw_uniform(draw, -1, 1);
}

/* At rest on a table as contact solvers leave it: with a slight tilt, and sunk in farther than the
 * tilt lifts any edge, which is at most 2 sqrt(2) tilt times sqrt(2). */
static void sunk_in_table(struct draw *draw, const struct family *family, const struct cell *cell,
                          struct question *out)
{
    yaw_on_table(draw, family, cell, out);
    double *q = out->b.orientation;
    const double tilt = exp2(-draw_uniform(draw, 6, 40)), yaw = draw_uniform(draw, -3, 3);
    q[0] = cos(yaw);
    q[1] = draw_uniform(draw, -tilt, tilt);
    q[2] = draw_uniform(draw, -tilt, tilt);
    q[3] = sin(yaw);
    out->b.origin[2] -= draw_uniform(draw, 5, 9) * tilt;
}

/* Some numbers near the largest double, so that vertices and gaps are beyond it. */
static void beyond_doubles(struct draw *draw, const struct family *family, const struct cell *cell,
                           struct question *out)
{
    const double large = DBL_MAX / 128;
    random_poses(draw, family, cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] *= draw_coin(draw) ? large : 1;
            solid->local[axis] *= draw_coin(draw) ? large : 1;
            solid->velocity[axis] *= draw_coin(draw) ? large : 1;
            solid->component[axis][axis] *= draw_coin(draw) ? large : 1;
            for (int v = 0; v < solid->vertex_count; v++)
                solid->vertex[v][axis] *= draw_coin(draw) ? large : 1;
        }
    }
}

/* clang-format off */
static const struct family families[] = {
    {"pose-random", "uniform numbers and quaternions", random_poses, .cells = FAMILY_POSED},
    {"pose-near", "any poses, touching or nearly", near_poses, .cells = FAMILY_POSED},
    {"pose-far-1e12", "any poses, touching or nearly, 1e12 from the origin", far_poses,
     .amount = 0x1p40, .cells = FAMILY_POSED},
    {"pose-whole-3", "quaternions of whole numbers up to 3, touching", whole,
     .amount = 3, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"pose-whole-255", "quaternions of whole numbers of 8 bits, touching", whole,
     .amount = 255, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"pose-whole-ulp", "quaternions of whole numbers, touching but for an ulp", whole_but_an_ulp,
     .amount = 3, .cells = FAMILY_POSED},
    {"pose-fractions", "quaternions and shapes of whole numbers, touching or nearly", fractions,
     .amount = 9, .cells = FAMILY_POSED},
    {"pose-turns", "quarter, half and third turns, touching", whole,
     .amount = 1, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"pose-turns-libm", "quarter turns as sin() and cos() give them, nearly touching",
     quarters_of_libm, .cells = FAMILY_POSED},
    {"pose-shared", "one pose for both, touching in body coordinates", shared_pose,
     .amount = 1, .cells = FAMILY_POSED, .verdict = FMB_TOUCHING},
    {"pose-stacked", "one orientation for both, touching or nearly", stacked,
     .cells = FAMILY_POSED},
    {"pose-apart-1e-3", "orientations 1e-3 apart, touching or nearly", stacked,
     .amount = 1e-3, .cells = FAMILY_POSED},
    {"pose-apart-1e-6", "orientations 1e-6 apart, touching or nearly", stacked,
     .amount = 1e-6, .cells = FAMILY_POSED},
    {"pose-apart-1e-9", "orientations 1e-9 apart, touching or nearly", stacked,
     .amount = 1e-9, .cells = FAMILY_POSED},
    {"pose-apart-1e-12", "orientations 1e-12 apart, touching or nearly", stacked,
     .amount = 1e-12, .cells = FAMILY_POSED},
    {"pose-apart-ulp", "orientations an ulp of a component apart, touching or nearly", an_ulp_apart,
     .cells = FAMILY_POSED},
    {"pose-length", "quaternions of lengths from 1e-150 to 1e150", of_any_length,
     .amount = 498, .cells = FAMILY_POSED},
    {"pose-beyond", "vertices and gaps beyond the largest double", beyond_doubles,
     .cells = FAMILY_POSED},
    {"pose-frames", "bodies of up to 3 frames that share faces, touching or nearly", rows,
     .amount = 3, .cells = FAMILY_POSED},
    {"pose-frames-shared", "bodies of 2 frames, one pose for both, touching", shared_pose,
     .amount = 2, .cells = FAMILY_POSED},
    {"pose-vertices", "simplices by vertices that they share, one pose for both", shared_vertices,
     .cells = FAMILY_POSED | FAMILY_SIMPLICES},
    {"pose-yaw", "at rest on a table, by any yaw", yaw_on_table,
     .cells = FAMILY_POSED | FAMILY_3D, .verdict = FMB_TOUCHING},
    {"pose-sunk", "at rest on a table, sunk in, with a slight tilt", sunk_in_table,
     .cells = FAMILY_POSED | FAMILY_3D, .verdict = FMB_OVERLAPPING},

    {"hull-random", "hulls of 1 to 12 uniform vertices in any poses", random_poses,
     .cells = FAMILY_A_HULL},
    {"hull-near", "any poses, touching or nearly", near_poses, .cells = FAMILY_A_HULL},
    {"hull-far-1e12", "any poses, touching or nearly, 1e12 from the origin", far_poses,
     .amount = 0x1p40, .cells = FAMILY_A_HULL},
    {"hull-whole-3", "quaternions of whole numbers up to 3, touching", whole,
     .amount = 3, .cells = FAMILY_A_HULL, .verdict = FMB_TOUCHING},
    {"hull-whole-255", "quaternions of whole numbers of 8 bits, touching", whole,
     .amount = 255, .cells = FAMILY_A_HULL, .verdict = FMB_TOUCHING},
    {"hull-whole-ulp", "quaternions of whole numbers, touching but for an ulp", whole_but_an_ulp,
     .amount = 3, .cells = FAMILY_A_HULL},
    {"hull-fractions", "quaternions and hulls of whole numbers, touching or nearly", fractions,
     .amount = 9, .cells = FAMILY_A_HULL},
    {"hull-turns", "quarter, half and third turns, touching", whole,
     .amount = 1, .cells = FAMILY_A_HULL, .verdict = FMB_TOUCHING},
    {"hull-shared", "one pose for both, touching in body coordinates", shared_pose,
     .amount = 1, .cells = FAMILY_A_HULL, .verdict = FMB_TOUCHING},
    {"hull-stacked", "one orientation for both, touching or nearly", stacked,
     .cells = FAMILY_A_HULL},
    {"hull-apart-1e-9", "orientations 1e-9 apart, touching or nearly", stacked,
     .amount = 1e-9, .cells = FAMILY_A_HULL},
    {"hull-length", "quaternions of lengths from 1e-150 to 1e150", of_any_length,
     .amount = 498, .cells = FAMILY_A_HULL},
    {"hull-beyond", "vertices and gaps beyond the largest double", beyond_doubles,
     .cells = FAMILY_A_HULL},
    {"hull-frames", "bodies of up to 3 hulls, touching or nearly", rows,
     .amount = 3, .cells = FAMILY_A_HULL},
    {"hull-of-shape", "pairs of the other families, one or both by their vertices", hull_of_shape,
     .cells = FAMILY_A_HULL},
    {"hull-equal", "equal hulls but for an ulp of a number, in one place or nearly", hull_equal,
     .cells = FAMILY_A_HULL},
    {"hull-in-plane", "points, segments and plates in one plane (2D: on one line)", hull_in_plane,
     .cells = FAMILY_A_HULL},
    {"hull-parting", "points, segments and plates that part from one plane", hull_parting,
     .cells = FAMILY_A_HULL | FAMILY_MOVING},
    {"hull-cloud-40", "ellipsoids of 13 to 40 vertices, touching or nearly", hull_cloud,
     .amount = 40, .cells = FAMILY_A_HULL},
    {"hull-thin-1e3", "plates and needles of 13 to 40 vertices, aspect 1e3", hull_cloud,
     .amount = 40, .features = {10, 0, false}, .cells = FAMILY_A_HULL},
    {"hull-thin-1e12", "plates and needles of 13 to 20 vertices, aspect 1e12", hull_cloud,
     .amount = 20, .features = {40, 0, false}, .cells = FAMILY_A_HULL},
    {"hull-exponents-200", "numbers from 2^-100 to 2^100, in contact or not", hull_exponents,
     .amount = 100, .cells = FAMILY_A_HULL},
    {"hull-exponents-all", "numbers from 2^-1000 to 2^1000, in contact or not", hull_exponents,
     .amount = 1000, .cells = FAMILY_A_HULL},
    {"hull-cloud-1000", "ellipsoids of 13 to 1000 vertices, touching or nearly", hull_cloud,
     .amount = 1000, .cells = FAMILY_A_HULL},
};
/* clang-format on */

const struct family *family_posed_at(size_t index)
{
    return index < sizeof families / sizeof *families ? &families[index] : NULL;
}

const struct family *family_any_at(size_t index)
{
    size_t others = 0;
    while (family_at(others))
        others++;
    return index < others ? family_at(index) : family_posed_at(index - others);
}

void family_draw_posed(struct draw *draw, const struct cell *cell, struct question *out)
{
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        posed_draw_shape(draw, 100, solid);
        posed_draw_any(draw, solid);
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] = draw_uniform(draw, -100, 100);
            if (cell->moving)
                solid->velocity[axis] = draw_uniform(draw, -100, 100);
        }
    }
}
