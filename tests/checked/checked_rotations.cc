/* Rotations, compiled with `double` as a number that carries a bound on its error. */
#define INLINED_NOT
#define LANES 2

#include "checked_rotations.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "lanes.h"

typedef number number_in_place_of_double; /* no variable has this name */
#define double number_in_place_of_double
#define ROTATION_TWO
typedef lanes rotation_two;

#include "rotation.c"

#undef double

/* The entries are off by the errors of their numerators and products, and all by that of 1 / n,
 * which is checked where it is computed; the norm of R is 1. */
void check_rotation(const double *orientation, int count, int dim, const double vector[3])
{
    struct fmb_placement placement;
    struct rotation_matrix rotation;
    number matrix[9], v[3], product[3];
    memset(&placement, 0, sizeof placement);
    placement.orientation_count = count;
    for (int i = 0; i < count; i++)
        placement.orientation[i] = orientation[i];
    rotation_of(&placement, dim, &rotation);
    for (int i = 0; i < 9; i++)
        matrix[i] = rotation_entry(&rotation, i / 3, i % 3);
    const number of_entries = MATRIX_ERROR - NORM_ERROR;
    check_vector("MATRIX_ERROR", of_entries.value, matrix, 9, of_entries);
    for (int i = 0; i < 3; i++) {
        rotation.xy[i] = given(rotation.xy[i]);
        rotation.z[i] = given(rotation.z[i]);
        v[i] = vector[i];
    }
    rotation_apply(&rotation, v, product);
    const number length = sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
    check_vector("PRODUCT_ERROR", PRODUCT_ERROR, product, 3, PRODUCT_ERROR * length);
    arena_clear();
}
