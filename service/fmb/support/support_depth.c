/* The depth of a pair in contact: the distance from the origin to the boundary of D.
 *
 * Method. An expanding polytope: a mesh of points of D, whose lowest facet is raised again
 * and again by the point of D that is farthest along its normal. The least value of that point in
 * any direction tried bounds the depth from above; the least height of the mesh, from below. If D
 * is thin in some direction, the first points find that, and the depth is 0 up to the width of an
 * enclosure.
 *
 * Proof of the lower bound of the depth. Let the height of every facet of the mesh be at least rho
 * > 0. Then every facet is seen from inside by the origin, and since the mesh is closed, each ray
 * from the origin meets a facet; there it is at a distance of at least rho. So the hull of the
 * points contains the ball of radius rho, and n . p >= rho for one of them for every unit vector n.
 * The points are off by the error of the pair and, on the grid, by less than sqrt(3) units: so D
 * reaches to rho less both in every direction.
 *
 * Accuracy. The greatest n . x is off by error |n|, where |n| is 1 up to 6 u; that is 6 u reach,
 * less than another error. A height is off by less than POLYTOPE_ERROR units. */
#include "support_gap.h"

#include <math.h>
#include <string.h>

/* In units of the grid. A facet whose height is less than TOLERANCE below the depth is not raised.
 * ROUNDING: of heights, and of points. */
static const double TOLERANCE = 2 * POLYTOPE_ERROR, ROUNDING = POLYTOPE_ERROR + 2;

static void set_on_grid(const struct support_depth *depth, const double point[FMB_DIM_MAX],
                        int64_t out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = (int64_t) (point[axis] * depth->gap->scale);
}

/* Finds the point of D that is farthest in a direction of unit length. Returns whether the depth is
 * now known to be 0. */
static bool scan(struct support_depth *depth, const double n[FMB_DIM_MAX], int64_t at[FMB_DIM_MAX])
{
    const struct support_gap *gap = depth->gap;
    struct support_column column;
    double point[FMB_DIM_MAX];
    const double value = support_farthest(gap->pair, n, &column);
    support_point(gap->pair, column, point);
    set_on_grid(depth, point, at);
    if (value < depth->least) {
        depth->least = value;
        memcpy(depth->direction, n, sizeof depth->direction);
    }
    return depth->least + 2 * gap->pair->error <= gap->tight;
}

/* Makes n a unit vector; false if it is too short. */
static bool normalise(double n[FMB_DIM_MAX], double shortest)
{
    const double length = sqrt(vec3_dot(n, n));
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] /= length;
    return length > shortest;
}

static void negate(double n[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] = -n[axis];
}

/* How far the points p and first are apart along n, in units. */
static double height_of(const double n[FMB_DIM_MAX], const int64_t p[FMB_DIM_MAX],
                        const int64_t first[FMB_DIM_MAX])
{
    const double d[FMB_DIM_MAX] = {(double) (p[0] - first[0]), (double) (p[1] - first[1]),
                                   (double) (p[2] - first[2])};
    return vec3_dot(n, d);
}

/* Adds the point farthest along n or, if that is not off the points so far, along -n. Returns false
 * if D is thin along n. *known: the depth is 0. */
static bool add_off(struct support_depth *depth, double n[FMB_DIM_MAX], bool *known)
{
    for (int side = 0; side < 2; side++, negate(n)) {
        int64_t at[FMB_DIM_MAX];
        *known = scan(depth, n, at);
        if (*known)
            return false;
        if (height_of(n, at, depth->mesh.point[0].at) > TOLERANCE) {
            polytope_add_point(&depth->mesh, at);
            return true;
        }
    }
    return false;
}

/* The direction from the middle of D to the origin. */
static void set_first(const struct support_pair *pair, double n[FMB_DIM_MAX])
{
    support_centre(pair, n);
    negate(n);
    if (normalise(n, 0x1p-40 * pair->reach))
        return;
    n[0] = 1;
    n[1] = n[2] = 0;
}

/* The direction from the line of the first two points to the origin or, if that is on it, any
 * direction across. */
static void set_second(const struct polytope *mesh, double n[FMB_DIM_MAX])
{
    const int64_t *p = mesh->point[0].at, *q = mesh->point[1].at;
    double e[FMB_DIM_MAX] = {(double) (q[0] - p[0]), (double) (q[1] - p[1]),
                             (double) (q[2] - p[2])};
    const double size = fabs(e[0]) + fabs(e[1]) + fabs(e[2]);
    double across[FMB_DIM_MAX];
    normalise(e, 0);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] = (double) -p[axis];
    /* Twice, the second time for what the first one rounds. */
    for (int step = 0; step < 2; step++) {
        const double along = vec3_dot(n, e);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            n[axis] -= along * e[axis];
    }
    if (mesh->dim == 3 && normalise(n, 0x1p-20 * size))
        return;
    const int i = mesh->dim == 2 ? 2 : fabs(e[0]) > fabs(e[1]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        across[axis] = axis == i;
    vec3_cross(e, across, n);
    normalise(n, 0);
}

/* Finds dim + 1 points of D that span a volume; false if D is thin, or if *known: the depth is 0.
 */
static bool find_first(struct support_depth *depth, bool *known)
{
    struct polytope *mesh = &depth->mesh;
    double n[FMB_DIM_MAX];
    int64_t at[FMB_DIM_MAX];
    set_first(depth->gap->pair, n);
    *known = scan(depth, n, at);
    if (*known)
        return false;
    polytope_add_point(mesh, at);
    negate(n);
    if (!add_off(depth, n, known))
        return false;
    set_second(mesh, n);
    if (!add_off(depth, n, known) || mesh->dim == 2)
        return mesh->points == 3;
    polytope_first_normal(mesh, n);
    if (height_of(n, (int64_t[FMB_DIM_MAX]){0, 0, 0}, mesh->point[0].at) < 0)
        negate(n);
    return add_off(depth, n, known);
}

/* Raises the lowest facet. Returns false if it is as far out as D, or the depth is known to be 0.
 */
static bool raise_lowest(struct support_depth *depth)
{
    const double scale = depth->gap->scale;
    struct polytope *mesh = &depth->mesh;
    const int f = polytope_lowest(mesh);
    const double height = mesh->facet[f].height;
    int64_t at[FMB_DIM_MAX];
    if (depth->least * scale - height <= TOLERANCE)
        return false;
    depth->zero = scan(depth, mesh->facet[f].normal, at);
    if (depth->zero || depth->least * scale - height <= TOLERANCE ||
        polytope_side(mesh, f, at) <= 0)
        return false;
    polytope_extend(mesh, f, at);
    return true;
}

/* Begins the mesh with a simplex in 3D; false if its points lie in one plane of the grid. */
static bool take_simplex(struct support_depth *depth, const struct support_simplex *simplex)
{
    for (unsigned i = 0; i < simplex->count; i++) {
        int64_t at[FMB_DIM_MAX];
        set_on_grid(depth, simplex->vertex[i].at, at);
        polytope_add_point(&depth->mesh, at);
    }
    return polytope_close(&depth->mesh);
}

bool support_depth_begin(struct support_depth *depth, const struct support_gap *gap,
                         const struct support_nearest *nearest)
{
    depth->gap = gap;
    depth->least = INFINITY;
    depth->zero = false;
    polytope_begin(&depth->mesh, gap->pair->dim);
    depth->closed =
        nearest && nearest->simplex.count == 4 && take_simplex(depth, &nearest->simplex);
    if (depth->closed)
        return true;
    polytope_begin(&depth->mesh, gap->pair->dim);
    depth->closed = find_first(depth, &depth->zero) && polytope_close(&depth->mesh);
    return depth->closed;
}

bool support_depth_step(struct support_depth *depth, int count)
{
    for (; count > 0; count--)
        if (!raise_lowest(depth))
            return true;
    return false;
}

bool support_depth_end(struct support_depth *depth, struct fmb_gap *out)
{
    const struct support_gap *gap = depth->gap;
    const double error = gap->pair->error;
    double upper = 0;
    if (depth->closed && !depth->zero)
        upper = error - (polytope_least_height(&depth->mesh) - ROUNDING) / gap->scale;
    polytope_end(&depth->mesh);
    out->bounds[0] = -(depth->least + 2 * error);
    out->bounds[1] = upper < 0 ? upper : 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->direction[axis] = -depth->direction[axis];
    return out->bounds[1] - out->bounds[0] <= gap->tight;
}
