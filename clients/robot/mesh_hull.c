/* mesh_hull(). The hull of the selected points grows until it contains all points, as the engine
 * decides exactly. If a point is separated from it, the point that is farthest in the direction of
 * their gap is selected; if it is selected already, the separated point is. Rounding in this
 * search can only select points that are not vertices. At the end, and when there are too many,
 * selected points that are in the hull of the others are removed.
 *
 * mesh_hull_cover(). The point farthest from the hull of the selected points is selected next,
 * until the distance is within the excess. Each point has an upper bound of its distance. The hull
 * only grows, so bounds remain valid, and only bounds above the largest distance so far are
 * computed again. */
#include "mesh_hull.h"

#include "allocate.h"
#include "progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct growing {
    const double (*point)[3];
    size_t count;
    bool *used;                   /* [count] */
    size_t selected;              /* number of used points */
    double (*vertex)[3], *memory; /* of the hull */
    double *point_memory;         /* of the hull of a point */
    struct fmb_body hull;
    enum fmb_status status;
    int64_t done; /* number of points that are known to be in the hull */
};

/* Makes the hull of the points that are used. Returns false on error. */
static bool make_hull(struct growing *growing)
{
    size_t count = 0;
    for (size_t i = 0; i < growing->count && count < growing->selected; i++)
        if (growing->used[i])
            memcpy(growing->vertex[count++], growing->point[i], sizeof *growing->vertex);
    growing->status =
        fmb_body_make_hull(3, growing->vertex[0], 3 * count, growing->memory, &growing->hull);
    return growing->status == FMB_OK;
}

/* Whether a point is outside the hull; false also on error. gap: receives the gap from the hull to
 * the point; NULL: not wanted. */
static bool is_outside(struct growing *growing, size_t i, struct fmb_gap *gap)
{
    struct fmb_body point;
    const struct fmb_placement hull = {.body = &growing->hull}, at = {.body = &point};
    struct fmb_answer answer = {.verdict = 0};
    growing->status = fmb_body_make_hull(3, growing->point[i], 3, growing->point_memory, &point);
    if (growing->status == FMB_OK)
        growing->status = fmb_decide(fmb_method_default(), &hull, &at, 0, 0, &answer);
    if (growing->status != FMB_OK || answer.verdict != FMB_SEPARATED)
        return false;
    if (gap) {
        growing->status = fmb_decide(fmb_method_default(), &hull, &at, 0, FMB_WANT_GAP, &answer);
        *gap = answer.gap;
    }
    return growing->status == FMB_OK;
}

static size_t farthest(const struct growing *growing, const double direction[3])
{
    size_t best = 0;
    double most = -INFINITY;
    for (size_t i = 0; i < growing->count; i++) {
        const double *p = growing->point[i];
        const double along = direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2];
        if (along > most) {
            most = along;
            best = i;
        }
    }
    return best;
}

/* Removes points that are in the hull of the others. Returns false on error. */
static bool prune(struct growing *growing)
{
    for (size_t i = 0; i < growing->count && growing->selected > 1; i++) {
        if (!growing->used[i])
            continue;
        progress_to(growing->done, (int64_t) growing->count);
        growing->used[i] = false;
        growing->selected--;
        if (!make_hull(growing))
            return false;
        growing->used[i] = is_outside(growing, i, NULL);
        growing->selected += growing->used[i];
        if (growing->status != FMB_OK)
            return false;
    }
    return make_hull(growing);
}

/* Selects a point. Returns false on error, and if there are too many. */
static bool select_point(struct growing *growing, size_t i)
{
    if (growing->selected == FMB_HULL_VERTICES_MAX && !prune(growing))
        return false;
    if (growing->selected == FMB_HULL_VERTICES_MAX)
        return false;
    growing->used[i] = true;
    growing->selected++;
    return make_hull(growing);
}

static bool grow(struct growing *growing)
{
    struct fmb_gap gap;
    if (!select_point(growing, 0))
        return false;
    for (size_t i = 0; growing->status == FMB_OK && i < growing->count; i++) {
        progress_to(growing->done = (int64_t) i, (int64_t) growing->count);
        while (!growing->used[i] && is_outside(growing, i, &gap)) {
            const size_t best = farthest(growing, gap.direction);
            if (!select_point(growing, growing->used[best] ? i : best))
                return false;
        }
    }
    return growing->status == FMB_OK && prune(growing);
}

static bool comes_first(const double a[3], const double b[3])
{
    const int axis = a[0] != b[0] ? 0 : a[1] != b[1] ? 1 : 2;
    return a[axis] < b[axis];
}

/* Lowers the bound of point i to its distance from the current hull. */
static void lower_bound(struct growing *growing, size_t i, double *bound)
{
    struct fmb_gap gap;
    const bool outside = is_outside(growing, i, &gap);
    if (growing->status == FMB_OK)
        bound[i] = outside ? fmin(bound[i], gap.bounds[1]) : 0;
}

/* Selects points. In/out: bound: [count], initially infinite. Returns the largest bound at the end.
 */
static double cover(struct growing *growing, size_t most, double excess, double *bound)
{
    size_t best = 0; /* the farthest point */
    for (size_t i = 1; i < growing->count; i++)
        if (comes_first(growing->point[i], growing->point[best]))
            best = i; /* a vertex of the hull of all */
    do {
        progress_to((int64_t) growing->selected, (int64_t) most);
        bound[best] = 0;
        growing->used[best] = true;
        growing->selected++;
        if (!make_hull(growing))
            break;
        for (size_t i = 0; i < growing->count; i++)
            if (bound[i] > bound[best])
                best = i;
        lower_bound(growing, best, bound);
        for (size_t i = 0; i < growing->count && growing->status == FMB_OK; i++)
            if (bound[i] > bound[best]) {
                lower_bound(growing, i, bound);
                if (bound[i] > bound[best])
                    best = i;
            }
    } while (growing->status == FMB_OK && bound[best] > excess && growing->selected < most);
    return bound[best];
}

static struct growing begin(const double (*point)[3], size_t count, double (*vertex)[3])
{
    progress_begin("vertices of a hull");
    return (struct growing){
        .point = point,
        .count = count,
        .vertex = vertex,
        .used = allocate(count, sizeof(bool)),
        .memory = allocate(fmb_hull_doubles(3, FMB_HULL_VERTICES_MAX), sizeof(double)),
        .point_memory = allocate(fmb_hull_doubles(3, 1), sizeof(double))};
}

static enum fmb_status end(struct growing *growing)
{
    progress_end();
    free(growing->used);
    free(growing->memory);
    free(growing->point_memory);
    return growing->status;
}

enum fmb_status mesh_hull(const double (*point)[3], size_t count, double (*vertex)[3],
                          size_t *found)
{
    struct growing growing = begin(point, count, vertex);
    *found = grow(&growing) ? growing.selected : 0;
    return end(&growing);
}

enum fmb_status mesh_hull_cover(const double (*point)[3], size_t count, size_t most, double excess,
                                double (*vertex)[3], size_t *found, double *radius)
{
    struct growing growing = begin(point, count, vertex);
    double *bound = allocate_unset(count * sizeof *bound);
    for (size_t i = 0; i < count; i++)
        bound[i] = INFINITY;
    *radius = cover(&growing, most, excess, bound);
    *found = growing.selected;
    free(bound);
    return end(&growing);
}
