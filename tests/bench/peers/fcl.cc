/* FCL: boxes, spheres and capsules as such, other solids as convex meshes. */
#include <fcl/fcl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bodies.hh"

namespace
{

/* FCL's own interpolation, but with the quaternions of struct peer_motion in place of slerp. Both
 * rotate about the same axis. The angular speed at s is 2 |q0 x q1| / |q(s)|^2, with the product in
 * the plane of the quaternions. FCL needs an upper bound over the window. */
class Motion final : public fcl::InterpMotion<double>
{
   public:
    explicit Motion(const peer_motion &of)
        : InterpMotion(matrix(of, 0), centre(of, 0), matrix(of, 1), centre(of, 1),
                       -fcl::Vector3d(of.centre)),
          q{quaternion(of, 0), quaternion(of, 1)},
          position(of.position[0])
    {
        const Eigen::Vector4d way = q[1].coeffs() - q[0].coeffs();
        const double square = way.squaredNorm();
        const double nearest =
            square > 0 ? std::clamp(-q[0].coeffs().dot(way) / square, 0.0, 1.0) : 0;
        angular_vel = 2 * (q[0].conjugate() * q[1]).vec().norm() /
                      (q[0].coeffs() + nearest * way).squaredNorm();
    }

    bool integrate(double time) const override
    {
        const double s = std::min(time, 1.0);
        fcl::Quaterniond at;
        at.coeffs() = (1 - s) * q[0].coeffs() + s * q[1].coeffs();
        at.normalize();
        tf.linear() = at.toRotationMatrix();
        tf.translation() = position + s * linear_vel - tf.linear() * reference_p;
        return true;
    }

    EIGEN_MAKE_ALIGNED_OPERATOR_NEW

   private:
    static fcl::Quaterniond quaternion(const peer_motion &of, int end)
    {
        const double *own = of.orientation[end];
        return fcl::Quaterniond(own[0], own[1], own[2], own[3]);
    }

    static fcl::Matrix3d matrix(const peer_motion &of, int end)
    {
        return quaternion(of, end).normalized().toRotationMatrix();
    }

    static fcl::Vector3d centre(const peer_motion &of, int end)
    {
        return fcl::Vector3d(of.position[end]) + matrix(of, end) * fcl::Vector3d(of.centre);
    }

    const fcl::Quaterniond q[2];
    const fcl::Vector3d position;
};

using Object = std::unique_ptr<fcl::CollisionObjectd>;

struct Body {
    Object object;
    std::unique_ptr<Motion> motion; /* NULL: the solid has none */
};

/* A box, a sphere or a capsule. */
Object primitive_of(const peer_solid &solid)
{
    std::shared_ptr<fcl::CollisionGeometryd> shape;
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; i++)
        pose.linear().col(i) = fcl::Vector3d(solid.axis[i]);
    pose.translation() = fcl::Vector3d(solid.centre);
    if (solid.box)
        shape = std::make_shared<fcl::Boxd>(fcl::Vector3d(solid.size));
    else if (solid.count == 1)
        shape = std::make_shared<fcl::Sphered>(solid.radius);
    else
        shape = std::make_shared<fcl::Capsuled>(solid.radius, solid.size[2]);
    return std::make_unique<fcl::CollisionObjectd>(shape, pose);
}

Object mesh_of(const peer_solid &solid)
{
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (int i = 0; i < solid.count; i++)
        vertices->push_back(fcl::Vector3d(solid.vertex[i]));
    const auto &v = *vertices;
    const bool cuboid = solid.count == 8;
    const int last = cuboid ? 4 : 3;
    if ((v[1] - v[0]).cross(v[2] - v[0]).dot(v[last] - v[0]) < 0) {
        std::swap((*vertices)[1], (*vertices)[2]);
        if (cuboid)
            std::swap((*vertices)[5], (*vertices)[6]);
    }
    auto faces = std::make_shared<std::vector<int>>(
        cuboid ? std::vector<int>{4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4,
                                  4, 2, 6, 7, 3, 4, 0, 4, 6, 2, 4, 1, 3, 7, 5}
               : std::vector<int>{3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2});
    auto convex = std::make_shared<fcl::Convexd>(vertices, cuboid ? 6 : 4, faces);
    convex->computeLocalAABB();
    return std::make_unique<fcl::CollisionObjectd>(convex);
}

Object hull_of(const peer_solid &solid)
{
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (int i = 0; i < solid.count; i++)
        vertices->push_back(fcl::Vector3d(solid.hull[i]));
    const int *end = solid.face;
    for (int i = 0; i < solid.faces; i++)
        end += 1 + *end;
    auto faces = std::make_shared<std::vector<int>>(solid.face, end);
    auto convex = std::make_shared<fcl::Convexd>(vertices, solid.faces, faces);
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = fcl::Vector3d(solid.centre);
    convex->computeLocalAABB();
    return std::make_unique<fcl::CollisionObjectd>(convex, pose);
}

Body body_of(const peer_solid &solid)
{
    Body body;
    body.object = solid.box || solid.radius > 0 ? primitive_of(solid)
                  : solid.hull                  ? hull_of(solid)
                                                : mesh_of(solid);
    if (solid.motion)
        body.motion = std::make_unique<Motion>(*solid.motion);
    return body;
}

fcl::CollisionObjectd *object(void *bodies, size_t i)
{
    return body_at<Body>(bodies, i).object.get();
}

/* Not by the default, libccd's MPR, which does not end for some pairs. */
double collide(void *bodies, size_t a, size_t b)
{
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    request.gjk_solver_type = fcl::GST_INDEP;
    return fcl::collide(object(bodies, a), object(bodies, b), request, result) > 0 ? -INFINITY
                                                                                   : INFINITY;
}

double distance(void *bodies, size_t a, size_t b)
{
    fcl::DistanceResultd result;
    return fcl::distance(object(bodies, a), object(bodies, b), fcl::DistanceRequestd(), result);
}

double distance_tight(void *bodies, size_t a, size_t b)
{
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    request.distance_tolerance = 1e-10;
    return fcl::distance(object(bodies, a), object(bodies, b), request, result);
}

/* FCL starts from the last pose of a motion: both are reset to time 0. */
double continuous(void *bodies, size_t a, size_t b, fcl::CCDSolverType solver)
{
    const Body &one = body_at<Body>(bodies, a), &other = body_at<Body>(bodies, b);
    fcl::ContinuousCollisionRequestd request;
    fcl::ContinuousCollisionResultd result;
    request.ccd_solver_type = solver;
    request.ccd_motion_type = fcl::CCDM_LINEAR;
    one.motion->integrate(0);
    other.motion->integrate(0);
    try {
        fcl::continuousCollide(one.object->collisionGeometry().get(), one.motion.get(),
                               other.object->collisionGeometry().get(), other.motion.get(), request,
                               result);
    } catch (const std::exception &) {
        return NAN;
    }
    return result.is_collide ? -INFINITY : INFINITY;
}

double advancement(void *bodies, size_t a, size_t b)
{
    return continuous(bodies, a, b, fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
}

double naive(void *bodies, size_t a, size_t b)
{
    return continuous(bodies, a, b, fcl::CCDC_NAIVE);
}

const peer methods[] = {
    {"fcl", PEER_VERDICT, PEER_HULLS, collide},
    {"fcl distance", PEER_DISTANCE, PEER_HULLS, distance},
    {"fcl 1e-10", PEER_DISTANCE, PEER_HULLS, distance_tight},
    {"fcl advancement", PEER_TURNING_VERDICT, PEER_HULLS | PEER_TURNING, advancement},
    {"fcl naive", PEER_TURNING_VERDICT, PEER_HULLS | PEER_TURNING, naive}};

}  // namespace

const peer_library peer_library_fcl = {
    methods, sizeof methods / sizeof *methods,
    "fcl: fcl::collide() of boxes, spheres and capsules and, by its own GJK, of convex meshes\n"
    "(the default, libccd's MPR, does not end for some pairs); fcl distance, fcl 1e-10:\n"
    "fcl::distance() at the default tolerance of 1e-6 and at 1e-10; no depth: its signed\n"
    "distance ends the program by a failed assertion for some overlapping pairs. fcl advancement,\n"
    "fcl naive: fcl::continuousCollide() by conservative advancement and at 10 poses, with all\n"
    "other settings at their defaults.",
    bodies_open<Body, body_of>, bodies_close<Body>};
