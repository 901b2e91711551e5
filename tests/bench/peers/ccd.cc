/* libccd, by support functions. A moving pair is B, swept by its velocity relative to A, and A. */
#include <ccd/ccd.h>

#include <cmath>

#include "peers.h"

namespace
{

/* ccdGJKPenetration() and ccdMPRIntersect() do not bound their iterations and do not end for some
 * pairs. Past the limit both supports are the origin, which ends them. */
constexpr int support_limit = 1000;
int supports;

struct Swept {
    const peer_solid *solid;
    double drift[3];
};

double dot(const double *a, const ccd_vec3_t *b)
{
    return a[0] * b->v[0] + a[1] * b->v[1] + a[2] * b->v[2];
}

void add(ccd_vec3_t *to, const double *vector)
{
    for (int axis = 0; axis < 3; axis++)
        to->v[axis] += vector[axis];
}

void add_farthest_of_simplex(const peer_solid &solid, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    const double *farthest = nullptr;
    double most = 0;
    for (const auto &component : solid.component) {
        const double along = dot(component, way);
        if (along > most) {
            most = along;
            farthest = component;
        }
    }
    if (farthest)
        add(out, farthest);
}

/* Its support functions scan all vertices, and add the radius along the direction. */
void add_farthest_of_hull(const peer_solid &solid, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    const double length = std::sqrt(dot(way->v, way));
    int farthest = 0;
    double most = -HUGE_VAL;
    for (int i = 0; i < solid.count; i++) {
        const double along = dot(solid.hull[i], way);
        farthest = along > most ? i : farthest;
        most = std::fmax(most, along);
    }
    add(out, solid.hull[farthest]);
    for (int axis = 0; axis < 3 && solid.radius > 0; axis++)
        out->v[axis] += solid.radius / length * way->v[axis];
}

void support(const void *object, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    const auto *swept = static_cast<const Swept *>(object);
    const peer_solid &solid = *swept->solid;
    if (++supports > support_limit)
        return ccdVec3Set(out, 0, 0, 0);
    ccdVec3Set(out, solid.origin[0], solid.origin[1], solid.origin[2]);
    if (solid.hull)
        add_farthest_of_hull(solid, way, out);
    else if (solid.count == 4)
        add_farthest_of_simplex(solid, way, out);
    else
        for (const auto &component : solid.component)
            if (dot(component, way) > 0)
                add(out, component);
    if (dot(swept->drift, way) > 0)
        add(out, swept->drift);
}

void centre(const void *object, ccd_vec3_t *out)
{
    const auto *swept = static_cast<const Swept *>(object);
    const peer_solid &solid = *swept->solid;
    const double part = solid.count == 4 ? 0.25 : 0.5;
    if (solid.hull)
        return ccdVec3Set(out, solid.centre[0], solid.centre[1], solid.centre[2]);
    for (int axis = 0; axis < 3; axis++)
        out->v[axis] =
            solid.origin[axis] + 0.5 * swept->drift[axis] +
            part * (solid.component[0][axis] + solid.component[1][axis] + solid.component[2][axis]);
}

struct Question {
    Swept a, b;
    ccd_t ccd;
};

Question question(void *bodies, size_t a, size_t b)
{
    const auto *solid = static_cast<const peer_solid *>(bodies);
    Question out = {{&solid[a], {0, 0, 0}}, {&solid[b], {0, 0, 0}}, {}};
    for (int axis = 0; axis < 3; axis++)
        out.b.drift[axis] = solid[b].velocity[axis] - solid[a].velocity[axis];
    CCD_INIT(&out.ccd);
    out.ccd.support1 = out.ccd.support2 = support;
    out.ccd.center1 = out.ccd.center2 = centre;
    out.ccd.max_iterations = 100;
    supports = 0;
    return out;
}

double gjk(void *bodies, size_t a, size_t b)
{
    const Question q = question(bodies, a, b);
    return ccdGJKIntersect(&q.a, &q.b, &q.ccd) ? -INFINITY : INFINITY;
}

double mpr(void *bodies, size_t a, size_t b)
{
    const Question q = question(bodies, a, b);
    const bool meets = ccdMPRIntersect(&q.a, &q.b, &q.ccd);
    return supports > support_limit ? NAN : meets ? -INFINITY : INFINITY;
}

double depth_of(const Question &q)
{
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    const int status = ccdGJKPenetration(&q.a, &q.b, &q.ccd, &depth, &direction, &position);
    if (supports > support_limit)
        return NAN;
    return status == 0 ? -depth : status == -1 ? INFINITY : NAN;
}

double depth(void *bodies, size_t a, size_t b)
{
    return depth_of(question(bodies, a, b));
}

double depth_tight(void *bodies, size_t a, size_t b)
{
    Question q = question(bodies, a, b);
    q.ccd.epa_tolerance = 1e-10;
    return depth_of(q);
}

void *open(const peer_solid *solid, size_t)
{
    return const_cast<peer_solid *>(solid);
}

void close(void *)
{
}

constexpr int at_rest = PEER_HULLS, moving = at_rest | PEER_MOVING;

const peer methods[] = {{"ccd gjk", PEER_VERDICT, moving, gjk},
                        {"ccd mpr", PEER_VERDICT, moving, mpr},
                        {"ccd epa", PEER_DEPTH, at_rest, depth},
                        {"ccd 1e-10", PEER_DEPTH, at_rest, depth_tight}};

}  // namespace

const peer_library peer_library_ccd = {
    methods, sizeof methods / sizeof *methods,
    "ccd gjk, ccd mpr: libccd's ccdGJKIntersect() and ccdMPRIntersect(), of moving pairs with the\n"
    "swept B; ccd epa, ccd 1e-10: ccdGJKPenetration() of overlapping pairs (libccd has no\n"
    "distance), at the default tolerance of 1e-4 and at 1e-10.",
    open, close};
