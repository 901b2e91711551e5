/* A pair as the article's system of linear inequalities M x <= y (section 3, equations 7 to 10).
 * Only this step depends on shape, dimension and motion. */
#ifndef FMB_ROWS_H
#define FMB_ROWS_H

#include "inexact.h"

enum {
    ROWS_VARS_MAX = FMB_DIM_MAX + 1, /* x_0 .. x_(dim-1), then tau if moving */
    ROWS_MAX = 14                    /* two cuboids in 3D, moving: 6 + 6 + 2 */
};

/* sum_i a[i] x_i <= y; if strict, < y, which describes the interiors. All rows are strict except
 * those of the window: tau runs over the closed interval [0,1]. */
struct row {
    double a[ROWS_VARS_MAX];
    double y;
    bool strict;
};

/* Writes the rows of a pair. The unknowns x are the parameters of frame b. The bounds of a's
 * parameters are expressed in them by projecting b into a's coordinates with a's inverse (Listing
 * 1, PROJ). tau = t / T.
 *
 * In: a has an inverse. Out: rows[0] to rows[*count - 1], in the order of Listing 1. Returns false
 * if a number overflowed. */
bool rows_of_pair(const struct inexact_pair *pair, struct row rows[ROWS_MAX], int *count);

#endif
