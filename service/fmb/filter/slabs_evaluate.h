/* The list of slabs of a pair (slabs.h), walked for LANES pairs at once. */
#ifndef FMB_SLABS_EVALUATE_H
#define FMB_SLABS_EVALUATE_H

#include "slabs_2d.h"
#include "slabs_3d.h"

INLINE void slabs_result_begin(struct slabs_result *result)
{
    result->gap_low = lanes_of(-1);
    result->gap_high = lanes_of(-INFINITY);
    result->enter[0] = result->enter[1] = lanes_of(-1);
    result->leave[0] = result->leave[1] = lanes_of(1);
}

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
