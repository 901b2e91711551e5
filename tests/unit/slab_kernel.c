/* What many.h is made of, once more, so that what is attacked is what runs. */
#define INLINED_NOT
#define SLABS_LIST
#include "kernel_lanes.h"

#include "slab_kernel.h"

static struct kernel_traits kind_of(const struct frame_pair *pair, bool along)
{
    struct slabs_pair slabs;
    struct fmb_prepared a, b;
    struct kernel_traits traits = {.dim = pair->a.frame->dim};
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    traits.simplex[0] = pair->a.frame->shape != FMB_CUBOID;
    traits.simplex[1] = pair->b.frame->shape != FMB_CUBOID;
    traits.face[0] = pair->a.frame->shape == FMB_FACE;
    traits.face[1] = pair->b.frame->shape == FMB_FACE;
    traits.drifts = slabs_prepare(&a, &b, pair->duration, &slabs) && slabs.motion.drifts;
    traits.axis_aligned = along && traits.dim == 3;
    return traits;
}

static void set_pair_lanes(const struct frame_pair *pair, const struct kernel_traits traits,
                           struct pair_lanes *out)
{
    struct fmb_prepared prepared[2];
    const double *const at[2][LANES] = {{(const double *) &prepared[0]},
                                        {(const double *) &prepared[1]}};
    struct frame_lanes frame[2];
    prepared_set(pair->a, &prepared[0]);
    prepared_set(pair->b, &prepared[1]);
    gather(traits, at[0], &frame[0]);
    gather(traits, at[1], &frame[1]);
    set_pair(traits, &frame[0], &frame[1], pair->duration, out);
}

int slab_kernel_list(const struct frame_pair *pair, bool along, struct slab_value out[SLABS_MAX])
{
    const struct kernel_traits traits = kind_of(pair, along);
    struct pair_lanes one;
    struct slabs_result result;
    set_pair_lanes(pair, traits, &one);
    slabs_result_begin(&result);
    result.next = out;
    evaluate_slabs(&one, traits, &result);
    return (int) (result.next - out);
}

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

double slab_kernel_axes(const struct frame_pair *pair, double *bound)
{
    const struct kernel_traits traits = kind_of(pair, false);
    struct pair_lanes one;
    struct slabs_result result;
    set_pair_lanes(pair, traits, &one);
    slabs_result_begin(&result);
    evaluate_axes(&one, traits, &result);
    *bound = SLABS_ROUNDING_AXES * one.reach;
    return result.gap_low;
}
