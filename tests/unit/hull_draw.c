#include "hull_draw.h"

#include "unit.h"

#include <math.h>
#include <string.h>

/* The vertices of a solid of one frame, [vertex][axis]. Returns the number of doubles. */
static size_t vertices_of(const struct solid *solid, double *out)
{
    const bool simplex = solid->shape == FMB_TETRAHEDRON || solid->shape == FMB_FACE;
    const bool box = solid->shape == FMB_BOX;
    const int count = solid_count(solid), vertices = simplex ? count + 1 : 1 << count;
    for (int k = 0; k < vertices; k++)
        for (int axis = 0; axis < solid->dim; axis++) {
            double x = solid->local[axis] - (box ? solid->component[axis][axis] / 2 : 0);
            for (int i = 0; i < count; i++)
                if (simplex ? k == i + 1 : k >> i & 1)
                    x += solid->component[i][axis];
            out[k * solid->dim + axis] = x;
        }
    return (size_t) (vertices * solid->dim);
}

static void make_hull(const struct solid *solid, struct shape_hull *out)
{
    double vertices[FMB_DIM_MAX * SHAPE_VERTICES];
    const size_t count = vertices_of(solid, vertices);
    assert_true(fmb_hull_doubles(solid->dim, count / (size_t) solid->dim) <=
                sizeof out->memory / sizeof *out->memory);
    assert_int_equal(fmb_body_make_hull(solid->dim, vertices, count, out->memory, &out->body),
                     FMB_OK);
}

void hull_replace(const struct question *question, unsigned which, struct shape_hull hull[2],
                  struct pair *pair)
{
    make_hull(&question->a, &hull[0]);
    make_hull(&question->b, &hull[1]);
    if (which & 1)
        pair->a.body = &hull[0].body;
    if (which & 2)
        pair->b.body = &hull[1].body;
}

/* Numbers of few bits, so that the vertices of a solid are exact. */
static double short_number(struct draw *draw)
{
    return draw_int(draw, -(1 << 20), 1 << 20) * 0x1p-20;
}

static double whole_number(struct draw *draw)
{
    return draw_int(draw, -3, 3);
}

static double long_number(struct draw *draw)
{
    return draw_uniform(draw, -1, 1);
}

typedef double number_function(struct draw *draw);

static struct solid draw_solid(struct draw *draw, int dim, number_function *number,
                               number_function *pose)
{
    struct solid solid = {.dim = dim, .shape = question_draw_shape(draw, dim)};
    const bool at_origin = draw_coin(draw), turned = draw_coin(draw);
    if (draw_int(draw, 0, 3) == 0)
        solid.shape = FMB_BOX;
    for (int i = 0; i < solid_count(&solid); i++)
        for (int axis = 0; axis < dim; axis++)
            if (solid.shape != FMB_BOX)
                solid.component[i][axis] = number(draw);
            else if (axis == i)
                solid.component[i][i] = fabs(number(draw));
    for (int axis = 0; axis < dim; axis++) {
        solid.origin[axis] = pose(draw);
        solid.velocity[axis] = pose(draw);
        solid.local[axis] = at_origin ? 0 : number(draw);
    }
    solid.orientation_count = turned ? dim == 3 ? 4 : 2 : 0;
    for (int i = 0; i < solid.orientation_count; i++)
        solid.orientation[i] = pose(draw);
    if (turned && solid.orientation[0] == 0)
        solid.orientation[0] = 1;
    return solid;
}

struct question hull_draw_question(struct draw *draw)
{
    static number_function *const numbers[][2] = {
        {whole_number, whole_number}, {whole_number, long_number}, {short_number, long_number}};
    const int dim = draw_int(draw, 0, 2) ? 3 : 2;
    number_function *const *number = numbers[draw_int(draw, 0, 2)];
    struct question question = {draw_solid(draw, dim, number[0], number[1]),
                                draw_solid(draw, dim, number[0], number[1]), 1};
    question_draw_movers(draw, &question);
    if (draw_coin(draw))
        for (int axis = 0; axis < dim; axis++)
            question.b.origin[axis] += number[1](draw);
    question.duration = draw_int(draw, 0, 2) ? 1 : draw_uniform(draw, 0, 3);
    return question;
}

void hull_draw_small(struct draw *draw, struct hull_pair_draw *out)
{
    const int dim = draw_int(draw, 0, 2) ? 3 : 2, most = draw_int(draw, 1, 3);
    struct fmb_placement *placement[2] = {&out->pair.a, &out->pair.b};
    memset(out, 0, sizeof *out);
    out->pair.duration = draw_int(draw, 0, 2);
    for (int f = 0; f < 2; f++) {
        double numbers[SMALL_VERTICES * FMB_DIM_MAX];
        const int flat = draw_int(draw, 0, 5); /* an axis on which all are 0 */
        out->count[f] = draw_int(draw, 1, SMALL_VERTICES);
        for (int k = 0; k < out->count[f]; k++)
            for (int axis = 0; axis < dim; axis++)
                numbers[k * dim + axis] = out->vertices[f][k][axis] =
                    axis == flat ? 0 : draw_int(draw, -most, most);
        assert_int_equal(fmb_body_make_hull(dim, numbers, (size_t) (out->count[f] * dim),
                                            out->hull[f].memory, &out->hull[f].body),
                         FMB_OK);
        placement[f]->body = &out->hull[f].body;
        for (int axis = 0; axis < dim; axis++) {
            placement[f]->position[axis] = draw_int(draw, -1, 1);
            placement[f]->velocity[axis] = draw_int(draw, 0, 2) ? 0 : draw_int(draw, -2, 2);
        }
    }
}
