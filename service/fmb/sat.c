/* The separating axis theorem, the article's comparator: two convex bodies are separated just
 * if they are so along one of the normals of their faces or of the planes of an edge of each
 * (Eberly and Schneider, the article's reference 1). Moving bodies: along each axis they are in
 * contact over an interval of time, and all of these must meet.
 *
 * Coordinates are relative to the origin of a; no vertex is built: along an axis n a cuboid
 * extends from sum min(0, n . c_i) to sum max(0, n . c_i), a tetrahedron from
 * min(0, n . c_i) to max(0, n . c_i).
 *
 * Accuracy: none is promised. Rounding decides near contact. */
#include "inexact.h"

#include <math.h>

enum { EDGES_MAX = 6 };

/* Directions of edges: the components, of a simplex also their differences. */
struct edges {
    int count;
    double edge[EDGES_MAX][3];
};

struct sat {
    const struct fmb_body *a, *b;
    struct relative_motion motion;
    struct bounds bounds; /* of the time */
};

static void edges_of(const struct fmb_body *body, struct edges *out)
{
    out->count = 0;
    for (int i = 0; i < body->dim; i++, out->count++)
        for (int axis = 0; axis < 3; axis++)
            out->edge[out->count][axis] = body->component[i][axis];
    if (body->shape == FMB_CUBOID)
        return;
    for (int i = 0; i < body->dim; i++)
        for (int j = i + 1; j < body->dim; j++, out->count++)
            for (int axis = 0; axis < 3; axis++)
                out->edge[out->count][axis] = body->component[j][axis] - body->component[i][axis];
}

static double dot(const double u[3], const double v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

static void extent(const struct fmb_body *body, const double normal[3], double range[2])
{
    range[0] = range[1] = 0;
    for (int i = 0; i < body->dim; i++) {
        double at = dot(normal, body->component[i]);
        if (body->shape == FMB_CUBOID) {
            range[0] += fmin(0, at);
            range[1] += fmax(0, at);
        } else {
            range[0] = fmin(range[0], at);
            range[1] = fmax(range[1], at);
        }
    }
}

/* Contact along the normal is while low <= start + tau slope <= high. False: never. */
static bool meet_along(struct sat *sat, const double normal[3])
{
    if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0)
        return true;
    double of_a[2], of_b[2];
    extent(sat->a, normal, of_a);
    extent(sat->b, normal, of_b);
    double low = of_a[0] - of_b[1], high = of_a[1] - of_b[0];
    double start = dot(normal, sat->motion.offset);
    double slope = sat->motion.moving ? dot(normal, sat->motion.drift) : 0;
    if (slope == 0) {
        if (start == low || start == high)
            sat->bounds.no_interior = true;
        return !(start < low || start > high);
    }
    double enter = ((slope > 0 ? low : high) - start) / slope;
    double leave = ((slope > 0 ? high : low) - start) / slope;
    sat->bounds.strict[0] = fmax(sat->bounds.strict[0], enter);
    sat->bounds.strict[1] = fmin(sat->bounds.strict[1], leave);
    return bounds_verdict(&sat->bounds) != FMB_SEPARATED;
}

static bool meet_across(struct sat *sat, const double u[3], const double v[3])
{
    double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                        u[0] * v[1] - u[1] * v[0]};
    return meet_along(sat, normal);
}

/* Edges of a tetrahedron: c0, c1, c2, c1 - c0, c2 - c0, c2 - c1. */
static bool meet_across_faces(struct sat *sat, const struct edges *of)
{
    return meet_across(sat, of->edge[0], of->edge[1]) &&
           meet_across(sat, of->edge[1], of->edge[2]) &&
           meet_across(sat, of->edge[2], of->edge[0]) &&
           (of->count == 3 || meet_across(sat, of->edge[3], of->edge[4]));
}

static bool meet_across_edges_2d(struct sat *sat, const struct edges *of)
{
    for (int i = 0; i < of->count; i++) {
        double normal[3] = {-of->edge[i][1], of->edge[i][0], 0};
        if (!meet_along(sat, normal))
            return false;
    }
    return true;
}

static bool meet(struct sat *sat)
{
    struct edges of_a, of_b;
    edges_of(sat->a, &of_a);
    edges_of(sat->b, &of_b);
    if (sat->a->dim == 2)
        return meet_across_edges_2d(sat, &of_a) && meet_across_edges_2d(sat, &of_b);
    if (!meet_across_faces(sat, &of_a) || !meet_across_faces(sat, &of_b))
        return false;
    for (int i = 0; i < of_a.count; i++)
        for (int j = 0; j < of_b.count; j++)
            if (!meet_across(sat, of_a.edge[i], of_b.edge[j]))
                return false;
    return true;
}

static double largest_of(double largest, const double v[3])
{
    return fmax(largest, fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))));
}

/* Products of three lengths, differences and sums of a few of them, must neither overflow nor all
 * vanish: the largest length of the pair has to be within 2^-300 and 2^300. */
static bool in_range(const struct sat *sat)
{
    double largest = largest_of(largest_of(0, sat->motion.offset), sat->motion.drift);
    for (int i = 0; i < 3; i++)
        largest = largest_of(largest_of(largest, sat->a->component[i]), sat->b->component[i]);
    return largest >= 0x1p-300 && largest <= 0x1p300;
}

enum fmb_status sat_decide(const struct fmb_pair *pair, unsigned want, struct fmb_answer *answer)
{
    (void) want;
    struct sat sat = {.a = pair->a.body,
                      .b = pair->b.body,
                      .bounds = {.strict = {-INFINITY, INFINITY}, .closed = {0, 1}}};
    if (sat.a->flat || sat.b->flat || !relative_motion_of(pair, &sat.motion) || !in_range(&sat))
        return FMB_CANNOT_DECIDE;
    answer->verdict = meet(&sat) ? bounds_verdict(&sat.bounds) : FMB_SEPARATED;
    if (answer->verdict != FMB_SEPARATED && sat.motion.moving)
        bounds_answer_contact(&sat.bounds, pair->duration, answer);
    return FMB_OK;
}
