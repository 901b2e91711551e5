/* Accuracy, in units of the grid and u = 2^-53. Coordinates are below 2^52, so that differences of
 * points are exact as doubles, and below 2^53. An exact normal is a cross product of two of them,
 * below 2^107. In doubles each of its coordinates is off by 2.01 u of itself, which turns it by at
 * most 2.01 u. The length of what results is off by 2.51 u (three roundings under a root, and its
 * own), each quotient by u more: the unit normal is off by less than 5.6 u. A product with a vector
 * d is off by 3.01 u |d| more. So the height of a facet, |d| < sqrt(3) 2^52, is off by less
 * than 8.7 sqrt(3) / 2 < 9, and that of a point over a facet, |d| < sqrt(3) 2^53, by less than
 * POLYTOPE_ERROR = 18. */
#include "polytope.h"

#include "checked.h"
#include "memory.h"

#include <math.h>
#include <string.h>

__extension__ typedef __int128 wide;
__extension__ typedef unsigned __int128 unsigned_wide;

/* ---- Memory ---- */

void polytope_begin(struct polytope *mesh, int dim)
{
    mesh->dim = dim;
    mesh->facets = mesh->points = mesh->waiting = 0;
    mesh->facet_capacity = POLYTOPE_FACETS;
    mesh->point_capacity = POLYTOPE_POINTS;
    mesh->facet = mesh->own_facet;
    mesh->point = mesh->own_point;
    mesh->heap = mesh->own_heap;
}

/* Returns an array of twice the capacity. */
static void *doubled(void *array, const void *own, int capacity, size_t size)
{
    const size_t bytes = (size_t) capacity * size;
    void *out = memcpy(memory_allocate(2 * bytes), array, bytes);
    if (array != own)
        memory_release(array, bytes);
    return out;
}

static void reserve_facet(struct polytope *mesh)
{
    const int capacity = mesh->facet_capacity;
    if (mesh->facets < capacity)
        return;
    mesh->facet = doubled(mesh->facet, mesh->own_facet, capacity, sizeof *mesh->facet);
    mesh->heap = doubled(mesh->heap, mesh->own_heap, capacity, sizeof *mesh->heap);
    mesh->facet_capacity *= 2;
}

static void reserve_point(struct polytope *mesh)
{
    if (mesh->points < mesh->point_capacity)
        return;
    mesh->point = doubled(mesh->point, mesh->own_point, mesh->point_capacity, sizeof *mesh->point);
    mesh->point_capacity *= 2;
}

void polytope_end(struct polytope *mesh)
{
    const size_t facets = (size_t) mesh->facet_capacity;
    if (mesh->facet != mesh->own_facet) {
        memory_release(mesh->facet, facets * sizeof *mesh->facet);
        memory_release(mesh->heap, facets * sizeof *mesh->heap);
    }
    if (mesh->point != mesh->own_point)
        memory_release(mesh->point, (size_t) mesh->point_capacity * sizeof *mesh->point);
    polytope_begin(mesh, mesh->dim);
}

/* ---- The heap ---- */

static bool is_lower(const struct polytope *mesh, int x, int y)
{
    const double of_x = mesh->facet[x].height, of_y = mesh->facet[y].height;
    return of_x < of_y || (of_x == of_y && x < y);
}

static void heap_add(struct polytope *mesh, int facet)
{
    int at = mesh->waiting++;
    for (; at > 0 && is_lower(mesh, facet, mesh->heap[(at - 1) / 2]); at = (at - 1) / 2)
        mesh->heap[at] = mesh->heap[(at - 1) / 2];
    mesh->heap[at] = facet;
}

static int heap_take(struct polytope *mesh)
{
    const int lowest = mesh->heap[0], last = mesh->heap[--mesh->waiting];
    int at = 0;
    for (int child = 1; child < mesh->waiting; child = 2 * at + 1) {
        if (child + 1 < mesh->waiting && is_lower(mesh, mesh->heap[child + 1], mesh->heap[child]))
            child++;
        if (!is_lower(mesh, mesh->heap[child], last))
            break;
        mesh->heap[at] = mesh->heap[child];
        at = child;
    }
    mesh->heap[at] = last;
    return lowest;
}

int polytope_lowest(struct polytope *mesh)
{
    while (mesh->waiting > 0) {
        const int facet = heap_take(mesh);
        if (!mesh->facet[facet].gone)
            return facet;
    }
    return -1;
}

double polytope_least_height(const struct polytope *mesh)
{
    double least = INFINITY;
    for (int f = 0; f < mesh->facets; f++)
        if (!mesh->facet[f].gone && mesh->facet[f].height < least)
            least = mesh->facet[f].height;
    return least;
}

/* ---- Points and planes ---- */

int polytope_add_point(struct polytope *mesh, const int64_t at[FMB_DIM_MAX])
{
    reserve_point(mesh);
    memcpy(mesh->point[mesh->points].at, at, sizeof mesh->point->at);
    return mesh->points++;
}

static void subtract(const int64_t x[FMB_DIM_MAX], const int64_t y[FMB_DIM_MAX],
                     int64_t out[FMB_DIM_MAX])
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = x[axis] - y[axis];
}

/* out := the exact normal of the plane of these points; of the line in 2D. */
static void set_normal(const struct polytope *mesh, const int corner[FMB_DIM_MAX],
                       wide out[FMB_DIM_MAX])
{
    const int64_t *origin = mesh->point[corner[0]].at;
    int64_t e[FMB_DIM_MAX], f[FMB_DIM_MAX] = {0, 0, 1};
    subtract(mesh->point[corner[1]].at, origin, e);
    if (mesh->dim == 3)
        subtract(mesh->point[corner[2]].at, origin, f);
    for (int i = 0; i < FMB_DIM_MAX; i++) {
        const int j = (i + 1) % FMB_DIM_MAX, k = (i + 2) % FMB_DIM_MAX;
        out[i] = (wide) e[j] * f[k] - (wide) e[k] * f[j];
    }
}

/* The sign of n . d. With n = high 2^64 + low, high . d is below 2^98, and low . d below 2^119. */
static int sign_of_dot(const wide n[FMB_DIM_MAX], const int64_t d[FMB_DIM_MAX])
{
    wide high = 0, low = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        high += (n[axis] >> 64) * d[axis];
        low += (wide) (uint64_t) n[axis] * d[axis];
    }
    high += low >> 64;
    return high != 0 ? (high > 0 ? 1 : -1) : (uint64_t) low != 0;
}

static int side_of(const struct polytope *mesh, const int corner[FMB_DIM_MAX],
                   const int64_t at[FMB_DIM_MAX])
{
    wide n[FMB_DIM_MAX];
    int64_t d[FMB_DIM_MAX];
    set_normal(mesh, corner, n);
    subtract(at, mesh->point[corner[0]].at, d);
    return sign_of_dot(n, d);
}

int polytope_side(const struct polytope *mesh, int facet, const int64_t at[FMB_DIM_MAX])
{
    const struct polytope_facet *f = &mesh->facet[facet];
    int64_t d[FMB_DIM_MAX];
    subtract(at, mesh->point[f->corner[0]].at, d);
    const double above = (f->normal[0] * (double) d[0] + f->normal[1] * (double) d[1]) +
                         f->normal[2] * (double) d[2];
    CHECK_BOUND(POLYTOPE_ERROR, false, above, POLYTOPE_ERROR);
    if (fabs(above) > POLYTOPE_ERROR)
        return above > 0 ? 1 : -1;
    return side_of(mesh, f->corner, at);
}

/* Rounds twice, each time by u of the number. Without branches: signs are unpredictable. */
static double to_double(wide x)
{
    const wide sign = x >> 127; /* 0 or -1 */
    const unsigned_wide magnitude = (unsigned_wide) ((x ^ sign) - sign);
    const uint64_t low = (uint64_t) magnitude;
    const double lower =
        0x1p32 * (double) (int64_t) (low >> 32) + (double) (int64_t) (uint32_t) low;
    const double out = 0x1p64 * (double) (int64_t) (magnitude >> 64) + lower;
    return copysign(out, (double) (int64_t) sign);
}

static void set_unit_normal(const struct polytope *mesh, const int corner[FMB_DIM_MAX],
                            double out[FMB_DIM_MAX])
{
    wide n[FMB_DIM_MAX];
    set_normal(mesh, corner, n);
    const double x = to_double(n[0]), y = to_double(n[1]), z = to_double(n[2]);
    const double length = sqrt(x * x + y * y + z * z);
    out[0] = x / length;
    out[1] = y / length;
    out[2] = z / length;
}

static const int first_corners[FMB_DIM_MAX] = {0, 1, 2};

void polytope_first_normal(const struct polytope *mesh, double out[FMB_DIM_MAX])
{
    set_unit_normal(mesh, first_corners, out);
}

/* Adds a facet without neighbours. Returns its number. */
static int add_facet(struct polytope *mesh, int x, int y, int z)
{
    reserve_facet(mesh);
    struct polytope_facet *out = &mesh->facet[mesh->facets];
    out->corner[0] = x;
    out->corner[1] = y;
    out->corner[2] = z;
    out->gone = false;
    set_unit_normal(mesh, out->corner, out->normal);
    const int64_t *at = mesh->point[x].at;
    out->height = (out->normal[0] * (double) at[0] + out->normal[1] * (double) at[1]) +
                  out->normal[2] * (double) at[2];
    heap_add(mesh, mesh->facets);
    return mesh->facets++;
}

/* ---- The mesh ---- */

/* The triangle 0 1 2, or the tetrahedron 0 1 2 3 with point 3 below the triangle 0 1 2. */
bool polytope_close(struct polytope *mesh)
{
    static const int corner[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
    static const int next[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const int side = side_of(mesh, first_corners, mesh->point[mesh->dim].at);
    if (side == 0)
        return false;
    if (side > 0) {
        const struct polytope_point first = mesh->point[0];
        mesh->point[0] = mesh->point[1];
        mesh->point[1] = first;
    }
    if (mesh->dim == 2)
        for (int i = 0; i < 3; i++)
            add_facet(mesh, i, (i + 1) % 3, 0);
    for (int f = 0; f < 4 && mesh->dim == 3; f++) {
        add_facet(mesh, corner[f][0], corner[f][1], corner[f][2]);
        memcpy(mesh->facet[f].next, next[f], sizeof mesh->facet[f].next);
    }
    return true;
}

/* Adds the triangle of point and the edge from corner i of a facet that it sees, whose neighbour
 * across that edge it does not see. */
static int add_across(struct polytope *mesh, int facet, int i, int point)
{
    const int x = mesh->facet[facet].corner[i], y = mesh->facet[facet].corner[(i + 1) % 3];
    const int neighbour = mesh->facet[facet].next[i], added = add_facet(mesh, x, y, point);
    struct polytope_facet *outside = &mesh->facet[neighbour];
    mesh->facet[added].next[0] = neighbour;
    for (int k = 0; k < 3; k++)
        if (outside->corner[k] == y)
            outside->next[k] = added;
    mesh->point[x].facet = added;
    return added;
}

/* Removes the facets that are seen, beginning with one of them, and adds those of the ridges. */
static void extend_space(struct polytope *mesh, int first, int point)
{
    const int begin = mesh->facets;
    int last = first;
    mesh->facet[first].gone = true;
    mesh->facet[first].link = -1;
    for (int f = first; f >= 0; f = mesh->facet[f].link)
        for (int i = 0; i < 3; i++) {
            const int neighbour = mesh->facet[f].next[i];
            if (mesh->facet[neighbour].gone)
                continue;
            if (polytope_side(mesh, neighbour, mesh->point[point].at) <= 0) {
                add_across(mesh, f, i, point);
                continue;
            }
            mesh->facet[neighbour].gone = true;
            mesh->facet[neighbour].link = -1;
            mesh->facet[last].link = neighbour;
            last = neighbour;
        }
    for (int f = begin; f < mesh->facets; f++) {
        const int next = mesh->point[mesh->facet[f].corner[1]].facet;
        mesh->facet[f].next[1] = next;
        mesh->facet[next].next[2] = f;
    }
}

void polytope_extend(struct polytope *mesh, int facet, const int64_t at[FMB_DIM_MAX])
{
    const int point = polytope_add_point(mesh, at);
    if (mesh->dim == 3) {
        extend_space(mesh, facet, point);
        return;
    }
    const int x = mesh->facet[facet].corner[0], y = mesh->facet[facet].corner[1];
    mesh->facet[facet].gone = true;
    add_facet(mesh, x, point, 0);
    add_facet(mesh, point, y, 0);
}
