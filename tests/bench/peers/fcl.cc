/* FCL: boxes, spheres and capsules as such, other solids as convex meshes. */
#include <fcl/fcl.h>

#include <memory>
#include <utility>
#include <vector>

#include "bodies.hh"

namespace
{

using Object = std::unique_ptr<fcl::CollisionObjectd>;

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

Object object_of(const peer_solid &solid)
{
    if (solid.box || solid.radius > 0)
        return primitive_of(solid);
    return solid.hull ? hull_of(solid) : mesh_of(solid);
}

fcl::CollisionObjectd *object(void *bodies, size_t i)
{
    return body_at<Object>(bodies, i).get();
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

const peer methods[] = {{"fcl", PEER_VERDICT, PEER_HULLS, collide},
                        {"fcl distance", PEER_DISTANCE, PEER_HULLS, distance},
                        {"fcl 1e-10", PEER_DISTANCE, PEER_HULLS, distance_tight}};

}  // namespace

const peer_library peer_library_fcl = {
    methods, sizeof methods / sizeof *methods,
    "fcl: fcl::collide() of boxes, spheres and capsules and, by its own GJK, of convex meshes\n"
    "(the default, libccd's MPR, does not end for some pairs); fcl distance, fcl 1e-10:\n"
    "fcl::distance() at the default tolerance of 1e-6 and at 1e-10; no depth: its signed\n"
    "distance ends the program by a failed assertion for some overlapping pairs.",
    bodies_open<Object, object_of>, bodies_close<Object>};
