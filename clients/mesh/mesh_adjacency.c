/* Method, one shared vertex. Let F = conv(a, b, c) and G = conv(a, d, e) share the vertex a and no
 * other. Let p be any other common point. The ray from a through p leaves F on bc and G on de.
 * Where it leaves the first of the two, it is still in the other. So F and G have a common point
 * besides a if and only if bc intersects G or de intersects F.
 *
 * A degenerate face may have a between b and c. It is then the segment bc, which a ray from a
 * leaves in b or in c. In this case the points b and c are tested instead of the segment bc.
 *
 * Two shared vertices. Let p, q be shared, and r and s be the remaining vertices. If p, q, r, s are
 * not coplanar, the faces have only pq in common. If they are coplanar, the faces touch if r and s
 * lie on different sides of the line pq, and overlap if they lie on the same side; the engine
 * decides which. A degenerate face and a face with an area have only pq in common, and touch. Two
 * degenerate faces overlap; they have more than pq in common if and only if both extend beyond p,
 * or both beyond q.
 *
 * Most pairs are decided by their projections (below). The engine decides the others, with
 * triangles, and with segments as degenerate triangles. */
#include "mesh_adjacency.h"

#include "allocate.h"
#include "mesh_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Vertices of equal coordinates ---- */

typedef const double (*place)[3]; /* a vertex of the mesh */

/* Orders by coordinates, then by index, so that the first vertex of equal ones comes first. */
static int compare(const void *x, const void *y)
{
    const place p = *(const place *) x, q = *(const place *) y;
    for (int axis = 0; axis < 3; axis++)
        if ((*p)[axis] != (*q)[axis])
            return (*p)[axis] < (*q)[axis] ? -1 : 1;
    return (p > q) - (p < q);
}

static bool same_place(place p, place q)
{
    return (*p)[0] == (*q)[0] && (*p)[1] == (*q)[1] && (*p)[2] == (*q)[2];
}

void mesh_adjacency_open(const struct mesh *mesh, struct mesh_adjacency *out)
{
    const place vertex = (place) mesh->vertex;
    const size_t count = mesh->vertex_count;
    place *sorted = allocate(count, sizeof *sorted);
    out->mesh = mesh;
    out->first = allocate(count, sizeof *out->first);
    for (size_t v = 0; v < count; v++)
        sorted[v] = vertex + v;
    qsort(sorted, count, sizeof *sorted, compare);
    for (size_t i = 0; i < count; i++) {
        const bool again = i > 0 && same_place(sorted[i], sorted[i - 1]);
        const unsigned v = (unsigned) (sorted[i] - vertex);
        out->first[v] = again ? out->first[sorted[i - 1] - vertex] : v;
    }
    free(sorted);
}

void mesh_adjacency_close(struct mesh_adjacency *adjacency)
{
    free(adjacency->first);
}

/* ---- Projections ----
 *
 * Adjacent triangles, projected along a coordinate axis: in a plane, the exact side of a line on
 * which a point lies is cheap to compute. If the projections of F and G intersect in nothing but
 * one point or edge, and the projection of F has an area, so that no two points of F project to
 * one, then F and G intersect in nothing else either.
 *
 * Method. The projections of F and G are cones with apex a, each spanned by two directions. If both
 * directions of G lie on the opposite side of a line through one direction of F than F does, or on
 * that line but opposite to the direction, the cones have no common point but a.
 *
 * Accuracy. The sign of the cross product x y - z w is exact if the vectors are. Rounding is
 * monotonic, so the rounded products x y and z w are in the order of the exact ones, or equal; if
 * they are equal, the difference of their rounding errors decides, which are doubles if nothing
 * underflows. The vectors are differences of points, exact if their own rounding errors are 0. If
 * they are not, a cross product is off by at most 4.01 u of the sum of the magnitudes of its
 * products: 2 roundings in its factors, 1 in each product and 1 in their difference. The bound
 * 2^-50 is 8 u. */

struct vector {
    double x, y;
    bool exact;
};

enum { UNKNOWN = 2 }; /* besides the signs -1, 0, 1; -UNKNOWN is never returned */

static bool is_exact(double x, double y, double difference)
{
    const double part = difference - x;
    return (x - (difference - part)) - (y + part) == 0;
}

static struct vector vector(const double *from, const double *to, int x, int y)
{
    const double dx = to[x] - from[x], dy = to[y] - from[y];
    return (struct vector){dx, dy, is_exact(to[x], from[x], dx) && is_exact(to[y], from[y], dy)};
}

static int sign(double x)
{
    return (x > 0) - (x < 0);
}

/* Whether a product is 0, or finite and so large that its rounding error is a double. */
static bool has_exact_error(double x, double y)
{
    const double product = fabs(x * y);
    return x == 0 || y == 0 || (product > 0x1p-900 && product < 0x1p1000);
}

static int flat_side(struct vector u, struct vector v)
{
    const double one = u.x * v.y, other = u.y * v.x;
    if (!has_exact_error(u.x, v.y) || !has_exact_error(u.y, v.x))
        return UNKNOWN;
    if (!u.exact || !v.exact)
        return fabs(one - other) > 0x1p-50 * (fabs(one) + fabs(other)) ? sign(one - other)
                                                                       : UNKNOWN;
    return one != other ? sign(one - other) : sign(fma(u.x, v.y, -one) - fma(u.y, v.x, -other));
}

/* On input: two collinear vectors. */
static bool are_opposite(struct vector u, struct vector v)
{
    return sign(u.x) * sign(v.x) < 0 || sign(u.y) * sign(v.y) < 0;
}

/* Whether w lies strictly on the other side of the line of u than the cone, which is on side `own`,
 * or on that line but opposite to u. */
static bool is_beyond(struct vector u, int own, struct vector w)
{
    const int side = flat_side(u, w);
    return side == -own || (side == 0 && are_opposite(u, w));
}

/* Whether the line of u or that of v separates the cone of u and v from that of w and t. */
static bool separates(struct vector u, struct vector v, struct vector w, struct vector t)
{
    const int own = flat_side(u, v);
    if (own == 0 || own == UNKNOWN)
        return false;
    return (is_beyond(u, own, w) && is_beyond(u, own, t)) ||
           (is_beyond(v, -own, w) && is_beyond(v, -own, t));
}

/* Whether F = conv(a, b, c) and G = conv(a, d, e) certainly have no common point but a. False: not
 * known. Points are [axis]. */
static bool flat_share_vertex(const double *a, const double *b, const double *c, const double *d,
                              const double *e)
{
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const struct vector u = vector(a, b, x, y), v = vector(a, c, x, y);
        const struct vector w = vector(a, d, x, y), t = vector(a, e, x, y);
        if (separates(u, v, w, t) || separates(w, t, u, v))
            return true;
    }
    return false;
}

/* Whether conv(p, q, r) and conv(p, q, s) certainly have no common point outside the segment pq.
 * False: not known. Points are [axis]. */
static bool flat_share_edge(const double *p, const double *q, const double *r, const double *s)
{
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const struct vector edge = vector(p, q, x, y);
        const int of_r = flat_side(edge, vector(p, r, x, y));
        if (of_r != 0 && flat_side(edge, vector(p, s, x, y)) == -of_r)
            return true;
    }
    return false;
}

/* ---- Cases that the engine decides ---- */

static enum fmb_verdict verdict_of(const double x[3][3], const double y[3][3])
{
    struct fmb_body body[2];
    struct fmb_answer answer;
    fmb_body_make_vertices(3, FMB_FACE, x[0], 9, &body[0]);
    fmb_body_make_vertices(3, FMB_FACE, y[0], 9, &body[1]);
    const struct fmb_placement a = {.body = &body[0]}, b = {.body = &body[1]};
    fmb_decide(fmb_method_default(), &a, &b, 0, 0, &answer);
    return answer.verdict;
}

static bool segment_intersects(const double *d, const double *e, const double corner[3][3])
{
    const double segment[3][3] = {{d[0], d[1], d[2]}, {e[0], e[1], e[2]}, {d[0], d[1], d[2]}};
    return verdict_of(segment, corner) != FMB_SEPARATED;
}

/* Whether p is on the segment de, ends included. */
static bool is_between(const double *d, const double *p, const double *e)
{
    const double point[3][3] = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    return segment_intersects(d, e, point);
}

/* Whether bc, the edge of a face opposite to a, has a common point other than a with the other
 * face. On input: a is a vertex of the other face. */
static bool edge_intersects(const double *a, const double *b, const double *c,
                            const double corner[3][3])
{
    if (!segment_intersects(b, c, corner))
        return false;
    return !is_between(b, a, c) || segment_intersects(b, b, corner) ||
           segment_intersects(c, c, corner);
}

/* ---- Faces ---- */

/* The distinct vertices that two faces share, and those that only one of them has. */
struct common {
    unsigned shared[3], own[2][3];
    int shared_count, own_count[2];
};

static bool is_among(unsigned vertex, const unsigned *list, int count)
{
    for (int i = 0; i < count; i++)
        if (list[i] == vertex)
            return true;
    return false;
}

static void set_common(const struct mesh_adjacency *adjacency, const unsigned face[2],
                       struct common *out)
{
    unsigned vertex[2][3];
    memset(out, 0, sizeof *out);
    for (int f = 0; f < 2; f++)
        for (int corner = 0; corner < 3; corner++)
            vertex[f][corner] = adjacency->first[adjacency->mesh->face[face[f]][corner]];
    for (int f = 0; f < 2; f++)
        for (int corner = 0; corner < 3; corner++) {
            const unsigned v = vertex[f][corner];
            const bool shared = is_among(v, vertex[!f], 3);
            unsigned *list = shared ? out->shared : out->own[f];
            int *count = shared ? &out->shared_count : &out->own_count[f];
            if (!is_among(v, list, *count))
                list[(*count)++] = v;
        }
}

static const double *at(const struct mesh_adjacency *adjacency, unsigned vertex)
{
    return adjacency->mesh->vertex[vertex];
}

/* On input: faces that overlap and share p and q. Whether both are degenerate, and they do not both
 * extend beyond p, nor both beyond q. */
static bool end_at_edge(const struct mesh_adjacency *adjacency, const struct common *common)
{
    const double *p = at(adjacency, common->shared[0]), *q = at(adjacency, common->shared[1]);
    bool beyond_p = true, beyond_q = true;
    for (int f = 0; f < 2; f++) {
        const double *r = common->own_count[f] ? at(adjacency, common->own[f][0]) : p;
        const bool here = is_between(p, r, q), past_p = !here && is_between(r, p, q);
        const bool past_q = !here && is_between(p, q, r);
        if (!here && !past_p && !past_q)
            return false; /* this face has an area, and so has the other, which overlaps it */
        beyond_p = beyond_p && past_p;
        beyond_q = beyond_q && past_q;
    }
    return !beyond_p && !beyond_q;
}

static enum mesh_relation relation_by_edge(const struct mesh_adjacency *adjacency,
                                           const struct common *common, const unsigned face[2],
                                           enum fmb_verdict *verdict)
{
    double corner[2][3][3];
    if (common->own_count[0] && common->own_count[1]) {
        const double *p = at(adjacency, common->shared[0]), *q = at(adjacency, common->shared[1]);
        const double *r = at(adjacency, common->own[0][0]), *s = at(adjacency, common->own[1][0]);
        if (flat_share_edge(p, q, r, s))
            return MESH_SHARE_EDGE;
    }
    for (int f = 0; f < 2; f++)
        mesh_face_vertices(adjacency->mesh, face[f], corner[f]);
    *verdict = verdict_of((const double(*)[3]) corner[0], (const double(*)[3]) corner[1]);
    const bool more = *verdict == FMB_OVERLAPPING &&
                      (common->shared_count == 3 || !end_at_edge(adjacency, common));
    return more ? MESH_SHARE_AND_INTERSECT : MESH_SHARE_EDGE;
}

/* Tests the edge of each face opposite to the shared vertex against the other face. */
static enum mesh_relation relation_by_vertex(const struct mesh_adjacency *adjacency,
                                             const struct common *common, const unsigned face[2],
                                             enum fmb_verdict *verdict)
{
    double corner[2][3][3];
    const double *end[2][2];
    bool intersect = false;
    if (common->own_count[0] == 2 && common->own_count[1] == 2 &&
        flat_share_vertex(at(adjacency, common->shared[0]), at(adjacency, common->own[0][0]),
                          at(adjacency, common->own[0][1]), at(adjacency, common->own[1][0]),
                          at(adjacency, common->own[1][1])))
        return MESH_SHARE_VERTEX;
    for (int f = 0; f < 2; f++)
        mesh_face_vertices(adjacency->mesh, face[f], corner[f]);
    for (int f = 0; f < 2; f++) {
        if (common->own_count[f] == 0) /* the face is a point, the shared vertex */
            return MESH_SHARE_VERTEX;
        end[f][0] = at(adjacency, common->own[f][0]);
        end[f][1] = at(adjacency, common->own[f][common->own_count[f] - 1]);
    }
    for (int f = 0; f < 2 && !intersect; f++)
        intersect = edge_intersects(at(adjacency, common->shared[0]), end[f][0], end[f][1],
                                    (const double(*)[3]) corner[!f]);
    if (!intersect)
        return MESH_SHARE_VERTEX;
    *verdict = verdict_of((const double(*)[3]) corner[0], (const double(*)[3]) corner[1]);
    return MESH_SHARE_AND_INTERSECT;
}

enum mesh_relation mesh_adjacency_of(const struct mesh_adjacency *adjacency, unsigned f, unsigned g,
                                     enum fmb_verdict *verdict)
{
    const unsigned face[2] = {f, g};
    struct common common;
    set_common(adjacency, face, &common);
    if (common.shared_count == 0)
        return MESH_NOT_ADJACENT;
    if (common.shared_count == 1)
        return relation_by_vertex(adjacency, &common, face, verdict);
    return relation_by_edge(adjacency, &common, face, verdict);
}
