/* Method. The projections of F and G are cones with apex a, each spanned by two directions. If both
 * directions of G lie on the opposite side of a line through one direction of F than F does, or on
 * that line but opposite to the direction, the cones have no common point but a.
 *
 * Accuracy. The sign of the cross product x y - z w is exact if the vectors are. Rounding is
 * monotonic, so the rounded products x y and z w are in the order of the exact ones, or equal; if
 * they are equal, the difference of their rounding errors decides, which are doubles if nothing
 * underflows. The vectors are differences of points, exact if their own rounding errors are 0. If
 * they are not, a cross product is off by at most 4.01 u of the sum of the magnitudes of its
 * products: 2 roundings in its factors, 1 in each product and 1 in their difference. The bound
 * 2^-50 is 8 u. */
#include "mesh_flat.h"

#include <math.h>

struct vector {
    double x, y;
    bool exact;
};

enum { UNKNOWN = 2 }; /* besides the signs -1, 0, 1; -UNKNOWN is never returned */

static bool is_exact(double x, double y, double difference)
{
    const double part = difference - x;
    return (x - (difference - part)) - (y + part) == 0;
}

static struct vector vector(const double *from, const double *to, int x, int y)
{
    const double dx = to[x] - from[x], dy = to[y] - from[y];
    return (struct vector){dx, dy, is_exact(to[x], from[x], dx) && is_exact(to[y], from[y], dy)};
}

static int sign(double x)
{
    return (x > 0) - (x < 0);
}

/* Whether a product is 0, or finite and so large that its rounding error is a double. */
static bool has_exact_error(double x, double y)
{
    const double product = fabs(x * y);
    return x == 0 || y == 0 || (product > 0x1p-900 && product < 0x1p1000);
}

static int side_of(struct vector u, struct vector v)
{
    const double one = u.x * v.y, other = u.y * v.x;
    if (!has_exact_error(u.x, v.y) || !has_exact_error(u.y, v.x))
        return UNKNOWN;
    if (!u.exact || !v.exact)
        return fabs(one - other) > 0x1p-50 * (fabs(one) + fabs(other)) ? sign(one - other)
                                                                       : UNKNOWN;
    return one != other ? sign(one - other) : sign(fma(u.x, v.y, -one) - fma(u.y, v.x, -other));
}

/* On input: two collinear vectors. */
static bool are_opposite(struct vector u, struct vector v)
{
    return sign(u.x) * sign(v.x) < 0 || sign(u.y) * sign(v.y) < 0;
}

/* Whether a vector lies strictly on the other side of the line dx u than the cone, which is on
 * side `own`, or on that line but opposite to u. */
static bool is_beyond(struct vector u, int own, struct vector w)
{
    const int side = side_of(u, w);
    return side == -own || (side == 0 && are_opposite(u, w));
}

/* Whether a line dx u or v separates the cone of u and v from that of w and t. */
static bool separates(struct vector u, struct vector v, struct vector w, struct vector t)
{
    const int own = side_of(u, v);
    if (own == 0 || own == UNKNOWN)
        return false;
    return (is_beyond(u, own, w) && is_beyond(u, own, t)) ||
           (is_beyond(v, -own, w) && is_beyond(v, -own, t));
}

bool mesh_flat_share_vertex(const double *a, const double *b, const double *c, const double *d,
                            const double *e)
{
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const struct vector u = vector(a, b, x, y), v = vector(a, c, x, y);
        const struct vector w = vector(a, d, x, y), t = vector(a, e, x, y);
        if (separates(u, v, w, t) || separates(w, t, u, v))
            return true;
    }
    return false;
}

bool mesh_flat_share_edge(const double *p, const double *q, const double *r, const double *s)
{
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const struct vector edge = vector(p, q, x, y);
        const int of_r = side_of(edge, vector(p, r, x, y));
        if (of_r != 0 && side_of(edge, vector(p, s, x, y)) == -of_r)
            return true;
    }
    return false;
}
