#include "rotation.h"

#include <math.h>
#include <string.h>

/* As components in space: w, x, y, z. */
INLINE void set_quaternion(const double *given, int count, double q[4])
{
    const double plane[4] = {given[0], 0, 0, given[1]};
    memcpy(q, count == 2 ? plane : given, sizeof plane);
}

INLINE double largest_of(const double q[4])
{
    const double w = fabs(q[0]), x = fabs(q[1]), y = fabs(q[2]), z = fabs(q[3]);
    const double wx = w > x ? w : x, yz = y > z ? y : z;
    return wx > yz ? wx : yz;
}

/* Scales q by a power of two so that its largest component lies in [0.5, 2]. */
static void scale(double q[4])
{
    const int exponent = ilogb(largest_of(q));
    for (int i = 0; i < 4; i++)
        q[i] = ldexp(q[i], -exponent);
}

INLINE bool is_scaled(const double q[4])
{
    const double largest = largest_of(q);
    return largest >= 0.5 && largest <= 2; /* as of unit length, which nearly all have */
}

bool rotation_is_orientation(const double *orientation, int count)
{
    double q[4];
    set_quaternion(orientation, count, q);
    const bool zero[4] = {q[0] == 0, q[1] == 0, q[2] == 0, q[3] == 0};
    if (!is_scaled(q)) {
        const double sum = (q[0] * 0 + q[1] * 0) + (q[2] * 0 + q[3] * 0);
        if (sum != 0 || largest_of(q) == 0) /* a number is not finite, or all are 0 */
            return false;
        scale(q);
    }
    const double least = largest_of(q) * 0x1p-200;
    return (zero[0] | (fabs(q[0]) >= least)) & (zero[1] | (fabs(q[1]) >= least)) &
           (zero[2] | (fabs(q[2]) >= least)) & (zero[3] | (fabs(q[3]) >= least)); /* no NaN */
}

/* The entry of row i and column j that is +-1, as its quaternion says exactly; 0: it is not. */
static int unit_entry(const double q[4], int i, int j)
{
    const int k = 3 - i - j;
    if (i == j) {
        const double *v = q + 1;
        const double y = v[(i + 1) % 3], z = v[(i + 2) % 3];
        return y == 0 && z == 0 ? 1 : q[0] == 0 && v[i] == 0 ? -1 : 0;
    }
    /* 2 (v_i v_j - turn w v_k): turn is 1 where i, j, k are cyclic. */
    const double x = q[1 + i], y = q[1 + j], z = (i + 1) % 3 == j ? -q[1 + k] : q[1 + k];
    return x == y && q[0] == z ? 1 : x == -y && q[0] == -z ? -1 : 0;
}

static void set_entry(struct rotation *out, int row, int column, double x)
{
    if (row < 2)
        out->xy[column][row] = x;
    else
        out->z[column] = x;
}

/* Sets the rows that are exactly unit vectors, and the columns that are so with them. */
static void set_units(const double q[4], struct rotation *out)
{
    for (int i = 0; i < out->dim; i++)
        for (int j = 0; j < out->dim; j++) {
            const bool near_one = fabs(rotation_entry(out, i, j)) > 1 - 0x1p-40;
            const int unit = near_one ? unit_entry(q, i, j) : 0;
            if (!unit)
                continue;
            for (int k = 0; k < out->dim; k++) {
                set_entry(out, i, k, 0);
                set_entry(out, k, j, 0);
            }
            set_entry(out, i, j, unit);
            out->axis_exact[i] = true;
            break;
        }
    out->exact = out->axis_exact[0] & out->axis_exact[1] & (out->axis_exact[2] | (out->dim == 2));
}

/* Whether some row may be a unit vector: a component of the quaternion is 0, or as large as the
 * first (unit_entry()). No product underflows. */
INLINE bool may_have_units(const double q[4])
{
    const double w = fabs(q[0]), x = fabs(q[1]), y = fabs(q[2]), z = fabs(q[3]);
    return (w * x) * (y * z) == 0 || (w - x) * (w - y) * (w - z) == 0;
}

static void set_identity(struct rotation *out)
{
    for (int i = 0; i < FMB_DIM_MAX; i++)
        for (int j = 0; j < FMB_DIM_MAX; j++)
            set_entry(out, i, j, i == j && i < out->dim);
    for (int i = 0; i < out->dim; i++)
        out->axis_exact[i] = true;
    out->exact = true;
}

/* In 2D the planar quaternion is one in space whose x and y are 0. */
void rotation_of(const struct fmb_placement *placement, int dim, struct rotation *out)
{
    double q[4];
    out->dim = dim;
    out->turned = placement->orientation_count != 0;
    out->exact = out->axis_exact[0] = out->axis_exact[1] = out->axis_exact[2] = false;
    if (!out->turned) {
        set_identity(out);
        return;
    }
    set_quaternion(placement->orientation, placement->orientation_count, q);
    if (!is_scaled(q))
        scale(q);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double ww = w * w, xx = x * x, yy = y * y, zz = z * z;
    const double inverse = 1 / ((ww + xx) + (yy + zz)), twice = 2 * inverse;
    const double wx = w * x, wy = w * y, wz = w * z, xy = x * y, xz = x * z, yz = y * z;
    out->xy[0] = (rotation_two){((ww + xx) - (yy + zz)) * inverse, (xy + wz) * twice};
    out->xy[1] = (rotation_two){(xy - wz) * twice, ((ww + yy) - (xx + zz)) * inverse};
    out->xy[2] = (rotation_two){(xz + wy) * twice, (yz - wx) * twice};
    out->z[0] = (xz - wy) * twice;
    out->z[1] = (yz + wx) * twice;
    out->z[2] = dim == 2 ? 0 : ((ww + zz) - (xx + yy)) * inverse;
    if (may_have_units(q))
        set_units(q, out);
}
