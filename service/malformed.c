#include "malformed.h"

#include "clock.h"
#include "say.h"

#include <inttypes.h>
#include <stdio.h>

void malformed_say(struct malformed *malformed)
{
    if (malformed->unsaid == 0 || !say_again(malformed->said_ns))
        return;
    fprintf(stderr,
            "fmbd: malformed message on %s (%" PRIu32 " bytes): %s; %" PRId64
            " of them so far, %" PRId64 " since this was last said\n",
            malformed->channel, malformed->size, malformed->reason, malformed->count,
            malformed->unsaid);
    malformed->said_ns = clock_ns();
    malformed->unsaid = 0;
}

void malformed_note(struct malformed *malformed, const char *channel, uint32_t size,
                    const char *reason)
{
    malformed->count++;
    malformed->unsaid++;
    malformed->channel = channel;
    malformed->size = size;
    malformed->reason = reason;
    malformed_say(malformed);
}
