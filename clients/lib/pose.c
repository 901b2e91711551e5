#include "pose.h"

#include "turn.h"

#include <string.h>

bool pose_is_translation(const struct pose *pose)
{
    return pose->q[1] == 0 && pose->q[2] == 0 && pose->q[3] == 0;
}

/* Accuracy, u = 2^-53. The entries of n R and n itself have errors of at most 4 u n. A row has
 * three products: 3 u more, and entries of at most n: less than 8 u n |x|_1. The quotient by n adds
 * 5 u |x|_1 and, since a row of R has the length 1, the last sum u (|x|_1 + |p|). Together less
 * than 16 u (|x|_1 + |p|_1); POSE_ERROR is 32 u. Underflow costs some 2^-1074, a part of 2^-1000.
 * Without a turn, R is exact. */
void pose_apply(const struct pose *pose, double x[3])
{
    double row[3][3];
    const double n = turn_matrix(pose->q, row);
    const double from[3] = {x[0], x[1], x[2]};
    for (int i = 0; i < 3; i++)
        x[i] = (row[i][0] * from[0] + row[i][1] * from[1] + row[i][2] * from[2]) / n + pose->p[i];
}

/* The product a b of quaternions. Products with a component that is 0 add no rounding error. */
static void multiply(const double a[4], const double b[4], double out[4])
{
    const double product[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                               a[0] * b[1] + a[1] * b[0] + (a[2] * b[3] - a[3] * b[2]),
                               a[0] * b[2] + a[2] * b[0] + (a[3] * b[1] - a[1] * b[3]),
                               a[0] * b[3] + a[3] * b[0] + (a[1] * b[2] - a[2] * b[1])};
    memcpy(out, product, sizeof product);
}

struct pose pose_compose(const struct pose *outer, const struct pose *inner)
{
    struct pose out = *inner;
    pose_apply(outer, out.p);
    multiply(outer->q, inner->q, out.q);
    return out;
}

void pose_turn(const double axis[3], double radians, double q[4])
{
    double turn[2];
    turn_radians(radians / 2, turn);
    q[0] = turn[0];
    for (int i = 0; i < 3; i++)
        q[i + 1] = turn[1] * axis[i];
}

void pose_turn_rpy(const double rpy[3], double q[4])
{
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pose_turn(axes[0], rpy[0], q);
    for (int i = 1; i < 3; i++) {
        double next[4];
        pose_turn(axes[i], rpy[i], next);
        multiply(next, q, q);
    }
}
