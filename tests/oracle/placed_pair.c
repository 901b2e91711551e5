#include "placed_pair.h"

#include <math.h>

enum fmb_status pair_check(const struct pair *pair)
{
    enum fmb_status status = fmb_placement_check(&pair->a);
    if (status == FMB_OK)
        status = fmb_placement_check(&pair->b);
    if (status != FMB_OK)
        return status;
    if (pair->a.body->dim != pair->b.body->dim)
        return FMB_DIMENSIONS_DIFFER;
    return isfinite(pair->duration) && pair->duration >= 0 ? FMB_OK : FMB_BAD_DURATION;
}

enum fmb_status pair_decide(const struct fmb_method *method, const struct pair *pair, unsigned want,
                            struct fmb_answer *answer)
{
    return fmb_decide(method, &pair->a, &pair->b, pair->duration, want, answer);
}

enum fmb_status pair_certificate(const struct pair *pair, char *text, size_t size, size_t *length)
{
    return fmb_certificate(&pair->a, &pair->b, pair->duration, text, size, length);
}

bool pair_certificate_holds(const struct pair *pair, enum fmb_verdict verdict, const char *text,
                            char *why, size_t size)
{
    return fmb_certificate_holds(&pair->a, &pair->b, pair->duration, verdict, text, why, size);
}

struct frame_pair pair_frames(const struct pair *pair)
{
    return (struct frame_pair){{fmb_body_frame(pair->a.body, 0), &pair->a},
                               {fmb_body_frame(pair->b.body, 0), &pair->b},
                               pair->duration};
}
