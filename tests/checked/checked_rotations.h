/* Computes rotations in numbers that carry bounds on their errors, and compares these with the
 * bounds of rotation.h: what check_gap() does for gaps. */
#ifndef CHECKED_ROTATIONS_H
#define CHECKED_ROTATIONS_H

#ifdef __cplusplus
extern "C" {
#endif

/* An orientation of 2 or 4 numbers, and its product with a vector. */
void check_rotation(const double *orientation, int count, int dim, const double vector[3]);

#ifdef __cplusplus
}
#endif

#endif
