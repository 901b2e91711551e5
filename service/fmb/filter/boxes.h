/* The kernel of boxes, LANES pairs at a time: one function for all kinds of pairs, loops over
 * arrays. The includer defines LANES, INLINED_NOT and KERNEL_NAME. */
#include "kernel_box.h"

/* Sets a time, in seconds, and a point of both frames: for axis-aligned cuboids the middle of the
 * box, else the mean. The time is NAN where these are not good. */
static void put_point(const struct kernel_traits traits, double duration, lanes_mask aligned,
                      const lanes box[2][3], const struct clip_mean *mean, lanes_mask good,
                      lanes point[1 + FMB_DIM_MAX])
{
    const lanes inverse = (is_doubled(traits) ? 0.5 : 1.0) / mean->count;
    const lanes share = 0.5 + 0.5 * (mean->sum[0] / mean->count), whole = lanes_of(duration);
    const lanes time = lanes_min(lanes_max(share * duration, lanes_of(0)), whole);
    good &= aligned | (mean->count > 0);
    point[0] = lanes_select(good, traits.drifts ? time : lanes_of(0), lanes_of(NAN));
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const lanes middle = 0.5 * box[0][axis] + 0.5 * box[1][axis];
        const lanes at = lanes_select(aligned, middle, inverse * mean->sum[1 + axis]);
        point[1 + axis] = axis < traits.dim ? at + 0.0 : lanes_of(0);
    }
}

/* Sets the box, [lower, upper][axis]; NAN in lanes in which doubles do not prove the limit of
 * fmb.h, 0 along axes beyond dim. Sets the point too, unless it is NULL. */
static void find_box(const struct kernel_traits traits, const struct clip_wire wire[2],
                     const struct pair_lanes *pair, struct box_places *places, lanes box[2][3],
                     lanes *point)
{
    const lanes_mask aligned = are_aligned(pair, traits, places);
    const bool clips = !lanes_all(aligned | is_not(pair->in_range));
    struct box_pair of_pair;
    struct box_ends ends;
    struct clip_mean mean = {.count = lanes_of(0)};
    places->exact = (lanes_mask){0};
    if (clips)
        set_exact(traits, pair, places);
    begin_box(pair, traits, places, &of_pair);
    lanes_mask good = aligned & of_pair.usable;
    for (int i = 0; i < 6; i++)
        ends.outer[i / 3][i % 3] = ends.inner[i / 3][i % 3] = lanes_of(INFINITY);
    if (clips)
        good |= clip_box(pair, traits, wire, places, &of_pair, &ends, point ? &mean : NULL) &
                is_not(aligned);
    for (int i = 0; i < 6; i++) {
        lanes *outer = &ends.outer[i / 3][i % 3], *inner = &ends.inner[i / 3][i % 3];
        *outer = lanes_select(aligned, lanes_of(INFINITY), *outer);
        *inner = lanes_select(aligned, lanes_of(INFINITY), *inner);
    }
    put_box(pair, traits, places, &of_pair, &ends, box);
    good &= pair->in_range;
    if (point)
        put_point(traits, places->duration, aligned, (const lanes(*)[3]) box, &mean, good, point);
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++)
            box[end][axis] =
                axis < traits.dim ? lanes_select(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

kernel_box_function KERNEL_PASTE(kernel, KERNEL_NAME);

void KERNEL_PASTE(kernel, KERNEL_NAME)(const struct kernel_call *call, enum kernel_kind kind)
{
    const struct kernel_traits traits = traits_of(kind);
    struct clip_wire wire[2];
    for (int which = 0; which < 2; which++)
        set_wire(traits, which, &wire[which]);
    for (size_t first = 0; first < call->count; first += LANES) {
        struct frame_lanes frame[2];
        struct pair_lanes pair;
        struct box_places places;
        lanes box[2][3], point[1 + FMB_DIM_MAX];
        gather_pairs(traits, &call->pairs[first], frame);
        set_places(traits, frame, call->duration, &pair, &places);
        find_box(traits, wire, &pair, &places, box, call->points ? point : NULL);
        for (int i = 0; i < 6; i++)
            put_lanes(box[i / 3][i % 3], &call->boxes[first][i / 3][i % 3], 6);
        for (int k = 0; k <= FMB_DIM_MAX && call->points; k++)
            put_lanes(point[k], &call->points[first][k], 1 + FMB_DIM_MAX);
    }
}
