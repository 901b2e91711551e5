#include "enclosure.h"

#include "turn.h"

#include <float.h>
#include <math.h>

/* Let N be the number of sides, k = cos(pi / N), and e_i the directions at (i + 1/2) of N equal
 * parts of the full turn. A convex set contains another if its extent in every direction does.
 *
 * The N vertices (s / k) e_i are a regular polygon whose edges have the distance s from the centre.
 * So two of them, at +-h, contain the cylinder of radius s and length 2 h. The farthest points are
 * vertices, at s / k from the axis. N is a multiple of 4, so that the hulls have sides normal to
 * each axis, and rest where the cylinders would.
 *
 * Rounding. Vertices that are off by d reduce each extent by at most d. With u = 2^-53: cosines,
 * sines and k are off by TURN_ERROR = 8 u, and k >= 0.7. So s / k is off by 16 u of itself, and its
 * product with a direction by 9 u s / k more on each axis: 42 u s in all. ENCLOSE, 512 u, is more.
 * Numbers that are subnormal have absolute errors of a few 2^-1074: TINY. Where the hull is turned
 * within a body, pose_apply() moves a vertex by at most sqrt(3) POSE_ERROR (|p|_1 + |x|_1) +
 * sqrt(3) 2^-1000, |x|_1 < 4 (r + h): the radius and the half length are that much larger first.
 *
 * An upright cylinder rests exactly where it should: its sides that face the axes are at s, and its
 * ends at h. A vertex (s, y) of such a side has an extent s cos a + y sin a >= s in the directions
 * a from 0 to 2 pi / N if y >= s tan(pi / N): y grows by ENCLOSE s, more than its error. This is
 * left out where TINY is not below the rounding errors. If the cylinder is shifted within a body,
 * each coordinate of a vertex is rounded away from the centre. Since the sides and ends that face
 * the axes remain normal to them, extents in the directions of an octant are those of its vertices,
 * which move outwards on every axis. */
#define ENCLOSE 0x1p-44
#define TINY 0x1p-990

/* Sets the coordinates of upright sides that face the axes. */
static void set_resting_sides(double radius, int sides, double (*vertex)[3])
{
    const int half = sides / 2, quarter = half / 2;
    for (int i = 0; i < 2 * sides; i++) {
        const int k = i % half;
        const bool faces[2] = {k == 0 || k == half - 1, k == quarter || k == quarter - 1};
        for (int axis = 0; axis < 2; axis++)
            if (faces[axis])
                vertex[i][axis] = copysign(radius, vertex[i][axis]);
            else if (faces[1 - axis])
                vertex[i][axis] += copysign(ENCLOSE * radius, vertex[i][axis]);
    }
}

/* Returns x + by, rounded towards the infinity that has the sign of x. */
static double shift_outwards(double x, double by)
{
    const double sum = by + x, part = sum - by, error = (by - (sum - part)) + (x - part);
    return error != 0 && (error > 0) == (x > 0) ? nextafter(sum, copysign(INFINITY, x)) : sum;
}

/* outwards: rounds vertices away from the centre; the placement is a translation. */
static void place(const struct pose *placed, bool outwards, double vertex[3])
{
    if (!outwards)
        pose_apply(placed, vertex);
    else
        for (int axis = 0; axis < 3; axis++)
            vertex[axis] = shift_outwards(vertex[axis], placed->p[axis]);
}

double enclose_cylinder(const struct cylinder *cylinder, int sides, double (*vertex)[3])
{
    const struct pose *placed = cylinder->placed;
    const bool upright = !placed || pose_is_translation(placed);
    const bool rests = cylinder->radius > TINY / DBL_EPSILON && upright;
    double k[2], turn[2], grow = 0, half = cylinder->length / 2;
    turn_degrees(180.0 / sides, k);
    if (2 * half < cylinder->length) /* subnormal */
        half += DBL_TRUE_MIN;
    if (placed && !rests) {
        const double *p = placed->p;
        grow = TINY + 2 * POSE_ERROR *
                          (fabs(p[0]) + fabs(p[1]) + fabs(p[2]) + 4 * (cylinder->radius + half));
        half = (half + grow) * (1 + DBL_EPSILON);
    }
    const double radius = (cylinder->radius + grow) * (1 + ENCLOSE) / k[0] + TINY;
    for (int i = 0; i < 2 * sides; i++) {
        turn_degrees((i % sides + 0.5) * 360 / sides, turn);
        vertex[i][0] = radius * turn[0];
        vertex[i][1] = radius * turn[1];
        vertex[i][2] = i < sides ? -half : half;
    }
    if (rests)
        set_resting_sides(cylinder->radius, sides, vertex);
    for (int i = 0; i < 2 * sides && placed; i++)
        place(placed, rests, vertex[i]);
    return radius - cylinder->radius;
}
