/* The verdict of a pair by its vertices, in doubles, and the point of D nearest to the origin.
 *
 * Method: gap_simplex.h. The search itself may be wrong in any way; what it claims is proven:
 *
 *   SEPARATED
 *       by a direction n of unit length up to 6 u. The least n . x over D is minus the greatest of
 *       support_farthest() for -n, which is off by error |n|; the length moves it by 6 u reach,
 *       less than another error. It is taken from the point p that was found, as n . p: the point
 *       and the value of its vertices are each off by one more error. So all of D has n . x >=
 *       n . p - 4 error.
 *   OVERLAPPING
 *       by a simplex with vertices p_0 to p_dim in D: the origin is inside if all coordinates of
 *       the origin, ratios of determinants of dim of the points, certainly are of one sign. Then it
 *       is in the interior of D, and that is the union of the interiors of M + t w if M has a
 *       volume: if a frame is solid, or the points are all of one time.
 *
 * The error of a determinant of points p, q, r, each within e = error of an exact point of D. With
 * L_p = |p| + e and so on, moving the points by e changes it by at most
 *
 *     e (L_q L_r + L_p L_r + L_p L_q).
 *
 * Computing it, as p . (q x r), is off by at most 6 u |p| |q| |r| sqrt(3), less than a ninth of
 * this sum, since e >= 32 u |p|, and so for q and r. The factor 1.2 covers this, and the rounding
 * of the bound. 2^-900 covers underflow. In 2D: e (L_p + L_q). */
#include "support_search.h"

#include "gap_simplex.h"

#include <math.h>

enum { VERTEX_BITS = 10 };
_Static_assert(FMB_HULL_VERTICES_MAX <= 1 << VERTEX_BITS, "bits of a corner");

static struct support_column column_of(unsigned bits)
{
    const unsigned mask = (1U << VERTEX_BITS) - 1;
    return (struct support_column){{bits & mask, bits >> VERTEX_BITS & mask},
                                   bits >> 2 * VERTEX_BITS};
}

void support_lowest(const struct support_pair *pair, const double n[FMB_DIM_MAX],
                    struct support_vertex *out)
{
    const double inverse = -1 / (fabs(n[0]) + fabs(n[1]) + fabs(n[2]) + 0x1p-1000);
    const double outward[FMB_DIM_MAX] = {inverse * n[0], inverse * n[1], inverse * n[2]};
    support_farthest(pair, outward, &out->column);
    support_point(pair, out->column, out->at);
}

/* D translated by -at. */
struct translated {
    const struct support_pair *pair;
    const double *at;
};

static void support(const void *context, const double n[FMB_DIM_MAX], struct gap_corner *out)
{
    const struct translated *of = context;
    struct support_vertex vertex;
    support_lowest(of->pair, n, &vertex);
    const struct support_column *column = &vertex.column;
    gap_subtract(vertex.at, of->at, out->at);
    out->bits =
        column->vertex[0] | column->vertex[1] << VERTEX_BITS | column->end << 2 * VERTEX_BITS;
}

void support_centre(const struct support_pair *pair, double out[FMB_DIM_MAX])
{
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    rotation_apply(&pair->view[0].rotation, pair->view[0].centre, a);
    rotation_apply(&pair->view[1].rotation, pair->view[1].centre, b);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = (b[axis] - a[axis]) + (pair->offset[axis] + 0.5 * pair->drift[axis]);
}

#define SUPPORT_DETERMINANT 1.2 /* as above */

/* Returns the determinant of dim points, reduced by its error: no farther from 0 than the exact
 * one, and of the same sign; 0 if the sign is not certain. */
static double determinant_of(const struct support_pair *pair,
                             const struct support_vertex *const p[FMB_DIM_MAX])
{
    const double e = pair->error;
    double length[FMB_DIM_MAX], value, bound;
    for (int i = 0; i < pair->dim; i++)
        length[i] = sqrt(vec3_dot(p[i]->at, p[i]->at)) + e;
    double normal[FMB_DIM_MAX];
    if (pair->dim == 2) {
        value = p[0]->at[0] * p[1]->at[1] - p[0]->at[1] * p[1]->at[0];
        bound = length[0] + length[1];
    } else {
        vec3_cross(p[1]->at, p[2]->at, normal);
        value = vec3_dot(p[0]->at, normal);
        bound = length[1] * length[2] + length[0] * (length[1] + length[2]);
    }
    bound = SUPPORT_DETERMINANT * e * bound + 0x1p-900;
    CHECK_BOUND(SUPPORT_DETERMINANT, false, value, bound);
    return value > bound ? value - bound : value < -bound ? value + bound : 0;
}

/* Sets the dim vertices of a facet: all but one, in order. */
static void set_facet(const struct support_simplex *simplex, int dim, int omitted,
                      const struct support_vertex *out[FMB_DIM_MAX])
{
    for (int i = 0; i < dim; i++)
        out[i] = &simplex->vertex[i < omitted ? i : i + 1];
}

/* Whether the origin is certainly inside the simplex. Without vertex i, the determinants of the
 * others in order have signs that alternate with i. */
bool support_simplex_contains_origin(const struct support_pair *pair,
                                     const struct support_simplex *simplex)
{
    int all = 0;
    for (int omitted = 0; omitted <= pair->dim; omitted++) {
        const struct support_vertex *p[FMB_DIM_MAX] = {NULL};
        set_facet(simplex, pair->dim, omitted, p);
        const double determinant = determinant_of(pair, p);
        const int sign = (omitted % 2 ? -1 : 1) * ((determinant > 0) - (determinant < 0));
        if (sign == 0 || (all != 0 && sign != all))
            return false;
        all = sign;
    }
    return true;
}

/* Returns an upper bound of twice the area of a facet; in 2D, of its length. Each edge is off by
 * 2 e, and rounded by far less, so that their cross product is off by 2 e (|x| + |y|) + 4 e^2 for
 * edges x and y, and rounded by less than e / 4 of their lengths, since e >= 32 u |x| / 2. */
static double size_of_facet(const struct support_pair *pair,
                            const struct support_vertex *const p[FMB_DIM_MAX])
{
    const double e = pair->error;
    double edge[2][FMB_DIM_MAX], normal[FMB_DIM_MAX], length[2];
    for (int i = 0; i + 1 < pair->dim; i++) {
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            edge[i][axis] = p[i + 1]->at[axis] - p[0]->at[axis];
        length[i] = sqrt(vec3_dot(edge[i], edge[i]));
    }
    if (pair->dim == 2)
        return length[0] + 3 * e;
    vec3_cross(edge[0], edge[1], normal);
    return sqrt(vec3_dot(normal, normal)) + 3 * e * (length[0] + length[1] + 3 * e);
}

/* The distance of a facet from the origin is the determinant of its points divided by its size. */
double support_simplex_depth(const struct support_pair *pair, const struct support_simplex *simplex)
{
    double least = INFINITY;
    if (simplex->count != (unsigned) pair->dim + 1 ||
        !support_simplex_contains_origin(pair, simplex))
        return 0;
    for (int omitted = 0; omitted <= pair->dim; omitted++) {
        const struct support_vertex *p[FMB_DIM_MAX] = {NULL};
        set_facet(simplex, pair->dim, omitted, p);
        least = fmin(least, fabs(determinant_of(pair, p)) / size_of_facet(pair, p));
    }
    return least * (1 - 0x1p-40);
}

void support_toward(const struct support_pair *pair, double out[FMB_DIM_MAX])
{
    support_centre(pair, out);
    if (!pair->usable)
        memset(out, 0, FMB_DIM_MAX * sizeof *out);
    if (!(vec3_dot(out, out) > 0x1p-100 * pair->reach * pair->reach))
        out[0] = pair->usable ? pair->reach : 1; /* any direction */
}

/* Whether the interior of D is known to be the union of the interiors of M + t w. */
static bool is_swept_open(const struct support_pair *pair)
{
    return !pair->drifts || pair->view[0].solid || pair->view[1].solid;
}

enum fmb_verdict support_search(const struct support_pair *pair, double far,
                                struct support_nearest *out)
{
    double toward[FMB_DIM_MAX];
    support_toward(pair, toward);
    return support_search_from(pair, toward, far, out);
}

static void search(const struct support_pair *pair, const double at[FMB_DIM_MAX],
                   const double toward[FMB_DIM_MAX], double far, struct support_nearest *out)
{
    const struct translated of = {pair, at};
    struct gap_simplex simplex;
    memset(out, 0, sizeof *out);
    out->outcome = gap_nearest(&of, support, pair->dim, toward, pair->error, far, &simplex,
                               out->direction, &out->least);
    if (out->outcome == GAP_FAR)
        return;
    out->simplex.count = (unsigned) simplex.count;
    for (int c = 0; c < simplex.count; c++) {
        struct support_vertex *vertex = &out->simplex.vertex[c];
        vertex->column = column_of(simplex.corner[c].bits);
        memcpy(vertex->at, simplex.corner[c].at, sizeof vertex->at);
        out->weight[c] = simplex.weight[c];
    }
}

void support_search_near(const struct support_pair *pair, const double at[FMB_DIM_MAX],
                         const double toward[FMB_DIM_MAX], struct support_nearest *out)
{
    search(pair, at, toward, INFINITY, out);
}

enum fmb_verdict support_search_from(const struct support_pair *pair,
                                     const double toward[FMB_DIM_MAX], double far,
                                     struct support_nearest *out)
{
    const double origin[FMB_DIM_MAX] = {0};
    search(pair, origin, toward, far, out);
    if (out->outcome == GAP_FAR ||
        (out->outcome == GAP_KNOWN && out->least > support_separating_distance(pair)))
        return FMB_SEPARATED;
    return out->simplex.count == (unsigned) pair->dim + 1 && is_swept_open(pair) &&
                   support_simplex_contains_origin(pair, &out->simplex)
               ? FMB_OVERLAPPING
               : 0;
}
