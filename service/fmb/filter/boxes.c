/* The kernel of boxes, LANES pairs at a time: one function for all kinds of pairs. It is not
 * inlined and not unrolled (Makefile): loops over arrays. */
#include "kernel_box.h"

/* Sets the box, [lower, upper][axis]; NAN in lanes in which doubles do not prove the limit of
 * fmb.h, 0 along axes beyond dim. */
static void find_box(const struct kernel_traits traits, const struct pair_lanes *pair,
                     const struct box_places *places, lanes box[2][3])
{
    struct box_pair of_pair;
    struct box_ends ends;
    begin_box(pair, traits, places, &of_pair);
    for (int i = 0; i < 6; i++)
        ends.outer[i / 3][i % 3] = ends.inner[i / 3][i % 3] = lanes_of(INFINITY);
    lanes_mask good = are_aligned(pair, traits, places, &of_pair) & of_pair.usable;
    if (lanes_mask_bits(good | is_not(pair->in_range)) != (1u << LANES) - 1) {
        struct box_ends clipped_ends;
        const lanes_mask clips = is_not(good);
        const lanes_mask found = clip_box(pair, traits, places, &of_pair, &clipped_ends);
        good |= found;
        for (int i = 0; i < 6; i++) {
            const int end = i / 3, axis = i % 3;
            if (axis >= traits.dim)
                continue;
            ends.outer[end][axis] =
                lanes_select(clips, clipped_ends.outer[end][axis], ends.outer[end][axis]);
            ends.inner[end][axis] =
                lanes_select(clips, clipped_ends.inner[end][axis], ends.inner[end][axis]);
        }
    }
    put_box(pair, traits, places, &of_pair, &ends, box);
    good &= pair->in_range;
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++)
            box[end][axis] =
                axis < traits.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

kernel_box_function KERNEL_PASTE(kernel, KERNEL_NAME);

void KERNEL_PASTE(kernel, KERNEL_NAME)(const struct kernel_call *call, enum kernel_kind kind)
{
    const struct kernel_traits traits = traits_of(kind);
    for (size_t first = 0; first < call->count; first += LANES) {
        struct frame_lanes frame[2];
        struct pair_lanes pair;
        struct box_places places;
        lanes box[2][3];
        gather_pairs((const struct fmb_prepared *const(*)[2]) & call->pairs[first], traits, frame);
        set_places(traits, frame, call->duration, &pair, &places);
        find_box(traits, &pair, &places, box);
        for (int i = 0; i < 6; i++) {
            double at[LANES];
            memcpy(at, &box[i / 3][i % 3], sizeof at);
            for (int lane = 0; lane < LANES; lane++)
                call->boxes[first + (size_t) lane][i / 3][i % 3] = at[lane];
        }
    }
}
