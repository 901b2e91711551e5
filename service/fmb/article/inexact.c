#include "inexact.h"

#include "rotation.h"

#include <string.h>

static void set_inverse(const struct placed_frame *placed, struct inexact_pair *out)
{
    const struct fmb_frame *frame = placed->frame;
    struct rotation_matrix rotation;
    memcpy(out->inverse, frame->inverse, sizeof out->inverse);
    rotation_of(placed->placement, frame->dim, &rotation);
    for (int axis = 0; axis < frame->dim && rotation.turned; axis++)
        for (int i = 0; i < frame->dim; i++) {
            out->inverse[axis][i] = 0;
            for (int k = 0; k < frame->dim; k++)
                out->inverse[axis][i] += rotation_entry(&rotation, axis, k) * frame->inverse[k][i];
        }
}

bool inexact_pair_of(const struct frame_pair *pair, struct inexact_pair *out)
{
    struct fmb_prepared a, b;
    if (pair->a.frame->flat || pair->b.frame->flat || support_takes(pair->a.frame, pair->b.frame) ||
        pair_turns(pair))
        return false;
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    world_frame_of(&a, &out->a);
    world_frame_of(&b, &out->b);
    set_inverse(&pair->a, out);
    out->duration = pair->duration;
    out->moving = pair_moves(pair);
    return relative_motion_of(&out->a, &out->b, pair->duration, &out->motion);
}
