#include "motion.h"

#include <math.h>
#include <string.h>

/* ---- Exact signs ---- */

/* Returns the sign of the sum of up to 16 products x[i] y[i], exactly. In: no product overflows;
 * each is 0 or at least 2^-900 in magnitude. The products and their errors are added to an
 * expansion (Shewchuk, Adaptive precision floating-point arithmetic, 1997, theorem 10): components
 * that do not overlap, in ascending order. The last component that is not 0 has the sign of the
 * sum. */
static int sign_of_products(const double *x, const double *y, int count)
{
    double part[32];
    double rounded = 0, most = 0;
    int parts = 0;
    for (int i = 0; i < count; i++) {
        rounded += x[i] * y[i];
        most += fabs(x[i] * y[i]);
    }
    if (fabs(rounded) > 0x1p-48 * most) /* off by at most 17 u most */
        return rounded > 0 ? 1 : -1;
    for (int i = 0; i < count; i++) {
        const double product = x[i] * y[i];
        const double term[2] = {fma(x[i], y[i], -product), product};
        for (int k = 0; k < 2; k++) {
            double sum = term[k];
            for (int j = 0; j < parts; j++) {
                const double next = sum + part[j], of_part = next - sum;
                part[j] = (sum - (next - of_part)) + (part[j] - of_part);
                sum = next;
            }
            part[parts++] = sum;
        }
    }
    while (parts > 0 && part[parts - 1] == 0)
        parts--;
    return parts == 0 ? 0 : part[parts - 1] > 0 ? 1 : -1;
}

/* Sets both orientations, each scaled by its own power of two so that its largest component is in
 * [1, 2). Returns the exponent of the second scale relative to the first. */
static int set_scaled(const struct fmb_placement *placement, double q[2][4])
{
    const int count = placement->orientation_count;
    int exponent[2];
    for (int end = 0; end < 2; end++) {
        const struct quaternion given = quaternion_of(
            end && placement->end_count ? placement->end_orientation : placement->orientation,
            count);
        const struct quaternion scaled = rotation_scaled(given);
        exponent[end] = ilogb(quaternion_largest(given));
        q[end][0] = scaled.w, q[end][1] = scaled.x, q[end][2] = scaled.y, q[end][3] = scaled.z;
    }
    return exponent[1] - exponent[0];
}

/* Returns whether |q|^2 <= 16 |r|^2. */
static bool is_within_four(const double q[4], const double r[4])
{
    double x[8], y[8];
    for (int i = 0; i < 4; i++) {
        x[i] = q[i], y[i] = q[i];
        x[4 + i] = -16 * r[i], y[4 + i] = r[i];
    }
    return sign_of_products(x, y, 8) <= 0;
}

static bool is_finite(const double *x, int count)
{
    double none = 0;
    for (int i = 0; i < count; i++)
        none += 0 * x[i];
    return none == 0;
}

/* The length of an orientation is within [1, 4) of its scale. If the scales differ by more than
 * 2^4, the lengths differ by more than a factor of 4. */
enum fmb_status motion_check(const struct fmb_placement *placement)
{
    const int dim = placement->body->dim, count = placement->orientation_count;
    const double *begin = placement->orientation, *end = placement->end_orientation;
    double q[2][4];
    if ((count != 0 && count != (dim == 2 ? 2 : 4)) || placement->end_count != dim + count ||
        placement_moves(placement, dim))
        return FMB_WRONG_COUNT;
    if (count == 0 && (begin[0] != 0 || begin[1] != 0 || begin[2] != 0 || begin[3] != 0))
        return FMB_WRONG_COUNT;
    if (!is_finite(placement->position, dim) || !is_finite(placement->end_position, dim))
        return FMB_NOT_FINITE;
    if (count == 0)
        return FMB_OK;
    if (!rotation_is_orientation(begin, count) || !rotation_is_orientation(end, count))
        return FMB_BAD_ORIENTATION;
    const int longer = set_scaled(placement, q);
    if (sign_of_products(q[0], q[1], 4) == 0 || longer < -4 || longer > 4)
        return FMB_BAD_ORIENTATION;
    for (int i = 0; i < 4; i++)
        q[1][i] = ldexp(q[1][i], longer);
    return is_within_four(q[0], q[1]) && is_within_four(q[1], q[0]) ? FMB_OK : FMB_BAD_ORIENTATION;
}

void motion_quaternions(const struct fmb_placement *placement, double q0[4], double q1[4])
{
    double q[2][4] = {{1, 0, 0, 0}, {1, 0, 0, 0}};
    int longer = 0, sign = 1;
    if (placement->orientation_count) {
        longer = set_scaled(placement, q);
        sign = placement->end_count ? sign_of_products(q[0], q[1], 4) : 1;
    }
    for (int i = 0; i < 4; i++) {
        q0[i] = q[0][i];
        q1[i] = sign * ldexp(q[1][i], longer);
    }
}

/* ---- Poses ---- */

/* Returns the number at a fraction s of the way from x to y. */
static double between(double x, double y, double s)
{
    return x == y ? x : (1 - s) * x + s * y;
}

void fmb_pose_at(const struct fmb_placement *placement, double duration, double time,
                 struct fmb_placement *out)
{
    const int dim = placement->body->dim, count = placement->orientation_count;
    struct fmb_placement pose = *placement;
    const double s = time / duration;
    pose.end_count = 0;
    memset(pose.velocity, 0, sizeof pose.velocity);
    if (!(time > 0) || !(duration > 0)) {
        *out = pose;
        return;
    }
    if (placement->end_count == 0) {
        for (int axis = 0; axis < dim; axis++)
            pose.position[axis] += placement->velocity[axis] * fmin(time, duration);
    } else if (time >= duration) {
        memcpy(pose.position, placement->end_position, sizeof pose.position);
        memcpy(pose.orientation, placement->end_orientation, (size_t) count * sizeof(double));
    } else {
        double q[2][4], largest = 0;
        motion_quaternions(placement, q[0], q[1]);
        for (int axis = 0; axis < dim; axis++)
            pose.position[axis] =
                between(placement->position[axis], placement->end_position[axis], s);
        for (int i = 0; i < 4; i++) {
            q[0][i] = between(q[0][i], q[1][i], s);
            largest = fmax(largest, fabs(q[0][i]));
        }
        /* Scaled back unless components might underflow. */
        const int exponent =
            count ? ilogb(quaternion_largest(quaternion_of(placement->orientation, count))) : 0;
        for (int i = 0; i < count; i++) {
            const double x = q[0][count == 2 ? 3 * i : i];
            pose.orientation[i] = ldexp(fabs(x) < 0x1p-190 * largest ? 0 : x,
                                        exponent > -800 && exponent < 1000 ? exponent : 0);
        }
    }
    *out = pose;
}

/* ---- Boxes ----
 *
 * R(q(s)) x is a rational Bezier curve with the control points N(q0, q0) x / q0 . q0,
 * N(q0, q1) x / q0 . q1 and N(q1, q1) x / q1 . q1. The weights are the divisors, all positive, so
 * the curve lies in the convex hull of these points. p(s) lies between p0 and p1. So on each axis
 * the least coordinate of a body is at least the lesser of p0 and p1 plus the least coordinate of
 * three linear images of its box. The greatest coordinate has the corresponding upper bound.
 *
 * Accuracy, with u = 2^-53, L = |q| |r|, w the divisor and S = sum_j (|m_j| + h_j) for the centre m
 * and the half extents h of the box. An entry of N(q, r) is off by 4.01 u L (motion.h), and so is
 * w; their quotient is off by 9.1 u (L / w)^2, and the sum of its three products with m or h by
 * 12.2 u (L / w)^2 S; the sum of both by 1.1 u (L / w) S more. 24 u (L / w)^2 S covers this, and
 * the rounding of the bound, if L / w < 2^20. Quaternions that are off by 3 u of their lengths move
 * the quotients by 12 u (L / w)^2 more. Otherwise, and wherever it is tighter, the box of a
 * ball with the radius reach about each position is taken. */
#define MOTION_BOX_ERROR (40 * 0x1p-53)

void motion_box_between(const double q[2][4], const double position[2][FMB_DIM_MAX], int dim,
                        const double box[2][FMB_DIM_MAX], double reach, double low[FMB_DIM_MAX],
                        double high[FMB_DIM_MAX])
{
    double m[FMB_DIM_MAX] = {0}, h[FMB_DIM_MAX] = {0}, sum = 0, norm[3];
    for (int axis = 0; axis < dim; axis++) {
        m[axis] = 0.5 * box[0][axis] + 0.5 * box[1][axis];
        h[axis] = fmax(box[1][axis] - m[axis], m[axis] - box[0][axis]) * (1 + 0x1p-51);
        sum += fabs(m[axis]) + h[axis];
        low[axis] = INFINITY, high[axis] = -INFINITY;
    }
    for (int k = 0; k < 3; k++) {
        const double *x = q[k == 2], *y = q[k > 0];
        norm[k] = (x[0] * y[0] + x[1] * y[1]) + (x[2] * y[2] + x[3] * y[3]);
    }
    for (int k = 0; k < 3; k++) {
        double matrix[FMB_DIM_MAX][FMB_DIM_MAX];
        const double ratio = k == 1 ? norm[0] * norm[2] / (norm[1] * norm[1]) : 1;
        const double error = ratio < 0x1p40 ? MOTION_BOX_ERROR * ratio * sum : INFINITY;
        motion_polar(q[k == 2], q[k > 0], matrix);
        for (int axis = 0; axis < dim; axis++) {
            double centre = 0, half = 0;
            for (int i = 0; i < FMB_DIM_MAX; i++) {
                const double entry = matrix[axis][i] / norm[k];
                centre += entry * m[i];
                half += fabs(entry) * h[i];
            }
            CHECK_BOUND(MOTION_BOX_ERROR, !(ratio < 0x1p40), centre - half, error);
            CHECK_BOUND(MOTION_BOX_ERROR, !(ratio < 0x1p40), centre + half, error);
            low[axis] = fmin(low[axis], centre - (half + error));
            high[axis] = fmax(high[axis], centre + (half + error));
        }
    }
    for (int axis = 0; axis < dim; axis++) {
        const double x = position[0][axis], y = position[1][axis];
        const double below = fmin(x, y) + (low[axis] > -reach ? low[axis] : -reach);
        const double above = fmax(x, y) + (high[axis] < reach ? high[axis] : reach);
        low[axis] = below - (fabs(below) * 0x1p-52 + 0x1p-1060);
        high[axis] = above + (fabs(above) * 0x1p-52 + 0x1p-1060);
        low[axis] = low[axis] > -INFINITY ? low[axis] : -INFINITY;
        high[axis] = high[axis] < INFINITY ? high[axis] : INFINITY;
    }
}

struct aabb motion_box(const struct fmb_placement *placement, const double box[2][FMB_DIM_MAX],
                       double reach)
{
    double q[2][4], low[FMB_DIM_MAX], high[FMB_DIM_MAX], position[2][FMB_DIM_MAX];
    struct aabb out = {{{0}}};
    motion_quaternions(placement, q[0], q[1]);
    memcpy(position[0], placement->position, sizeof position[0]);
    memcpy(position[1], placement->end_position, sizeof position[1]);
    motion_box_between((const double(*)[4]) q, (const double(*)[FMB_DIM_MAX]) position,
                       placement->body->dim, box, reach, low, high);
    for (int axis = 0; axis < placement->body->dim; axis++)
        out.end[axis] = (lanes){low[axis], -high[axis]};
    return out;
}

struct aabb motion_box_of(const struct fmb_prepared *frame)
{
    double box[2][FMB_DIM_MAX];
    frame_box(frame->frame, box);
    return motion_box(frame->placement, (const double(*)[FMB_DIM_MAX]) box, frame->frame->reach);
}
