/* The rotation of a placement in doubles: R(q) of fmb.h, with a bound on its error.
 *
 * Accuracy, with u = 2^-53. A quaternion whose norm n is not within [2^-400, 2^400] is scaled by a
 * power of two first. Then no square overflows, components other than 0 are at least 2^-402, and no
 * product of two underflows. With the sums of squares p = ww + xx, r = yy + zz and so on, every
 * square passes at most three roundings on its way into the norm n, a sum of positive terms: its
 * relative error is at most 3.01 u, that of 1 / n 4.02 u. A diagonal entry (ww + xx) - (yy + zz) is
 * off by at most 3.01 u n, one beside it, 2 (xy - wz), by 2.01 u (2 |xy| + 2 |wz|) <= 2.01 u n.
 * Times 1 / n, with one more rounding: an entry is off by at most 3.01 u + 5.04 u |entry|. The
 * Frobenius norm of the error of the matrix, whose own is sqrt(3), is at most
 *
 *     u (sqrt(3 * 3.01^2 + 6 * 2.01^2) + 5.04 sqrt(3)) < 15.9 u.
 *
 * A vector times the matrix is rounded three times in each coordinate: at most 3.01 u of the sum of
 * the magnitudes, which is at most |v|, so 5.3 u |v| for the vector. Coordinates below 2^-60 |v|
 * become 0, which adds less than 0.1 u |v|. Together less than 21.3 u |v|; ROTATION_ERROR leaves
 * the rest to the rounding of what is computed with it.
 *
 * A row that is exactly +- a unit vector is computed so. An entry is +-1 if and only if a sum of
 * two squares is 0: with n = ww + xx + yy + zz,
 *
 *     ww + xx - yy - zz = n   if and only if   y = z = 0
 *     ww + xx - yy - zz = -n  if and only if   w = x = 0
 *     2 (yz - wx) = n         if and only if   (y - z)^2 + (w + x)^2 = 0,
 *
 * and likewise for the other entries. */
#ifndef FMB_ROTATION_H
#define FMB_ROTATION_H

#include "fmb.h"
#include "inlined.h"

#include <math.h>
#include <string.h>

#define ROTATION_ERROR (24 * 0x1p-53)

/* Two coordinates side by side. */
typedef double rotation_two __attribute__((vector_size(16)));

struct rotation_matrix {
    int dim;
    bool turned;                  /* there is an orientation; else the matrix is the identity */
    bool exact;                   /* all entries are 0 or +-1, exactly */
    bool axis_exact[FMB_DIM_MAX]; /* those of row [axis] */
    bool general;                 /* 3D, and no entry is smaller than 2^-60 */
    bool small;                   /* an entry may be, and not exactly 0 */
    /* By columns: rows 0 and 1, and row 2. */
    rotation_two xy[FMB_DIM_MAX];
    double z[FMB_DIM_MAX];
};

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

INLINE struct quaternion quaternion_of(const double *given, int count)
{
    if (count == 2)
        return (struct quaternion){given[0], 0, 0, given[1]};
    return (struct quaternion){given[0], given[1], given[2], given[3]};
}

INLINE double quaternion_largest(struct quaternion q)
{
    const double w = fabs(q.w), x = fabs(q.x), y = fabs(q.y), z = fabs(q.z);
    const double wx = w > x ? w : x, yz = y > z ? y : z;
    return wx > yz ? wx : yz;
}

INLINE double quaternion_norm(struct quaternion q)
{
    return (q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z);
}

/* Whether no square overflows, and no product of two components other than 0 underflows, of a legal
 * orientation. */
INLINE bool quaternion_is_scaled(double norm)
{
    return norm >= 0x1p-400 && norm <= 0x1p400;
}

/* q times a power of two, its largest component in [1, 2). In: finite, not all 0. */
struct quaternion rotation_scaled(struct quaternion q);

/* Whether no component of given but 0 is more than 2^200 times smaller than the largest; q: given,
 * scaled. */
bool rotation_is_spread_legal(struct quaternion given, struct quaternion q);

/* Sets the rows that are exactly unit vectors, and the columns that are so with them. */
void rotation_set_units(struct quaternion q, struct rotation_matrix *out);

/* Whether an orientation is accepted: fmb_placement_check(). */
INLINE bool rotation_is_orientation(const double *orientation, int count)
{
    const struct quaternion q = quaternion_of(orientation, count);
    const double norm = quaternion_norm(q);
    if (quaternion_is_scaled(norm)) {
        /* With L the largest component and m the smallest, norm >= L^2 and |w x y z| <= m L^3: so
         * m >= 2^-180 L where the product is so large. Likewise |w z| <= m L. */
        const bool planar = q.x == 0 && q.y == 0;
        const bool large = planar ? fabs(q.w * q.z) >= 0x1p-180 * norm
                                  : fabs((q.w * q.x) * (q.y * q.z)) >= 0x1p-180 * norm * norm;
        return large || rotation_is_spread_legal(q, q);
    }
    const double sum = (q.w * 0 + q.x * 0) + (q.y * 0 + q.z * 0); /* 0 if all are finite */
    return sum == 0 && quaternion_largest(q) > 0 && rotation_is_spread_legal(q, rotation_scaled(q));
}

/* Whether some row may be a unit vector: a component of the quaternion is 0, or as large as the
 * first (unit_entry()). No product underflows. */
INLINE bool rotation_may_have_units(struct quaternion q)
{
    const double w = fabs(q.w), x = fabs(q.x), y = fabs(q.y), z = fabs(q.z);
    return (w * x) * (y * z) == 0 || (w - x) * (w - y) * (w - z) == 0;
}

/* No entry is larger than 1 + 9 u, so that the product is less than twice the least of them. */
INLINE bool rotation_no_entry_is_small(const struct rotation_matrix *rotation)
{
    const rotation_two xy = (rotation->xy[0] * rotation->xy[1]) * rotation->xy[2];
    const double z = (rotation->z[0] * rotation->z[1]) * rotation->z[2];
    return fabs((xy[0] * xy[1]) * z) >= 0x1p-59;
}

/* A rotation about the z axis, or in the plane. */
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

/* As rotation_of() says, for x = y = 0. */
INLINE void rotation_set_about_z(double w, double z, struct rotation_matrix *out)
{
    const double ww = w * w, zz = z * z, inverse = 1 / (ww + zz);
    if (w * z == 0)
        rotation_set_planar(z == 0 ? 1 : -1, 0, true, out);
    else if (fabs(w) == fabs(z))
        rotation_set_planar(0, w == z ? 1 : -1, true, out);
    else
        rotation_set_planar((ww - zz) * inverse, (w * z) * (2 * inverse), false, out);
}

INLINE void rotation_set_in_space(struct quaternion q, struct rotation_matrix *out)
{
    const double w = q.w, x = q.x, y = q.y, z = q.z;
    const double ww = w * w, xx = x * x, yy = y * y, zz = z * z;
    const double inverse = 1 / ((ww + xx) + (yy + zz)), twice = 2 * inverse;
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

/* In: a placement that fmb_placement_check() accepts. In 2D the planar quaternion is one in space
 * whose x and y are 0. */
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
