#include "inexact.h"

#include <math.h>

void bounds_range(const struct bounds *bounds, double range[2])
{
    range[0] = fmax(bounds->strict[0], bounds->closed[0]);
    range[1] = fmin(bounds->strict[1], bounds->closed[1]);
}

/* The open interval (p, q) meets the closed interval [u, v], u <= v, if and only if p < q, p < v
 * and u < q. (limbs_decide.h has the same rule for exact ratios: that method is to share nothing
 * with the others.) */
enum fmb_verdict bounds_verdict(const struct bounds *bounds)
{
    double p = bounds->strict[0], q = bounds->strict[1];
    double u = bounds->closed[0], v = bounds->closed[1], range[2];
    bounds_range(bounds, range);
    if (range[0] > range[1])
        return FMB_SEPARATED;
    return p < q && p < v && u < q && !bounds->no_interior ? FMB_OVERLAPPING : FMB_TOUCHING;
}

void bounds_answer_contact(const struct bounds *bounds, double duration, struct fmb_answer *answer)
{
    double range[2];
    bounds_range(bounds, range);
    answer->has_contact = true;
    answer->contact[0] = fmax(range[0], 0) * duration + 0.0; /* + 0.0: never -0 */
    answer->contact[1] = fmin(range[1], 1) * duration + 0.0;
}
