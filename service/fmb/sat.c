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
    bool moving;
    double offset[3]; /* of b's origin from a's, at tau = 0 */
    double drift[3];  /* of b against a, over the window */
    struct contact_times times;
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
    double start = dot(normal, sat->offset);
    double slope = sat->moving ? dot(normal, sat->drift) : 0;
    if (slope == 0) {
        if (start == low || start == high)
            sat->times.no_interior = true;
        return !(start < low || start > high);
    }
    double enter = ((slope > 0 ? low : high) - start) / slope;
    double leave = ((slope > 0 ? high : low) - start) / slope;
    sat->times.strict[0] = fmax(sat->times.strict[0], enter);
    sat->times.strict[1] = fmin(sat->times.strict[1], leave);
    return contact_times_verdict(&sat->times) != FMB_SEPARATED;
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

static double velocity_of(const struct fmb_frame *frame, int axis)
{
    return frame->moving ? frame->velocity[axis] : 0;
}

enum fmb_status sat_decide(const struct fmb_pair *pair, unsigned want, struct fmb_answer *answer)
{
    (void) want;
    if (pair->a.body->flat || pair->b.body->flat)
        return FMB_CANNOT_DECIDE;
    struct sat sat = {.a = pair->a.body,
                      .b = pair->b.body,
                      .moving = pair->a.moving || pair->b.moving,
                      .times = {.strict = {-INFINITY, INFINITY}, .window = {0, 1}}};
    bool finite = true;
    for (int axis = 0; axis < sat.a->dim; axis++) {
        sat.offset[axis] = pair->b.origin[axis] - pair->a.origin[axis];
        sat.drift[axis] =
            (velocity_of(&pair->b, axis) - velocity_of(&pair->a, axis)) * pair->duration;
        finite = finite && isfinite(sat.offset[axis]) && isfinite(sat.drift[axis]);
    }
    if (!finite)
        return FMB_CANNOT_DECIDE;

    answer->verdict = meet(&sat) ? contact_times_verdict(&sat.times) : FMB_SEPARATED;
    if (answer->verdict != FMB_SEPARATED && sat.moving)
        contact_times_answer(&sat.times, pair->duration, answer);
    return FMB_OK;
}
