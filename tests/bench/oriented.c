/* In the coordinates of a: r[i][j] is the cosine between axis i of a and axis j of b, and t is
 * where the centre of b lies. Along an axis of a box the radius of that box is its half size, that
 * of the other box a sum of cosines times half sizes; the normal of two axes has coordinates that
 * are cosines too. Cosines are made a little larger, for normals that are nearly 0. */
#include "oriented.h"

#include <math.h>

#include "lean_sat.h"

#ifndef __OPTIMIZE__
#define INLINED_NOT
#endif
#include "inlined.h"

INLINE double dot(const double u[3], const double v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

INLINE int next(int i)
{
    return i == 2 ? 0 : i + 1;
}

/* r and its magnitudes, by rows of a. */
struct cosines {
    double r[3][3], size[3][3];
};

INLINE bool meet_across_faces_of_a(const struct oriented *a, const struct oriented *b,
                                   const double t[3], const struct cosines *cosines)
{
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        if (fabs(t[i]) > a->half[i] + dot(b->half, cosines->size[i]))
            return false;
    return true;
}

INLINE bool meet_across_faces_of_b(const struct oriented *a, const struct oriented *b,
                                   const double t[3], const struct cosines *cosines)
{
    UNROLL(3)
    for (int j = 0; j < 3; j++) {
        const double column[3] = {cosines->r[0][j], cosines->r[1][j], cosines->r[2][j]};
        const double size[3] = {cosines->size[0][j], cosines->size[1][j], cosines->size[2][j]};
        if (fabs(dot(t, column)) > dot(a->half, size) + b->half[j])
            return false;
    }
    return true;
}

INLINE bool meet_across_edges(const struct oriented *a, const struct oriented *b, const double t[3],
                              const struct cosines *cosines)
{
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), m = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            const int k = next(j), l = next(k);
            const double of_a = a->half[p] * cosines->size[m][j] + a->half[m] * cosines->size[p][j];
            const double of_b = b->half[k] * cosines->size[i][l] + b->half[l] * cosines->size[i][k];
            if (fabs(t[m] * cosines->r[p][j] - t[p] * cosines->r[m][j]) > of_a + of_b)
                return false;
        }
    }
    return true;
}

bool oriented_meet(const struct oriented *a, const struct oriented *b)
{
    const double least = 1e-12;
    const double way[3] = {b->centre[0] - a->centre[0], b->centre[1] - a->centre[1],
                           b->centre[2] - a->centre[2]};
    struct cosines cosines;
    double t[3];
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        t[i] = dot(way, a->axis[i]);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            cosines.r[i][j] = dot(a->axis[i], b->axis[j]);
            cosines.size[i][j] = fabs(cosines.r[i][j]) + least;
        }
    }
    return meet_across_faces_of_a(a, b, t, &cosines) && meet_across_faces_of_b(a, b, t, &cosines) &&
           meet_across_edges(a, b, t, &cosines);
}

/* With the rotation of the yardstick, of a box of size 1. */
void oriented_place(const struct fmb_frame *frame, const struct fmb_placement *placement,
                    struct oriented *out)
{
    struct fmb_frame unit = *frame;
    struct lean_frame lean;
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        unit.component[axis][axis] = 1;
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        unit.origin[axis] = frame->centre[axis];
    lean_place(&unit, placement, &lean);
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        out->centre[i] = lean.origin[i];
        out->half[i] = 0.5 * frame->component[i][i];
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++)
            out->axis[i][axis] = lean.component[i][axis];
    }
}
