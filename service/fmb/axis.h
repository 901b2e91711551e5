/* Pairs that touch along a coordinate axis: a box on a table, boxes in a grid. */
#ifndef FMB_AXIS_H
#define FMB_AXIS_H

#include "slabs.h"

/* On input: a pair that is not two faces. Returns SEPARATED or TOUCHING, or 0 where doubles leave
 * it open. */
enum fmb_verdict axis_verdict(const struct slabs_pair *pair);

#endif
