#include "inexact.h"

#include <math.h>

/* The open interval (p, q) meets the closed interval [u, v], u <= v, just if p < q, p < v and
 * u < q. */
enum fmb_verdict contact_times_verdict(const struct contact_times *times)
{
    double p = times->strict[0], q = times->strict[1];
    double u = times->window[0], v = times->window[1];
    if (fmax(p, u) > fmin(q, v))
        return FMB_SEPARATED;
    return p < q && p < v && u < q && !times->no_interior ? FMB_OVERLAPPING : FMB_TOUCHING;
}

void contact_times_answer(const struct contact_times *times, double duration,
                          struct fmb_answer *answer)
{
    double first = fmax(times->strict[0], times->window[0]);
    double last = fmin(times->strict[1], times->window[1]);
    answer->has_contact = true;
    answer->contact[0] = fmax(first, 0) * duration + 0.0; /* + 0.0: never -0 */
    answer->contact[1] = fmin(last, 1) * duration + 0.0;
}
