#include "mesh_transform.h"

#include "turn.h"

#include <float.h>
#include <math.h>

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
            turn_degrees(transform->step[i].number[0], turn);
        for (size_t v = 0; v < mesh->vertex_count; v++)
            move(&transform->step[i], turn, mesh->vertex[v]);
    }
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (!is_near(mesh->vertex[v]))
            return v;
    return SIZE_MAX;
}
