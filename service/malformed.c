#include "malformed.h"

#include "clock.h"
#include "process.h"

#include <inttypes.h>
#include <stdio.h>

void malformed_report(struct malformed *malformed)
{
    if (malformed->unreported == 0 || !stderr_report_due(malformed->reported_ns))
        return;
    fprintf(stderr,
            "fmbd: malformed message on %s (%" PRIu32 " bytes): %s; %" PRId64
            " of them so far, %" PRId64 " since this was last said\n",
            malformed->channel, malformed->size, malformed->reason, malformed->count,
            malformed->unreported);
    malformed->reported_ns = clock_ns();
    malformed->unreported = 0;
}

void malformed_note(struct malformed *malformed, const char *channel, uint32_t size,
                    const char *reason)
{
    malformed->count++;
    malformed->unreported++;
    malformed->channel = channel;
    malformed->size = size;
    malformed->reason = reason;
    malformed_report(malformed);
}
