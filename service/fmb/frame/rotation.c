#include "rotation.h"

#include <math.h>

struct quaternion rotation_scaled(struct quaternion q)
{
    const int exponent = ilogb(quaternion_largest(q));
    const int first = exponent < -1000 ? -1000 : exponent;
    /* rest is 1 unless exponent < -1000. */
    const double scale = ldexp(1, -first), rest = ldexp(1, first - exponent);
    return (struct quaternion){q.w * scale * rest, q.x * scale * rest, q.y * scale * rest,
                               q.z * scale * rest};
}

/* Returns whether a component is 0 or, scaled, at least least in magnitude; false for a NaN. */
INLINE bool is_in_range(double given, double scaled, double least)
{
    return given == 0 || fabs(scaled) >= least;
}

bool rotation_is_spread_legal(struct quaternion given, struct quaternion q)
{
    const double largest = quaternion_largest(q), least = largest * 0x1p-200;
    return largest > 0 && is_in_range(given.w, q.w, least) && is_in_range(given.x, q.x, least) &&
           is_in_range(given.y, q.y, least) && is_in_range(given.z, q.z, least);
}

/* Returns the entry of row i and column j if it is exactly +-1 (rotation.h), else 0. q: w, x, y, z.
 */
static int unit_entry(const double q[4], int i, int j)
{
    const int k = 3 - i - j;
    if (i == j) {
        const double *v = q + 1;
        const double y = v[(i + 1) % 3], z = v[(i + 2) % 3];
        return y == 0 && z == 0 ? 1 : q[0] == 0 && v[i] == 0 ? -1 : 0;
    }
    /* The numerator is 2 (v_i v_j - s w v_k), where s is 1 if i, j, k are cyclic, else -1. */
    const double x = q[1 + i], y = q[1 + j], z = (i + 1) % 3 == j ? -q[1 + k] : q[1 + k];
    return x == y && q[0] == z ? 1 : x == -y && q[0] == -z ? -1 : 0;
}

static void set_entry(struct rotation_matrix *out, int row, int column, double x)
{
    if (row < 2)
        out->xy[column][row] = x;
    else
        out->z[column] = x;
}

void rotation_set_units(struct quaternion quaternion, struct rotation_matrix *out)
{
    const double q[4] = {quaternion.w, quaternion.x, quaternion.y, quaternion.z};
    bool column_exact[FMB_DIM_MAX] = {false};
    for (int i = 0; i < FMB_DIM_MAX; i++)
        for (int j = 0; j < FMB_DIM_MAX; j++) {
            const bool near_one = fabs(rotation_entry(out, i, j)) > 1 - 0x1p-40;
            const int unit = near_one ? unit_entry(q, i, j) : 0;
            if (!unit)
                continue;
            for (int k = 0; k < FMB_DIM_MAX; k++) {
                set_entry(out, i, k, 0);
                set_entry(out, k, j, 0);
            }
            set_entry(out, i, j, unit);
            out->axis_exact[i] = column_exact[j] = true;
            break;
        }
    out->small = false;
    for (int i = 0; i < FMB_DIM_MAX; i++)
        for (int j = 0; j < FMB_DIM_MAX; j++)
            out->small |= !out->axis_exact[i] && !column_exact[j] &&
                          fabs(rotation_entry(out, i, j)) < 0x1p-60;
    out->exact = out->axis_exact[0] & out->axis_exact[1] & out->axis_exact[2];
}
