/* The rotation of a placement in doubles: R(q) of fmb.h, with a bound on its error.
 *
 * Accuracy, with u = 2^-53. Quaternions are scaled by a power of two first, so that the largest
 * component lies in [0.5, 2] and no square overflows; nonzero components are at least 2^-201 then,
 * and no product underflows. With the sums of squares p = ww + xx, r = yy + zz and so on, every
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
#include <stdint.h>
#include <string.h>

#define ROTATION_ERROR (24 * 0x1p-53)

/* Two coordinates side by side. */
typedef double rotation_two __attribute__((vector_size(16)));
typedef int64_t rotation_two_mask __attribute__((vector_size(16)));

struct rotation {
    int dim;
    bool turned;                  /* there is an orientation; else the matrix is the identity */
    bool exact;                   /* all entries are 0 or +-1, exactly */
    bool axis_exact[FMB_DIM_MAX]; /* those of row [axis] */
    /* By columns: rows 0 and 1, and row 2. */
    rotation_two xy[FMB_DIM_MAX];
    double z[FMB_DIM_MAX];
};

static inline double rotation_entry(const struct rotation *rotation, int row, int column)
{
    return row < 2 ? rotation->xy[column][row] : rotation->z[column];
}

/* x where the mask is set, else 0. */
INLINE rotation_two rotation_keep(rotation_two_mask mask, rotation_two x)
{
    return (rotation_two) (mask & (rotation_two_mask) x);
}

INLINE rotation_two rotation_magnitude(rotation_two x)
{
    return (rotation_two) ((rotation_two_mask) x & INT64_MAX);
}

/* out := R v. Coordinates that are smaller than tiny become 0, but for those of exact rows. */
INLINE void rotation_turn(const struct rotation *rotation, const double v[FMB_DIM_MAX], double tiny,
                          double out[FMB_DIM_MAX])
{
    const rotation_two xy =
        (rotation->xy[0] * v[0] + rotation->xy[1] * v[1]) + rotation->xy[2] * v[2];
    const double z = (rotation->z[0] * v[0] + rotation->z[1] * v[1]) + rotation->z[2] * v[2];
    const rotation_two least = {rotation->axis_exact[0] ? 0 : tiny,
                                rotation->axis_exact[1] ? 0 : tiny};
    const rotation_two kept = rotation_keep(rotation_magnitude(xy) >= least, xy);
    memcpy(out, &kept, sizeof kept);
    const bool dropped = fabs(z) < tiny && !rotation->axis_exact[2];
    out[2] = dropped ? 0 : z;
}

/* In: a placement that fmb_placement_check() accepts. */
void rotation_of(const struct fmb_placement *placement, int dim, struct rotation *out);

/* Whether an orientation is accepted: fmb_placement_check(). */
bool rotation_is_orientation(const double *orientation, int count);

#endif
