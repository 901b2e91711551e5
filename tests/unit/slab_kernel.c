/* What many.h is made of, once more, so that what is attacked is what runs. */
#define INLINED_NOT
#include "kernel_lanes.h"

#include "slab_kernel.h"

void slab_kernel_times(double low, double high, double swing, double error, double enter[2],
                       double leave[2])
{
    const struct kernel_traits traits = {
        .dim = 3, .simplex = {true, true}, .drifts = true, .swap_invariant = true, .times = true};
    const struct slab_extent d = {low, high, 0};
    struct slabs_result result;
    slabs_result_begin(&result);
    bound_times(traits, d, error, 0, swing, false, &result);
    for (int side = 0; side < 2; side++) {
        enter[side] = result.enter[side];
        leave[side] = result.leave[side];
    }
}
