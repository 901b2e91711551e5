/* Contact and box of an overlapping pair by its vertices, in doubles; of frames without a radius.
 *
 * Each end is the optimum of the linear program of programs.c: the greatest h over the origin,
 * where h is linear in the vertices of A and B and in the time, with h = +-t / T for the contact
 * and +- a coordinate of a + t v_a for the box.
 *
 * Method: the simplex method. A basis is a simplex of dim + 1 points p_i of D that contains the
 * origin. Its heights h_i define the plane h = n . p + n0 through it; n0 is the height over the
 * origin. The vertex of D that is highest above the plane, found by the support function, enters
 * the basis.
 *
 * Accuracy. The plane bounds the optimum from both sides, however it was found.
 *
 *   Outer: h <= n0 over the origin if no vertex of D is above the plane. For any n, the greatest
 *   h - n . x over the vertices of D is an upper bound. It is one support of A in the direction
 *   n + e, one of B in -n, and sums: off by at most error (|n| + 1), where error is 32 u reach, and
 *   support_pair.h derives 28 u reach; a quarter more covers the five sums. The height adds a
 *   position and a path, each off by at most 4 u of itself.
 *
 *   Inner: let the exact points be p_i + d_i, |d_i| <= error, their exact heights h_i + g_i, and
 *   b_i the coordinates of the origin in their simplex, all >= 0. The exact height over the origin
 *   is
 *
 *       sum b_i (h_i + g_i) = n0 + sum b_i (r_i + g_i) - n . sum b_i d_i,
 *
 *   with r_i = h_i - n . p_i - n0 as computed or nearly: at least
 *   n0 - max |r_i| - max |g_i| - |n| error. That the origin is inside is certain
 *   (support_simplex_contains_origin()); if not, the end stays open.
 *
 * So the outer bound is given if it is within the limit of the inner one. */
#include "support_search.h"

#include <math.h>
#include <string.h>

static const double unit_roundoff = 0x1p-53;

/* Limits of fmb.h, with a margin for the rounding of their comparison. */
static const double limit = 1e-12 * (1 - 0x1p-10);

/* Of the outer bound, relative to error (|n| + 1). */
#define SUPPORT_HEIGHT 1.25

enum { PIVOTS_MAX = 100 };

/* A point of the basis. */
struct high_point {
    struct support_vertex vertex;
    double a[FMB_DIM_MAX]; /* world coordinates of the point of A at its time */
    double tau;            /* its time / T */
    double h;
};

/* One linear program. */
struct program {
    const struct support_pair *pair;
    int axis;     /* of the box; -1: the contact */
    double sign;  /* of the height */
    double extra; /* the error of a height that |n| does not affect */
    struct high_point basis[FMB_DIM_MAX + 1];
    double normal[FMB_DIM_MAX], level; /* the plane h = normal . p + level */
    double residual;
    double part[FMB_DIM_MAX][FMB_DIM_MAX]; /* coordinate 1 + i of p is part[i] . (p - p_0) */
};

/* ---- Points ---- */

static void set_high_point(const struct program *program, const struct support_vertex *vertex,
                           struct high_point *out)
{
    const struct support_pair *pair = program->pair;
    out->vertex = *vertex;
    out->tau = vertex->column.end;
    support_place(&pair->view[0], vertex->column.vertex[0], out->a);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->a[axis] += pair->position[0][axis] + out->tau * pair->path[0][axis];
}

static void set_height(const struct program *program, struct high_point *point)
{
    point->h = program->sign * (program->axis < 0 ? point->tau : point->a[program->axis]);
}

/* Returns a lower bound of the largest magnitude of a coordinate of a vertex over the window. */
static double largest_coordinate(const struct program *program)
{
    const struct support_pair *pair = program->pair;
    double largest = 0, sum = 0;
    for (int i = 0; i <= pair->dim; i++) {
        const struct high_point *point = &program->basis[i];
        for (int axis = 0; axis < pair->dim; axis++) {
            const double a = fabs(point->a[axis]);
            const double b = fabs(point->a[axis] + point->vertex.at[axis]);
            largest = fmax(largest, fmax(a, b));
            sum += a + b;
        }
    }
    return largest - 2 * pair->error - 0x1p-50 * sum;
}

/* ---- The plane ---- */

static void set_plane(struct program *program)
{
    const int dim = program->pair->dim;
    const struct high_point *p = program->basis;
    double edge[FMB_DIM_MAX][FMB_DIM_MAX] = {{0}}, determinant;
    for (int i = 0; i < dim; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            edge[i][axis] = p[1 + i].vertex.at[axis] - p[0].vertex.at[axis];
    if (dim == 2)
        edge[2][2] = 1;
    for (int i = 0; i < dim; i++)
        vec3_cross(edge[(i + 1) % 3], edge[(i + 2) % 3], program->part[i]);
    determinant = vec3_dot(edge[0], program->part[0]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        program->normal[axis] = 0;
        for (int i = 0; i < dim; i++) {
            program->part[i][axis] /= determinant;
            program->normal[axis] += (p[1 + i].h - p[0].h) * program->part[i][axis];
        }
    }
    program->level = p[0].h - vec3_dot(program->normal, p[0].vertex.at);
    program->residual = 0;
    for (int i = 0; i <= dim; i++)
        program->residual =
            fmax(program->residual,
                 fabs(p[i].h - (vec3_dot(program->normal, p[i].vertex.at) + program->level)));
}

/* Returns the greatest h - normal . x of a vertex of D, which is *out. */
static double find_highest(const struct program *program, struct support_vertex *out)
{
    const struct support_pair *pair = program->pair;
    const double n[FMB_DIM_MAX] = {CHECK_GIVEN(program->normal[0]), CHECK_GIVEN(program->normal[1]),
                                   CHECK_GIVEN(program->normal[2])};
    double of_a[FMB_DIM_MAX] = {n[0], n[1], n[2]};
    const double of_b[FMB_DIM_MAX] = {-n[0], -n[1], -n[2]};
    double later = pair->drifts ? -vec3_dot(n, pair->drift) : 0, still = -vec3_dot(n, pair->offset);
    if (program->axis < 0) {
        later += program->sign;
    } else {
        of_a[program->axis] += program->sign;
        later += program->sign * pair->path[0][program->axis];
        still += program->sign * pair->position[0][program->axis];
    }
    const struct support a = support_view_farthest(&pair->view[0], of_a);
    const struct support b = support_view_farthest(&pair->view[1], of_b);
    out->column = (struct support_column){{a.index, b.index}, later > 0};
    return (a.value + b.value) + (still + (later > 0 ? later : 0));
}

/* Puts a vertex into the basis, for the point without which the origin stays inside: of the points
 * that the ray from the origin away from the vertex leaves, the first. Returns false if there is
 * none. */
static bool pivot(struct program *program, const struct support_vertex *vertex)
{
    const int dim = program->pair->dim;
    const double *first = program->basis[0].vertex.at;
    double from_origin[FMB_DIM_MAX + 1] = {1}, from_vertex[FMB_DIM_MAX + 1] = {1}, least = INFINITY;
    int leaving = -1;
    for (int i = 1; i <= dim; i++) {
        const double *part = program->part[i - 1];
        from_origin[i] = -vec3_dot(part, first);
        from_vertex[i] = vec3_dot(part, vertex->at) - vec3_dot(part, first);
        from_origin[0] -= from_origin[i];
        from_vertex[0] -= from_vertex[i];
    }
    for (int i = 0; i <= dim; i++)
        if (from_vertex[i] > 0 && from_origin[i] / from_vertex[i] < least) {
            least = from_origin[i] / from_vertex[i];
            leaving = i;
        }
    if (leaving < 0)
        return false;
    set_high_point(program, vertex, &program->basis[leaving]);
    set_height(program, &program->basis[leaving]);
    return true;
}

static bool is_inside(const struct program *program)
{
    struct support_simplex simplex = {.count = (unsigned) program->pair->dim + 1};
    for (unsigned i = 0; i < simplex.count; i++)
        simplex.vertex[i] = program->basis[i].vertex;
    return support_simplex_contains_origin(program->pair, &simplex);
}

/* Maximises the height. prove: returns whether the upper bound *outer is within the limit, relative
 * to the largest coordinate. Otherwise: returns whether an optimum was found, up to rounding
 * errors. */
static bool maximise(struct program *program, bool prove, double *outer)
{
    const struct support_pair *pair = program->pair;
    const bool box = program->axis >= 0;
    for (int i = 0; i <= pair->dim; i++)
        set_height(program, &program->basis[i]);
    for (int pivots = 0; pivots < PIVOTS_MAX; pivots++) {
        struct support_vertex highest;
        set_plane(program);
        const double length = sqrt(vec3_dot(program->normal, program->normal)) * (1 + 0x1p-40);
        const double found = find_highest(program, &highest);
        const double out = SUPPORT_HEIGHT * (length + box) * pair->error + program->extra;
        CHECK_BOUND(SUPPORT_HEIGHT, false, found, out);
        const double in = out + (length * pair->error + program->residual);
        const double scale = box ? largest_coordinate(program) : 1;
        *outer = found + out;
        if (prove && *outer - (program->level - in) <= limit * scale)
            return is_inside(program);
        if (!(found - program->level > 2 * (out + in)))
            return !prove;
        support_point(pair, highest.column, highest.at);
        if (!pivot(program, &highest))
            return false;
    }
    return false;
}

static void begin(const struct support_pair *pair, const struct support_simplex *simplex,
                  struct program *out)
{
    out->pair = pair;
    for (int i = 0; i <= pair->dim; i++)
        set_high_point(out, &simplex->vertex[i], &out->basis[i]);
}

bool support_contact(const struct support_pair *pair, const struct support_simplex *simplex,
                     double contact[2])
{
    const double duration = pair->frames->duration;
    struct program program = {.axis = -1, .extra = 4 * unit_roundoff};
    contact[0] = 0;
    contact[1] = duration + 0.0; /* never -0 */
    if (!pair->drifts)
        return true;
    begin(pair, simplex, &program);
    for (int end = 0; end < 2; end++) {
        double tau;
        program.sign = end ? 1 : -1;
        if (!maximise(&program, true, &tau))
            return false;
        /* The product is rounded outward: 2^-1074 covers underflow. */
        if (end && tau < 1)
            contact[1] = fmin(tau * duration * (1 + 0x1p-51) + 0x1p-1074, duration);
        else if (!end && tau < 0)
            contact[0] = fmax(-tau * duration * (1 - 0x1p-51) - 0x1p-1074, 0);
    }
    return true;
}

bool support_box(const struct support_pair *pair, const struct support_simplex *simplex,
                 double box[2][FMB_DIM_MAX])
{
    struct program program = {.axis = 0};
    memset(box, 0, sizeof(double[2][FMB_DIM_MAX]));
    begin(pair, simplex, &program);
    for (; program.axis < pair->dim; program.axis++)
        for (int end = 0; end < 2; end++) {
            double height;
            program.sign = end ? 1 : -1;
            program.extra =
                8 * unit_roundoff *
                (fabs(pair->position[0][program.axis]) + fabs(pair->path[0][program.axis]));
            if (!maximise(&program, true, &height))
                return false;
            box[end][program.axis] = program.sign * height + 0.0; /* never -0 */
        }
    return true;
}

/* ---- A simplex around the origin ---- */

enum { WIDENINGS_MAX = 8 };

/* Sets the gradient of barycentric coordinate i of a point in the simplex of the basis. It is
 * orthogonal to the facet opposite vertex i and points inward. */
static void set_gradient(const struct program *program, int i, double out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out[axis] = i > 0 ? program->part[i - 1][axis] : 0;
        for (int k = 0; i == 0 && k < program->pair->dim; k++)
            out[axis] -= program->part[k][axis];
    }
}

/* In each step, the vertex of D that is farthest beyond the facet nearest to the origin enters the
 * simplex. */
void support_widen(const struct support_pair *pair, double depth, struct support_nearest *nearest)
{
    const int dim = pair->dim;
    double widest = 0;
    struct program program = {.axis = -1};
    begin(pair, &nearest->simplex, &program);
    for (int step = 0; step < WIDENINGS_MAX && widest < depth; step++) {
        double least = INFINITY, coordinate[FMB_DIM_MAX + 1], inward[FMB_DIM_MAX];
        struct support_vertex next;
        set_plane(&program);
        for (int i = 0; i <= dim; i++) {
            double gradient[FMB_DIM_MAX];
            set_gradient(&program, i, gradient);
            coordinate[i] = (i == 0) - vec3_dot(gradient, program.basis[0].vertex.at);
            const double distance = coordinate[i] / sqrt(vec3_dot(gradient, gradient));
            if (distance < least) {
                least = distance;
                memcpy(inward, gradient, sizeof inward);
            }
        }
        if (least > widest) {
            widest = least;
            for (int i = 0; i <= dim; i++) {
                nearest->simplex.vertex[i] = program.basis[i].vertex;
                nearest->weight[i] = coordinate[i];
            }
        }
        support_lowest(pair, inward, &next);
        if (!pivot(&program, &next))
            break;
    }
}

/* ---- Guesses ---- */

bool support_guess_begin(const struct support_pair *pair, struct support_guess *out)
{
    struct support_nearest nearest;
    double centre[FMB_DIM_MAX];
    support_pair_set(pair->frames, &out->pair);
    support_centre(pair, centre);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->pair.offset[axis] -= 0x1p-30 * centre[axis];
    if (support_search(&out->pair, support_separating_distance(pair), &nearest) != FMB_OVERLAPPING)
        return false;
    out->simplex = nearest.simplex;
    return true;
}

bool support_guess_basis(const struct support_guess *guess, int axis, double sign,
                         struct support_column out[FMB_DIM_MAX + 1])
{
    struct program program = {.axis = axis, .sign = sign};
    double outer;
    begin(&guess->pair, &guess->simplex, &program);
    if (!maximise(&program, false, &outer))
        return false;
    for (int i = 0; i <= guess->pair.dim; i++)
        out[i] = program.basis[i].vertex.column;
    return true;
}
