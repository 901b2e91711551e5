#include "relative.h"

#include <math.h>

bool relative_motion_of(const struct world_frame *a, const struct world_frame *b, double duration,
                        struct relative_motion *out)
{
    *out = (struct relative_motion){.drifts = false};
    bool finite = true;
    for (int axis = 0; axis < a->dim; axis++) {
        out->offset[axis] = b->origin[axis] - a->origin[axis];
        const double speed = b->velocity[axis] - a->velocity[axis];
        out->drift[axis] = speed * duration;
        out->drifts = out->drifts || (speed != 0 && duration > 0);
        finite = finite && isfinite(out->offset[axis]) && isfinite(out->drift[axis]);
    }
    return finite;
}
