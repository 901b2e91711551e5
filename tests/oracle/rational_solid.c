#include "rational_solid.h"

static void rational_solid_each(struct rational_solid *solid, void (*call)(mpq_ptr))
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        call(solid->origin[axis]);
        call(solid->velocity[axis]);
        for (int i = 0; i < FMB_DIM_MAX; i++)
            call(solid->component[i][axis]);
    }
}

void rational_add_product(mpq_t sum, int sign, const mpq_t x, const mpq_t y)
{
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

/* The matrix of fmb.h; of a planar quaternion, that of (w, 0, 0, z). */
static void set_rotation(const struct fmb_placement *placement, mpq_t matrix[3][3])
{
    enum { W, X, Y, Z };
    static const int sign[3][4] = {{1, 1, -1, -1}, {1, -1, 1, -1}, {1, -1, -1, 1}};
    mpq_t q[4], norm;
    mpq_inits(q[W], q[X], q[Y], q[Z], norm, NULL);
    const int count = placement->orientation_count;
    mpq_set_d(q[W], count ? placement->orientation[0] : 1);
    for (int i = 1; i < count; i++)
        mpq_set_d(q[count == 2 ? Z : i], placement->orientation[i]);
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
    mpq_clears(q[W], q[X], q[Y], q[Z], norm, NULL);
}

/* out += matrix * vector. */
static void add_turned(mpq_t matrix[3][3], mpq_t vector[3], mpq_t out[3])
{
    for (int row = 0; row < 3; row++)
        for (int axis = 0; axis < 3; axis++)
            rational_add_product(out[row], 1, matrix[row][axis], vector[axis]);
}

/* In body coordinates: origin, and component + rest; of a box, centre - size / 2. */
static void set_local(const struct fmb_frame *frame, struct rational_solid *out)
{
    mpq_t term;
    mpq_init(term);
    out->count = frame->count;
    out->simplex = frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
    for (int axis = 0; axis < frame->dim; axis++) {
        const bool box = frame->shape == FMB_BOX;
        mpq_set_d(out->origin[axis], box ? frame->centre[axis] : frame->origin[axis]);
        for (int i = 0; i < frame->count; i++) {
            mpq_set_d(out->component[i][axis], frame->component[i][axis]);
            mpq_set_d(term, frame->remainder[i][axis]);
            mpq_add(out->component[i][axis], out->component[i][axis], term);
        }
        mpq_div_2exp(term, out->component[axis][axis], 1);
        if (box)
            mpq_sub(out->origin[axis], out->origin[axis], term);
    }
    mpq_clear(term);
}

void rational_solid_init(const struct fmb_frame *frame, const struct fmb_placement *placement,
                         struct rational_solid *out)
{
    struct rational_solid local;
    mpq_t matrix[3][3];
    rational_solid_each(&local, mpq_init);
    rational_solid_each(out, mpq_init);
    for (int i = 0; i < 9; i++)
        mpq_init(matrix[i / 3][i % 3]);
    set_local(frame, &local);
    set_rotation(placement, matrix);
    out->count = local.count;
    out->simplex = local.simplex;
    for (int axis = 0; axis < frame->dim; axis++) {
        mpq_set_d(out->origin[axis], placement->position[axis]);
        mpq_set_d(out->velocity[axis], placement->velocity[axis]);
    }
    add_turned(matrix, local.origin, out->origin);
    for (int i = 0; i < frame->count; i++)
        add_turned(matrix, local.component[i], out->component[i]);
    for (int i = 0; i < 9; i++)
        mpq_clear(matrix[i / 3][i % 3]);
    rational_solid_each(&local, mpq_clear);
}

void rational_solid_clear(struct rational_solid *solid)
{
    rational_solid_each(solid, mpq_clear);
}

void rational_solid_farthest(const struct rational_solid *solid, const mpq_t duration, int axis,
                             int sign, mpq_t out)
{
    mpq_t term, most, direction;
    mpq_inits(term, most, direction, NULL);
    mpq_set_si(direction, sign, 1);
    mpq_mul(out, direction, solid->origin[axis]);
    mpq_mul(term, direction, solid->velocity[axis]);
    mpq_mul(term, term, duration);
    if (mpq_sgn(term) > 0)
        mpq_add(out, out, term);
    for (int i = 0; i < solid->count; i++) {
        mpq_mul(term, direction, solid->component[i][axis]);
        if (mpq_sgn(term) <= 0)
            continue;
        if (!solid->simplex)
            mpq_add(most, most, term);
        else if (mpq_cmp(term, most) > 0)
            mpq_set(most, term);
    }
    mpq_add(out, out, most);
    mpq_clears(term, most, direction, NULL);
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
