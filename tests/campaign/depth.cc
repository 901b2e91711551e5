/* The verdict and the depth of hulls of many vertices, from all facets: for each pair of bodies of
 * one frame in 3D, CGAL computes the convex hull of the swept difference { b - a + t v } in exact
 * numbers. With n . x <= d for the plane of a facet, n outward,
 *
 *     separated    some d < 0
 *     in contact   no d < 0; the depth is the least d / |n|, 0 if the difference is flat
 *
 * which is compared with the verdict of the default method and with its gap, without rounding. */
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <gmp.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <vector>

extern "C" {
#include "campaign_options.h"
#include "posed.h"
#include "rational_solid.h"
#include "trial.h"
}

namespace
{

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Exact = Kernel::Exact_kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

/* The most points of a difference: pairs of more are not decided. */
constexpr size_t points_max = 600000;

struct Tally {
    long pairs = 0, deep = 0, flat = 0, large = 0, wrong = 0;
    size_t most = 0; /* vertices of a pair */
};

Vector vector_of(const mpq_t *v)
{
    return {Number(Exact(v[0])), Number(Exact(v[1])), Number(Exact(v[2]))};
}

/* The vertices of a placed frame at the start of the window, and its displacement over it. */
std::vector<Vector> vertices_of(const fmb_placement &placement, double duration, Vector *way)
{
    rational_solid solid;
    std::vector<Vector> out;
    rational_solid_init(fmb_body_frame(placement.body, 0), &placement, &solid);
    const Vector origin = vector_of(solid.origin);
    *way = Number(duration) * vector_of(solid.velocity);
    for (int i = 0; i < (solid.hull ? solid.count : 1 << solid.count); i++) {
        Vector v = origin;
        for (int c = 0; c < solid.count; c++)
            if (solid.hull ? c == i : i >> c & 1)
                v = v + vector_of(solid.column[c]);
        out.push_back(v);
    }
    for (Vector &v : out)
        v = Vector(Number(CGAL::exact(v.x())), Number(CGAL::exact(v.y())),
                   Number(CGAL::exact(v.z())));
    rational_solid_clear(&solid);
    return out;
}

std::vector<Point> difference_of(const std::vector<Vector> &a, const std::vector<Vector> &b,
                                 const Vector &drift)
{
    std::vector<Point> out;
    for (const Vector &v : a)
        for (const Vector &w : b) {
            out.push_back(CGAL::ORIGIN + (w - v));
            if (drift != CGAL::NULL_VECTOR)
                out.push_back(CGAL::ORIGIN + (w - v + drift));
        }
    return out;
}

bool is_flat(const std::vector<Point> &points)
{
    size_t i = 1, j, k;
    while (i < points.size() && points[i] == points[0])
        i++;
    for (j = i; j < points.size() && CGAL::collinear(points[0], points[i], points[j]);)
        j++;
    for (k = j; k < points.size() && CGAL::coplanar(points[0], points[i], points[j], points[k]);)
        k++;
    return k >= points.size();
}

/* What is wrong with the answer; NULL: nothing. */
const char *flaw_of(const std::vector<Point> &points, const fmb_answer &answer)
{
    CGAL::Surface_mesh<Point> hull;
    const bool separated = answer.verdict == FMB_SEPARATED;
    const double *bounds = answer.gap.bounds; /* infinite beyond the largest double */
    const Number low = std::clamp(bounds[0], -DBL_MAX, DBL_MAX);
    const Number high = std::clamp(bounds[1], -DBL_MAX, DBL_MAX);
    bool outside = false, below = std::isinf(bounds[0]), above = true;
    CGAL::convex_hull_3(points.begin(), points.end(), hull);
    for (const auto face : hull.faces()) {
        auto edge = hull.halfedge(face);
        Point p[3];
        for (Point &corner : p) {
            corner = hull.point(hull.target(edge));
            edge = hull.next(edge);
        }
        const Vector n = CGAL::cross_product(p[1] - p[0], p[2] - p[0]);
        const Number d = n * (p[0] - CGAL::ORIGIN), square = n * n;
        outside = outside || d < 0;
        above = above && d * d >= high * high * square; /* the depth is at least -high */
        below = below || d * d <= low * low * square;
    }
    if (outside != separated)
        return "verdict";
    if (!separated && !above)
        return "a facet is nearer than the upper bound says";
    return separated || below ? nullptr : "no facet is as near as the lower bound says";
}

void check(const question &question, Tally *tally)
{
    trial trial;
    trial_begin(&question, &trial);
    const pair &pair = trial.pair[0];
    Vector way[2];
    const auto a = vertices_of(pair.a, pair.duration, &way[0]);
    const auto b = vertices_of(pair.b, pair.duration, &way[1]);
    const Vector drift = way[1] - way[0];
    if (a.size() * b.size() * (drift != CGAL::NULL_VECTOR ? 2 : 1) > points_max) {
        tally->large++;
    } else {
        const auto points = difference_of(a, b, drift);
        const fmb_answer answer =
            trial_decide(&trial, fmb_method_default(), 0, FMB_WANT_GAP).answer;
        const char *flaw = nullptr;
        if (!is_flat(points))
            flaw = flaw_of(points, answer);
        else if (tally->flat++; answer.verdict != FMB_SEPARATED && answer.gap.bounds[1] < 0)
            flaw = "a flat difference has a depth";
        tally->pairs++;
        tally->deep += answer.verdict == FMB_OVERLAPPING;
        tally->most = std::max(tally->most, a.size() + b.size());
        if (flaw) {
            tally->wrong++;
            printf("wrong: %s\n", flaw);
            question_print(&question);
        }
    }
    trial_end(&trial);
}

Tally check_family(const family &family, const options &options)
{
    cell cells[CELL_OF_ALL_SHAPES];
    Tally tally;
    const int count = family_cells(&family, cells);
    for (int c = 0; c < count; c++) {
        draw draw = cell_draw(options.seed, family.name, &cells[c], 0);
        for (long i = 0; cells[c].dim == 3 && i < options.pairs; i++) {
            question question;
            family_draw(&family, &cells[c], &draw, &question);
            if (solid_frames(&question.a) == 1 && solid_frames(&question.b) == 1)
                check(question, &tally);
        }
    }
    return tally;
}

void help()
{
    puts(
        "Usage: depth [OPTIONS]\n"
        "Compares verdict and gap of pairs with a hull in 3D with CGAL's exact convex hull of\n"
        "their difference.\n"
        "  --pairs N    of each family and combination of shapes (100)\n"
        "  --seed S     seed of the pairs\n"
        "  --family F   this family, or those whose names begin so up to a dash");
}

}  // namespace

int main(int argc, char **argv)
{
    static const option table[] = {{"pairs", required_argument, nullptr, OPTION_PAIRS},
                                   {"seed", required_argument, nullptr, OPTION_SEED},
                                   {"family", required_argument, nullptr, OPTION_FAMILY},
                                   {"help", no_argument, nullptr, OPTION_HELP},
                                   {nullptr, 0, nullptr, 0}};
    const options_program program = {"depth", table, help, 100};
    options options;
    Tally all;
    const int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    if (options.families == 0)
        for (size_t i = 0; family_any_at(i); i++)
            if (family_any_at(i)->cells & FAMILY_A_HULL)
                options.family[options.families++] = family_any_at(i);
    for (int i = 0; i < options.families; i++) {
        const Tally tally = check_family(*options.family[i], options);
        printf(
            "%s: %ld pairs of up to %zu vertices, %ld overlapping, %ld flat; %ld too large; "
            "%ld wrong\n",
            options.family[i]->name, tally.pairs, tally.most, tally.deep, tally.flat, tally.large,
            tally.wrong);
        fflush(stdout);
        all.pairs += tally.pairs;
        all.wrong += tally.wrong;
    }
    printf("%ld pairs, %ld wrong\n", all.pairs, all.wrong);
    return all.wrong > 0 ? EXIT_FOUND : EXIT_NONE_WRONG;
}
