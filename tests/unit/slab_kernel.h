/* The slabs of a pair as the filter's kernels have them: in the order of their operations, which is
 * not that of the list in slabs.c, fused where they are. */
#ifndef SLAB_KERNEL_H
#define SLAB_KERNEL_H

#include <stdbool.h>

#include "pair.h"
#include "slabs.h"

/* On input: a checked pair of which doubles can say something; a cuboid before a tetrahedron.
 * along: as if an edge were parallel to a coordinate axis. Returns how many. */
typedef int slab_kernel_function(const struct frame_pair *pair, bool along,
                                 struct slab_value out[SLABS_MAX]);

/* On input: the same in space. What the coordinate axes make of the pair: more than 0 where one of
 * them surely parts it; *bound is what the gap was made smaller by. */
typedef double slab_kernel_axes_function(const struct frame_pair *pair, double *bound);

/* The ends of the time, from -1 to 1, that a slab leaves of a pair that drifts: enter and leave,
 * [outer, inner]. On input: its bounds from the middle of the window. */
void slab_kernel_times(double low, double high, double swing, double error, double enter[2],
                       double leave[2]);

/* Compiled as kernels of verdicts are; with fused operations; with a bound that is wrong
 * (tests.mk). */
slab_kernel_function slab_kernel_list, fused_slab_kernel_list, planted_slab_kernel_list;
slab_kernel_axes_function slab_kernel_axes, fused_slab_kernel_axes, planted_slab_kernel_axes;

#endif
