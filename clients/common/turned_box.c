/* Accuracy, u = 2^-53, n = |q|^2. The entries of n R and n itself have errors of at most 4 u n, and
 * the quotient and the product with a size s add 2 u s: less than 12 u s for a component, and less
 * than 16 u (|centre| + |size|_1) for an origin. Where R has entries 0 and +-1, as for quarter
 * turns, components are exact. */
#include "turned_box.h"

#include "turn.h"

#include <string.h>

void turned_box(int dim, const double *orientation, double *origin, double *components)
{
    double q[4] = {orientation[0], 0, 0, orientation[1]}; /* in 2D about z */
    double size[FMB_DIM_MAX], row[3][3];
    memcpy(size, components, (size_t) dim * sizeof *size);
    if (dim == 3)
        memcpy(q, orientation, sizeof q);
    turn_scale(q);
    const double n = turn_matrix(q, row);
    for (int axis = 0; axis < dim; axis++)
        for (int i = 0; i < dim; i++) {
            const double component = row[axis][i] / n * size[i];
            components[i * dim + axis] = component;
            origin[axis] -= component / 2;
        }
}
