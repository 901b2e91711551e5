#include "hard_pairs.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* ---- Parts ---- */

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

/* A point of the shape, relative to its origin: parameters that are eighths, often at their
 * bounds, so that small integers give an exact point. */
static void draw_point(struct draw *draw, const struct solid *solid, double point[FMB_DIM_MAX])
{
    static const double eighths[] = {0, 0, 1, 0.5, 0.25, 0.125};
    double left = 1; /* what a tetrahedron may still take */
    memset(point, 0, FMB_DIM_MAX * sizeof point[0]);
    for (int i = 0; i < solid_count(solid); i++) {
        double x = eighths[draw_int(draw, 0, (int) COUNT(eighths) - 1)];
        if (solid->shape != FMB_CUBOID) {
            x = fmin(x, left);
            left -= x;
        }
        for (int axis = 0; axis < solid->dim; axis++)
            point[axis] += x * solid->component[i][axis];
    }
}

/* Moves B so that point_a of A and point_b of B coincide at t = 0 (or nearly, as it rounds). */
static void bring_together(struct question *question, const double *point_a, const double *point_b)
{
    for (int axis = 0; axis < question->a.dim; axis++)
        question->b.origin[axis] = question->a.origin[axis] + (point_a[axis] - point_b[axis]);
}

static void bring_into_contact(struct draw *draw, struct question *question)
{
    double point_a[FMB_DIM_MAX], point_b[FMB_DIM_MAX];
    draw_point(draw, &question->a, point_a);
    draw_point(draw, &question->b, point_b);
    bring_together(question, point_a, point_b);
}

/* ---- Touching by construction ----
 *
 * Take a direction n, the features of A farthest along n and of B farthest against n (a vertex
 * as a rule; an edge, a face where n is made for it), and one point of each feature; put these
 * points together. The plane across n then parts the two: they have a point in common, and if A
 * is not wholly in that plane, its relative interior is strictly on its own side. So they touch.
 * All numbers are small multiples of 1/4, hence exact. */

static double dot(const double *u, const double *v, int dim)
{
    double sum = 0;
    for (int axis = 0; axis < dim; axis++)
        sum += u[axis] * v[axis];
    return sum;
}

static void cross(const double *u, const double *v, double *out)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = u[j] * v[k] - u[k] * v[j];
    }
}

static const double *draw_component(struct draw *draw, const struct solid *solid)
{
    return solid->component[draw_int(draw, 0, solid_count(solid) - 1)];
}

/* A normal of a face of A or of B, of an edge of A and one of B, or any. May be zero. */
static void draw_direction(struct draw *draw, const struct question *question, double *n)
{
    const struct solid *one = draw_coin(draw) ? &question->a : &question->b;
    const struct solid *other = draw_coin(draw) ? &question->a : &question->b;
    const double *u = draw_component(draw, one), *v = draw_component(draw, other);
    if (draw_int(draw, 0, 3) == 0)
        draw_integers(draw, one->dim, -3, 3, n);
    else if (one->dim == 3)
        cross(u, v, n);
    else
        n[0] = -u[1], n[1] = u[0];
}

/* A point of the feature of the solid that is farthest along sign * n. A cuboid takes all
 * components that go up, none that go down, and any quarter of those that lie across n. A
 * tetrahedron (a face) takes the mean of two of its farthest vertices. */
static void draw_farthest(struct draw *draw, const struct solid *solid, const double *n,
                          double sign, double *point)
{
    const int dim = solid->dim, count = solid_count(solid);
    memset(point, 0, FMB_DIM_MAX * sizeof point[0]);
    if (solid->shape == FMB_CUBOID) {
        for (int i = 0; i < count; i++) {
            double up = sign * dot(n, solid->component[i], dim);
            double x = up > 0 ? 1 : up < 0 ? 0 : draw_int(draw, 0, 4) / 4.0;
            for (int axis = 0; axis < dim; axis++)
                point[axis] += x * solid->component[i][axis];
        }
        return;
    }
    static const double zero[FMB_DIM_MAX];
    const double *farthest[FMB_DIM_MAX + 1] = {zero};
    int found = 1; /* the origin is a vertex as well */
    for (int i = 0; i < count; i++) {
        double gain = sign * (dot(n, solid->component[i], dim) - dot(n, farthest[0], dim));
        if (gain > 0)
            found = 0;
        if (gain >= 0)
            farthest[found++] = solid->component[i];
    }
    const double *p = farthest[draw_int(draw, 0, found - 1)];
    const double *q = farthest[draw_int(draw, 0, found - 1)];
    for (int axis = 0; axis < dim; axis++)
        point[axis] = (p[axis] + q[axis]) / 2;
}

static bool lies_across(const struct solid *solid, const double *n)
{
    for (int i = 0; i < solid_count(solid); i++)
        if (dot(n, solid->component[i], solid->dim) != 0)
            return false;
    return true;
}

/* A touching static pair, and the direction of its parting plane (from A to B). */
static void draw_touching(struct draw *draw, struct question *question, double *n)
{
    const int dim = draw_dim(draw), most = draw_coin(draw) ? 1 : 6;
    do {
        *question = (struct question){.duration = 1};
        memset(n, 0, FMB_DIM_MAX * sizeof n[0]);
        question->a = draw_integer_solid(draw, dim, most);
        question->b = draw_integer_solid(draw, dim, most);
        draw_integers(draw, dim, -9, 9, question->a.origin);
        draw_direction(draw, question, n);
    } while (lies_across(&question->a, n)); /* a zero direction too */
    double point_a[FMB_DIM_MAX], point_b[FMB_DIM_MAX];
    draw_farthest(draw, &question->a, n, +1, point_a);
    draw_farthest(draw, &question->b, n, -1, point_b);
    bring_together(question, point_a, point_b);
}

static void touching(struct draw *draw, struct question *question)
{
    double n[FMB_DIM_MAX];
    draw_touching(draw, question, n);
}

static void touching_far_out(struct draw *draw, struct question *question)
{
    touching(draw, question);
    for (int axis = 0; axis < question->a.dim; axis++) {
        double far = draw_int(draw, -3, 3) * 0x1p40; /* 40 + 10 bits, all exact */
        question->a.origin[axis] += far;
        question->b.origin[axis] += far;
    }
}

static void an_ulp_from_touching(struct draw *draw, struct question *question)
{
    touching_far_out(draw, question);
    double *number = &question->b.origin[draw_int(draw, 0, question->a.dim - 1)];
    *number = nextafter(*number, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
}

/* Gives B the relative velocity w, on top of a velocity of both, and puts it where it is in
 * touching contact at time t of the window. */
static void touch_at(struct draw *draw, struct question *question, const double *w, double t)
{
    double both[FMB_DIM_MAX] = {0};
    question->a.moving = draw_coin(draw);
    question->b.moving = true;
    if (question->a.moving)
        draw_integers(draw, question->a.dim, -3, 3, both);
    for (int axis = 0; axis < question->a.dim; axis++) {
        question->a.velocity[axis] = both[axis];
        question->b.velocity[axis] = both[axis] + w[axis];
        question->b.origin[axis] -= t * w[axis];
    }
}

static double draw_window(struct draw *draw, struct question *question)
{
    static const double windows[] = {0, 0.25, 1, 2, 5};
    return question->duration = windows[draw_int(draw, 0, (int) COUNT(windows) - 1)];
}

/* The relative velocity lies in the parting plane: they slide, or graze in an instant. */
static void sliding(struct draw *draw, struct question *question)
{
    double n[FMB_DIM_MAX], any[FMB_DIM_MAX], w[FMB_DIM_MAX] = {0};
    draw_touching(draw, question, n);
    draw_integers(draw, question->a.dim, -2, 2, any);
    if (question->a.dim == 3)
        cross(n, any, w);
    else
        w[0] = -n[1] * any[0], w[1] = n[0] * any[0];
    touch_at(draw, question, w, draw_window(draw, question) * draw_int(draw, 0, 2) / 2);
}

/* B has a velocity away from A, and touches as the window opens; or the reverse, and touches as
 * it closes. */
static void at_the_window_s_end(struct draw *draw, struct question *question)
{
    double n[FMB_DIM_MAX], w[FMB_DIM_MAX];
    draw_touching(draw, question, n);
    do {
        draw_integers(draw, question->a.dim, -3, 3, w);
    } while (dot(n, w, question->a.dim) == 0);
    bool away = dot(n, w, question->a.dim) > 0;
    touch_at(draw, question, w,
             away ? 0 * draw_window(draw, question) : draw_window(draw, question));
}

/* ---- Contact of no given kind ---- */

static void overlap_then_recede(struct draw *draw, struct question *question)
{
    const int dim = draw_dim(draw);
    *question = (struct question){.a = draw_integer_solid(draw, dim, 4),
                                  .b = draw_integer_solid(draw, dim, 4)};
    bring_into_contact(draw, question);
    question_draw_movers(draw, question);
    draw_integers(draw, dim, -2, 2, question->a.velocity);
    draw_integers(draw, dim, -5, 5, question->b.velocity);
    question->duration = draw_duration(draw);
}

/* Components from a space of the rank given, with integer coefficients. */
static void flatten(struct draw *draw, struct solid *solid, int rank)
{
    double basis[FMB_DIM_MAX][FMB_DIM_MAX] = {{0}};
    for (int r = 0; r < rank; r++)
        draw_integers(draw, solid->dim, -2, 2, basis[r]);
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < solid->dim; axis++) {
            solid->component[i][axis] = 0;
            for (int r = 0; r < rank; r++)
                solid->component[i][axis] += draw_int(draw, -2, 2) * basis[r][axis];
        }
}

static void flat(struct draw *draw, struct question *question)
{
    overlap_then_recede(draw, question);
    flatten(draw, &question->a, draw_int(draw, 0, question->a.dim));
    flatten(draw, &question->b, draw_int(draw, 0, question->b.dim - 1));
    if (draw_int(draw, 0, 3))
        bring_into_contact(draw, question);
}

/* Both in one plane (on one line): the hard case of flat pairs. */
static void flat_in_one_plane(struct draw *draw, struct question *question)
{
    flat(draw, question);
    const int axis = draw_int(draw, 0, question->a.dim - 1);
    for (int i = 0; i < FMB_DIM_MAX; i++)
        question->a.component[i][axis] = question->b.component[i][axis] = 0;
    question->b.origin[axis] = question->a.origin[axis];
    if (draw_coin(draw))
        question->a.velocity[axis] = question->b.velocity[axis] = 1;
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

/* ---- Scaled ---- */

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

static void small_world_of_any_size(struct draw *draw, struct question *question)
{
    const int exponent = draw_int(draw, -950, 950);
    small_world(draw, question);
    scale_lengths(question, exponent, exponent);
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

static struct solid draw_solid(struct draw *draw, int dim, double (*number)(struct draw *))
{
    struct solid solid = {.dim = dim, .shape = question_draw_shape(draw, dim)};
    for (int axis = 0; axis < dim; axis++) {
        solid.origin[axis] = number(draw);
        solid.velocity[axis] = number(draw);
        for (int i = 0; i < solid_count(&solid); i++)
            solid.component[i][axis] = number(draw);
    }
    return solid;
}

static void draw_pair(struct draw *draw, struct question *question, double (*number)(struct draw *))
{
    const int dim = draw_dim(draw);
    *question = (struct question){draw_solid(draw, dim, number), draw_solid(draw, dim, number),
                                  draw_duration(draw)};
    question_draw_movers(draw, question);
}

static double ordinary(struct draw *draw)
{
    return draw_uniform(draw, -100, 100);
}
static double any_exponent(struct draw *draw)
{
    return draw_log(draw, -1000, 1000);
}
static double subnormal(struct draw *draw)
{
    return draw_int(draw, -9, 9) * 0x1p-1074;
}
static double near_the_end(struct draw *draw)
{
    return draw_uniform(draw, -1, 1) * DBL_MAX;
}

static double of_every_kind(struct draw *draw)
{
    switch (draw_int(draw, 0, 7)) {
    case 0: return draw_coin(draw) ? 0 : -0.0;
    case 1: return draw_int(draw, -2, 2);
    case 2: return subnormal(draw);
    case 3: return near_the_end(draw);
    case 4: return draw_coin(draw) ? DBL_MAX : -DBL_MAX;
    case 5: return any_exponent(draw);
    default: return draw_finite(draw);
    }
}

static void ordinary_moving(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, ordinary);
    question->duration = draw_uniform(draw, 0, 4);
}

static void near_contact(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, ordinary);
    bring_into_contact(draw, question);
}

static void sizes_mixed(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, any_exponent);
    if (draw_coin(draw))
        bring_into_contact(draw, question); /* may overflow: see repair() */
}

static void subnormals(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, subnormal);
}

static void ends_of_the_doubles(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, near_the_end);
    if (draw_coin(draw))
        bring_into_contact(draw, question);
}

static void numbers_of_every_kind(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, of_every_kind);
    if (draw_coin(draw))
        bring_into_contact(draw, question);
    if (draw_coin(draw))
        question->duration = fabs(of_every_kind(draw));
}

/* Each frame of its own size, from 1e-300 to 1e300, in contact or nearly. */
static void frames_of_two_sizes(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, ordinary);
    double size[2] = {draw_log(draw, -990, 990), draw_log(draw, -990, 990)};
    for (int i = 0; i < FMB_DIM_MAX; i++)
        for (int axis = 0; axis < question->a.dim; axis++) {
            question->a.component[i][axis] *= size[0];
            question->b.component[i][axis] *= size[1];
        }
    bring_into_contact(draw, question);
}

/* Components that differ from dependent ones by an ulp or two in one number. */
static void slivers(struct draw *draw, struct question *question)
{
    draw_pair(draw, question, ordinary);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = side == 0 ? &question->a : &question->b;
        memcpy(solid->component[1], solid->component[0], sizeof solid->component[1]);
        double *number = &solid->component[1][draw_int(draw, 0, solid->dim - 1)];
        for (int steps = draw_int(draw, 0, 2); steps > 0; steps--)
            *number = nextafter(*number, HUGE_VAL);
    }
    bring_into_contact(draw, question);
}

/* Velocities that do next to nothing, or the same to both. */
static void idle_velocities(struct draw *draw, struct question *question)
{
    overlap_then_recede(draw, question);
    if (!question->a.moving)
        question->b.moving = true;
    for (int axis = 0; axis < question->a.dim; axis++) {
        double velocity = draw_coin(draw) ? ordinary(draw) : of_every_kind(draw);
        question->a.velocity[axis] = question->b.velocity[axis] = velocity;
    }
    switch (draw_int(draw, 0, 3)) {
    case 0: memset(question->b.velocity, 0, sizeof question->b.velocity); /* fallthrough */
    case 1: memset(question->a.velocity, 0, sizeof question->a.velocity); break;
    case 2: question->a.velocity[0] += subnormal(draw); break;
    default: break;
    }
}

/* ---- The families ---- */

static const struct hard_family families[] = {
    {"small_world", small_world, 0, 6000},
    {"small_world_of_any_size", small_world_of_any_size, 0, 3000},
    {"windows_of_any_length", windows_of_any_length, 0, 3000},
    {"windows_of_subnormals", windows_of_subnormals, 0, 2000},
    {"drifts_that_vanish_along_an_axis", drifts_that_vanish_along_an_axis, 0, 4000},
    {"touching", touching, FMB_TOUCHING, 6000},
    {"touching_far_out", touching_far_out, FMB_TOUCHING, 3000},
    {"an_ulp_from_touching", an_ulp_from_touching, 0, 3000},
    {"sliding", sliding, FMB_TOUCHING, 6000},
    {"at_the_window_s_end", at_the_window_s_end, FMB_TOUCHING, 4000},
    {"overlap_then_recede", overlap_then_recede, -1, 3000},
    {"flat", flat, 0, 6000},
    {"flat_in_one_plane", flat_in_one_plane, 0, 6000},
    {"ordinary_moving", ordinary_moving, -1, 3000},
    {"near_contact", near_contact, 0, 3000},
    {"slivers", slivers, 0, 3000},
    {"idle_velocities", idle_velocities, -1, 3000},
    {"frames_of_two_sizes", frames_of_two_sizes, 0, 1000},
    {"sizes_mixed", sizes_mixed, -1, 1000},
    {"subnormals", subnormals, -1, 3000},
    {"ends_of_the_doubles", ends_of_the_doubles, -1, 2000},
    {"numbers_of_every_kind", numbers_of_every_kind, -1, 1500},
};

/* What a family computed may have left the finite doubles: it is pulled back to the last one. */
static void repair(struct question *question)
{
    for (int side = 0; side < 2; side++) {
        struct solid *solid = side == 0 ? &question->a : &question->b;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            solid->origin[axis] = fmax(-DBL_MAX, fmin(DBL_MAX, solid->origin[axis]));
            solid->velocity[axis] = fmax(-DBL_MAX, fmin(DBL_MAX, solid->velocity[axis]));
            for (int i = 0; i < FMB_DIM_MAX; i++)
                solid->component[i][axis] =
                    fmax(-DBL_MAX, fmin(DBL_MAX, solid->component[i][axis]));
        }
    }
}

const struct hard_family *hard_family_at(size_t index)
{
    return index < COUNT(families) ? &families[index] : NULL;
}

void hard_draw(struct draw *draw, const struct hard_family *family, struct question *question)
{
    family->draw_question(draw, question);
    repair(question);
}
