#include "turned_box.h"

#include <gmp.h>
#include <math.h>
#include <string.h>

/* out += factor * x * y. */
static void add_product(mpq_t out, int factor, double x, double y)
{
    mpq_t a, b;
    mpq_inits(a, b, NULL);
    mpq_set_d(a, x);
    mpq_set_d(b, y);
    mpq_mul(a, a, b);
    mpq_set_si(b, factor, 1);
    mpq_mul(a, a, b);
    mpq_add(out, out, a);
    mpq_clears(a, b, NULL);
}

/* out = (R(q) |q|^2)[row][column], for q = (w, v). */
static void set_entry(mpq_t out, double w, const double v[3], int row, int column)
{
    mpq_set_si(out, 0, 1);
    if (row == column) {
        add_product(out, 1, w, w);
        for (int i = 0; i < 3; i++)
            add_product(out, i == row ? 1 : -1, v[i], v[i]);
    } else {
        add_product(out, 2, v[row], v[column]);
        add_product(out, (column - row + 3) % 3 == 1 ? -2 : 2, w, v[3 - row - column]);
    }
}

/* Returns the nearest double; halfway between two, the one nearer to 0. mpq_get_d() rounds towards
 * 0. */
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
    const bool beyond = mpq_sgn(value) * mpq_cmp(value, middle) > 0;
    mpq_clears(middle, other, NULL);
    return beyond ? far : near;
}

void turned_box(int dim, const double *orientation, double *origin, double *components)
{
    const double w = orientation[0];
    double v[3] = {0, 0, orientation[1]}; /* in 2D about z */
    double size[FMB_DIM_MAX];
    mpq_t norm, edge, number, corner;
    memcpy(size, components, (size_t) dim * sizeof *size);
    if (dim == 3)
        memcpy(v, orientation + 1, sizeof v);
    mpq_inits(norm, edge, number, corner, NULL);
    add_product(norm, 1, w, w);
    for (int i = 0; i < 3; i++)
        add_product(norm, 1, v[i], v[i]);
    for (int axis = 0; axis < dim; axis++) {
        mpq_set_d(corner, origin[axis]);
        for (int i = 0; i < dim; i++) {
            set_entry(edge, w, v, axis, i);
            mpq_set_d(number, size[i]);
            mpq_mul(edge, edge, number);
            mpq_div(edge, edge, norm);
            components[i * dim + axis] = round_once(edge);
            mpq_div_2exp(edge, edge, 1);
            mpq_sub(corner, corner, edge);
        }
        origin[axis] = round_once(corner);
    }
    mpq_clears(norm, edge, number, corner, NULL);
}
