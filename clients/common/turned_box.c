#include "turned_box.h"

#include <gmp.h>
#include <math.h>

/* A rotation without division: entry is R(q) |q|^2, [row][column]; norm is |q|^2. */
struct rotation {
    mpq_t entry[3][3], norm;
};

/* out += sign * x * y. */
static void add_product(mpq_t out, int sign, const double x, const double y)
{
    mpq_t a, b;
    mpq_inits(a, b, NULL);
    mpq_set_d(a, x);
    mpq_set_d(b, y);
    mpq_mul(a, a, b);
    (sign > 0 ? mpq_add : mpq_sub)(out, out, a);
    mpq_clears(a, b, NULL);
}

/* A rotation in 2D is one about z. */
static void set_rotation(int dim, const double *orientation, struct rotation *out)
{
    const double w = orientation[0], z = orientation[dim == 2 ? 1 : 3];
    const double q[3] = {dim == 2 ? 0 : orientation[1], dim == 2 ? 0 : orientation[2], z};
    mpq_init(out->norm);
    add_product(out->norm, 1, w, w);
    for (int i = 0; i < 3; i++)
        add_product(out->norm, 1, q[i], q[i]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpq_init(out->entry[i][j]);
            for (int twice = 0; twice < 2; twice++) {
                add_product(out->entry[i][j], 1, q[i], q[j]);
                if (i != j)
                    add_product(out->entry[i][j], (j - i + 3) % 3 == 1 ? -1 : 1, w, q[3 - i - j]);
            }
        }
    for (int i = 0; i < 3; i++) { /* ww + ii - jj - kk = 2 ii + 2 ww - norm */
        add_product(out->entry[i][i], 1, w, w);
        add_product(out->entry[i][i], 1, w, w);
        mpq_sub(out->entry[i][i], out->entry[i][i], out->norm);
    }
}

static void clear_rotation(struct rotation *rotation)
{
    mpq_clear(rotation->norm);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            mpq_clear(rotation->entry[i][j]);
}

/* Returns the nearest double; halfway between two, the one nearer to 0. mpq_get_d() rounds towards
 * 0.
 */
static double round_once(const mpq_t value)
{
    const double near = mpq_get_d(value);
    const double far = nextafter(near, mpq_sgn(value) < 0 ? -INFINITY : INFINITY);
    mpq_t middle, other;
    if (!isfinite(far))
        return near;
    mpq_inits(middle, other, NULL);
    mpq_set_d(middle, near);
    mpq_set_d(other, far);
    mpq_add(middle, middle, other);
    mpq_div_2exp(middle, middle, 1);
    const int beyond = mpq_cmp(value, middle);
    mpq_clears(middle, other, NULL);
    return mpq_sgn(value) < 0 ? (beyond < 0 ? far : near) : (beyond > 0 ? far : near);
}

void turned_box(int dim, const double *centre, const double *size, const double *orientation,
                double *numbers)
{
    struct rotation rotation;
    mpq_t corner[3], edge;
    set_rotation(dim, orientation, &rotation);
    mpq_init(edge);
    for (int axis = 0; axis < dim; axis++) {
        mpq_init(corner[axis]);
        mpq_set_d(corner[axis], centre[axis]);
    }
    for (int i = 0; i < dim; i++)
        for (int axis = 0; axis < dim; axis++) {
            mpq_set_d(edge, size[i]);
            mpq_mul(edge, edge, rotation.entry[axis][i]);
            mpq_div(edge, edge, rotation.norm);
            numbers[dim + i * dim + axis] = round_once(edge);
            mpq_div_2exp(edge, edge, 1);
            mpq_sub(corner[axis], corner[axis], edge);
        }
    for (int axis = 0; axis < dim; axis++) {
        numbers[axis] = round_once(corner[axis]);
        mpq_clear(corner[axis]);
    }
    mpq_clear(edge);
    clear_rotation(&rotation);
}
