/* A pair of frames in which a placement has an end, in doubles: poses within the window, and
 * directions that separate the frames over an interval of it. Times are fractions s = t / T.
 *
 * A direction n turns with A, or with B, or is the product of an edge of each. The frames are apart
 * over an interval if n . (b - a) > 0 for all vertices a of A and b of B at all its times. Let q be
 * the quaternions, linear in s, N(q) = |q|^2 R(q), and D the difference of the positions, linear
 * too. Times |q_A|^2 |q_B|^2, which is positive, n . (b - a) is a polynomial of degree 5 in s:
 *
 *   n = R_A m, m fixed in A   N_A m . (|q_B|^2 D + N_B b) - |q_A|^2 |q_B|^2 m . a
 *   n = R_B m, m fixed in B   N_B m . (|q_A|^2 D - N_A a) + |q_A|^2 |q_B|^2 m . b
 *   n = R_A e x R_B f         (N_A e x N_B f) . D + (x x f) . b + (y x e) . a
 *                             with x = N_B^T N_A e and y = N_A^T N_B f
 *
 * (the last since N u x R v = N (u x v) for the same quaternion). A polynomial is
 * sum_k c_k s^k (1 - s)^(5 - k) over an interval mapped to [0, 1]. The c_k are its Bernstein
 * coefficients times binomials, and are called coefficients below. They are convolutions of the
 * coefficients of the factors (motion.h), and linear in a and b. The least value of a coefficient
 * over all a and b is a support in one direction. If all these least values are positive, so is
 * every polynomial on the closed interval. A separation that is constant in the frame of the
 * direction takes a single interval.
 *
 * Accuracy, with u = 2^-53, L_A the greater |q_A|^2 of both ends of the interval and r the reaches.
 *
 *   q(s)   (1 - s) q0 + s q1 passes two roundings a component; since q0 . q1 > 0, (1 - s) |q0| +
 *          s |q1| <= sqrt(2) |q(s)|: off by at most 2.9 u |q(s)|
 *   pose   R(q(s)) x is off by twice that, 5.8 u r, besides the 22 u r that support_pair.h counts;
 *          D(s) by 3.1 u of the largest of the sums of magnitudes that D is made of at both ends,
 *          besides 4.1 u: 32 u reach covers this too
 *   N      a matrix is off by 12.1 u (motion.h; Frobenius) and 5.8 u: 18 u L
 *   N m    18 u + 5.3 u = 24 u L |m|; products of two of them: 24 + 24 + 4 = 52 u L_A L_B |e| |f|
 *   x      N_B^T N_A e: 18 + 24 + 5.3 = 48 u L_A L_B |e|; y likewise; x x f: 52 u
 *   sums   a coefficient of a convolution is a sum of at most 3 products with positive weights, and
 *          a degree is raised once: at most 8 u for vectors, twice
 *   dots   with a vertex: 3.1 u, with D: 3.1 u of rounding and 3.1 u of D
 *
 * So no coefficient of the three terms is off by more than 75 u C(5, k) L_A L_B |m| (r_A + r_B +
 * |D|) plus the slack of the stored vertices; their sum by 3 u more. TURN_ERROR is 80 u. Underflow:
 * lengths are above 2^-200 and quaternions in [1, 2) up to components that do not matter: 2^-900.
 *
 * A radius R subtracts R |n|. Times the same factors, |n| is |q_A|^2 |q_B|^2 |m| or, in the last
 * case, at most the polynomial with the lengths of the coefficients of N_A e x N_B f. No shared
 * state. */
#ifndef FMB_TURN_PATH_H
#define FMB_TURN_PATH_H

#include "motion.h"
#include "support_round.h"

struct turn_path {
    struct support_pair pair;           /* at the pose last set */
    double q[2][2][4];                  /* [frame][begin, end] */
    double position[2][2][FMB_DIM_MAX]; /* [frame][begin, end]; the end rounded twice */
    double offset[2][FMB_DIM_MAX];
    double farthest; /* bounds the length of the offset; its error is relative to this */
};

/* Returns the number of vertices of both frames. */
INLINE unsigned turn_vertices(const struct turn_path *path)
{
    return path->pair.view[0].vertices.count + path->pair.view[1].vertices.count;
}

/* Sets the pair at its beginning. The pair points to frames and into itself: not to be copied. */
void turn_path_set(const struct frame_pair *frames, struct turn_path *out);

/* q, position := the pose of frame f at s, in [0, 1], rounded. */
void turn_path_at(const struct turn_path *path, int f, double s, double q[4],
                  double position[FMB_DIM_MAX]);

/* Sets path->pair to the pose at s, a multiple of 2^-52 in [0, 1]. */
void turn_path_pose(struct turn_path *path, double s);

/* Returns the verdict at s that doubles prove, or 0. *cores := the verdict without the
 * radii, or 0. In: the pair is usable; toward: a direction to begin with, or 0. */
enum fmb_verdict turn_look(struct turn_path *path, double s, const double toward[FMB_DIM_MAX],
                           struct support_nearest *nearest, enum fmb_verdict *cores);

/* A direction: m fixed in frame `of`; or of = 2 and the product of edges e of A and f of B. */
struct turn_direction {
    int of;
    double m[2][FMB_DIM_MAX]; /* m, or e and f; body coordinates */
};

/* A direction by vertices: the normal of three vertices of frame `of` (in 2D of two); or of = 2,
 * and the product of two vertices of each frame. */
struct turn_corners {
    int of;
    uint16_t vertex[4];
};

/* out := the direction, rounded. */
void turn_direction_of(const struct support_view *view, const struct turn_corners *corners,
                       struct turn_direction *out);

/* out := R^T n at the present pose. */
void turn_body_direction(const struct support_view *view, const double n[FMB_DIM_MAX],
                         double out[FMB_DIM_MAX]);

/* Sets up to three directions near the direction of the nearest point at the present pose, which a
 * search gave. slack: tolerance, relative to the reach, for vertices to count as supporting.
 * Returns the number of directions. */
unsigned turn_directions(const struct turn_path *path, const double nearest[FMB_DIM_MAX],
                         double slack, struct turn_direction out[3]);

/* Returns the least n . (b - a) / |n| at s, rounded, less the radii; sets the pose. */
double turn_along(struct turn_path *path, const struct turn_direction *direction, double s);

/* out := the direction at the present pose, in the world; not of unit length. */
void turn_normal(const struct turn_path *path, const struct turn_direction *direction,
                 double out[FMB_DIM_MAX]);

/* Returns a lower bound of n . (b - a) / |n| over the interval [lo, hi], less the radii, or
 * -INFINITY if none is known. A positive bound proves that the frames are apart. A quotient of
 * polynomials is at least the least quotient of their coefficients, if the coefficients of the
 * divisor are positive. If a coefficient of the dividend is negative, the divisor is |n| for a
 * direction that is fixed in a frame; for a product it is the component of n along one vector, the
 * middle coefficient of n, which is at most |n|. */
double turn_distance(const struct turn_path *path, const struct turn_direction *direction,
                     double lo, double hi);

/* Shrinks [*lo, *hi], which contains `at`, to the part around `at` over which a polynomial is
 * probably positive, by samples. This proves nothing. c: its coefficients over [*lo, *hi]. */
void turn_positive_part(const double c[6], double at, double *lo, double *hi);

/* The same for the polynomial of turn_distance(), less the radii and four times its error. */
void turn_part(const struct turn_path *path, const struct turn_direction *direction, double at,
               double *lo, double *hi);

/* Returns whether a direction, or its opposite if sign is -1, might separate the frames weakly: no
 * coefficient is far below 0. This proves nothing. */
bool turn_may_separate(const struct turn_path *path, const struct turn_direction *direction,
                       double sign, double lo, double hi);

/* Lists the vertices v with nearly the greatest sign n . v. Returns their number. In: n is in body
 * coordinates; out has the capacity for all vertices. */
unsigned turn_farthest(const struct support_view *view, const double n[FMB_DIM_MAX], double sign,
                       double slack, uint16_t *out);

#endif
