/* Tetrahedra at rest by Ganovelli, Ponchio and Rocchini, Fast Tetrahedron-Tetrahedron Overlap
 * Algorithm (2002), in plain doubles; written from the paper. */
#ifndef GPR_H
#define GPR_H

#include "lean_sat.h"

/* In: tetrahedra at rest, however long. Touching ones meet. */
bool gpr_meets(const struct lean_frame *a, const struct lean_frame *b, double duration);

#endif
