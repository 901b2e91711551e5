/* Computes pairs by the kernels of the filter in numbers that carry bounds on their errors
 * (number.hpp), and compares these with the bounds that the kernels use. Not thread safe: the
 * results are kept until check_begin(). */
#ifndef CHECKED_BOUNDS_H
#define CHECKED_BOUNDS_H

#include "prepared.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Forgets all results. */
void check_begin(void);

/* Computes a pair of valid frames of one dimension by each job, in both orders. */
void check_pair(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration);

/* Computes a pair of valid frames of one dimension as service/fmb/turn does. At least one of the
 * placements has an end. */
void check_turning_pair(const struct fmb_prepared *a, const struct fmb_prepared *b,
                        double duration);

/* The names of the constants; NULL past the last. */
const char *check_constant(int index);

/* From here on the constant is compared as if it were its value times factor. */
void check_lower(int index, double factor);

/* Whether some bound by the constant was below what is derived. */
bool check_failed(int index);

/* Prints a line for each constant. Returns whether none failed. */
bool check_report(FILE *out);

#ifdef __cplusplus
}
#endif

#endif
