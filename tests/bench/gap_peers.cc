#include "gap_peers.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#ifdef BENCH_CCD
#include <ccd/ccd.h>
#endif
#ifdef BENCH_FCL
#include <fcl/fcl.h>
#endif
#ifdef BENCH_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#endif

struct gap_peers {
    const gap_solid *solid;
    size_t pairs;
#ifdef BENCH_FCL
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> fcl;
#endif
#ifdef BENCH_BULLET
    std::vector<std::unique_ptr<btConvexHullShape>> bullet;
#endif
};

static constexpr double tight [[maybe_unused]] = 1e-10;

#ifdef BENCH_CCD
/* ccdGJKPenetration() has no bound on its iterations and does not end for some pairs at a tight
 * tolerance. Past the limit both supports are the origin, which ends it. */
static constexpr int support_limit = 1000;
static int supports;

static void support(const void *object, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    const auto *solid = static_cast<const gap_solid *>(object);
    double most = -INFINITY;
    if (++supports > support_limit)
        return ccdVec3Set(out, 0, 0, 0);
    for (int i = 0; i < solid->count; i++) {
        const double *at = solid->vertex[i];
        const double along = at[0] * way->v[0] + at[1] * way->v[1] + at[2] * way->v[2];
        if (along > most) {
            most = along;
            ccdVec3Set(out, at[0], at[1], at[2]);
        }
    }
}

static ccd_t ccd_settings()
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.max_iterations = 100;
    supports = 0;
    return ccd;
}

static void ccd_meets(gap_peers *peers, size_t i, double *gap)
{
    const ccd_t ccd = ccd_settings();
    const bool meets = ccdGJKIntersect(&peers->solid[i], &peers->solid[peers->pairs + i], &ccd);
    *gap = meets ? -INFINITY : INFINITY;
}

static void ccd_depth_by(ccd_t ccd, gap_peers *peers, size_t i, double *gap)
{
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    const int status = ccdGJKPenetration(&peers->solid[i], &peers->solid[peers->pairs + i], &ccd,
                                         &depth, &direction, &position);
    if (supports > support_limit)
        *gap = NAN;
    else
        *gap = status == 0 ? -depth : status == -1 ? INFINITY : NAN;
}

static void ccd_depth(gap_peers *peers, size_t i, double *gap)
{
    ccd_depth_by(ccd_settings(), peers, i, gap);
}

static void ccd_depth_tight(gap_peers *peers, size_t i, double *gap)
{
    ccd_t ccd = ccd_settings();
    ccd.epa_tolerance = tight;
    ccd_depth_by(ccd, peers, i, gap);
}
#endif

#ifdef BENCH_FCL
static std::unique_ptr<fcl::CollisionObjectd> fcl_of(const gap_solid &solid)
{
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (int i = 0; i < solid.count; i++)
        vertices->push_back({solid.vertex[i][0], solid.vertex[i][1], solid.vertex[i][2]});
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

static void fcl_distance_by(const fcl::DistanceRequestd &request, gap_peers *peers, size_t i,
                            double *gap)
{
    fcl::DistanceResultd result;
    *gap = fcl::distance(peers->fcl[i].get(), peers->fcl[peers->pairs + i].get(), request, result);
}

static void fcl_distance(gap_peers *peers, size_t i, double *gap)
{
    fcl_distance_by(fcl::DistanceRequestd(), peers, i, gap);
}

static void fcl_distance_tight(gap_peers *peers, size_t i, double *gap)
{
    fcl::DistanceRequestd request;
    request.distance_tolerance = tight;
    fcl_distance_by(request, peers, i, gap);
}
#endif

#ifdef BENCH_BULLET
static std::unique_ptr<btConvexHullShape> bullet_of(const gap_solid &solid)
{
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < solid.count; i++)
        hull->addPoint(btVector3(solid.vertex[i][0], solid.vertex[i][1], solid.vertex[i][2]),
                       false);
    hull->setMargin(0);
    hull->recalcLocalAabb();
    return hull;
}

static void bullet_gap(gap_peers *peers, size_t i, double *gap)
{
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(peers->bullet[i].get(), peers->bullet[peers->pairs + i].get(),
                               &simplex, &depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    *gap = result.m_hasResult ? double(result.m_distance) : NAN;
}
#endif

static const struct {
    const char *name;
    int answers;
    void (*run)(gap_peers *peers, size_t i, double *gap);
} table[] = {
#ifdef BENCH_FCL
    {"fcl", GAP_PEER_DISTANCE, fcl_distance},
    {"fcl 1e-10", GAP_PEER_DISTANCE, fcl_distance_tight},
#endif
#ifdef BENCH_CCD
    {"ccd", GAP_PEER_DEPTH, ccd_depth},
    {"ccd 1e-10", GAP_PEER_DEPTH, ccd_depth_tight},
    {"ccd verdict", GAP_PEER_MEETS, ccd_meets},
#endif
#ifdef BENCH_BULLET
    {"bullet", GAP_PEER_DISTANCE | GAP_PEER_DEPTH, bullet_gap},
#endif
};

gap_peers *gap_peers_open(const gap_solid *solid, size_t pairs)
{
    auto *out = new gap_peers;
    out->solid = solid;
    out->pairs = pairs;
    for (size_t i = 0; i < 2 * pairs; i++) {
#ifdef BENCH_FCL
        out->fcl.push_back(fcl_of(solid[i]));
#endif
#ifdef BENCH_BULLET
        out->bullet.push_back(bullet_of(solid[i]));
#endif
    }
    return out;
}

void gap_peers_close(gap_peers *peers)
{
    delete peers;
}

const char *gap_peer_name(int peer)
{
    return size_t(peer) < sizeof table / sizeof *table ? table[peer].name : nullptr;
}

int gap_peer_answers(int peer)
{
    return table[peer].answers;
}

void gap_peer_run(gap_peers *peers, int peer, size_t first, size_t count, double *gap)
{
    for (size_t i = first; i < first + count; i++)
        table[peer].run(peers, i, &gap[i]);
}

void gap_peers_help()
{
#ifdef BENCH_FCL
    puts(
        "fcl: fcl::distance() of convex meshes, by its copy of libccd's GJK, at the default\n"
        "tolerance of 1e-6 and at 1e-10; no depth: its signed distance ends the program by a\n"
        "failed assertion for some overlapping pairs.");
#endif
#ifdef BENCH_CCD
    puts(
        "ccd: ccdGJKPenetration(), at the default tolerance of 1e-4 and at 1e-10, of overlapping\n"
        "pairs (libccd has no distance); ccd verdict: ccdGJKIntersect().");
#endif
#ifdef BENCH_BULLET
    printf("bullet: btGjkPairDetector with EPA, margin 0, %s precision as installed.\n",
           sizeof(btScalar) == sizeof(float) ? "single" : "double");
#endif
}
