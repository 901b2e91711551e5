#include "question.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

int solid_count(const struct solid *solid)
{
    return solid->shape == FMB_FACE ? 2 : solid->dim;
}

int solid_frames(const struct solid *solid)
{
    return solid->frames > 1 ? solid->frames : 1;
}

/* About the middle of the face opposite to the origin: the vertices of the face stay. */
static void turn_over(struct solid *solid)
{
    const int count = solid_count(solid);
    double sum[FMB_DIM_MAX] = {0};
    for (int i = 0; i < count; i++)
        for (int axis = 0; axis < solid->dim; axis++)
            sum[axis] += solid->component[i][axis];
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->local[axis] += sum[axis];
        for (int i = 0; i < count; i++)
            solid->component[i][axis] -= sum[axis];
    }
}

struct solid solid_frame(const struct solid *solid, int i)
{
    const bool simplex = solid->shape == FMB_TETRAHEDRON || solid->shape == FMB_FACE;
    const int steps = simplex ? i / 2 : i;
    struct solid one = *solid;
    one.frames = 1;
    for (int axis = 0; axis < solid->dim; axis++)
        one.local[axis] += steps * solid->component[0][axis];
    if (simplex && i % 2)
        turn_over(&one);
    return one;
}

bool solid_is_hull(const struct solid *solid)
{
    return solid->shape == FMB_HULL || solid->as_hull;
}

static void add(double *to, double times, const double *vector)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        to[axis] += times * vector[axis];
}

/* One way to draw in four has vertices inside, one in four equal ones. */
static void draw_cloud(const struct solid *solid, int count, double (*out)[FMB_DIM_MAX])
{
    struct draw draw = {solid->cloud_seed};
    const int kind = draw_int(&draw, 0, 3);
    for (int v = 0; v < count; v++) {
        double unit[FMB_DIM_MAX], square;
        do {
            square = 0;
            for (int i = 0; i < solid->dim; i++) {
                unit[i] = draw_uniform(&draw, -1, 1);
                square += unit[i] * unit[i];
            }
        } while (square > 1 || square == 0);
        const bool other = draw_int(&draw, 0, 7) == 0;
        const double radius = other && kind == 0 ? draw_uniform(&draw, 0, 1) : 1;
        memcpy(out[v], solid->local, sizeof out[v]);
        for (int i = 0; i < solid->dim; i++)
            add(out[v], unit[i] * radius / sqrt(square), solid->component[i]);
        if (v > 0 && other && kind == 1)
            memcpy(out[v], out[draw_int(&draw, 0, v - 1)], sizeof out[v]);
    }
}

static void pull_back(double *vertex)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        vertex[axis] = fmax(-DBL_MAX, fmin(DBL_MAX, vertex[axis])); /* NaN becomes DBL_MAX */
}

int solid_vertices(const struct solid *solid, double (*vertex)[FMB_DIM_MAX])
{
    const int components = solid_count(solid);
    const bool simplex = solid->shape == FMB_TETRAHEDRON || solid->shape == FMB_FACE;
    const int first = solid->shape == FMB_HULL ? solid->vertex_count
                      : simplex                ? components + 1
                                               : 1 << components;
    for (int v = 0; v < first; v++) {
        memcpy(vertex[v], solid->local, sizeof vertex[v]);
        if (solid->shape == FMB_HULL)
            add(vertex[v], 1, solid->vertex[v]);
        else if (simplex && solid->by_vertices && v > 0)
            memcpy(vertex[v], solid->component[v - 1], sizeof vertex[v]);
        else if (simplex && v > 0)
            add(vertex[v], 1, solid->component[v - 1]);
        for (int i = 0; i < components && solid->shape == FMB_BOX; i++)
            vertex[v][i] += (v >> i & 1 ? 0.5 : -0.5) * solid->component[i][i];
        for (int i = 0; i < components && solid->shape == FMB_CUBOID; i++)
            add(vertex[v], v >> i & 1, solid->component[i]);
    }
    const int count = first + (solid->shape == FMB_HULL ? solid->cloud : 0);
    draw_cloud(solid, count - first, vertex + first);
    for (int v = 0; v < count; v++)
        pull_back(vertex[v]);
    return count;
}

int solid_numbers(const struct solid *solid, double number[SOLID_NUMBERS_MAX])
{
    const int dim = solid->dim;
    int count = dim;
    if (solid_is_hull(solid)) {
        double vertex[SOLID_VERTICES_MAX][FMB_DIM_MAX];
        const int vertices = solid_vertices(solid, vertex);
        for (int v = 0; v < vertices; v++)
            memcpy(number + v * dim, vertex[v], (size_t) dim * sizeof *number);
        return vertices * dim;
    }
    memcpy(number, solid->local, (size_t) dim * sizeof *number);
    for (int i = 0; i < solid_count(solid); i++)
        for (int axis = 0; axis < dim; axis++)
            if (solid->shape != FMB_BOX || axis == i)
                number[count++] = solid->component[i][axis];
    return count;
}

struct fmb_placement solid_placement(const struct solid *solid, const struct fmb_body *body)
{
    struct fmb_placement placement = {.body = body, .orientation_count = solid->orientation_count};
    memcpy(placement.position, solid->origin, sizeof placement.position);
    if (solid->moving)
        memcpy(placement.velocity, solid->velocity, sizeof placement.velocity);
    memcpy(placement.orientation, solid->orientation, sizeof placement.orientation);
    memcpy(placement.end_position, solid->end_origin, sizeof placement.end_position);
    memcpy(placement.end_orientation, solid->end_orientation, sizeof placement.end_orientation);
    placement.end_count = solid->ending ? solid->dim + solid->orientation_count : 0;
    return placement;
}

static void fill_body(const struct solid *solid, struct fmb_body *body)
{
    memset(body, 0, sizeof *body);
    body->dim = body->one.dim = solid->dim;
    body->frame_count = 1;
    body->one.shape = solid->shape;
    body->one.count = solid_count(solid);
    body->one.radius = solid->radius;
    memcpy(body->one.component, solid->component, sizeof body->one.component);
    memcpy(solid->shape == FMB_BOX ? body->one.centre : body->one.origin, solid->local,
           sizeof solid->local);
}

void question_pair(const struct question *question, struct fmb_body body[2], struct pair *pair)
{
    fill_body(&question->a, &body[0]);
    fill_body(&question->b, &body[1]);
    *pair = (struct pair){solid_placement(&question->a, &body[0]),
                          solid_placement(&question->b, &body[1]), question->duration};
}

static bool same_numbers(const double *x, const double *y, int count)
{
    for (int i = 0; i < count; i++)
        if (x[i] != y[i])
            return false;
    return true;
}

/* As they are rounded. */
static bool same_vertices(const struct solid *a, const struct solid *b)
{
    double vertex[2][SOLID_VERTICES_MAX][FMB_DIM_MAX] = {{{0}}};
    const int count = solid_is_hull(a) ? solid_vertices(a, vertex[0]) : 0;
    return !solid_is_hull(a) || (solid_vertices(b, vertex[1]) == count &&
                                 same_numbers(vertex[0][0], vertex[1][0], FMB_DIM_MAX * count));
}

bool question_is_symmetric(const struct question *question)
{
    static const double rest[FMB_DIM_MAX];
    const struct solid *a = &question->a, *b = &question->b;
    return a->shape == b->shape && solid_frames(a) == solid_frames(b) &&
           a->by_vertices == b->by_vertices && a->orientation_count == b->orientation_count &&
           a->as_hull == b->as_hull && a->radius == b->radius && same_vertices(a, b) &&
           ((solid_is_hull(a) && solid_frames(a) == 1) ||
            (same_numbers(a->component[0], b->component[0], FMB_COMPONENTS_MAX) &&
             same_numbers(a->local, b->local, a->dim))) &&
           same_numbers(a->origin, b->origin, a->dim) &&
           same_numbers(a->moving ? a->velocity : rest, b->moving ? b->velocity : rest, a->dim) &&
           same_numbers(a->orientation, b->orientation, a->orientation_count) &&
           a->ending == b->ending && same_numbers(a->end_origin, b->end_origin, a->dim) &&
           same_numbers(a->end_orientation, b->end_orientation, a->orientation_count);
}

struct question question_swapped(const struct question *question)
{
    struct question swapped = *question;
    swapped.a = question->b;
    swapped.b = question->a;
    return swapped;
}

static void reverse(struct solid *solid)
{
    const struct solid was = *solid;
    if (!solid->ending)
        return;
    memcpy(solid->origin, was.end_origin, sizeof was.origin);
    memcpy(solid->end_origin, was.origin, sizeof was.origin);
    memcpy(solid->orientation, was.end_orientation, sizeof was.orientation);
    memcpy(solid->end_orientation, was.orientation, sizeof was.orientation);
}

struct question question_reversed(const struct question *question)
{
    struct question reversed = *question;
    reverse(&reversed.a);
    reverse(&reversed.b);
    return reversed;
}

enum fmb_shape question_draw_shape(struct draw *draw, int dim)
{
    return (enum fmb_shape) draw_int(draw, FMB_CUBOID, dim == 3 ? FMB_FACE : FMB_TETRAHEDRON);
}

void question_draw_movers(struct draw *draw, struct question *question)
{
    const int who = draw_int(draw, 0, 3);
    question->a.moving = who & 1;
    question->b.moving = who & 2;
}

static void print_vector(const double *number)
{
    printf("{%a, %a, %a}", number[0], number[1], number[2]);
}

static void print_solid(const char *name, const struct solid *solid)
{
    static const char *const shapes[] = {"0",        "FMB_CUBOID", "FMB_TETRAHEDRON",
                                         "FMB_FACE", "FMB_BOX",    "FMB_HULL"};
    const double *q = solid->orientation, *end = solid->end_orientation;
    printf("#   .%s = {%d, %s, {", name, solid->dim, shapes[solid->shape]);
    for (int i = 0; i < FMB_DIM_MAX; i++) {
        print_vector(solid->component[i]);
        printf("%s", i + 1 < FMB_DIM_MAX ? ", " : "},\n#      ");
    }
    print_vector(solid->origin);
    printf(", ");
    print_vector(solid->velocity);
    printf(", %s,\n#      ", solid->moving ? "true" : "false");
    print_vector(solid->local);
    printf(", {%a, %a, %a, %a}, %d, %d, %s, %s,\n#      %d, %d, {", q[0], q[1], q[2], q[3],
           solid->orientation_count, solid->frames, solid->by_vertices ? "true" : "false",
           solid->as_hull ? "true" : "false", solid->vertex_count, solid->cloud);
    for (int v = 0; v < solid->vertex_count; v++) {
        printf("%s", v ? ", " : "");
        print_vector(solid->vertex[v]);
    }
    printf("}, 0x%llx, %a", (unsigned long long) solid->cloud_seed, solid->radius);
    if (solid->ending) {
        printf(", true,\n#      ");
        print_vector(solid->end_origin);
        printf(", {%a, %a, %a, %a}", end[0], end[1], end[2], end[3]);
    }
    printf("},\n");
}

int question_numbers(struct question *question, double *out[QUESTION_NUMBERS_MAX])
{
    struct solid *solids[2] = {&question->a, &question->b};
    int count = 0;
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < solids[f]->dim; axis++) {
            for (int i = 0; i < solid_count(solids[f]); i++)
                out[count++] = &solids[f]->component[i][axis];
            out[count++] = &solids[f]->origin[axis];
            if (solids[f]->moving)
                out[count++] = &solids[f]->velocity[axis];
        }
    return count;
}

void question_print(const struct question *question)
{
    printf("# struct question question = {\n");
    print_solid("a", &question->a);
    print_solid("b", &question->b);
    printf("#   .duration = %a};\n", question->duration);
    fflush(stdout);
}
