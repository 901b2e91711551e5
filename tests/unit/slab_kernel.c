/* What run.c is made of, once more, so that what is attacked is what runs. */
#include "run_lanes.h"

#include "slab_kernel.h"

static struct walk_kind kind_of(const struct frame_pair *pair, bool along)
{
    struct slabs_pair slabs;
    struct fmb_prepared a, b;
    struct walk_kind kind = {.dim = pair->a.frame->dim};
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    kind.simplex[0] = pair->a.frame->shape != FMB_CUBOID;
    kind.simplex[1] = pair->b.frame->shape != FMB_CUBOID;
    kind.face[0] = pair->a.frame->shape == FMB_FACE;
    kind.face[1] = pair->b.frame->shape == FMB_FACE;
    kind.drifts = slabs_prepare(&a, &b, pair->duration, &slabs) && slabs.motion.drifts;
    kind.along = along && kind.dim == 3;
    return kind;
}

static void set_walk_pair(const struct frame_pair *pair, const struct walk_kind kind,
                          struct walk_pair *out)
{
    struct fmb_prepared prepared[2];
    const double *const at[2][LANES] = {{(const double *) &prepared[0]},
                                        {(const double *) &prepared[1]}};
    struct run_frame frame[2];
    prepared_set(pair->a, &prepared[0]);
    prepared_set(pair->b, &prepared[1]);
    gather(kind, at[0], &frame[0]);
    gather(kind, at[1], &frame[1]);
    set_pair(kind, &frame[0], &frame[1], pair->duration, out);
}

int slab_kernel_list(const struct frame_pair *pair, bool along, struct slab_value out[SLABS_MAX])
{
    const struct walk_kind kind = kind_of(pair, along);
    struct walk_pair one;
    struct walk_found found;
    set_walk_pair(pair, kind, &one);
    walk_begin(&found);
    found.next = out;
    walk(&one, kind, &found);
    return (int) (found.next - out);
}

void slab_kernel_times(double low, double high, double swing, double error, double enter[2],
                       double leave[2])
{
    const struct walk_kind kind = {
        .dim = 3, .simplex = {true, true}, .drifts = true, .ordered = true, .times = true};
    const struct walk_extent d = {low, high, 0};
    struct walk_found found;
    walk_begin(&found);
    bound_times(kind, d, error, 0, swing, false, &found);
    for (int side = 0; side < 2; side++) {
        enter[side] = found.enter[side];
        leave[side] = found.leave[side];
    }
}

double slab_kernel_axes(const struct frame_pair *pair, double *bound)
{
    const struct walk_kind kind = kind_of(pair, false);
    struct walk_pair one;
    struct walk_found found;
    set_walk_pair(pair, kind, &one);
    walk_begin(&found);
    ask_axes(&one, kind, &found);
    *bound = SLABS_ROUNDING_AXES * one.reach;
    return found.surely;
}
