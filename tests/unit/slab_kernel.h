/* A part of the filter's kernels, for one pair. */
#ifndef SLAB_KERNEL_H
#define SLAB_KERNEL_H

/* The ends of the time, from -1 to 1, that a slab leaves of a pair that drifts: enter and leave,
 * [outer, inner]. On input: its bounds from the middle of the window. */
void slab_kernel_times(double low, double high, double swing, double error, double enter[2],
                       double leave[2]);

#endif
