#include "solids.h"

#include <math.h>
#include <string.h>

/* ---- Vectors ---- */

double vector_dot(const double *u, const double *v)
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

void vector_cross(const double *u, const double *v, double *out)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = u[j] * v[k] - u[k] * v[j];
    }
}

void vector_add(double *to, double times, const double *vector)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        to[axis] += times * vector[axis];
}

double vector_length(const double *vector)
{
    double most = fmax(fabs(vector[0]), fmax(fabs(vector[1]), fabs(vector[2])));
    if (most == 0)
        return 0;
    double part[3] = {vector[0] / most, vector[1] / most, vector[2] / most};
    return most * sqrt(vector_dot(part, part));
}

/* ---- Solids ---- */

struct solid *question_solid(struct question *question, int side)
{
    return side == 0 ? &question->a : &question->b;
}

void solid_centre(const struct solid *solid, double *out)
{
    double vertex[VERTICES_MAX][FMB_DIM_MAX];
    const int count = solid_vertices(solid, vertex);
    memcpy(out, solid->origin, sizeof vertex[0]);
    for (int v = 0; v < count; v++)
        vector_add(out, 1.0 / count, vertex[v]);
}
