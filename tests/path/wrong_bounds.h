/* Programs that wrap path_bounds_of() multiply the bounds of fmb path by these factors, which are 1
 * at first. */
#ifndef WRONG_BOUNDS_H
#define WRONG_BOUNDS_H

extern double wrong_speed, wrong_curve;

#endif
