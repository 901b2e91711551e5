#include "turn_path.h"

#include <math.h>
#include <string.h>

#define TURN_ERROR (80 * 0x1p-53)

static const double binomial[6] = {1, 5, 10, 10, 5, 1};

/* ---- Poses ---- */

/* Without an end, the position at the end is p + v T: the differences of p and of v T are rounded
 * once each. */
void turn_path_set(const struct frame_pair *frames, struct turn_path *out)
{
    const struct fmb_placement *a = frames->a.placement, *b = frames->b.placement;
    struct support_pair *pair = &out->pair;
    const struct fmb_placement *const placed[2] = {a, b};
    double path[FMB_DIM_MAX] = {0}, late[FMB_DIM_MAX] = {0};
    support_pair_set(frames, pair);
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < pair->dim; axis++) {
            const double p = placed[f]->position[axis];
            out->position[f][0][axis] = p;
            out->position[f][1][axis] = placed[f]->end_count
                                            ? placed[f]->end_position[axis]
                                            : p + placed[f]->velocity[axis] * frames->duration;
        }
    motion_quaternions(a, out->q[0][0], out->q[0][1]);
    motion_quaternions(b, out->q[1][0], out->q[1][1]);
    for (int axis = 0; axis < pair->dim; axis++) {
        path[axis] = pair->drift[axis];
        late[axis] = (b->end_count ? b->end_position : b->position)[axis] -
                     (a->end_count ? a->end_position : a->position)[axis];
        pair->drift[axis] = 0;
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out->offset[0][axis] = pair->offset[axis];
        out->offset[1][axis] = late[axis] + path[axis];
    }
    out->farthest = fmax(vec3_sum(pair->offset), vec3_sum(late) + vec3_sum(path));
    memset(pair->path, 0, sizeof pair->path);
    pair->drifts = false;
    pair->posed = true;
    pair->reach = (pair->view[0].reach + pair->view[1].reach) + out->farthest;
    pair->error =
        32 * 0x1p-53 * pair->reach + (pair->view[0].slack + pair->view[1].slack) + 0x1p-1000;
    pair->usable = pair->reach < 0x1p200 && pair->reach > 0x1p-200;
}

static void orientation_at(const double q[2][4], double s, double out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = (1 - s) * q[0][i] + s * q[1][i];
}

void turn_path_at(const struct turn_path *path, int f, double s, double q[4],
                  double position[FMB_DIM_MAX])
{
    orientation_at(path->q[f], s, q);
    for (int axis = 0; axis < path->pair.dim; axis++)
        position[axis] = (1 - s) * path->position[f][0][axis] + s * path->position[f][1][axis];
}

void turn_path_pose(struct turn_path *path, double s)
{
    struct support_pair *pair = &path->pair;
    const struct fmb_placement *const placed[2] = {pair->frames->a.placement,
                                                   pair->frames->b.placement};
    pair->at = s;
    for (int axis = 0; axis < pair->dim; axis++)
        pair->offset[axis] = (1 - s) * path->offset[0][axis] + s * path->offset[1][axis];
    for (int f = 0; f < 2; f++) {
        struct fmb_placement turned = {.orientation_count = 4};
        turn_path_at(path, f, s, turned.orientation, pair->position[f]);
        if (placed[f]->end_count && placed[f]->orientation_count)
            rotation_of(&turned, pair->dim, &pair->view[f].rotation);
    }
}

/* Sets the direction of a search that ended with a simplex of dim + 1 vertices, which contains the
 * origin up to rounding: the normal of the facet nearest to the origin, pointing into the simplex.
 */
static void facet_direction(const struct support_pair *pair, struct support_nearest *nearest)
{
    double least = INFINITY;
    for (int omitted = 0; omitted <= pair->dim; omitted++) {
        const double *p[FMB_DIM_MAX] = {NULL}, *other = nearest->simplex.vertex[omitted].at;
        double edge[2][FMB_DIM_MAX] = {{0}, {0, 0, 1}}, n[FMB_DIM_MAX], inward = 0;
        for (int i = 0; i < pair->dim; i++)
            p[i] = nearest->simplex.vertex[i < omitted ? i : i + 1].at;
        for (int i = 0; i + 1 < pair->dim; i++)
            for (int axis = 0; axis < FMB_DIM_MAX; axis++)
                edge[i][axis] = p[i + 1][axis] - p[0][axis];
        vec3_cross(edge[0], edge[1], n);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            inward += n[axis] * (other[axis] - p[0][axis]);
        const double length = copysign(sqrt(vec3_dot(n, n)), inward);
        const double away = fabs(vec3_dot(n, p[0]) / length);
        if (!(away < least))
            continue;
        least = away;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            nearest->direction[axis] = n[axis] / length;
    }
}

enum fmb_verdict turn_look(struct turn_path *path, double s, const double toward[FMB_DIM_MAX],
                           struct support_nearest *nearest, enum fmb_verdict *cores)
{
    struct support_pair *pair = &path->pair;
    double first[FMB_DIM_MAX];
    turn_path_pose(path, s);
    memcpy(first, toward, sizeof first);
    if (vec3_dot(first, first) == 0)
        support_toward(pair, first);
    *cores = support_search_from(pair, first, INFINITY, nearest);
    if (nearest->simplex.count == (unsigned) pair->dim + 1 && *cores == 0)
        facet_direction(pair, nearest);
    return pair->rounded ? support_round_verdict(pair, *cores, nearest) : *cores;
}

/* ---- Directions ---- */

void turn_body_direction(const struct support_view *view, const double n[FMB_DIM_MAX],
                         double out[FMB_DIM_MAX])
{
    for (int j = 0; j < FMB_DIM_MAX; j++)
        out[j] = rotation_entry(&view->rotation, 0, j) * n[0] +
                 rotation_entry(&view->rotation, 1, j) * n[1] +
                 rotation_entry(&view->rotation, 2, j) * n[2];
    if (view->rotation.dim == 2)
        out[2] = 0;
}

unsigned turn_farthest(const struct support_view *view, const double n[FMB_DIM_MAX], double sign,
                       double slack, uint16_t *out)
{
    const double along[FMB_DIM_MAX] = {sign * n[0], sign * n[1], sign * n[2]};
    const double most = support_max(&view->vertices, along).value;
    return support_list(&view->vertices, along,
                        most - ((0x1p-30 + slack) * view->reach + 2 * view->slack) * vec3_sum(n),
                        out);
}

/* out := the edge, scaled. Returns its largest component before that. */
static double get_edge(const struct support_view *view, const uint16_t vertex[2],
                       double out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double *at = view->vertices.at + (size_t) axis * view->vertices.stride;
        out[axis] = axis < view->vertices.dim ? at[vertex[1]] - at[vertex[0]] : 0;
    }
    const double largest = vec3_largest(out);
    for (int axis = 0; axis < FMB_DIM_MAX && largest > 0; axis++)
        out[axis] /= largest;
    return largest;
}

void turn_direction_of(const struct support_view *view, const struct turn_corners *corners,
                       struct turn_direction *out)
{
    const uint16_t *v = corners->vertex;
    out->of = corners->of;
    if (corners->of == 2) {
        get_edge(&view[0], &v[0], out->m[0]);
        get_edge(&view[1], &v[2], out->m[1]);
        return;
    }
    const uint16_t other[2] = {v[0], v[2]};
    double edge[2][FMB_DIM_MAX] = {{0}, {0, 0, 1}};
    get_edge(&view[corners->of], &v[0], edge[0]);
    if (view->vertices.dim == 3)
        get_edge(&view[corners->of], other, edge[1]);
    vec3_cross(edge[0], edge[1], out->m[0]);
    if (view->vertices.dim == 2)
        for (int axis = 0; axis < 2; axis++)
            out->m[0][axis] = -out->m[0][axis];
}

/* Removes the vertices of a short list that are close to an earlier one, such as the second edge of
 * a thin plate. Returns the number of the others. */
static unsigned remove_close(const struct support_view *view, unsigned count, uint16_t *list)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < count; i++) {
        double edge[FMB_DIM_MAX];
        bool close = false;
        for (unsigned k = 0; k < kept && count <= SUPPORT_SMALL && !close; k++) {
            const uint16_t ends[2] = {list[k], list[i]};
            close = get_edge(view, ends, edge) <= 0x1p-20 * view->reach;
        }
        if (!close)
            list[kept++] = list[i];
    }
    return kept;
}

/* For a vertex of one frame and a face of the other, the direction is fixed in the frame of the
 * face, which has more supporting vertices. For two edges that are not parallel it is their
 * product. It may be fixed in either frame for two parallel edges, and for frames with a radius,
 * since a frame may turn about a vertex. */
unsigned turn_directions(const struct turn_path *path, const double nearest[FMB_DIM_MAX],
                         double slack, struct turn_direction out[3])
{
    const struct support_view *view = path->pair.view;
    uint16_t list[2][FMB_HULL_VERTICES_MAX];
    unsigned count[2];
    for (int f = 0; f < 2; f++) {
        out[f].of = f;
        turn_body_direction(&view[f], nearest, out[f].m[0]);
        count[f] = turn_farthest(&view[f], out[f].m[0], f ? -1 : 1, slack, list[f]);
        count[f] = remove_close(&view[f], count[f], list[f]);
    }
    if (count[0] == 2 && count[1] == 2 && path->pair.dim == 3) {
        struct turn_direction edges = {.of = 2};
        double e[FMB_DIM_MAX], f[FMB_DIM_MAX], n[FMB_DIM_MAX];
        for (int k = 0; k < 2; k++)
            get_edge(&view[k], list[k], edges.m[k]);
        rotation_apply(&view[0].rotation, edges.m[0], e);
        rotation_apply(&view[1].rotation, edges.m[1], f);
        vec3_cross(e, f, n);
        if (vec3_dot(n, n) > 0x1p-20 * vec3_dot(e, e) * vec3_dot(f, f)) {
            for (int axis = 0; axis < FMB_DIM_MAX && vec3_dot(n, nearest) < 0; axis++)
                edges.m[0][axis] = -edges.m[0][axis];
            out[2] = out[0];
            out[0] = edges;
            return 3;
        }
    }
    if (count[1] > count[0]) {
        const struct turn_direction of_a = out[0];
        out[0] = out[1];
        out[1] = of_a;
    }
    return count[0] == count[1] || path->pair.rounded ? 2 : 1;
}

void turn_normal(const struct turn_path *path, const struct turn_direction *direction,
                 double out[FMB_DIM_MAX])
{
    const struct support_view *view = path->pair.view;
    double e[FMB_DIM_MAX], f[FMB_DIM_MAX];
    rotation_apply(&view[direction->of % 2].rotation, direction->m[0], direction->of < 2 ? out : e);
    if (direction->of < 2)
        return;
    rotation_apply(&view[1].rotation, direction->m[1], f);
    vec3_cross(e, f, out);
}

double turn_along(struct turn_path *path, const struct turn_direction *direction, double s)
{
    struct support_column column;
    double n[FMB_DIM_MAX];
    turn_path_pose(path, s);
    turn_normal(path, direction, n);
    const double length = sqrt(vec3_dot(n, n));
    const double outward[FMB_DIM_MAX] = {-n[0] / length, -n[1] / length, -n[2] / length};
    return -support_farthest(&path->pair, outward, &column) - path->pair.radius[1];
}

/* ---- Polynomials ---- */

/* For one frame over an interval: the coefficients of N(q) and of |q|^2. */
struct turn_quadratic {
    double matrix[3][FMB_DIM_MAX][FMB_DIM_MAX];
    double norm[3], largest;
};

static void set_quadratic(const double q[2][4], double lo, double hi, struct turn_quadratic *out)
{
    double end[2][4];
    orientation_at(q, lo, end[0]);
    orientation_at(q, hi, end[1]);
    for (int k = 0; k < 3; k++) {
        const double *x = end[k == 2], *y = end[k > 0], twice = k == 1 ? 2 : 1;
        motion_polar(x, y, out->matrix[k]);
        out->norm[k] = twice * ((x[0] * y[0] + x[1] * y[1]) + (x[2] * y[2] + x[3] * y[3]));
        for (int i = 0; i < 9; i++)
            out->matrix[k][i / 3][i % 3] *= twice;
    }
    out->largest = fmax(out->norm[0], out->norm[2]) * (1 + 0x1p-40);
}

INLINE void apply(const double matrix[FMB_DIM_MAX][FMB_DIM_MAX], const double v[FMB_DIM_MAX],
                  double out[FMB_DIM_MAX])
{
    for (int i = 0; i < FMB_DIM_MAX; i++)
        out[i] = vec3_dot(matrix[i], v);
}

/* out += matrix^T v */
INLINE void add_transposed(const double matrix[FMB_DIM_MAX][FMB_DIM_MAX],
                           const double v[FMB_DIM_MAX], double out[FMB_DIM_MAX])
{
    for (int i = 0; i < FMB_DIM_MAX; i++)
        for (int j = 0; j < FMB_DIM_MAX; j++)
            out[j] += matrix[i][j] * v[i];
}

/* x := x raised from degree 4 to 5 */
static void raise_degree(double *x, int stride)
{
    for (int k = 5; k >= 0; k--)
        for (int i = 0; i < stride; i++)
            x[k * stride + i] =
                (k < 5 ? x[k * stride + i] : 0) + (k > 0 ? x[(k - 1) * stride + i] : 0);
}

/* value[k] -= the greatest sign c_k . v over the vertices */
static void subtract_support(const struct support_view *view, double c[6][FMB_DIM_MAX], double sign,
                             double value[6])
{
    for (int k = 0; k < 6; k++) {
        const double n[FMB_DIM_MAX] = {sign * c[k][0], sign * c[k][1], sign * c[k][2]};
        value[k] -= support_max(&view->vertices, n).value;
    }
}

/* The least coefficients of n . (b - a), and bounds of the coefficients of |n|; both times |q_A|^2
 * |q_B|^2. Coefficient k is off by C(5, k) error. */
struct turn_polynomial {
    double value[6], length[6], error;
    double below[6]; /* coefficients of a polynomial that is at most |n| */
};

static void fixed_polynomial(const struct turn_path *path, const struct turn_direction *direction,
                             double sign, const struct turn_quadratic quadratic[2],
                             double difference[2][FMB_DIM_MAX], struct turn_polynomial *out)
{
    const int f = direction->of;
    const struct turn_quadratic *own = &quadratic[f], *other = &quadratic[!f];
    const struct support_view *view = path->pair.view;
    const double *m = direction->m[0], way = f == 0 ? sign : -sign;
    const double along[FMB_DIM_MAX] = {way * m[0], way * m[1], way * m[2]};
    double c[6][FMB_DIM_MAX] = {{0}}, o[4] = {0}, norm[6] = {0};
    for (int i = 0; i < 3; i++) {
        double n[FMB_DIM_MAX];
        apply((const double(*)[FMB_DIM_MAX]) own->matrix[i], m, n);
        for (int j = 0; j < 3; j++) {
            add_transposed((const double(*)[FMB_DIM_MAX]) other->matrix[j], n, c[i + j]);
            norm[i + j] += own->norm[i] * other->norm[j];
        }
        for (int j = 0; j < 2; j++)
            o[i + j] += sign * vec3_dot(n, difference[j]);
    }
    raise_degree(c[0], FMB_DIM_MAX);
    raise_degree(norm, 1);
    const double most = support_max(&view[f].vertices, along).value;
    const double length = sqrt(vec3_dot(m, m)) * (1 + 0x1p-50);
    for (int k = 0; k < 6; k++) {
        out->value[k] = -norm[k] * most;
        out->length[k] = norm[k] * length;
        for (int i = 0; i < 4; i++)
            if (k >= i && k - i < 3)
                out->value[k] += o[i] * other->norm[k - i];
    }
    subtract_support(&view[!f], c, -way, out->value);
    memcpy(out->below, out->length, sizeof out->below);
    out->error = length;
}

static void product_polynomial(const struct turn_path *path, const struct turn_direction *direction,
                               double sign, const struct turn_quadratic quadratic[2],
                               double difference[2][FMB_DIM_MAX], struct turn_polynomial *out)
{
    const double(*m)[FMB_DIM_MAX] = (const double(*)[FMB_DIM_MAX]) direction->m;
    double edge[2][3][FMB_DIM_MAX], n[6][FMB_DIM_MAX] = {{0}};
    double x[2][6][FMB_DIM_MAX] = {{{0}}}, c[6][FMB_DIM_MAX];
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < 3; i++)
            apply((const double(*)[FMB_DIM_MAX]) quadratic[f].matrix[i], m[f], edge[f][i]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double product[FMB_DIM_MAX];
            vec3_cross(edge[0][i], edge[1][j], product);
            for (int axis = 0; axis < FMB_DIM_MAX; axis++)
                n[i + j][axis] += sign * product[axis];
            add_transposed((const double(*)[FMB_DIM_MAX]) quadratic[1].matrix[j], edge[0][i],
                           x[0][i + j]);
            add_transposed((const double(*)[FMB_DIM_MAX]) quadratic[0].matrix[i], edge[1][j],
                           x[1][i + j]);
        }
    for (int k = 0; k < 6; k++)
        out->value[k] = (k < 5 ? vec3_dot(n[k], difference[0]) : 0) +
                        (k > 0 ? vec3_dot(n[k - 1], difference[1]) : 0);
    raise_degree(x[0][0], FMB_DIM_MAX);
    raise_degree(x[1][0], FMB_DIM_MAX);
    for (int f = 0; f < 2; f++) {
        for (int k = 0; k < 6; k++)
            vec3_cross(x[f][k], m[!f], c[k]);
        subtract_support(&path->pair.view[!f], c, -sign, out->value);
    }
    const double middle = sqrt(vec3_dot(n[2], n[2])) * (1 + 0x1p-50);
    for (int k = 0; k < 6; k++) {
        out->length[k] = k < 5 ? sqrt(vec3_dot(n[k], n[k])) * (1 + 0x1p-50) : 0;
        out->below[k] = k < 5 ? vec3_dot(n[k], n[2]) / middle : 0;
    }
    raise_degree(out->length, 1);
    raise_degree(out->below, 1);
    out->error = sqrt(vec3_dot(m[0], m[0])) * sqrt(vec3_dot(m[1], m[1])) * (1 + 0x1p-50);
}

static void set_polynomial(const struct turn_path *path, const struct turn_direction *direction,
                           double sign, double lo, double hi, struct turn_polynomial *out)
{
    const struct support_pair *pair = &path->pair;
    struct turn_quadratic quadratic[2];
    double difference[2][FMB_DIM_MAX];
    for (int f = 0; f < 2; f++)
        set_quadratic((const double(*)[4]) path->q[f], lo, hi, &quadratic[f]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        difference[0][axis] = (1 - lo) * path->offset[0][axis] + lo * path->offset[1][axis];
        difference[1][axis] = (1 - hi) * path->offset[0][axis] + hi * path->offset[1][axis];
    }
    (direction->of < 2 ? fixed_polynomial : product_polynomial)(path, direction, sign, quadratic,
                                                                difference, out);
    out->error *= (TURN_ERROR * (pair->reach + pair->radius[1]) +
                   (pair->view[0].slack + pair->view[1].slack) * (1 + 0x1p-40)) *
                  (quadratic[0].largest * quadratic[1].largest);
    out->error = out->error * (1 + 0x1p-30) + 0x1p-900;
}

double turn_distance(const struct turn_path *path, const struct turn_direction *direction,
                     double lo, double hi)
{
    struct turn_polynomial of;
    double least = INFINITY;
    bool negative = false;
    set_polynomial(path, direction, 1, lo, hi, &of);
    for (int k = 0; k < 6; k++)
        negative = negative || !(of.value[k] - binomial[k] * of.error > 0);
    for (int k = 0; k < 6; k++) {
        const double certain = of.value[k] - binomial[k] * of.error;
        const double off = binomial[k] * of.error / path->pair.reach;
        CHECK_BOUND(TURN_ERROR, false, of.value[k], binomial[k] * of.error);
        CHECK_BOUND(TURN_ERROR, direction->of == 2, of.length[k], off);
        const double divisor = (negative ? of.below[k] - off : of.length[k] + off);
        if (!(divisor > 0))
            return -INFINITY;
        least = fmin(least, certain / divisor);
    }
    if (negative)
        least = fmin(least, 0);
    return least - (fabs(least) * 0x1p-50 + path->pair.radius[1]);
}

bool turn_may_separate(const struct turn_path *path, const struct turn_direction *direction,
                       double sign, double lo, double hi)
{
    struct turn_polynomial of;
    bool may = true;
    set_polynomial(path, direction, sign, lo, hi, &of);
    for (int k = 0; k < 6; k++)
        may = may && !(of.value[k] - path->pair.radius[1] * of.length[k] <
                       -0x1p12 * binomial[k] * of.error);
    return may;
}

/* Returns a polynomial with these coefficients at x in [0, 1]. */
static double value_at(const double c[6], double x)
{
    const double y = 1 - x;
    double value = c[5], power = y;
    for (int k = 4; k >= 0; k--) {
        value = value * x + c[k] * power;
        power *= y;
    }
    return value;
}

/* Follows a polynomial that is positive at x from x to `end`, by samples. *negative := whether it
 * becomes negative. Returns the fraction of the distance up to which it is positive or, if it is
 * positive all the way, at which it is least. */
static double positive_part(const double c[6], double x, double end, bool *negative)
{
    enum { SAMPLES = 16, HALVINGS = 40 };
    double least = value_at(c, x), before = 0, at = 0, in = 0, out = 1;
    for (int k = 1; k <= SAMPLES; k++) {
        const double share = (double) k / SAMPLES, value = value_at(c, x + share * (end - x));
        *negative = value < 0;
        if (*negative) {
            in = before, out = share;
            break;
        }
        before = share;
        if (value < least)
            least = value, at = share;
    }
    for (int k = 0; k < HALVINGS && *negative; k++) {
        const double middle = 0.5 * (in + out);
        *(value_at(c, x + middle * (end - x)) > 0 ? &in : &out) = middle;
    }
    return *negative ? in : at;
}

void turn_positive_part(const double c[6], double at, double *lo, double *hi)
{
    const double width = *hi - *lo, x = (at - *lo) / width;
    bool negative[2];
    const double before = positive_part(c, x, 0, &negative[0]);
    const double after = positive_part(c, x, 1, &negative[1]);
    if (negative[0] || (!negative[1] && before > 0))
        *lo = ceil((at - before * x * width) * 0x1p52) * 0x1p-52;
    if (negative[1] || (!negative[0] && after > 0))
        *hi = floor((at + after * (1 - x) * width) * 0x1p52) * 0x1p-52;
}

void turn_part(const struct turn_path *path, const struct turn_direction *direction, double at,
               double *lo, double *hi)
{
    struct turn_polynomial of;
    set_polynomial(path, direction, 1, *lo, *hi, &of);
    for (int k = 0; k < 6; k++)
        of.value[k] -= 4 * binomial[k] * of.error + path->pair.radius[1] * of.length[k];
    turn_positive_part(of.value, at, lo, hi);
}
