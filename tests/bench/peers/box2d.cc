/* box2d, in floats: the distance of shapes without their skin; of moving pairs the time of
 * impact. */
#include <box2d/b2_distance.h>
#include <box2d/b2_time_of_impact.h>

#include <cmath>

#include "bodies.hh"

namespace
{

struct Body {
    b2Vec2 vertex[4], velocity;
    int count;
};

b2Vec2 vector_of(const double *v)
{
    return {float(v[0]), float(v[1])};
}

Body body_of(const peer_solid &solid)
{
    Body out;
    out.count = solid.count;
    out.velocity = vector_of(solid.velocity);
    for (int v = 0; v < solid.count; v++)
        out.vertex[v] = vector_of(solid.vertex[v]);
    return out;
}

b2DistanceProxy proxy_of(const Body &body)
{
    b2DistanceProxy out;
    out.Set(body.vertex, body.count, 0);
    return out;
}

/* The threshold is that of b2TestOverlap(). */
double gap_at_rest(const Body &a, const Body &b)
{
    b2DistanceInput input;
    input.proxyA = proxy_of(a);
    input.proxyB = proxy_of(b);
    input.transformA.SetIdentity();
    input.transformB.SetIdentity();
    input.useRadii = false;
    b2SimplexCache cache;
    cache.count = 0;
    b2DistanceOutput output;
    b2Distance(&output, &cache, &input);
    return output.distance < 10 * b2_epsilon ? 0 : output.distance;
}

b2Sweep sweep_of(b2Vec2 way)
{
    b2Sweep out;
    out.localCenter.SetZero();
    out.c0.SetZero();
    out.c = way;
    out.a0 = out.a = out.alpha0 = 0;
    return out;
}

double time_of_impact(const Body &a, const Body &b, b2Vec2 drift)
{
    b2TOIInput input;
    input.proxyA = proxy_of(a);
    input.proxyB = proxy_of(b);
    input.sweepA = sweep_of(b2Vec2_zero);
    input.sweepB = sweep_of(drift);
    input.tMax = 1;
    b2TOIOutput output;
    b2TimeOfImpact(&output, &input);
    switch (output.state) {
    case b2TOIOutput::e_overlapped:
    case b2TOIOutput::e_touching: return -INFINITY;
    case b2TOIOutput::e_separated: return INFINITY;
    default: return NAN;
    }
}

double gap(void *bodies, size_t a, size_t b)
{
    const Body &p = body_at<Body>(bodies, a), &q = body_at<Body>(bodies, b);
    const b2Vec2 drift = q.velocity - p.velocity;
    return drift == b2Vec2_zero ? gap_at_rest(p, q) : time_of_impact(p, q, drift);
}

const peer methods[] = {{"box2d", PEER_VERDICT, PEER_2D | PEER_MOVING, gap}};

}  // namespace

const peer_library peer_library_box2d = {
    methods, sizeof methods / sizeof *methods,
    "box2d: b2Distance(), of moving pairs b2TimeOfImpact(), in floats.", bodies_open<Body, body_of>,
    bodies_close<Body>};
