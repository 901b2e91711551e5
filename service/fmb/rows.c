#include "rows.h"

#include "inexact.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Frame b in a's coordinates: the point of parameters x at tau is, along a's component j,
 * origin[j] + tau displacement[j] + sum_i component[i][j] x_i. */
struct projection {
    int dim;
    bool moving;
    double origin[FMB_DIM_MAX];
    double displacement[FMB_DIM_MAX];
    double component[FMB_DIM_MAX][FMB_DIM_MAX];
};

/* out[i] := sum_axis inverse[axis][i] v[axis] */
static void project_vector(const struct fmb_body *onto, const double *v, double *out)
{
    for (int i = 0; i < onto->dim; i++) {
        out[i] = 0;
        for (int axis = 0; axis < onto->dim; axis++)
            out[i] += onto->inverse[axis][i] * v[axis];
    }
}

static void project(const struct fmb_pair *pair, const struct relative_motion *motion,
                    struct projection *out)
{
    const struct fmb_body *a = pair->a.body;
    out->dim = a->dim;
    out->moving = motion->moving;
    project_vector(a, motion->offset, out->origin);
    project_vector(a, motion->drift, out->displacement);
    for (int i = 0; i < a->dim; i++)
        project_vector(a, pair->b.body->component[i], out->component[i]);
}

struct builder {
    struct row *rows;
    int count;
};

static struct row *add_row(struct builder *builder, double y, bool strict)
{
    assert(builder->count < ROWS_MAX);
    struct row *row = &builder->rows[builder->count++];
    memset(row, 0, sizeof *row);
    row->y = y;
    row->strict = strict;
    return row;
}

/* Adds sign (coordinate of b's point along a's component j) to the row. */
static void add_coordinate(struct row *row, const struct projection *b, int j, double sign)
{
    for (int i = 0; i < b->dim; i++)
        row->a[i] += sign * b->component[i][j];
    if (b->moving)
        row->a[b->dim] += sign * b->displacement[j];
    row->y -= sign * b->origin[j];
}

/* 0 <= coordinate, and coordinate <= 1 (cuboid) or sum of all <= 1. */
static void add_rows_of_a(struct builder *builder, const struct projection *b, bool cuboid)
{
    for (int j = 0; j < b->dim; j++)
        add_coordinate(add_row(builder, 0, true), b, j, -1);
    struct row *sum = cuboid ? NULL : add_row(builder, 1, true);
    for (int j = 0; j < b->dim; j++)
        add_coordinate(cuboid ? add_row(builder, 1, true) : sum, b, j, 1);
}

/* x_i <= 1 (cuboid) or sum of all <= 1, and 0 <= x_i. */
static void add_rows_of_b(struct builder *builder, int dim, bool cuboid)
{
    struct row *sum = cuboid ? NULL : add_row(builder, 1, true);
    for (int i = 0; i < dim; i++)
        (cuboid ? add_row(builder, 1, true) : sum)->a[i] = 1;
    for (int i = 0; i < dim; i++)
        add_row(builder, 0, true)->a[i] = -1;
}

static bool rows_are_finite(const struct builder *builder)
{
    for (int r = 0; r < builder->count; r++) {
        bool finite = isfinite(builder->rows[r].y);
        for (int i = 0; i < ROWS_VARS_MAX; i++)
            finite = finite && isfinite(builder->rows[r].a[i]);
        if (!finite)
            return false;
    }
    return true;
}

bool rows_of_pair(const struct fmb_pair *pair, struct row rows[ROWS_MAX], int *count)
{
    struct relative_motion motion;
    struct projection b;
    if (!relative_motion_of(pair, &motion))
        return false;
    project(pair, &motion, &b);
    struct builder builder = {.rows = rows};
    add_rows_of_a(&builder, &b, pair->a.body->shape == FMB_CUBOID);
    add_rows_of_b(&builder, b.dim, pair->b.body->shape == FMB_CUBOID);
    if (b.moving) {
        add_row(&builder, 1, false)->a[b.dim] = 1;
        add_row(&builder, 0, false)->a[b.dim] = -1;
    }
    *count = builder.count;
    return rows_are_finite(&builder);
}
