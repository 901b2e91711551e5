/* Evaluates all slabs of LANES pairs at once (the list of slabs.h). */
#ifndef FMB_SLABS_EVALUATE_H
#define FMB_SLABS_EVALUATE_H

#include "slabs_2d.h"
#include "slabs_3d.h"

/* The result of no slab. */
INLINE void slabs_result_begin(struct slabs_result *result)
{
    result->gap_low = lanes_of(-1);
    result->gap_high = lanes_of(-INFINITY);
    result->enter[0] = result->enter[1] = lanes_of(-1);
    result->leave[0] = result->leave[1] = lanes_of(1);
}

/* In 3D, stops as soon as all pairs are separated and no more is computed (is_enough()). */
INLINE void evaluate_slabs(const struct pair_lanes *pair, const struct kernel_traits traits,
                           struct slabs_result *result)
{
    if (traits.dim == 2) {
        evaluate_slabs_2d(pair, traits, result);
        return;
    }
    evaluate_axes(pair, traits, result);
    if (!is_enough(traits, result))
        evaluate_slabs_3d(pair, traits, result);
}

#endif
