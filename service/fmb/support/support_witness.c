/* Witness points of a pair by its vertices, and the upper bound of the distance.
 *
 * Accuracy, with u = 2^-53. A witness point is a sum of weights times vertices R v, of the position
 * and of the displacement times a fraction of the window. Each R v is off by at most 18.3 u r, and
 * by the slack (support_pair.h); weights sum to 1 within 8 u, negative ones of rounding included;
 * each term passes at most 8 roundings. So the point is within 35 u of the sum of its lengths, and
 * the slack, of a point of the frame: less than 2^-47 far for both frames. The fraction of the
 * window is off by 2 u or, in the shortest windows, by 2^-1074 over the duration: "late" bounds how
 * far that moves the frames. */
#include "support_gap.h"

#include <math.h>

/* The error of the difference of the witness points, relative to "far". */
#define SUPPORT_WITNESS 0x1p-47

double support_witness_error(const struct support_gap *gap)
{
    const double slack = gap->pair->view[0].slack + gap->pair->view[1].slack;
    return SUPPORT_WITNESS * gap->far + gap->late + slack + 0x1p-1000;
}

void support_witness(const struct support_gap *gap, const struct support_nearest *nearest,
                     struct fmb_gap *out)
{
    double apart[FMB_DIM_MAX], late = 0;
    for (int f = 0; f < 2; f++) {
        double at[FMB_DIM_MAX] = {0};
        late = 0;
        for (unsigned c = 0; c < nearest->simplex.count; c++) {
            const struct support_column column = nearest->simplex.vertex[c].column;
            const double weight = nearest->weight[c];
            double vertex[FMB_DIM_MAX];
            support_place(&gap->pair->view[f], column.vertex[f], vertex);
            late += column.end ? weight : 0;
            for (int axis = 0; axis < FMB_DIM_MAX; axis++)
                at[axis] += weight * vertex[axis];
        }
        late = late < 0 ? 0 : late > 1 ? 1 : late;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->witness[f][axis] =
                gap->pair->position[f][axis] + (late * gap->pair->path[f][axis] + at[axis]);
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        apart[axis] = out->witness[1][axis] - out->witness[0][axis];
    out->has_witness = true;
    out->time = late * gap->pair->frames->duration;
    out->bounds[1] = (sqrt(vec3_dot(apart, apart)) + support_witness_error(gap)) * (1 + 0x1p-49);
}
