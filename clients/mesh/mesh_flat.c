/* Method. F and G, seen from a, are cones of two directions each. If both directions of G lie on
 * the other side of a line along one direction of F than F does, or on the line but opposite to
 * that direction, the cones have no point but a in common.
 *
 * Signs of cross products of two vectors are exact where the vectors are: x y and z w rounded are
 * in the order of x y and z w themselves, or equal; and then their errors, which are doubles where
 * nothing underflows, tell. Vectors are differences, exact where their own errors are 0. Where they
 * are not, a cross product is off by at most 4.01 u of the sum of the magnitudes of its products: 2
 * roundings in its factors, 1 in each product and 1 in their difference; 2^-50 is 8 u. */
#include "mesh_flat.h"

#include <math.h>

struct arrow {
    double x, y;
    bool exact;
};

enum { UNKNOWN = 2 }; /* beside the signs -1, 0, 1 */

static bool is_exact(double x, double y, double difference)
{
    const double part = difference - x;
    return (x - (difference - part)) - (y + part) == 0;
}

static struct arrow arrow(const double *from, const double *to, int x, int y)
{
    const double along = to[x] - from[x], across = to[y] - from[y];
    return (struct arrow){along, across,
                          is_exact(to[x], from[x], along) && is_exact(to[y], from[y], across)};
}

static int sign(double x)
{
    return (x > 0) - (x < 0);
}

/* Whether a product is 0, or so large that its error is a double, and no infinity. */
static bool is_plain(double x, double y)
{
    const double product = fabs(x * y);
    return x == 0 || y == 0 || (product > 0x1p-900 && product < 0x1p1000);
}

static int side_of(struct arrow u, struct arrow v)
{
    const double one = u.x * v.y, other = u.y * v.x;
    if (!is_plain(u.x, v.y) || !is_plain(u.y, v.x))
        return UNKNOWN;
    if (!u.exact || !v.exact)
        return fabs(one - other) > 0x1p-50 * (fabs(one) + fabs(other)) ? sign(one - other)
                                                                       : UNKNOWN;
    return one != other ? sign(one - other) : sign(fma(u.x, v.y, -one) - fma(u.y, v.x, -other));
}

/* Of two arrows on one line. */
static bool are_opposite(struct arrow u, struct arrow v)
{
    return sign(u.x) * sign(v.x) < 0 || sign(u.y) * sign(v.y) < 0;
}

/* Whether an arrow lies beyond the line along u, where the cone is on the side `own` of it. */
static bool is_beyond(struct arrow u, int own, struct arrow w)
{
    const int side = side_of(u, w);
    return side == -own || (side == 0 && are_opposite(u, w));
}

/* Whether a line along an edge of the cone of u and v parts it from that of w and t. */
static bool parts(struct arrow u, struct arrow v, struct arrow w, struct arrow t)
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
        const struct arrow u = arrow(a, b, x, y), v = arrow(a, c, x, y);
        const struct arrow w = arrow(a, d, x, y), t = arrow(a, e, x, y);
        if (parts(u, v, w, t) || parts(w, t, u, v))
            return true;
    }
    return false;
}

bool mesh_flat_share_edge(const double *p, const double *q, const double *r, const double *s)
{
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const struct arrow edge = arrow(p, q, x, y);
        const int of_r = side_of(edge, arrow(p, r, x, y));
        if (of_r != UNKNOWN && of_r != 0 && side_of(edge, arrow(p, s, x, y)) == -of_r)
            return true;
    }
    return false;
}
