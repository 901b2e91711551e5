#include "report.h"

#include "query.h"

const char *report_refusal(const struct pair_result *result)
{
    if (result->status == FMB_OK)
        return NULL;
    return result->detail[0] ? result->detail : fmb_status_text(result->status);
}
