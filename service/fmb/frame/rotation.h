/* The rotation matrix of a placement in doubles, R(q) of fmb.h, with a bound on its error.
 *
 * Accuracy, with u = 2^-53 and n = ww + xx + yy + zz:
 *
 * 1. Scaling. A quaternion whose n is not within [2^-400, 2^400] is scaled by a power of two first.
 *    Then no square overflows, components other than 0 are at least 2^-402, and no product of two
 *    underflows.
 * 2. The norm n is a sum of positive terms. It is computed from sums of two squares, ww + xx and
 *    yy + zz, so that every square passes at most three roundings. The relative error of n is at
 *    most 3.01 u, that of 1 / n at most 4.02 u.
 * 3. The numerators. On the diagonal, (ww + xx) - (yy + zz) is off by at most 3.01 u n. Off the
 *    diagonal, 2 (xy - wz) is off by at most 2.01 u (2 |xy| + 2 |wz|) <= 2.01 u n.
 *    As a matrix these errors have a Frobenius norm of at most
 *    u n sqrt(3 * 3.01^2 + 6 * 2.01^2) < 7.2 u n.
 * 4. The matrix. All numerators are multiplied with the same 1 / n, whose error scales R by up to
 *    4.02 u, and each product is rounded. The norm of R is 1, its Frobenius norm sqrt(3). So the
 *    norm of the error of the matrix is less than
 *
 *        u (7.2 + 4.03 + 1.01 sqrt(3)) < 13 u,    MATRIX_ERROR.
 *
 * 5. The product R v. Each coordinate is rounded three times: it is off by at most 3.01 u times the
 *    sum of the magnitudes of its terms, which is at most |v|. For the vector that is at most
 *    3.01 sqrt(3) u |v| < 5.22 u |v|. Coordinates below 2^-60 |v| become 0, which adds less than
 *    0.02 u |v|: 5.3 u |v|, PRODUCT_ERROR.
 *
 * Together less than 18.3 u |v|. ROTATION_ERROR is 21 u; the difference covers the rounding of
 * bounds that are computed with it.
 *
 * A row that is exactly plus or minus a unit vector is computed without error. An entry is +-1 if
 * and only if a sum of two squares is 0:
 *
 *     ww + xx - yy - zz = n   if and only if   y = z = 0
 *     ww + xx - yy - zz = -n  if and only if   w = x = 0
 *     2 (yz - wx) = n         if and only if   (y - z)^2 + (w + x)^2 = 0,
 *
 * and in the same way for the other entries. No shared state. */
#ifndef FMB_ROTATION_H
#define FMB_ROTATION_H

#include "checked.h"
#include "fmb.h"
#include "inlined.h"

#include <math.h>
#include <string.h>

#define NORM_ERROR (4.03 * 0x1p-53) /* relative to 1 / n */
#define MATRIX_ERROR (13 * 0x1p-53)
#define PRODUCT_ERROR (5.3 * 0x1p-53)
#define ROTATION_ERROR (21 * 0x1p-53)

/* A SIMD vector of two coordinates, or two rows. tests/checked defines its own. */
#ifndef ROTATION_TWO
typedef double rotation_two __attribute__((vector_size(16)));
#endif

struct rotation_matrix {
    int dim;
    bool turned;                  /* the placement has an orientation; else R is the identity */
    bool exact;                   /* all entries are 0 or +-1, exactly */
    bool axis_exact[FMB_DIM_MAX]; /* the entries of row [axis] are 0 or +-1, exactly */
    bool general;                 /* 3D, and the magnitude of every entry is at least 2^-60 */
    bool small;                   /* an entry may be below 2^-60, and not exactly 0 */
    /* The columns: rows 0 and 1 in xy, row 2 in z. */
    rotation_two xy[FMB_DIM_MAX];
    double z[FMB_DIM_MAX];
};

/* Returns R[row][column]. */
static inline double rotation_entry(const struct rotation_matrix *rotation, int row, int column)
{
    return row < 2 ? rotation->xy[column][row] : rotation->z[column];
}

/* out := R v. */
INLINE void rotation_apply(const struct rotation_matrix *rotation, const double v[FMB_DIM_MAX],
                           double out[FMB_DIM_MAX])
{
    const rotation_two xy =
        (rotation->xy[0] * v[0] + rotation->xy[1] * v[1]) + rotation->xy[2] * v[2];
    out[2] = (rotation->z[0] * v[0] + rotation->z[1] * v[1]) + rotation->z[2] * v[2];
    memcpy(out, &xy, sizeof xy);
}

struct quaternion {
    double w, x, y, z;
};

/* Returns an orientation of 2 numbers (w, z) or 4 (w, x, y, z) as a quaternion. */
INLINE struct quaternion quaternion_of(const double *given, int count)
{
    if (count == 2)
        return (struct quaternion){given[0], 0, 0, given[1]};
    return (struct quaternion){given[0], given[1], given[2], given[3]};
}

/* Returns the largest magnitude of a component. In: no NaN. */
INLINE double quaternion_largest(struct quaternion q)
{
    const double w = fabs(q.w), x = fabs(q.x), y = fabs(q.y), z = fabs(q.z);
    const double wx = w > x ? w : x, yz = y > z ? y : z;
    return wx > yz ? wx : yz;
}

/* Returns n = |q|^2, rounded. */
INLINE double quaternion_norm(struct quaternion q)
{
    return (q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z);
}

/* Returns whether a legal orientation of this norm needs no scaling: no square overflows, and no
 * product of two components other than 0 underflows. */
INLINE bool quaternion_is_scaled(double norm)
{
    return norm >= 0x1p-400 && norm <= 0x1p400;
}

/* Returns q times a power of two, with the magnitude of its largest component in [1, 2). In:
 * finite, not all 0. */
struct quaternion rotation_scaled(struct quaternion q);

/* Returns whether every component of given is 0 or at least 2^-200 times the largest. In: q is
 * given times a power of two. */
bool rotation_is_spread_legal(struct quaternion given, struct quaternion q);

/* Makes exact the rows that are plus or minus a unit vector, and the columns of their entries. Sets
 * small for the entries that remain. */
void rotation_set_units(struct quaternion q, struct rotation_matrix *out);

/* Returns whether fmb_placement_check() accepts the orientation. In: count is 2 or 4. */
INLINE bool rotation_is_orientation(const double *orientation, int count)
{
    const struct quaternion q = quaternion_of(orientation, count);
    const double norm = quaternion_norm(q);
    if (quaternion_is_scaled(norm)) {
        /* Let L be the largest magnitude of a component, and m the smallest. Then norm >= L^2 and
         * |w x y z| <= m L^3. So |w x y z| >= 2^-180 norm^2 implies m >= 2^-180 L. In the planar
         * case |w z| <= m L, and |w z| >= 2^-180 norm implies the same. */
        const bool planar = q.x == 0 && q.y == 0;
        const bool large = planar ? fabs(q.w * q.z) >= 0x1p-180 * norm
                                  : fabs((q.w * q.x) * (q.y * q.z)) >= 0x1p-180 * norm * norm;
        return large || rotation_is_spread_legal(q, q);
    }
    const double sum = (q.w * 0 + q.x * 0) + (q.y * 0 + q.z * 0); /* 0 if all are finite */
    return sum == 0 && quaternion_largest(q) > 0 && rotation_is_spread_legal(q, rotation_scaled(q));
}

/* Returns whether some row may be plus or minus a unit vector: a component of q is 0, or as large
 * in magnitude as w (unit_entry()). No product underflows. */
INLINE bool rotation_may_have_units(struct quaternion q)
{
    const double w = fabs(q.w), x = fabs(q.x), y = fabs(q.y), z = fabs(q.z);
    return (w * x) * (y * z) == 0 || (w - x) * (w - y) * (w - z) == 0;
}

/* Returns whether every entry is at least 2^-60 in magnitude. No entry is larger than 1 + 9 u, so
 * that the product of all is less than twice the smallest. */
INLINE bool rotation_no_entry_is_small(const struct rotation_matrix *rotation)
{
    const rotation_two xy = (rotation->xy[0] * rotation->xy[1]) * rotation->xy[2];
    const double z = (rotation->z[0] * rotation->z[1]) * rotation->z[2];
    return fabs((xy[0] * xy[1]) * z) >= 0x1p-59;
}

/* Sets a rotation about the z axis, or in the plane. exact: cosine and sine are 0 or +-1, exactly.
 */
INLINE void rotation_set_planar(double cosine, double sine, bool exact, struct rotation_matrix *out)
{
    out->xy[0] = (rotation_two){cosine, sine};
    out->xy[1] = (rotation_two){0 - sine, cosine};
    out->xy[2] = (rotation_two){0, 0};
    out->z[0] = out->z[1] = 0;
    out->z[2] = out->dim == 3;
    out->axis_exact[0] = out->axis_exact[1] = out->exact = exact;
    out->axis_exact[2] = out->dim == 3;
    out->general = false;
    out->small = !exact && fabs(cosine * sine) < 0x1p-59;
}

/* Sets the rotation of a quaternion with x = y = 0. In: the norm is scaled. */
INLINE void rotation_set_about_z(double w, double z, struct rotation_matrix *out)
{
    const double ww = w * w, zz = z * z, of_norm = 1 / (ww + zz);
    CHECK_BOUND(NORM_ERROR, false, of_norm, NORM_ERROR * of_norm);
    const double inverse = CHECK_GIVEN(of_norm);
    if (w * z == 0)
        rotation_set_planar(z == 0 ? 1 : -1, 0, true, out);
    else if (fabs(w) == fabs(z))
        rotation_set_planar(0, w == z ? 1 : -1, true, out);
    else
        rotation_set_planar((ww - zz) * inverse, (w * z) * (2 * inverse), false, out);
}

/* Sets the rotation of any other quaternion. In: the norm is scaled. */
INLINE void rotation_set_in_space(struct quaternion q, struct rotation_matrix *out)
{
    const double w = q.w, x = q.x, y = q.y, z = q.z;
    const double ww = w * w, xx = x * x, yy = y * y, zz = z * z;
    const double of_norm = 1 / ((ww + xx) + (yy + zz));
    CHECK_BOUND(NORM_ERROR, false, of_norm, NORM_ERROR * of_norm);
    const double inverse = CHECK_GIVEN(of_norm), twice = 2 * inverse;
    const double wx = w * x, wy = w * y, wz = w * z, xy = x * y, xz = x * z, yz = y * z;
    out->xy[0] = (rotation_two){((ww + xx) - (yy + zz)) * inverse, (xy + wz) * twice};
    out->xy[1] = (rotation_two){(xy - wz) * twice, ((ww + yy) - (xx + zz)) * inverse};
    out->xy[2] = (rotation_two){(xz + wy) * twice, (yz - wx) * twice};
    out->z[0] = (xz - wy) * twice;
    out->z[1] = (yz + wx) * twice;
    out->z[2] = ((ww + zz) - (xx + yy)) * inverse;
    out->axis_exact[0] = out->axis_exact[1] = out->axis_exact[2] = out->exact = false;
    out->general = rotation_no_entry_is_small(out);
    out->small = !out->general;
    if (out->small && rotation_may_have_units(q))
        rotation_set_units(q, out);
}

/* Computes the rotation of a placement. In: fmb_placement_check() accepts the placement. In 2D the
 * quaternion has x = y = 0. */
INLINE void rotation_of(const struct fmb_placement *placement, int dim, struct rotation_matrix *out)
{
    out->dim = dim;
    out->turned = placement->orientation_count != 0;
    if (!out->turned) {
        rotation_set_planar(1, 0, true, out);
        return;
    }
    struct quaternion q = quaternion_of(placement->orientation, placement->orientation_count);
    if (!quaternion_is_scaled(quaternion_norm(q)))
        q = rotation_scaled(q);
    if (q.x == 0 && q.y == 0)
        rotation_set_about_z(q.w, q.z, out);
    else
        rotation_set_in_space(q, out);
}

#endif
