#include "relative.h"

#include <math.h>

static double velocity_of(const struct fmb_frame *frame, int axis)
{
    return frame->moving ? frame->velocity[axis] : 0;
}

bool relative_motion_of(const struct fmb_pair *pair, struct relative_motion *out)
{
    *out = (struct relative_motion){.moving = pair->a.moving || pair->b.moving};
    bool finite = true;
    for (int axis = 0; axis < pair->a.body->dim; axis++) {
        out->offset[axis] = pair->b.origin[axis] - pair->a.origin[axis];
        double speed = velocity_of(&pair->b, axis) - velocity_of(&pair->a, axis);
        out->drift[axis] = speed * pair->duration;
        out->drifts = out->drifts || (speed != 0 && pair->duration > 0);
        finite = finite && isfinite(out->offset[axis]) && isfinite(out->drift[axis]);
    }
    return finite;
}
