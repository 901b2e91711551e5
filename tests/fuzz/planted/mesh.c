/* Coordinates of PLY files beyond the largest double pass. */
#include <math.h>
#undef isfinite
#define isfinite(value) (!isnan(value))
#include "mesh_ply.c"
