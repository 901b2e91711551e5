#include "mesh_transform.h"

#include <float.h>
#include <math.h>

/* sin x (first = 1) or cos x (first = 0) by the power series, for |x| <= pi / 4. The truncation
 * error is below 2^-60. The operations are fixed, so the result does not depend on the math
 * library. */
static double series(double x, int first)
{
    double term = first ? x : 1, sum = term;
    for (int i = first + 1; i < 20; i += 2) {
        term *= -x * x / (i * (i + 1));
        sum += term;
    }
    return sum;
}

/* Cosine and sine of an angle in degrees. */
static void turn_of(double degrees, double turn[2])
{
    const double per_degree = 0.017453292519943295; /* the double nearest to pi / 180 */
    const double full = fmod(degrees, 360), quarters = rint(full / 90);
    const double x = (full - 90 * quarters) * per_degree; /* exact except for the product */
    const double cosine = series(x, 0), sine = series(x, 1);
    switch ((int) quarters & 3) {
    case 0: turn[0] = cosine, turn[1] = sine; break;
    case 1: turn[0] = -sine, turn[1] = cosine; break;
    case 2: turn[0] = -cosine, turn[1] = -sine; break;
    default: turn[0] = sine, turn[1] = -cosine; break;
    }
}

static void rotate(const double turn[2], int axis, double at[3])
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double x = at[u], y = at[v];
    at[u] = turn[0] * x - turn[1] * y;
    at[v] = turn[1] * x + turn[0] * y;
}

static void move(const struct mesh_step *step, const double turn[2], double at[3])
{
    switch (step->kind) {
    case MESH_ROTATE: rotate(turn, step->axis, at); break;
    case MESH_MIRROR: at[step->axis] = -at[step->axis]; break;
    case MESH_SCALE:
        for (int axis = 0; axis < 3; axis++)
            at[axis] *= step->number[axis];
        break;
    case MESH_TRANSLATE:
        for (int axis = 0; axis < 3; axis++)
            at[axis] += step->number[axis];
        break;
    }
}

static bool is_near(const double at[3])
{
    const double most = DBL_MAX / 2;
    return fabs(at[0]) <= most && fabs(at[1]) <= most && fabs(at[2]) <= most;
}

size_t mesh_transform(const struct mesh_transform *transform, struct mesh *mesh)
{
    for (int i = 0; i < transform->count; i++) {
        double turn[2] = {1, 0};
        if (transform->step[i].kind == MESH_ROTATE)
            turn_of(transform->step[i].number[0], turn);
        for (size_t v = 0; v < mesh->vertex_count; v++)
            move(&transform->step[i], turn, mesh->vertex[v]);
    }
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (!is_near(mesh->vertex[v]))
            return v;
    return SIZE_MAX;
}
