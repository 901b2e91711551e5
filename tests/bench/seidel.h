/* Linear programming by Seidel, Linear Programming and Convex Hulls Made Easy (1990), in
 * doubles, with a tolerance; written from the paper. */
#ifndef SEIDEL_H
#define SEIDEL_H

#include "lean_sat.h"

/* As lean_meets(). Touching frames meet. B is not flat. */
bool seidel_meets(const struct lean_frame *a, const struct lean_frame *b, double duration);

#endif
