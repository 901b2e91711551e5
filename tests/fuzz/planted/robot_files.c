/* Numbers of URDF beyond the largest double pass. */
#include <math.h>
#undef isfinite
#define isfinite(value) (!isnan(value))
#include "robot.c"
