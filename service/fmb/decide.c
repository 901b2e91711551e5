#include "fmb.h"

#include "certified.h"
#include "exact.h"
#include "inexact.h"

#include <string.h>

static const struct fmb_method methods[] = {
    {"certified", 4, "never wrong: doubles with bounds, exact arithmetic where these are unsure",
     true, true, certified_decide},
    {"exact", 1, "right for every input, flat frames included (GMP)", true, true, exact_decide},
    {"fmb", 2, "the article's elimination in doubles, with its loose box; inexact", false, true,
     eliminate_decide},
    {"sat", 3, "separating axes in doubles, no box; inexact", false, false, sat_decide},
};

enum { METHOD_COUNT = sizeof methods / sizeof *methods };

const struct fmb_method *fmb_method_default(void)
{
    return &methods[0];
}

const struct fmb_method *fmb_method_at(size_t index)
{
    return index < METHOD_COUNT ? &methods[index] : NULL;
}

const struct fmb_method *fmb_method_by_name(const char *name)
{
    for (size_t i = 0; i < METHOD_COUNT; i++)
        if (strcmp(methods[i].name, name) == 0)
            return &methods[i];
    return NULL;
}

const struct fmb_method *fmb_method_by_number(int number)
{
    if (number == 0)
        return fmb_method_default();
    for (size_t i = 0; i < METHOD_COUNT; i++)
        if (methods[i].number == number)
            return &methods[i];
    return NULL;
}

enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_pair *pair,
                           unsigned want, struct fmb_answer *answer)
{
    memset(answer, 0, sizeof *answer);
    enum fmb_status status = fmb_pair_check(pair);
    if (status != FMB_OK)
        return status;
    if (want & ~(unsigned) FMB_WANT_BOX)
        return FMB_UNKNOWN_WANT;
    status = method->decide(pair, want, answer);
    if (status != FMB_OK) /* a method may have gone some way before it knew */
        memset(answer, 0, sizeof *answer);
    return status;
}
