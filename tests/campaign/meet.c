/* Method of the exact contacts. The plane is spanned by edges of the features that are to meet, and
 * by random integer vectors where these span too little. It is accepted if the features farthest
 * along its normal, of A, and against it, of B, are of the dimensions wanted; else all is drawn
 * again. This is found with exact integers: most ratio <= 2^35 makes edges below 2^37 and, of a
 * guest laid into their plane, vertices below 2^41; normals then lie below 2^75, products below
 * 2^118. */
#include "meeting.h"

#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

__extension__ typedef __int128 wide;

/* Two edges of a face of the solid (2D: of the solid), in random order. */
static void draw_edges(struct draw *draw, const struct solid *solid, double edge[2][FMB_DIM_MAX])
{
    const int count = solid_count(solid), i = draw_int(draw, 0, count - 1);
    const int j = (i + draw_int(draw, 1, count - 1)) % count;
    memcpy(edge[0], solid->component[i], sizeof edge[0]);
    memcpy(edge[1], solid->component[j], sizeof edge[1]);
    if (solid->shape == FMB_CUBOID || draw_int(draw, 0, 3) > 0)
        return;
    vector_add(edge[0], -1, solid->component[j]); /* the edge, the face opposite to the origin */
    if (count == 3)
        vector_add(edge[1], -1, solid->component[3 - i - j]);
}

/* ---- Exact directions ---- */

struct direction {
    wide number[FMB_DIM_MAX];
};

static struct direction direction_across(int dim, const double u[FMB_DIM_MAX],
                                         const double v[FMB_DIM_MAX])
{
    wide p[3], q[3] = {0, 0, -1};
    for (int axis = 0; axis < 3; axis++) {
        p[axis] = (wide) u[axis];
        if (dim == 3)
            q[axis] = (wide) v[axis];
    }
    return (struct direction){
        {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]}};
}

static wide direction_dot(const struct direction *direction, const double *vector)
{
    wide sum = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        sum += direction->number[axis] * (wide) vector[axis];
    return sum;
}

/* The vertices farthest along sign * direction. Returns how many. */
static int farthest(const struct solid *solid, const struct direction *direction, int sign,
                    double out[VERTICES_MAX][FMB_DIM_MAX])
{
    double vertex[VERTICES_MAX][FMB_DIM_MAX];
    const int count = solid_vertices(solid, vertex);
    wide best = 0;
    int found = 0;
    for (int v = 0; v < count; v++) {
        wide way = sign * direction_dot(direction, vertex[v]);
        if (found > 0 && way < best)
            continue;
        if (way > best)
            found = 0;
        best = way;
        memcpy(out[found++], vertex[v], sizeof out[0]);
    }
    return found;
}

static int dimension_of(int vertices)
{
    return vertices > 2 ? 2 : vertices - 1;
}

static bool is_flat(const struct solid *solid)
{
    const struct direction across =
        direction_across(solid->dim, solid->component[0], solid->component[1]);
    if (solid->dim == 2) {
        const double(*c)[FMB_DIM_MAX] = solid->component;
        return (wide) c[0][0] * (wide) c[1][1] == (wide) c[0][1] * (wide) c[1][0];
    }
    return direction_dot(&across, solid->component[2]) == 0;
}

/* A point strictly within the feature that has these vertices: quarters of one to four of them. */
static void draw_within(struct draw *draw, int count, double vertex[VERTICES_MAX][FMB_DIM_MAX],
                        double *out)
{
    int quarters[4] = {4, 0, 0, 0};
    if (count == 2) {
        quarters[0] = draw_int(draw, 1, 3);
        quarters[1] = 4 - quarters[0];
    } else if (count == 3) {
        for (int v = 0; v < 3; v++)
            quarters[v] = 1;
        quarters[draw_int(draw, 0, 2)]++;
    } else if (count == 4) { /* two of them might share an edge; three never do */
        for (int v = 0; v < 4; v++)
            quarters[v] = 1;
        int more = draw_int(draw, 0, 3), less = draw_int(draw, 0, 3);
        quarters[more]++;
        quarters[less]--;
    }
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    for (int v = 0; v < count; v++)
        vector_add(out, quarters[v] / 4.0, vertex[v]);
}

/* ---- Exact contacts ---- */

static struct solid draw_lattice_solid(struct draw *draw, const struct cell *cell, int side,
                                       double most, double ratio)
{
    struct solid solid = {.dim = cell->dim, .shape = cell->shape[side]};
    for (int i = 0; i < solid_count(&solid); i++) {
        draw_integers(draw, cell->dim, -(int) most, (int) most, solid.component[i]);
        for (int axis = 0; axis < cell->dim; axis++)
            solid.component[i][axis] *= ratio;
    }
    return solid;
}

/* Puts into the solid's first component (and its second, for a face) vectors of the plane of these
 * edges. (2D, and parallel edges: of the line of the first.) Multiplied by scale. */
static void lay_into_plane(struct draw *draw, int dimension, bool line, double edge[2][FMB_DIM_MAX],
                           double scale, struct solid *solid)
{
    for (int i = 0; i < dimension; i++) {
        memset(solid->component[i], 0, sizeof solid->component[i]);
        vector_add(solid->component[i], scale * draw_int(draw, -2, 2), edge[0]);
        if (!line)
            vector_add(solid->component[i], scale * draw_int(draw, -2, 2), edge[1]);
    }
}

/* Two vectors that span the parting plane. What the features leave open is random. host has the
 * greater feature. */
static void span_plane(struct draw *draw, struct features features, double scale,
                       const struct solid *host, struct solid *guest, double along[2][FMB_DIM_MAX])
{
    const int dim = host->dim;
    double edge[2][FMB_DIM_MAX];
    for (int i = 0; i < 2; i++) {
        memset(along[i], 0, sizeof along[i]);
        if (i < dim - 1)
            draw_integers(draw, dim, -9, 9, along[i]);
    }
    draw_edges(draw, host, edge);
    for (int i = 0; i < features.one && i < dim - 1; i++)
        memcpy(along[i], edge[i], sizeof along[i]);
    if (features.other == 0)
        return;
    if (features.parallel || features.one + features.other > dim - 1) {
        lay_into_plane(draw, features.other, features.one == 1, along, scale, guest);
        return;
    }
    draw_edges(draw, guest, edge);
    memcpy(along[1], edge[0], sizeof along[1]);
}

static void bring_together_exactly(struct draw *draw, struct question *question, int count[2],
                                   double vertex[2][VERTICES_MAX][FMB_DIM_MAX])
{
    double point[2][FMB_DIM_MAX];
    for (int side = 0; side < 2; side++)
        draw_within(draw, count[side], vertex[side], point[side]);
    draw_integers(draw, question->a.dim, -9, 9, question->a.origin);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        question->b.origin[axis] = question->a.origin[axis] + point[0][axis] - point[1][axis];
}

static bool try_to_meet(struct draw *draw, const struct cell *cell, struct features features,
                        double most, double ratio, struct meeting *out)
{
    const int host = draw_coin(draw), big = draw_coin(draw);
    double vertex[2][VERTICES_MAX][FMB_DIM_MAX];
    int count[2];
    *out = (struct meeting){.question = {.duration = 1}};
    struct question *question = &out->question;
    for (int side = 0; side < 2; side++)
        *question_solid(question, side) =
            draw_lattice_solid(draw, cell, side, most, side == big ? ratio : 1);
    /* A guest laid into the plane of a host of another size takes its own size. */
    const double scale = host == big ? 1 / ratio : ratio;
    span_plane(draw, features, scale, question_solid(question, host),
               question_solid(question, !host), out->along);
    if (is_flat(&question->a) || is_flat(&question->b))
        return false;

    struct direction normal = direction_across(cell->dim, out->along[0], out->along[1]);
    const int flip = draw_coin(draw) ? 1 : -1;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        normal.number[axis] *= flip;
        out->normal[axis] = (double) normal.number[axis];
    }
    for (int side = 0; side < 2; side++) {
        count[side] =
            farthest(question_solid(question, side), &normal, side == 0 ? +1 : -1, vertex[side]);
        if (dimension_of(count[side]) != (side == host ? features.one : features.other))
            return false;
    }
    bring_together_exactly(draw, question, count, vertex);
    return true;
}

struct meeting meet_exactly(struct draw *draw, const struct cell *cell, struct features features,
                            double most, double ratio)
{
    struct meeting meeting;
    while (!try_to_meet(draw, cell, features, most, ratio, &meeting))
        continue;
    return meeting;
}

struct features meeting_draw_features(struct draw *draw, int dim)
{
    static const struct features plane[] = {{0, 0, false}, {1, 0, false}, {1, 1, false}};
    static const struct features space[] = {{0, 0, false}, {1, 0, false}, {2, 0, false},
                                            {1, 1, false}, {1, 1, true},  {2, 1, false},
                                            {2, 2, false}};
    if (dim == 2)
        return plane[draw_int(draw, 0, COUNT(plane) - 1)];
    return space[draw_int(draw, 0, COUNT(space) - 1)];
}

double meeting_draw_most(struct draw *draw)
{
    static const double most[] = {3, 9, 1000, 0x1p24};
    return most[draw_int(draw, 0, COUNT(most) - 1)];
}

struct meeting meet_anyhow(struct draw *draw, const struct cell *cell)
{
    const double most = meeting_draw_most(draw);
    return meet_exactly(draw, cell, meeting_draw_features(draw, cell->dim), most, 1);
}

/* ---- Rounded contacts ---- */

/* The mean of the vertices farthest along sign * direction, but for rounding: a feature is met
 * somewhere within. */
static void farthest_point(struct draw *draw, const struct solid *solid, const double *direction,
                           int sign, double *out)
{
    double vertex[VERTICES_MAX][FMB_DIM_MAX], way[VERTICES_MAX], best = -HUGE_VAL;
    const int count = solid_vertices(solid, vertex);
    for (int v = 0; v < count; v++) {
        way[v] = sign * vector_dot(direction, vertex[v]);
        best = fmax(best, way[v]);
    }
    const double near = best - 1e-9 * vector_length(direction) * vector_length(vertex[count - 1]);
    double total = 0;
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    for (int v = 0; v < count; v++)
        if (way[v] >= near) {
            double weight = draw_uniform(draw, 0.1, 1);
            vector_add(out, weight, vertex[v]);
            total += weight;
        }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] /= total;
}

void meeting_bring_together(struct draw *draw, struct meeting *meeting)
{
    struct question *question = &meeting->question;
    const int host = draw_coin(draw);
    double edge[2][FMB_DIM_MAX], point[2][FMB_DIM_MAX];
    memset(meeting->along, 0, sizeof meeting->along);
    draw_edges(draw, question_solid(question, host), meeting->along);
    if (question->a.dim == 2) {
        meeting->along[1][0] = meeting->along[1][1] = 0;
        vector_cross(meeting->along[0], (double[3]){0, 0, 1}, meeting->normal);
    } else {
        if (draw_coin(draw)) {
            draw_edges(draw, question_solid(question, !host), edge);
            memcpy(meeting->along[1], edge[0], sizeof edge[0]);
        }
        vector_cross(meeting->along[0], meeting->along[1], meeting->normal);
    }
    const double sign = draw_coin(draw) ? 1 : -1;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        meeting->normal[axis] *= sign;
    farthest_point(draw, &question->a, meeting->normal, +1, point[0]);
    farthest_point(draw, &question->b, meeting->normal, -1, point[1]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        question->b.origin[axis] = question->a.origin[axis] + (point[0][axis] - point[1][axis]);
}

struct meeting meet_nearly(struct draw *draw, const struct cell *cell, double size)
{
    struct meeting meeting = {.question = {.duration = 1}};
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(&meeting.question, side);
        *solid = (struct solid){.dim = cell->dim, .shape = cell->shape[side]};
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->origin[axis] = draw_uniform(draw, -size, size);
            for (int i = 0; i < solid_count(solid); i++)
                solid->component[i][axis] = draw_uniform(draw, -size, size);
        }
    }
    meeting_bring_together(draw, &meeting);
    return meeting;
}
