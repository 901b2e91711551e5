/* Vectors, and the solids of a question: what drawing needs of them. */
#ifndef SOLIDS_H
#define SOLIDS_H

#include "draw.h"
#include "question.h"

/* Vectors have FMB_DIM_MAX numbers, 0 beyond the dimension. */
double vector_dot(const double *u, const double *v);
void vector_cross(const double *u, const double *v, double *out);
void vector_add(double *to, double times, const double *vector);
double vector_length(const double *vector);

/* A for side 0, B for 1. */
struct solid *question_solid(struct question *question, int side);

/* The mean of the vertices of a solid that is no hull, in world coordinates. */
void solid_centre(const struct solid *solid, double *out);

#endif
