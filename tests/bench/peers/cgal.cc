/* CGAL: exact predicates on tetrahedra and triangles; a cuboid is five tetrahedra, a parallelogram
 * two triangles. The vertices are rounded: exact are the answers about these. */
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <cmath>
#include <vector>

#include "bodies.hh"

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct Body {
    std::vector<Kernel::Tetrahedron_3> space;
    std::vector<Kernel::Triangle_2> plane;
};

void add_tetrahedron(const peer_solid &solid, const int (&index)[4], Body *out)
{
    Kernel::Point_3 p[4];
    for (int i = 0; i < 4; i++) {
        const double *v = solid.vertex[index[i]];
        p[i] = Kernel::Point_3(v[0], v[1], v[2]);
    }
    out->space.emplace_back(p[0], p[1], p[2], p[3]);
}

void add_triangle(const peer_solid &solid, const int (&index)[3], Body *out)
{
    Kernel::Point_2 p[3];
    for (int i = 0; i < 3; i++)
        p[i] = Kernel::Point_2(solid.vertex[index[i]][0], solid.vertex[index[i]][1]);
    out->plane.emplace_back(p[0], p[1], p[2]);
}

Body body_of(const peer_solid &solid)
{
    static const int tetrahedron[] = {0, 1, 2, 3};
    static const int cuboid[5][4] = {
        {0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};
    static const int triangle[] = {0, 1, 2}, other_half[] = {3, 1, 2};
    Body out;
    if (solid.dim == 2)
        add_triangle(solid, triangle, &out);
    if (solid.dim == 2 && solid.count == 4)
        add_triangle(solid, other_half, &out);
    if (solid.dim == 3 && solid.count == 4)
        add_tetrahedron(solid, tetrahedron, &out);
    if (solid.count == 8)
        for (const auto &part : cuboid)
            add_tetrahedron(solid, part, &out);
    return out;
}

template <class Parts>
bool any_intersect(const Parts &a, const Parts &b)
{
    for (const auto &p : a)
        for (const auto &q : b)
            if (CGAL::do_intersect(p, q))
                return true;
    return false;
}

double gap(void *bodies, size_t a, size_t b)
{
    const Body &p = body_at<Body>(bodies, a), &q = body_at<Body>(bodies, b);
    return any_intersect(p.space, q.space) || any_intersect(p.plane, q.plane) ? -INFINITY
                                                                              : INFINITY;
}

const peer methods[] = {{"cgal", PEER_VERDICT, PEER_2D | PEER_3D, gap}};

}  // namespace

const peer_library peer_library_cgal = {methods, sizeof methods / sizeof *methods,
                                        "cgal: do_intersect() by exact predicates, of tetrahedra "
                                        "and triangles; five of them a cuboid,\n"
                                        "two a parallelogram, of vertices rounded to doubles.",
                                        bodies_open<Body, body_of>, bodies_close<Body>};
