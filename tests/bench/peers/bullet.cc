/* Bullet, margin 0: boxes, spheres and capsules as such, other solids as convex hulls. */
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btSubSimplexConvexCast.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <cmath>
#include <memory>

#include "bodies.hh"

namespace
{

struct Body {
    std::unique_ptr<btConvexShape> shape;
    btTransform pose;
    btVector3 velocity;
};

btVector3 vector_of(const double *v)
{
    return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])};
}

btTransform pose_of(const peer_solid &solid)
{
    btMatrix3x3 rows;
    for (int i = 0; i < 3; i++)
        rows[i] = vector_of(solid.axis[i]);
    return btTransform(rows.transpose(), vector_of(solid.centre));
}

std::unique_ptr<btConvexShape> hull_of(const peer_solid &solid)
{
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < solid.count; i++)
        hull->addPoint(vector_of(solid.hull ? solid.hull[i] : solid.vertex[i]), false);
    hull->recalcLocalAabb();
    return hull;
}

Body body_of(const peer_solid &solid)
{
    Body out = {nullptr, btTransform::getIdentity(), vector_of(solid.velocity)};
    if (solid.radius > 0) { /* their margin is the radius */
        const auto radius = btScalar(solid.radius);
        out.pose = pose_of(solid);
        if (solid.count == 1)
            out.shape = std::make_unique<btSphereShape>(radius);
        else
            out.shape = std::make_unique<btCapsuleShapeZ>(radius, btScalar(solid.size[2]));
        return out;
    }
    if (solid.box) {
        out.shape = std::make_unique<btBoxShape>(vector_of(solid.size) / 2);
        out.pose = pose_of(solid);
    } else {
        out.shape = hull_of(solid);
        if (solid.hull)
            out.pose.setOrigin(vector_of(solid.centre));
    }
    out.shape->setMargin(0);
    return out;
}

double gap_at_rest(const Body &a, const Body &b)
{
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(a.shape.get(), b.shape.get(), &simplex, &depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = a.pose;
    input.m_transformB = b.pose;
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    return result.m_hasResult ? double(result.m_distance) : NAN;
}

/* A cast does not report pairs that overlap from the start. */
double gap_moving(const Body &a, const Body &b, const btVector3 &drift)
{
    const double gap = gap_at_rest(a, b);
    if (!(gap > 0))
        return gap;
    btVoronoiSimplexSolver simplex;
    btSubsimplexConvexCast cast(a.shape.get(), b.shape.get(), &simplex);
    btConvexCast::CastResult result;
    btTransform end = b.pose;
    end.getOrigin() += drift;
    return cast.calcTimeOfImpact(a.pose, a.pose, b.pose, end, result) ? -INFINITY : INFINITY;
}

double gap(void *bodies, size_t a, size_t b)
{
    const Body &p = body_at<Body>(bodies, a), &q = body_at<Body>(bodies, b);
    const btVector3 drift = q.velocity - p.velocity;
    return drift.isZero() ? gap_at_rest(p, q) : gap_moving(p, q, drift);
}

const peer methods[] = {
    {"bullet", PEER_VERDICT | PEER_DISTANCE | PEER_DEPTH, PEER_MOVING | PEER_HULLS, gap}};

}  // namespace

const peer_library peer_library_bullet = {
    methods, sizeof methods / sizeof *methods,
    "bullet: btGjkPairDetector with EPA; of moving pairs that do not overlap at\n"
    "the start, btSubsimplexConvexCast; margin 0, "
#ifdef BT_USE_DOUBLE_PRECISION
    "doubles.",
#else
    "floats.",
#endif
    bodies_open<Body, body_of>, bodies_close<Body>};
