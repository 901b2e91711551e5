#include "rational_solid.h"

#include "memory.h"

static void allocate(struct rational_solid *solid, int count, bool hull)
{
    solid->count = count;
    solid->hull = hull;
    mpq_init(solid->radius);
    solid->column = memory_get((size_t) count * sizeof *solid->column);
    rational_vector_init(solid->origin);
    rational_vector_init(solid->velocity);
    for (int i = 0; i < count; i++)
        rational_vector_init(solid->column[i]);
}

void rational_solid_clear(struct rational_solid *solid)
{
    rational_vector_clear(solid->origin);
    rational_vector_clear(solid->velocity);
    mpq_clear(solid->radius);
    for (int i = 0; i < solid->count; i++)
        rational_vector_clear(solid->column[i]);
    free(solid->column);
}

static bool is_whole(const mpq_t x)
{
    return mpz_cmp_ui(mpq_denref(x), 1) == 0;
}

void rational_add_product(mpq_t sum, int sign, const mpq_t x, const mpq_t y)
{
    if (is_whole(sum) && is_whole(x) && is_whole(y)) { /* as most are: nothing is reduced */
        (sign < 0 ? mpz_submul : mpz_addmul)(mpq_numref(sum), mpq_numref(x), mpq_numref(y));
        return;
    }
    mpq_t product;
    mpq_init(product);
    mpq_mul(product, x, y);
    if (sign < 0)
        mpq_neg(product, product);
    mpq_add(sum, sum, product);
    mpq_clear(product);
}

/* 2 (u v + sign s t). */
static void twice(mpq_t out, const mpq_t u, const mpq_t v, int sign, const mpq_t s, const mpq_t t)
{
    mpq_set_ui(out, 0, 1);
    rational_add_product(out, 1, u, v);
    rational_add_product(out, sign, s, t);
    mpq_add(out, out, out);
}

static void set_orientation(const double *number, int count, mpq_t q[4])
{
    mpq_set_d(q[0], count ? number[0] : 1);
    for (int i = 1; i < 4; i++)
        mpq_set_ui(q[i], 0, 1);
    for (int i = 1; i < count; i++)
        mpq_set_d(q[count == 2 ? 3 : i], number[i]);
}

void rational_orientation(const struct fmb_placement *placement, mpq_t start[4], mpq_t end[4])
{
    const int count = placement->orientation_count;
    mpq_t dot;
    mpq_init(dot);
    set_orientation(placement->orientation, count, start);
    set_orientation(placement->end_count ? placement->end_orientation : placement->orientation,
                    count, end);
    for (int i = 0; i < 4; i++)
        rational_add_product(dot, 1, start[i], end[i]);
    for (int i = 0; i < 4 && mpq_sgn(dot) < 0; i++)
        mpq_neg(end[i], end[i]);
    mpq_clear(dot);
}

/* out += at * (end - out). */
static void move_on(mpq_t out, mpq_srcptr at, const mpq_t end)
{
    mpq_t way;
    mpq_init(way);
    mpq_sub(way, end, out);
    rational_add_product(out, 1, way, at);
    mpq_clear(way);
}

/* The matrix of fmb.h; of a planar quaternion, that of (w, 0, 0, z). */
static void set_rotation(const struct fmb_placement *placement, mpq_srcptr at, mpq_t matrix[3][3])
{
    enum { W, X, Y, Z };
    static const int sign[3][4] = {{1, 1, -1, -1}, {1, -1, 1, -1}, {1, -1, -1, 1}};
    mpq_t q[4], end[4], norm;
    mpq_init(norm);
    for (int i = 0; i < 4; i++)
        mpq_inits(q[i], end[i], NULL);
    rational_orientation(placement, q, end);
    for (int i = 0; i < 4 && at; i++)
        move_on(q[i], at, end[i]);
    for (int i = 0; i < 4; i++)
        rational_add_product(norm, 1, q[i], q[i]);
    for (int axis = 0; axis < 3; axis++) {
        mpq_set_ui(matrix[axis][axis], 0, 1);
        for (int i = 0; i < 4; i++)
            rational_add_product(matrix[axis][axis], sign[axis][i], q[i], q[i]);
    }
    twice(matrix[0][1], q[X], q[Y], -1, q[W], q[Z]);
    twice(matrix[1][0], q[X], q[Y], +1, q[W], q[Z]);
    twice(matrix[0][2], q[X], q[Z], +1, q[W], q[Y]);
    twice(matrix[2][0], q[X], q[Z], -1, q[W], q[Y]);
    twice(matrix[1][2], q[Y], q[Z], -1, q[W], q[X]);
    twice(matrix[2][1], q[Y], q[Z], +1, q[W], q[X]);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            mpq_div(matrix[row][column], matrix[row][column], norm);
    for (int i = 0; i < 4; i++)
        mpq_clears(q[i], end[i], NULL);
    mpq_clear(norm);
}

/* Sets the position at a time, and the velocity to 0. */
static void stop(const struct fmb_placement *placement, mpq_srcptr at, double duration,
                 struct rational_solid *out)
{
    mpq_t end;
    mpq_init(end);
    for (int axis = 0; axis < placement->body->dim; axis++) {
        mpq_set_d(end, duration);
        mpq_mul(end, end, out->velocity[axis]);
        mpq_add(end, end, out->origin[axis]);
        if (placement->end_count)
            mpq_set_d(end, placement->end_position[axis]);
        move_on(out->origin[axis], at, end);
        mpq_set_ui(out->velocity[axis], 0, 1);
    }
    mpq_clear(end);
}

/* out += matrix * vector. */
static void add_turned(mpq_t matrix[3][3], mpq_t vector[3], mpq_t out[3])
{
    for (int row = 0; row < 3; row++)
        for (int axis = 0; axis < 3; axis++)
            rational_add_product(out[row], 1, matrix[row][axis], vector[axis]);
}

/* In body coordinates: the vertices of a hull, as they are. */
static void set_vertices(const struct fmb_frame *frame, struct rational_solid *out)
{
    allocate(out, (int) frame->vertex_count, true);
    for (int i = 0; i < out->count; i++)
        for (int axis = 0; axis < frame->dim; axis++)
            mpq_set_d(out->column[i][axis], frame->vertices[axis * frame->vertex_stride + i]);
}

/* The same of other frames: of a box centre - size / 2; component + remainder; a tetrahedron and a
 * face have the origin itself as a vertex, their last. */
static void set_local(const struct fmb_frame *frame, struct rational_solid *out)
{
    const bool simplex = frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
    mpq_t term;
    if (frame->shape == FMB_HULL) {
        set_vertices(frame, out);
        return;
    }
    allocate(out, frame->count + simplex, simplex);
    mpq_init(term);
    for (int axis = 0; axis < frame->dim; axis++) {
        const bool box = frame->shape == FMB_BOX;
        mpq_set_d(out->origin[axis], box ? frame->centre[axis] : frame->origin[axis]);
        for (int i = 0; i < frame->count; i++) {
            mpq_set_d(out->column[i][axis], frame->component[i][axis]);
            mpq_set_d(term, frame->remainder[i][axis]);
            mpq_add(out->column[i][axis], out->column[i][axis], term);
        }
        if (!box)
            continue;
        mpq_div_2exp(term, out->column[axis][axis], 1);
        mpq_sub(out->origin[axis], out->origin[axis], term);
    }
    mpq_clear(term);
}

void rational_solid_init(const struct fmb_frame *frame, const struct fmb_placement *placement,
                         struct rational_solid *out)
{
    rational_solid_init_at(frame, placement, NULL, 0, out);
}

void rational_solid_init_at(const struct fmb_frame *frame, const struct fmb_placement *placement,
                            mpq_srcptr at, double duration, struct rational_solid *out)
{
    struct rational_solid local;
    mpq_t matrix[3][3];
    for (int i = 0; i < 9; i++)
        mpq_init(matrix[i / 3][i % 3]);
    set_local(frame, &local);
    set_rotation(placement, at, matrix);
    allocate(out, local.count, local.hull);
    mpq_set_d(out->radius, frame->radius);
    for (int axis = 0; axis < frame->dim; axis++) {
        mpq_set_d(out->origin[axis], placement->position[axis]);
        mpq_set_d(out->velocity[axis], placement->velocity[axis]);
    }
    if (at)
        stop(placement, at, duration, out);
    add_turned(matrix, local.origin, out->origin);
    for (int i = 0; i < local.count; i++)
        add_turned(matrix, local.column[i], out->column[i]);
    for (int i = 0; i < 9; i++)
        mpq_clear(matrix[i / 3][i % 3]);
    rational_solid_clear(&local);
}

void rational_solid_support(struct rational_solid *solid, rational_vector n, mpq_t extent,
                            mpq_t *point)
{
    mpq_t at;
    int best = -1;
    mpq_init(at);
    mpq_set_ui(extent, 0, 1);
    for (int i = 0; i < solid->count; i++) {
        rational_dot(at, n, solid->column[i]);
        if (solid->hull && (i == 0 || mpq_cmp(at, extent) > 0)) {
            best = i;
            mpq_set(extent, at);
        }
        if (solid->hull || mpq_sgn(at) <= 0)
            continue;
        mpq_add(extent, extent, at);
        for (int axis = 0; axis < FMB_DIM_MAX && point; axis++)
            mpq_add(point[axis], point[axis], solid->column[i][axis]);
    }
    for (int axis = 0; axis < FMB_DIM_MAX && point && best >= 0; axis++)
        mpq_add(point[axis], point[axis], solid->column[best][axis]);
    mpq_clear(at);
}

void rational_solid_farthest(struct rational_solid *solid, const mpq_t duration, int axis, int sign,
                             mpq_t out)
{
    rational_vector direction;
    mpq_t term;
    rational_vector_init(direction);
    mpq_init(term);
    mpq_set_si(direction[axis], sign, 1);
    rational_solid_support(solid, direction, out, NULL);
    rational_add_product(out, 1, direction[axis], solid->origin[axis]);
    mpq_mul(term, direction[axis], solid->velocity[axis]);
    mpq_mul(term, term, duration);
    if (mpq_sgn(term) > 0)
        mpq_add(out, out, term);
    mpq_add(out, out, solid->radius);
    rational_vector_clear(direction);
    mpq_clear(term);
}

void rational_vector_init(rational_vector v)
{
    mpq_inits(v[0], v[1], v[2], NULL);
}

void rational_vector_clear(rational_vector v)
{
    mpq_clears(v[0], v[1], v[2], NULL);
}

void rational_dot(mpq_t out, rational_vector x, rational_vector y)
{
    mpq_set_ui(out, 0, 1);
    for (int axis = 0; axis < 3; axis++)
        rational_add_product(out, 1, x[axis], y[axis]);
}
