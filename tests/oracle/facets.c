/* Method. A facet has two directions of edges that are independent, so all pairs of edges are
 * tried, the drift being an edge too. Where all edges are parallel there is no facet.
 *
 * Most normals are seen in doubles to be far from the limit. All lengths are divided for that by
 * the largest coordinate after a vertex of each hull was subtracted, so that each is off by at most
 * 2^-52, and edges by their own largest one. A normal is then off by at most 2^-49 an axis, its
 * product with a vector of the difference, whose coordinates are at most 10, by less than 2^-42,
 * and d by less than QUICK_ERROR.
 *
 * Large hulls have too many pairs of edges, and thin ones of many vertices too many that are not
 * far. Of these, facets are sampled: the planes through the farthest points along three directions
 * close to each other, of any directions and of those about the one that has come nearest to the
 * limit. This may miss a facet that is above it; tests/campaign/depth.cc has all of them. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "difference.h"
#include "draw.h"
#include "memory.h"

static const double QUICK_ERROR = 0x1p-40;

/* All pairs of edges of two hulls of 41 vertices; so many products of a normal and a column, which
 * all pairs of edges of two hulls of 12 vertices take; planes. */
enum { ALL_EDGES_MAX = 1700, WORK_MAX = 430000, SAMPLES = 600 };

typedef double vector[FMB_DIM_MAX];

struct quick_solid {
    int count;
    bool hull;
    vector *column;
};

struct facets {
    const struct difference *difference;
    int edges;
    rational_vector *edge;
    mpq_t scale; /* what lengths were divided by */
    vector *quick_edge, offset, drift;
    struct quick_solid solid[2];
    double limit;
};

/* ---- Exactly ---- */

void difference_end(const struct difference *difference, rational_vector n, int sign, mpq_t end,
                    mpq_t *point)
{
    rational_vector with, against;
    mpq_t at,
        scale; /* which makes the direction integers: no fraction is reduced for each vertex */
    rational_vector_init(with);
    rational_vector_init(against);
    mpq_inits(at, scale, NULL);
    mpq_set_ui(scale, 1, 1);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpz_lcm(mpq_numref(scale), mpq_numref(scale), mpq_denref(n[axis]));
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_mul(sign > 0 ? with[axis] : against[axis], n[axis], scale);
        mpq_neg(sign > 0 ? against[axis] : with[axis], sign > 0 ? with[axis] : against[axis]);
        if (point)
            mpq_set_ui(point[axis], 0, 1);
    }
    mpq_set_ui(end, 0, 1);
    if (difference->first)
        rational_solid_support(difference->first, against, end, point);
    for (int axis = 0; axis < FMB_DIM_MAX && point; axis++)
        mpq_sub(point[axis], difference->offset[axis], point[axis]);
    rational_solid_support(difference->second, with, at, point);
    mpq_add(end, end, at);
    if (difference->drift) {
        rational_dot(at, with, difference->drift);
        if (mpq_sgn(at) > 0) {
            mpq_add(end, end, at);
            for (int axis = 0; axis < FMB_DIM_MAX && point; axis++)
                mpq_add(point[axis], point[axis], difference->drift[axis]);
        }
    }
    rational_dot(at, with, difference->offset);
    mpq_add(end, end, at);
    mpq_div(end, end, scale);
    if (sign < 0)
        mpq_neg(end, end);
    rational_vector_clear(with);
    rational_vector_clear(against);
    mpq_clears(at, scale, NULL);
}

int difference_compare(const mpq_t x, const mpq_t y, rational_vector n)
{
    const int of_x = mpq_sgn(x), of_y = mpq_sgn(y);
    if (of_x != of_y || of_x == 0)
        return of_x > of_y ? 1 : of_x < of_y ? -1 : 0;
    mpq_t left, right;
    mpq_inits(left, right, NULL);
    mpq_mul(left, x, x);
    rational_dot(right, n, n);
    mpq_mul(right, right, y);
    mpq_mul(right, right, y);
    const int order = mpq_cmp(left, right);
    mpq_clears(left, right, NULL);
    return of_x * ((order > 0) - (order < 0));
}

/* The edges of the solids, of a hull all differences of its vertices, and the drift. In: out may be
 * NULL. Returns how many. */
static int list_edges(const struct difference *difference, rational_vector *out)
{
    int count = 0;
    for (int side = 0; side < 2; side++) {
        struct rational_solid *solid = side == 0 ? difference->first : difference->second;
        for (int i = 0; i < solid->count; i++)
            for (int j = solid->hull ? 0 : i; j < (solid->hull ? i : i + 1); j++, count++)
                for (int axis = 0; axis < 3 && out; axis++) {
                    mpq_set(out[count][axis], solid->column[i][axis]);
                    if (solid->hull)
                        mpq_sub(out[count][axis], out[count][axis], solid->column[j][axis]);
                }
    }
    for (int axis = 0; axis < 3 && out; axis++)
        mpq_set(out[count][axis], difference->drift[axis]);
    return count + 1;
}

static void cross(rational_vector out, rational_vector x, rational_vector y)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpq_set_ui(out[i], 0, 1);
        rational_add_product(out[i], 1, x[j], y[k]);
        rational_add_product(out[i], -1, x[k], y[j]);
    }
}

/* ---- In doubles ---- */

static void raise_to(mpq_t most, rational_vector v)
{
    mpq_t size;
    mpq_init(size);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_abs(size, v[axis]);
        if (mpq_cmp(size, most) > 0)
            mpq_set(most, size);
    }
    mpq_clear(size);
}

/* out := v / scale, each axis rounded towards 0. The quotient is not reduced: that would take most
 * of the time of facets. */
static void divide(rational_vector v, const mpq_t scale, vector out)
{
    mpq_t ratio;
    mpq_init(ratio);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out[axis] = 0;
        if (mpq_sgn(scale) == 0)
            continue;
        mpz_mul(mpq_numref(ratio), mpq_numref(v[axis]), mpq_denref(scale));
        mpz_mul(mpq_denref(ratio), mpq_denref(v[axis]), mpq_numref(scale));
        out[axis] = mpq_get_d(ratio);
    }
    mpq_clear(ratio);
}

/* out := column i, of a hull less column 0. */
static void relative_column(struct rational_solid *solid, int i, rational_vector out)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_set(out[axis], solid->column[i][axis]);
        if (solid->hull)
            mpq_sub(out[axis], out[axis], solid->column[0][axis]);
    }
}

static void set_quick(struct facets *facets, const mpq_t limit)
{
    const struct difference *difference = facets->difference;
    struct rational_solid *solid[2] = {difference->first, difference->second};
    rational_vector offset, at;
    mpq_t most;
    mpq_init(most);
    rational_vector_init(offset);
    rational_vector_init(at);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_set(offset[axis], difference->offset[axis]);
        if (solid[0]->hull)
            mpq_sub(offset[axis], offset[axis], solid[0]->column[0][axis]);
        if (solid[1]->hull)
            mpq_add(offset[axis], offset[axis], solid[1]->column[0][axis]);
    }
    raise_to(facets->scale, offset);
    raise_to(facets->scale, difference->drift);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < solid[side]->count; i++) {
            relative_column(solid[side], i, at);
            raise_to(facets->scale, at);
        }
    divide(offset, facets->scale, facets->offset);
    divide(difference->drift, facets->scale, facets->drift);
    for (int side = 0; side < 2; side++) {
        struct quick_solid *quick = &facets->solid[side];
        *quick = (struct quick_solid){solid[side]->count, solid[side]->hull,
                                      memory_get((size_t) solid[side]->count * sizeof(vector))};
        for (int i = 0; i < quick->count; i++) {
            relative_column(solid[side], i, at);
            divide(at, facets->scale, quick->column[i]);
        }
    }
    for (int e = 0; e < facets->edges; e++) {
        mpq_set_ui(most, 0, 1);
        raise_to(most, facets->edge[e]);
        divide(facets->edge[e], most, facets->quick_edge[e]);
    }
    mpq_set_ui(most, 0, 1);
    if (mpq_sgn(facets->scale) != 0)
        mpq_div(most, limit, facets->scale);
    facets->limit = mpq_get_d(most);
    mpq_clear(most);
    rational_vector_clear(offset);
    rational_vector_clear(at);
}

static double dot(const double *x, const double *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

static void cross_doubles(const double *x, const double *y, double *out)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = x[j] * y[k] - x[k] * y[j];
    }
}

static void add(double *to, double times, const double *v)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        to[axis] += times * v[axis];
}

/* The greatest sign * n . (a point of the solid). */
static double quick_extent(const struct quick_solid *solid, const double *n, int sign)
{
    double extent = solid->hull ? -HUGE_VAL : 0;
    for (int i = 0; i < solid->count; i++) {
        const double at = sign * dot(n, solid->column[i]);
        extent = solid->hull ? fmax(extent, at) : extent + fmax(at, 0);
    }
    return extent;
}

/* Whether d of the normal sign * (x times y) is surely below the limit. */
static bool is_far(const struct facets *facets, const double *x, const double *y, int sign)
{
    vector n;
    cross_doubles(x, y, n);
    const double least = sign * dot(n, facets->offset) - quick_extent(&facets->solid[0], n, sign) -
                         quick_extent(&facets->solid[1], n, -sign) +
                         fmin(sign * dot(n, facets->drift), 0);
    return least - facets->limit * sqrt(dot(n, n)) < -QUICK_ERROR;
}

/* ---- Exactly again ---- */

static void facets_init(struct facets *facets, const struct difference *difference,
                        const mpq_t limit)
{
    facets->difference = difference;
    facets->edges = list_edges(difference, NULL);
    facets->edge = memory_get((size_t) facets->edges * sizeof *facets->edge);
    facets->quick_edge = memory_get((size_t) facets->edges * sizeof *facets->quick_edge);
    for (int e = 0; e < facets->edges; e++)
        rational_vector_init(facets->edge[e]);
    list_edges(difference, facets->edge);
    mpq_init(facets->scale);
    set_quick(facets, limit);
}

static void facets_clear(struct facets *facets)
{
    for (int e = 0; e < facets->edges; e++)
        rational_vector_clear(facets->edge[e]);
    free(facets->edge);
    free(facets->quick_edge);
    mpq_clear(facets->scale);
    for (int side = 0; side < 2; side++)
        free(facets->solid[side].column);
}

/* The sign of d - limit of the normal sign * n. */
static int compare_facet(const struct difference *difference, rational_vector n, int sign,
                         const mpq_t limit)
{
    mpq_t end;
    mpq_init(end);
    difference_end(difference, n, -sign, end, NULL);
    if (sign < 0)
        mpq_neg(end, end);
    const int order = difference_compare(end, limit, n);
    mpq_clear(end);
    return order;
}

/* ---- Sampled ---- */

/* value := d of the direction n, of any length; point := a point where it is attained. */
static double quick_least(const struct facets *facets, const double *n, double *point)
{
    const double length = sqrt(dot(n, n));
    memcpy(point, facets->offset, sizeof facets->offset);
    if (dot(n, facets->drift) < 0)
        add(point, 1, facets->drift);
    for (int side = 0; side < 2; side++) {
        const struct quick_solid *solid = &facets->solid[side];
        const int sign = side == 0 ? -1 : 1;
        int best = 0;
        for (int i = 0; i < solid->count; i++) {
            const double at = sign * dot(n, solid->column[i]);
            if (!solid->hull && at < 0)
                add(point, sign, solid->column[i]);
            else if (at < sign * dot(n, solid->column[best]))
                best = i;
        }
        if (solid->hull)
            add(point, sign, solid->column[best]);
    }
    return dot(n, point) / length;
}

/* n := the normal of a plane through points of the difference that are farthest along directions
 * no farther from about than the radius, inwards; 0: these are not three. */
static void sample_facet(const struct facets *facets, struct draw *draw, const double *about,
                         double radius, double *n)
{
    vector point[3];
    for (int i = 0; i < 3; i++) {
        vector way = {0};
        for (int axis = 0; axis < facets->difference->dim; axis++)
            way[axis] = about[axis] + draw_uniform(draw, -radius, radius);
        quick_least(facets, way, point[i]);
    }
    add(point[1], -1, point[0]);
    add(point[2], -1, point[0]);
    if (facets->difference->dim == 2)
        memcpy(point[2], (const vector){0, 0, 1}, sizeof point[2]);
    cross_doubles(point[1], point[2], n);
    if (dot(n, about) < 0)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            n[axis] = -n[axis];
}

static int compare_samples(const struct facets *facets, const mpq_t limit)
{
    struct draw draw = {1};
    vector best = {1}, n, point;
    rational_vector exact;
    double most = quick_least(facets, best, point);
    rational_vector_init(exact);
    for (int k = 0; k < SAMPLES; k++) {
        const bool anywhere = k % 2 == 0;
        sample_facet(facets, &draw, anywhere ? (const vector){0} : best,
                     anywhere ? 1 : ldexp(1, -k % 40), n);
        if (dot(n, n) == 0 || !(quick_least(facets, n, point) > most))
            continue;
        most = quick_least(facets, n, point);
        memcpy(best, n, sizeof best);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            best[axis] /= sqrt(dot(n, n));
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpq_set_d(exact[axis], best[axis]);
    const int order = compare_facet(facets->difference, exact, 1, limit);
    rational_vector_clear(exact);
    return order;
}

/* ---- The whole ---- */

int difference_compare_facets(const struct difference *difference, const mpq_t limit)
{
    static const vector quick_up = {0, 0, 1};
    const bool space = difference->dim == 3;
    rational_vector n, up;
    struct facets facets;
    bool any = false;
    int order = -1;
    rational_vector_init(n);
    rational_vector_init(up);
    mpq_set_ui(up[2], 1, 1);
    facets_init(&facets, difference, limit);
    const long columns = facets.solid[0].count + facets.solid[1].count;
    long work = 0;
    bool large = facets.edges > ALL_EDGES_MAX;
    for (int i = 0; !large && i < facets.edges; i++)
        for (int j = space ? 0 : i; !large && j <= i; j++)
            for (int sign = -1; sign <= 1 && order < 1; sign += 2) {
                if (is_far(&facets, facets.quick_edge[i], space ? facets.quick_edge[j] : quick_up,
                           sign)) {
                    any = true; /* a normal of 0 is not far */
                    continue;
                }
                cross(n, facets.edge[i], space ? facets.edge[j] : up);
                if (!mpq_sgn(n[0]) && !mpq_sgn(n[1]) && !mpq_sgn(n[2]))
                    continue;
                const int one = compare_facet(difference, n, sign, limit);
                order = one > order ? one : order;
                any = true;
                work += columns;
                large = work > WORK_MAX;
            }
    if (large && order < 1)
        order = compare_samples(&facets, limit);
    facets_clear(&facets);
    rational_vector_clear(n);
    rational_vector_clear(up);
    return any || large ? order : -mpq_sgn(limit);
}
