#include "fcl.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/fcl.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace
{

using Object = fcl::CollisionObjectd;

/* A frame: its object, and where it is in its body. */
struct Part {
    std::unique_ptr<Object> object;
    fcl::Transform3d local;
    int body;
};

std::shared_ptr<fcl::CollisionGeometryd> tetrahedron(const fmb_frame &frame)
{
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    auto faces = std::make_shared<std::vector<int>>(
        std::vector<int>{3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2});
    vertices->push_back(fcl::Vector3d::Zero());
    for (int i = 0; i < 3; i++)
        vertices->push_back({frame.component[i][0], frame.component[i][1], frame.component[i][2]});
    const fcl::Vector3d normal = ((*vertices)[1]).cross((*vertices)[2]);
    if (normal.dot((*vertices)[3]) < 0)
        std::swap((*vertices)[1], (*vertices)[2]);
    return std::make_shared<fcl::Convexd>(vertices, 4, faces);
}

/* Rings, whose faces are known. */
std::shared_ptr<fcl::CollisionGeometryd> hull(const fmb_frame &frame)
{
    const rings rings = *std::find_if(robot_rings, robot_rings + ROBOT_RINGS, [&](auto some) {
        return int(frame.vertex_count) == rings_vertices(some);
    });
    int count;
    auto faces = std::make_shared<std::vector<int>>(rings_faces(rings, nullptr, &count));
    rings_faces(rings, faces->data(), &count);
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (unsigned v = 0; v < frame.vertex_count; v++)
        vertices->push_back({frame.vertices[v], frame.vertices[frame.vertex_stride + v],
                             frame.vertices[2 * frame.vertex_stride + v]});
    return std::make_shared<fcl::Convexd>(vertices, count, faces);
}

struct Pairs {
    const robot *states;
    std::set<std::pair<int, int>> met;
};

bool collide(Object *a, Object *b, void *data)
{
    auto *pairs = static_cast<Pairs *>(data);
    int first = static_cast<Part *>(a->getUserData())->body;
    int second = static_cast<Part *>(b->getUserData())->body;
    if (first > second)
        std::swap(first, second);
    if (first == second || (second < pairs->states->links && second == first + 1) ||
        pairs->met.count({first, second}))
        return false;
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(a, b, request, result) > 0)
        pairs->met.insert({first, second});
    return false;
}

fcl::Transform3d transform_of(const fmb_placement &placement)
{
    const double *q = placement.orientation, *p = placement.position;
    fcl::Transform3d out = fcl::Transform3d::Identity();
    out.linear() = fcl::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    out.translation() = fcl::Vector3d(p[0], p[1], p[2]);
    return out;
}

}  // namespace

struct fcl_robot {
    const robot *states;
    std::vector<std::unique_ptr<Part>> parts;
    fcl::DynamicAABBTreeCollisionManagerd links, obstacles;
};

static void add(fcl_robot *out, int body, const fmb_frame &frame)
{
    auto part = std::make_unique<Part>();
    const bool box = frame.shape == FMB_BOX;
    const double *at = box ? frame.centre : frame.origin;
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    if (frame.shape == FMB_HULL)
        geometry = hull(frame);
    else if (box)
        geometry = std::make_shared<fcl::Boxd>(frame.component[0][0], frame.component[1][1],
                                               frame.component[2][2]);
    else
        geometry = tetrahedron(frame);
    geometry->computeLocalAABB();
    part->local = fcl::Transform3d::Identity();
    if (frame.shape != FMB_HULL) /* whose vertices are where they are in its body */
        part->local.translation() = fcl::Vector3d(at[0], at[1], at[2]);
    part->body = body;
    part->object = std::make_unique<Object>(geometry);
    part->object->setUserData(part.get());
    out->parts.push_back(std::move(part));
}

static void move(fcl_robot *robot, int state, int first, int end)
{
    for (const auto &part : robot->parts) {
        if (part->body < first || part->body >= end)
            continue;
        part->object->setTransform(transform_of(robot->states->placement[state][part->body]) *
                                   part->local);
        part->object->computeAABB();
    }
}

struct fcl_robot *fcl_robot_create(const struct robot *states)
{
    auto *out = new fcl_robot;
    out->states = states;
    const int bodies = states->links + states->obstacles;
    for (int body = 0; body < bodies; body++)
        for (unsigned i = 0; i < states->body[body].frame_count; i++)
            add(out, body, *fmb_body_frame(&states->body[body], i));
    move(out, 0, 0, bodies);
    for (const auto &part : out->parts)
        (part->body < states->links ? out->links : out->obstacles)
            .registerObject(part->object.get());
    out->links.setup();
    out->obstacles.setup();
    return out;
}

void fcl_robot_destroy(struct fcl_robot *robot)
{
    delete robot;
}

int fcl_robot_decide(struct fcl_robot *robot, int state)
{
    Pairs pairs = {robot->states, {}};
    move(robot, state, 0, robot->states->links);
    robot->links.update();
    robot->links.collide(&pairs, collide);
    robot->links.collide(&robot->obstacles, &pairs, collide);
    return static_cast<int>(pairs.met.size());
}
