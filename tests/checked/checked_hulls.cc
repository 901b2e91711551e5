/* Pairs by their vertices, compiled with `double` as a number that carries a bound on its error. */
#define INLINED_NOT
#undef __SSE2__ /* vectors are structs here */
#define LANES 2

#include "checked_hulls.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lanes.h"

/* In place of memory.h, whose name is that of a header of the system too. */
static void *memory_allocate(size_t bytes)
{
    return malloc(bytes);
}

static void memory_release(void *memory, size_t)
{
    free(memory);
}

typedef number number_in_place_of_double; /* no variable has this name */
#define double number_in_place_of_double
#define _Static_assert static_assert
#define ROTATION_TWO
typedef lanes rotation_two;

#define unit_roundoff unit_roundoff_of_pairs
#include "support_pair.c"
#undef unit_roundoff
#define unit_roundoff unit_roundoff_of_heights
#include "support_heights.c"
#undef unit_roundoff
#include "polytope.c"
#include "support_search.c"
#include "support_witness.c"
#define fmb_pose_at checked_pose_at
#include "motion.c"
#include "turn_path.c"

#undef double

/* Not reached. */
enum fmb_verdict support_round_verdict(const struct support_pair *, enum fmb_verdict cores,
                                       const struct support_nearest *)
{
    return cores;
}

void frame_box(const struct fmb_frame *, number[2][FMB_DIM_MAX])
{
}

unsigned support_list(const struct support_vertices *, const number[FMB_DIM_MAX], number,
                      uint16_t *)
{
    return 0;
}

struct checked_frame {
    struct fmb_frame frame;
    struct fmb_placement placement;
    number at[FMB_DIM_MAX * FMB_HULL_VERTICES_MAX];
};

/* Without derivations of the values of the other vertices. */
struct support support_max(const struct support_vertices *vertices, const number n[FMB_DIM_MAX])
{
    struct support out = {0, -INFINITY};
    for (unsigned i = 0; i < vertices->count; i++) {
        double value = 0;
        for (int axis = 0; axis < vertices->dim; axis++)
            value += n[axis].value * vertices->at[axis * vertices->stride + i].value;
        if (value > out.value.value)
            out = {i, value};
    }
    return {out.index, support_value(vertices, n, out.index)};
}

static void set_frame(const struct checked_vertices *from, struct checked_frame *out)
{
    memset(out, 0, sizeof *out);
    fmb_frame &frame = out->frame;
    frame.shape = (enum fmb_shape) from->shape;
    frame.dim = from->dim;
    frame.count = from->count;
    frame.flat = from->flat;
    frame.slack = from->slack;
    frame.core_reach = from->reach;
    frame.vertices = out->at;
    frame.vertex_stride = FMB_HULL_VERTICES_MAX;
    frame.vertex_count = from->vertex_count;
    out->placement.orientation_count = from->orientation_count;
    out->placement.end_count = from->end_count;
    for (int i = 0; i < 4; i++) {
        frame.spanning[i] = from->spanning[i];
        out->placement.orientation[i] = from->orientation[i];
        out->placement.end_orientation[i] = from->end_orientation[i];
    }
    for (int axis = 0; axis < from->dim; axis++) {
        out->placement.end_position[axis] = from->end_position[axis];
        frame.origin[axis] = from->origin[axis];
        out->placement.position[axis] = from->position[axis];
        out->placement.velocity[axis] = from->velocity[axis];
        for (int i = 0; i < from->dim; i++)
            frame.component[i][axis] = from->component[i][axis];
        for (unsigned i = 0; i < FMB_HULL_VERTICES_MAX && from->vertex_count; i++)
            out->at[axis * FMB_HULL_VERTICES_MAX + i] =
                from->vertices[axis * from->vertex_stride + i % from->vertex_count];
    }
}

/* The support in a direction, and the point that has it. */
static void check_support(const struct support_pair *pair, const number n[FMB_DIM_MAX],
                          struct support_vertex *out)
{
    const number value = support_farthest(pair, n, &out->column);
    const number length = sqrt(vec3_dot(n, n)).value, error = pair->error.value;
    check_bound("SUPPORT_ROUNDING", 32 * 0x1p-53, value, error * length);
    support_point(pair, out->column, out->at);
    check_vector("SUPPORT_ROUNDING", 32 * 0x1p-53, out->at, FMB_DIM_MAX, error);
}

/* The order of all vertices but the last. */
static void check_order(const struct support_view *view)
{
    const number n[FMB_DIM_MAX] = {0.04, -0.05, view->vertices.dim == 3 ? 0.06 : 0};
    uint16_t face[FMB_HULL_VERTICES_MAX], listed[FMB_HULL_VERTICES_MAX];
    for (unsigned i = 0; i < view->vertices.count; i++)
        face[i] = (uint16_t) i;
    support_view_list(view, n, face, view->vertices.count - 1, listed);
}

/* The witness points, for any weights. */
static void check_witness(const struct support_pair *pair, struct support_nearest *nearest)
{
    struct support_pair with_paths = *pair; /* that count as given */
    struct support_gap gap = {&with_paths};
    struct fmb_gap out;
    number length[2];
    for (unsigned c = 0; c < nearest->simplex.count; c++)
        nearest->weight[c] = given(nearest->weight[c]);
    for (int f = 0; f < 2; f++) {
        for (number &path : with_paths.path[f])
            path = given(path);
        length[f] =
            given(vec3_sum(pair->position[f]) + vec3_sum(with_paths.path[f]) + pair->view[f].reach);
    }
    support_witness(&gap, nearest, &out);
    for (int f = 0; f < 2; f++)
        check_vector("SUPPORT_WITNESS", SUPPORT_WITNESS, out.witness[f], FMB_DIM_MAX,
                     SUPPORT_WITNESS * length[f]);
}

/* From here on vertices and matrices count as given: their errors are slack, and MATRIX_ERROR. */
static void give_views(struct support_pair *pair)
{
    for (support_view &view : pair->view) {
        for (number &coordinate : view.small)
            coordinate = given(coordinate);
        for (int i = 0; i < FMB_DIM_MAX; i++) {
            view.rotation.xy[i] = given(view.rotation.xy[i]);
            view.rotation.z[i] = given(view.rotation.z[i]);
        }
    }
}

/* A mesh of the points, on a grid of nearly 2^52 units. */
static void check_mesh(const struct support_pair *pair, const struct support_vertex *vertex,
                       int count)
{
    struct polytope mesh;
    double largest = 0;
    for (int k = 0; k < count; k++)
        largest = std::fmax(largest, vec3_largest(vertex[k].at).value);
    polytope_begin(&mesh, pair->dim);
    for (int k = 0; k < count && largest > 0; k++) {
        int64_t at[FMB_DIM_MAX];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            at[axis] = (int64_t) (vertex[k].at[axis].value / largest * 0x1.fp51);
        if (k <= pair->dim)
            polytope_add_point(&mesh, at);
        if (k == pair->dim && !polytope_close(&mesh))
            break;
        for (int f = 0; k > pair->dim && f < mesh.facets; f++)
            polytope_side(&mesh, f, at);
    }
    polytope_end(&mesh);
}

static struct checked_frame frame[2];

/* Bound of the error of an orientation within the window, relative to the length of the quaternion
 * (turn_path.h). */
#define ORIENTATION_ERROR (2.9 * 0x1p-53)

void check_hulls(const struct checked_vertices from[2], plain_double duration)
{
    enum { POINTS = 8 };
    struct support_pair pair;
    struct support_vertex vertex[POINTS];
    struct support_nearest nearest;
    number bounds[2], box[2][FMB_DIM_MAX];
    for (int f = 0; f < 2; f++)
        set_frame(&from[f], &frame[f]);
    const struct frame_pair frames = {
        {&frame[0].frame, &frame[0].placement}, {&frame[1].frame, &frame[1].placement}, duration};
    support_pair_set(&frames, &pair);
    for (int k = 0; k < POINTS && pair.usable; k++) {
        const number n[FMB_DIM_MAX] = {k & 1 ? 0.6 : -0.7, k & 2 ? 0.3 : -0.4,
                                       pair.dim == 2 ? 0
                                       : k & 4       ? 0.5
                                                     : -0.2};
        check_support(&pair, n, &vertex[k]);
    }
    if (pair.usable) {
        check_mesh(&pair, vertex, POINTS);
        /* Less than half is derived for points: the constants beside it would have to be several
         * times too small to be found. */
        pair.error = 0.5 * pair.error.value;
        if (support_search(&pair, INFINITY, &nearest) == FMB_OVERLAPPING) {
            support_contact(&pair, &nearest.simplex, bounds);
            support_box(&pair, &nearest.simplex, box);
        }
        give_views(&pair);
        for (const struct support_view &view : pair.view)
            check_order(&view);
        if (nearest.outcome == GAP_KNOWN)
            check_witness(&pair, &nearest);
    }
    arena_clear();
}

/* The box of the moving vertices over an interval. The box of the vertices in body coordinates
 * counts as given. */
static void check_motion_box(const struct turn_path *path, int f, number lo, number hi)
{
    const struct support_vertices *vertices = &path->pair.view[f].vertices;
    number q[2][4], position[2][FMB_DIM_MAX], box[2][FMB_DIM_MAX], low[FMB_DIM_MAX],
        high[FMB_DIM_MAX];
    for (int axis = 0; axis < vertices->dim; axis++) {
        box[0][axis] = INFINITY, box[1][axis] = -INFINITY;
        for (unsigned i = 0; i < vertices->count; i++) {
            const number x = vertices->at[axis * vertices->stride + i];
            box[0][axis] = fmin(box[0][axis], x), box[1][axis] = fmax(box[1][axis], x);
        }
    }
    turn_path_at(path, f, lo, q[0], position[0]);
    turn_path_at(path, f, hi, q[1], position[1]);
    for (const number *each : q)
        check_vector("ORIENTATION_ERROR", ORIENTATION_ERROR, each, 4,
                     ORIENTATION_ERROR * sqrt((each[0] * each[0] + each[1] * each[1]) +
                                              (each[2] * each[2] + each[3] * each[3])));
    motion_box_between(q, position, vertices->dim, box, path->pair.view[f].reach, low, high);
}

/* The polynomials of a direction over an interval. The direction counts as given. */
static void check_direction(const struct turn_path *path, const struct turn_corners *corners,
                            number lo, number hi)
{
    struct turn_direction direction;
    turn_direction_of(path->pair.view, corners, &direction);
    for (number *m : direction.m)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            m[axis] = given(m[axis]);
    if (vec3_dot(direction.m[0], direction.m[0]) > 0 &&
        (direction.of < 2 || vec3_dot(direction.m[1], direction.m[1]) > 0))
        turn_distance(path, &direction, lo, hi);
}

void check_turns(const struct checked_vertices from[2], plain_double duration)
{
    static const plain_double interval[][2] = {
        {0, 1}, {0.375, 0.5}, {0x1.8p-3, 0x1.8p-3 + 0x1p-40}};
    struct turn_path path;
    for (int f = 0; f < 2; f++)
        set_frame(&from[f], &frame[f]);
    const struct frame_pair frames = {
        {&frame[0].frame, &frame[0].placement}, {&frame[1].frame, &frame[1].placement}, duration};
    turn_path_set(&frames, &path);
    give_views(&path.pair);
    for (struct support_view &view : path.pair.view)
        view.slack = 0;
    const unsigned last[2] = {path.pair.view[0].vertices.count - 1,
                              path.pair.view[1].vertices.count - 1};
    for (const plain_double *each : interval)
        for (int of = 0; of < 3 && path.pair.usable; of++) {
            if (of < 2)
                check_motion_box(&path, of, each[0], each[1]);
            if (of < path.pair.dim && last[of % 2] > 0 && last[1] > 0) {
                const unsigned middle = (last[of % 2] + 1) / 2;
                const struct turn_corners corners = {
                    of,
                    {0, (uint16_t) (of < 2 ? middle : last[0]), (uint16_t) (of < 2 ? last[of] : 0),
                     (uint16_t) last[1]}};
                check_direction(&path, &corners, each[0], each[1]);
            }
        }
    arena_clear();
}
