/* Method. If tetrahedra are separated, so they are by a plane through a face of A, through an edge
 * of A or through a face of B.
 *
 * The heights of B's four vertices above a face of A decide whether that face separates: all are
 * positive. An edge of A lies in two faces, f and g. Seen along it A is the quadrant x <= 0, y <= 0
 * of the heights x above f and y above g, and a plane through the edge separates if and only if
 * the hull of B's four points (x, y) does not meet that quadrant: none of them is in it, and no
 * segment from a point with only x > 0 to one with only y > 0 crosses it. So the heights above
 * A's faces serve its edges too, in two dimensions. */
#include "gpr.h"

#include <math.h>

enum { VERTICES = 4, FACES = 4, ALL = 15 };

typedef double vector[3];

/* Above each face of one tetrahedron, each vertex of the other; times an area. */
struct heights {
    double at[FACES][VERTICES];
    unsigned above[FACES]; /* bits: vertices with a positive height */
    double volume;
};

static double dot(const vector a, const vector b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const vector a, const vector b, vector out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool set_above(int face, struct heights *heights)
{
    heights->above[face] = 0;
    for (int v = 0; v < VERTICES; v++)
        heights->above[face] |= (unsigned) (heights->at[face][v] > 0) << v;
    return heights->above[face] == ALL;
}

/* vertex: of the other, relative to the origin of the first. The last face is the one opposite to
 * the origin; the others are set before it. Returns whether the face separates. */
static bool set_face(const struct lean_frame *frame, const vector vertex[VERTICES], int face,
                     struct heights *heights)
{
    double(*at)[VERTICES] = heights->at;
    if (face == FACES - 1) {
        for (int v = 0; v < VERTICES; v++)
            at[face][v] = -(at[0][v] + at[1][v] + at[2][v]) - fabs(heights->volume);
        return set_above(face, heights);
    }
    vector normal;
    cross(frame->component[(face + 1) % 3], frame->component[(face + 2) % 3], normal);
    heights->volume = dot(normal, frame->component[face]);
    for (int v = 0; v < VERTICES; v++)
        at[face][v] = dot(normal, vertex[v]) * (heights->volume > 0 ? -1 : 1);
    return set_above(face, heights);
}

static bool edge_separates(const struct heights *heights, int f, int g)
{
    const double *x = heights->at[f], *y = heights->at[g];
    const unsigned only_f = heights->above[f] & ~heights->above[g],
                   only_g = heights->above[g] & ~heights->above[f];
    if ((heights->above[f] | heights->above[g]) != ALL)
        return false;
    for (int i = 0; i < VERTICES; i++)
        for (int j = 0; only_f >> i & 1 && j < VERTICES; j++)
            if (only_g >> j & 1 && x[i] * y[j] <= x[j] * y[i])
                return false;
    return true;
}

/* offset: of the other's origin. */
static void set_vertices(const struct lean_frame *other, const vector offset, vector out[VERTICES])
{
    for (int axis = 0; axis < 3; axis++) {
        out[0][axis] = offset[axis];
        for (int c = 0; c < 3; c++)
            out[c + 1][axis] = offset[axis] + other->component[c][axis];
    }
}

bool gpr_meets(const struct lean_frame *a, const struct lean_frame *b, double duration)
{
    (void) duration;
    struct heights heights;
    vector offset, back, vertex[VERTICES];
    for (int axis = 0; axis < 3; axis++) {
        offset[axis] = b->origin[axis] - a->origin[axis];
        back[axis] = -offset[axis];
    }
    set_vertices(b, offset, vertex);
    for (int f = 0; f < FACES; f++) {
        if (set_face(a, vertex, f, &heights))
            return false;
        for (int g = 0; g < f; g++)
            if (edge_separates(&heights, g, f))
                return false;
    }
    const unsigned *above = heights.above;
    if ((above[0] | above[1] | above[2] | above[3]) != ALL)
        return true; /* a vertex of B is in A */
    set_vertices(a, back, vertex);
    for (int f = 0; f < FACES; f++)
        if (set_face(b, vertex, f, &heights))
            return false;
    return true;
}
