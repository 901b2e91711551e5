#include "rows.h"

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
static void project_vector(const struct inexact_pair *pair, const double *v, double *out)
{
    for (int i = 0; i < pair->a.dim; i++) {
        out[i] = 0;
        for (int axis = 0; axis < pair->a.dim; axis++)
            out[i] += pair->inverse[axis][i] * v[axis];
    }
}

static void project(const struct inexact_pair *pair, struct projection *out)
{
    out->dim = pair->a.dim;
    out->moving = pair->moving;
    project_vector(pair, pair->motion.offset, out->origin);
    project_vector(pair, pair->motion.drift, out->displacement);
    for (int i = 0; i < out->dim; i++)
        project_vector(pair, pair->b.component[i], out->component[i]);
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

bool rows_of_pair(const struct inexact_pair *pair, struct row rows[ROWS_MAX], int *count)
{
    struct projection b;
    project(pair, &b);
    struct builder builder = {.rows = rows};
    add_rows_of_a(&builder, &b, pair->a.shape == FMB_CUBOID);
    add_rows_of_b(&builder, b.dim, pair->b.shape == FMB_CUBOID);
    if (b.moving) {
        add_row(&builder, 1, false)->a[b.dim] = 1;
        add_row(&builder, 0, false)->a[b.dim] = -1;
    }
    *count = builder.count;
    return rows_are_finite(&builder);
}
