/* Method. Let F = conv(a, b, c) and G = conv(a, d, e) have the vertex a in common and no other. Any
 * other point p of both lies on a ray from a, which leaves F on bc and G on de; where it leaves the
 * first of them, it is in the other one still. So F and G have more in common than a just if bc
 * meets G, or de meets F. A segment misses a triangle whose plane has both of its ends strictly on
 * one side; or, of a triangle pqr that it passes, if two of the tetrahedra (d e p q), (d e q r),
 * (d e r p) have strictly opposite orientations: the line passes beside an edge.
 *
 * A face without an area may have a between b and c. Then it is the segment bc, which a ray from a
 * leaves in b or in c: in place of bc these are asked.
 *
 * Faces with two vertices p, q in common and one each besides, r and s, have no more than pq in
 * common if p, q, r, s lie in no plane. If they do, and r and s lie on different sides of the line
 * pq, they touch, and on the same side they overlap: the engine tells. A face without an area has
 * no more than pq in common with one that has one, and they touch. Two without an area overlap, and
 * have more in common just if both go on beyond p, or both beyond q.
 *
 * Most of them are known from what they look like along an axis (mesh_flat.h). Orientations in
 * space are those of doubles with a bound; what they leave open, the engine decides, of triangles,
 * and of segments as triangles without an area. */
#include "mesh_near.h"

#include "allocate.h"
#include "mesh_face.h"
#include "mesh_flat.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Vertices of equal coordinates ---- */

typedef const double (*place)[3]; /* a vertex of the mesh */

/* Of the same coordinates the first one of the mesh comes first. */
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

void mesh_near_open(const struct mesh *mesh, struct mesh_near *out)
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

void mesh_near_close(struct mesh_near *near)
{
    free(near->first);
}

/* ---- Orientations ---- */

/* The sign of (q - p) x (r - p) . (s - p); 0 where doubles leave it open.
 *
 * Each of six products is rounded 3 times in its differences, 2 times in multiplications, and 3 in
 * sums at most: 8.01 u of the sum of the magnitudes, which is found with as few roundings; 2^-49
 * is 16 u. Where products underflow they are off by less than 2^-1074 each, those of two factors
 * times the third one. What overflows is not larger than its bound, and neither is what is no
 * number. */
static int side_of(const double *p, const double *q, const double *r, const double *s)
{
    double u[3], v[3], w[3], determinant = 0, permanent = 0, far = 1;
    for (int axis = 0; axis < 3; axis++) {
        u[axis] = q[axis] - p[axis];
        v[axis] = r[axis] - p[axis];
        w[axis] = s[axis] - p[axis];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double x = u[j] * v[k], y = u[k] * v[j];
        determinant += w[i] * (x - y);
        permanent += fabs(w[i]) * (fabs(x) + fabs(y));
        far += fabs(w[i]);
    }
    if (!(fabs(determinant) > 0x1p-49 * permanent + 0x1p-1070 * far))
        return 0;
    return determinant > 0 ? 1 : -1;
}

/* Surely, of a segment and a triangle. */
static bool misses(const double *d, const double *e, const double *const corner[3])
{
    int side[3];
    const int of_d = side_of(corner[0], corner[1], corner[2], d);
    if (of_d != 0 && of_d == side_of(corner[0], corner[1], corner[2], e))
        return true;
    for (int i = 0; i < 3; i++)
        side[i] = side_of(d, e, corner[i], corner[(i + 1) % 3]);
    return side[0] * side[1] < 0 || side[1] * side[2] < 0 || side[2] * side[0] < 0;
}

/* ---- What is left to the engine ---- */

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

static bool segment_meets(const double *d, const double *e, const double corner[3][3])
{
    const double segment[3][3] = {{d[0], d[1], d[2]}, {e[0], e[1], e[2]}, {d[0], d[1], d[2]}};
    return verdict_of(segment, corner) != FMB_SEPARATED;
}

/* Whether p is on the segment de, ends included. */
static bool is_between(const double *d, const double *p, const double *e)
{
    const double point[3][3] = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    return segment_meets(d, e, point);
}

/* Whether bc, across from a in its face, has a point in common with the other face, in which a is
 * too, that is not a. */
static bool edge_meets(const double *a, const double *b, const double *c, const double corner[3][3])
{
    if (!segment_meets(b, c, corner))
        return false;
    return !is_between(b, a, c) || segment_meets(b, b, corner) || segment_meets(c, c, corner);
}

/* ---- Faces ---- */

/* Of each face which corners are also the other's, and which are not: by vertex, each once. */
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

static void set_common(const struct mesh_near *near, const unsigned face[2], struct common *out)
{
    unsigned vertex[2][3];
    memset(out, 0, sizeof *out);
    for (int f = 0; f < 2; f++)
        for (int corner = 0; corner < 3; corner++)
            vertex[f][corner] = near->first[near->mesh->face[face[f]][corner]];
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

static const double *at(const struct mesh_near *near, unsigned vertex)
{
    return near->mesh->vertex[vertex];
}

/* Of faces that overlap and share p and q: whether they have no area, and do not both go on beyond
 * p, nor both beyond q. */
static bool end_at_edge(const struct mesh_near *near, const struct common *common)
{
    const double *p = at(near, common->shared[0]), *q = at(near, common->shared[1]);
    bool beyond_p = true, beyond_q = true;
    for (int f = 0; f < 2; f++) {
        const double *r = common->own_count[f] ? at(near, common->own[f][0]) : p;
        const bool here = is_between(p, r, q), past_p = !here && is_between(r, p, q);
        const bool past_q = !here && is_between(p, q, r);
        if (!here && !past_p && !past_q) /* it has an area, and so has the other */
            return false;
        beyond_p = beyond_p && past_p;
        beyond_q = beyond_q && past_q;
    }
    return !beyond_p && !beyond_q;
}

static enum mesh_nearness nearness_of_edge(const struct mesh_near *near,
                                           const struct common *common, const unsigned face[2],
                                           enum fmb_verdict *verdict)
{
    double corner[2][3][3];
    if (common->own_count[0] && common->own_count[1]) {
        const double *p = at(near, common->shared[0]), *q = at(near, common->shared[1]);
        const double *r = at(near, common->own[0][0]), *s = at(near, common->own[1][0]);
        if (mesh_flat_share_edge(p, q, r, s) || side_of(p, q, r, s) != 0)
            return MESH_SHARE_EDGE;
    }
    for (int f = 0; f < 2; f++)
        mesh_face_vertices(near->mesh, face[f], corner[f]);
    *verdict = verdict_of((const double(*)[3]) corner[0], (const double(*)[3]) corner[1]);
    const bool more =
        *verdict == FMB_OVERLAPPING && (common->shared_count == 3 || !end_at_edge(near, common));
    return more ? MESH_SHARE_AND_MEET : MESH_SHARE_EDGE;
}

/* Each face's edge across from the vertex that is shared, against the other face. */
static enum mesh_nearness nearness_of_vertex(const struct mesh_near *near,
                                             const struct common *common, const unsigned face[2],
                                             enum fmb_verdict *verdict)
{
    double corner[2][3][3];
    const double *end[2][2];
    bool open[2], meet = false;
    if (common->own_count[0] == 2 && common->own_count[1] == 2 &&
        mesh_flat_share_vertex(at(near, common->shared[0]), at(near, common->own[0][0]),
                               at(near, common->own[0][1]), at(near, common->own[1][0]),
                               at(near, common->own[1][1])))
        return MESH_SHARE_VERTEX;
    for (int f = 0; f < 2; f++)
        mesh_face_vertices(near->mesh, face[f], corner[f]);
    for (int f = 0; f < 2; f++) {
        if (common->own_count[f] == 0) /* a point, which is the shared one */
            return MESH_SHARE_VERTEX;
        const double *const other[3] = {corner[!f][0], corner[!f][1], corner[!f][2]};
        end[f][0] = at(near, common->own[f][0]);
        end[f][1] = at(near, common->own[f][common->own_count[f] - 1]);
        open[f] = !misses(end[f][0], end[f][1], other);
    }
    for (int f = 0; f < 2 && !meet; f++)
        meet = open[f] && edge_meets(at(near, common->shared[0]), end[f][0], end[f][1],
                                     (const double(*)[3]) corner[!f]);
    if (!meet)
        return MESH_SHARE_VERTEX;
    *verdict = verdict_of((const double(*)[3]) corner[0], (const double(*)[3]) corner[1]);
    return MESH_SHARE_AND_MEET;
}

enum mesh_nearness mesh_near_of(const struct mesh_near *near, unsigned f, unsigned g,
                                enum fmb_verdict *verdict)
{
    const unsigned face[2] = {f, g};
    struct common common;
    set_common(near, face, &common);
    if (common.shared_count == 0)
        return MESH_APART;
    if (common.shared_count == 1)
        return nearness_of_vertex(near, &common, face, verdict);
    return nearness_of_edge(near, &common, face, verdict);
}
