#include "inexact.h"

#include <math.h>

/* The open interval (p, q) meets the closed interval [u, v], u <= v, just if p < q, p < v and
 * u < q. (exact_span.c has the same rule for exact ratios: that method is to share nothing with
 * the others.) */
enum fmb_verdict bounds_verdict(const struct bounds *bounds)
{
    double p = bounds->strict[0], q = bounds->strict[1];
    double u = bounds->closed[0], v = bounds->closed[1];
    if (fmax(p, u) > fmin(q, v))
        return FMB_SEPARATED;
    return p < q && p < v && u < q && !bounds->no_interior ? FMB_OVERLAPPING : FMB_TOUCHING;
}

void bounds_answer_contact(const struct bounds *bounds, double duration, struct fmb_answer *answer)
{
    double first = fmax(bounds->strict[0], bounds->closed[0]);
    double last = fmin(bounds->strict[1], bounds->closed[1]);
    answer->has_contact = true;
    answer->contact[0] = fmax(first, 0) * duration + 0.0; /* + 0.0: never -0 */
    answer->contact[1] = fmin(last, 1) * duration + 0.0;
}
