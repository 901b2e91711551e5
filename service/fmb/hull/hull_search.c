/* The verdict of a pair with a hull in doubles.
 *
 * Method: Minkowski portal refinement (G. Snethen, XenoCollide, Game Programming Gems 7, 2008), the
 * search of hull_exact.c in doubles. A ray goes from the centre c of D through the origin. A portal
 * is dim vertices of D whose cone with apex c contains the ray. Its normal n, away from c, is the
 * next direction: the farthest vertex of D in that direction replaces one of the portal, so that
 * the portal moves outward, until the origin is between c and the portal, or beyond a vertex in
 * direction n.
 *
 * Accuracy. The search itself may be wrong in any way; what it claims is proven:
 *
 *   SEPARATED    by a direction n: all of D has n . x <= value + error |n| < 0 (hull.h).
 *   OVERLAPPING  by a simplex with vertices p_0 to p_dim in D (one may be the centre): the
 *                origin is inside if all coordinates of the origin, ratios of determinants of dim
 *                of the points, certainly are of one sign. Then it is in the interior of D, and
 * that is the union of the interiors of M + t w if M has a volume: if a frame is solid, or the
 * points are all of one time.
 *
 * The error of a point. A vertex is within error of the exact one. The centre is off by no more
 * than the roundings of the two means: 4 u r, or of a frame that is no hull at most twice its slack
 * (which is 3.1 u times the sum of all magnitudes), and error contains 32 u r and the slack. A
 * centre within 8 u reach of the origin is moved by at most 10 u reach. So every point is within e
 * = 3 error of an exact point of D.
 *
 * The error of a determinant of points p, q, r. With L_p = |p| + e and so on, moving the points by
 * e changes it by at most e (L_q L_r + L_p L_r + L_p L_q). Computing it, as p . (q x r), is off by
 * at most 6 u |p| |q| |r| sqrt(3), less than e / 9 times L_q L_r, since e >= 96 u |p|. The
 * factor 1.2 covers this, and the rounding of the bound. 2^-900 covers underflow. In 2D: e (L_p +
 * L_q). */
#include "hull_search.h"

#include <math.h>

enum { SUPPORTS_MAX = 60 }; /* enough for hulls of a thousand vertices: most take less than 12 */

static void subtract(const double x[FMB_DIM_MAX], const double y[FMB_DIM_MAX],
                     double out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = x[axis] - y[axis];
}

static void negate(double v[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        v[axis] = -v[axis];
}

/* Scales n to unit length, up to rounding. Returns false if it is too short. */
static bool normalise(double n[FMB_DIM_MAX])
{
    const double square = gap_dot(n, n);
    if (!(square > 0x1p-960))
        return false;
    const double scale = 1 / sqrt(square);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] *= scale;
    return true;
}

struct search {
    const struct hull_pair *pair;
    double n[FMB_DIM_MAX]; /* the last direction, a unit vector */
    double value;          /* in that direction, of the point found last */
    int supports;
    bool separated;
    struct hull_vertex centre, portal[FMB_DIM_MAX], last;
};

void hull_centre(const struct hull_pair *pair, struct hull_vertex *out)
{
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    rotation_apply(&pair->view[0].rotation, pair->view[0].centre, a);
    rotation_apply(&pair->view[1].rotation, pair->view[1].centre, b);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->at[axis] = (b[axis] - a[axis]) + (pair->offset[axis] + 0.5 * pair->drift[axis]);
    out->is_centre = true;
    out->column = (struct hull_column){{0, 0}, 0};
}

/* Finds the farthest point in direction n. Returns false if the search ends: n separates, is too
 * short, or there were too many directions. The factor covers a length of n other than 1. */
static bool find(struct search *s)
{
    if (!normalise(s->n) || s->supports++ == SUPPORTS_MAX)
        return false;
    s->value = hull_support(s->pair, s->n, &s->last.column);
    hull_point(s->pair, s->last.column, s->last.at);
    s->last.is_centre = false;
    s->separated = s->value < -s->pair->error * (1 + 0x1p-40);
    return !s->separated;
}

/* ---- Proof of an overlap ---- */

/* Returns the sign of the determinant of dim points, 0 if it is not certain. */
static int sign_of(const struct hull_pair *pair, const struct hull_vertex *const p[FMB_DIM_MAX])
{
    const double e = hull_point_error(pair);
    double length[FMB_DIM_MAX], value, bound;
    for (int i = 0; i < pair->dim; i++)
        length[i] = sqrt(gap_dot(p[i]->at, p[i]->at)) + e;
    double normal[FMB_DIM_MAX];
    if (pair->dim == 2) {
        value = p[0]->at[0] * p[1]->at[1] - p[0]->at[1] * p[1]->at[0];
        bound = length[0] + length[1];
    } else {
        gap_cross(p[1]->at, p[2]->at, normal);
        value = gap_dot(p[0]->at, normal);
        bound = length[1] * length[2] + length[0] * (length[1] + length[2]);
    }
    bound = 1.2 * e * bound + 0x1p-900;
    return value > bound ? 1 : value < -bound ? -1 : 0;
}

/* Whether the origin is certainly inside the simplex. Without vertex i, the determinants of the
 * others in order have signs that alternate with i. */
bool hull_simplex_contains_origin(const struct hull_pair *pair, const struct hull_simplex *simplex)
{
    int all = 0;
    for (int omitted = 0; omitted <= pair->dim; omitted++) {
        const struct hull_vertex *p[FMB_DIM_MAX] = {NULL};
        for (int i = 0; i < pair->dim; i++)
            p[i] = &simplex->vertex[i < omitted ? i : i + 1];
        const int sign = (omitted % 2 ? -1 : 1) * sign_of(pair, p);
        if (sign == 0 || (all != 0 && sign != all))
            return false;
        all = sign;
    }
    return true;
}

/* Whether the interior of D is known to be the union of the interiors of M + t w. */
static bool is_swept_open(const struct hull_pair *pair)
{
    return !pair->drifts || pair->view[0].solid || pair->view[1].solid;
}

/* Whether the centre and the portal enclose the origin, for certain. */
static bool encloses(const struct search *s, struct hull_simplex *out)
{
    out->count = (unsigned) s->pair->dim + 1;
    out->vertex[0] = s->centre;
    for (int i = 0; i < s->pair->dim; i++)
        out->vertex[1 + i] = s->portal[i];
    return is_swept_open(s->pair) && hull_simplex_contains_origin(s->pair, out);
}

/* ---- The search ---- */

/* Finds a portal in 3D. */
static bool find_portal(struct search *s)
{
    struct hull_vertex *v = s->portal;
    const double *c = s->centre.at;
    double u[FMB_DIM_MAX], w[FMB_DIM_MAX];
    gap_cross(c, v[0].at, s->n);
    if (!(gap_dot(s->n, s->n) > 0x1p-80 * gap_dot(c, c) * gap_dot(v[0].at, v[0].at))) {
        /* The ray passes close to the vertex: any direction across the ray will do. */
        const int axis = fabs(c[0]) < fabs(c[1]) ? (fabs(c[0]) < fabs(c[2]) ? 0 : 2)
                                                 : (fabs(c[1]) < fabs(c[2]) ? 1 : 2);
        const double unit[FMB_DIM_MAX] = {axis == 0, axis == 1, axis == 2};
        gap_cross(c, unit, s->n);
    }
    if (!find(s))
        return false;
    v[1] = s->last;
    subtract(v[0].at, c, u);
    subtract(v[1].at, c, w);
    gap_cross(u, w, s->n);
    if (gap_dot(s->n, c) > 0) {
        v[1] = v[0];
        v[0] = s->last;
        negate(s->n);
    }
    while (find(s)) {
        double side[FMB_DIM_MAX];
        v[2] = s->last;
        gap_cross(v[0].at, v[2].at, side);
        if (gap_dot(side, c) < 0) {
            v[1] = v[2];
        } else {
            gap_cross(v[2].at, v[1].at, side);
            if (gap_dot(side, c) >= 0)
                return true;
            v[0] = v[2];
        }
        subtract(v[0].at, c, u);
        subtract(v[1].at, c, w);
        gap_cross(u, w, s->n);
    }
    return false;
}

/* Sets n to the normal of the portal, away from the centre. */
static void set_normal(struct search *s)
{
    const struct hull_vertex *v = s->portal;
    double u[FMB_DIM_MAX], w[FMB_DIM_MAX];
    subtract(v[1].at, v[0].at, u);
    if (s->pair->dim == 2) {
        s->n[0] = u[1];
        s->n[1] = -u[0];
        s->n[2] = 0;
    } else {
        subtract(v[2].at, v[0].at, w);
        gap_cross(u, w, s->n);
    }
    subtract(v[0].at, s->centre.at, w);
    if (gap_dot(s->n, w) < 0)
        negate(s->n);
}

/* Puts the last point into the portal, so that the ray still passes through it. */
static void advance(struct search *s)
{
    struct hull_vertex *v = s->portal;
    const double *c = s->centre.at;
    double side[FMB_DIM_MAX];
    if (s->pair->dim == 2) {
        const double turn = s->last.at[0] * c[1] - s->last.at[1] * c[0];
        const double first = v[0].at[0] * c[1] - v[0].at[1] * c[0];
        v[(turn > 0) == (first > 0) ? 0 : 1] = s->last;
        return;
    }
    gap_cross(s->last.at, c, side);
    if (gap_dot(v[0].at, side) > 0)
        v[gap_dot(v[1].at, side) > 0 ? 0 : 2] = s->last;
    else
        v[gap_dot(v[2].at, side) > 0 ? 1 : 0] = s->last;
}

/* Moves the portal outward until the origin is certainly inside, or no vertex is farther out than
 * the rounding errors. Returns whether it is inside. */
static bool refine(struct search *s, struct hull_simplex *out)
{
    do {
        set_normal(s);
        const bool inside = gap_dot(s->n, s->portal[0].at) >= 0;
        if (inside && encloses(s, out))
            return true;
        if (!find(s))
            return false;
        if (s->value - gap_dot(s->n, s->portal[0].at) <= 4 * s->pair->error)
            return false;
        advance(s);
    } while (true);
}

/* out := points of D for the start of the exact method: the portal, and the farthest point behind
 * it.
 */
static void put_start(struct search *s, struct hull_simplex *out)
{
    out->count = 0;
    for (int i = 0; i < s->pair->dim; i++)
        out->vertex[out->count++] = s->portal[i];
    set_normal(s);
    negate(s->n);
    if (!normalise(s->n))
        return;
    hull_support(s->pair, s->n, &s->last.column);
    out->vertex[out->count++] = s->last;
}

enum fmb_verdict hull_search(const struct hull_pair *pair, struct hull_simplex *out)
{
    struct search s = {.pair = pair};
    bool found = false;
    hull_centre(pair, &s.centre);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        s.n[axis] = -s.centre.at[axis];
    if (!(gap_dot(s.n, s.n) > 0x1p-100 * pair->reach * pair->reach)) { /* a ray in any direction */
        s.n[0] = 1;
        s.n[1] = s.n[2] = 0;
        s.centre.at[0] = -0x1p-52 * pair->reach;
    }
    if (find(&s)) {
        s.portal[0] = s.last;
        if (pair->dim == 3) {
            found = find_portal(&s);
        } else { /* across the ray, on the side of it where the first point is not */
            const double *c = s.centre.at, *v = s.portal[0].at;
            const double sign = c[0] * v[1] - c[1] * v[0] > 0 ? 1 : -1;
            s.n[0] = sign * c[1];
            s.n[1] = sign * -c[0];
            s.n[2] = 0;
            found = find(&s);
            s.portal[1] = s.last;
        }
    }
    if (found && refine(&s, out))
        return FMB_OVERLAPPING;
    if (s.separated)
        return FMB_SEPARATED;
    out->count = 0;
    if (found)
        put_start(&s, out);
    return 0;
}
