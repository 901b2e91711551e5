/* events LOG: prints what LCM's own reader finds in an event log, a line for each event:
 *
 *     NUMBER UTIME CHANNEL SIZE SUM
 *
 * SUM is a checksum of the data (FNV-1a, 64 bits). Exit code 1 where it cannot be read, or where
 * the reader stops before the end of the file. */
#include <inttypes.h>
#include <lcm/eventlog.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static uint64_t checksum(const unsigned char *bytes, int32_t size)
{
    uint64_t sum = UINT64_C(0xcbf29ce484222325);
    for (int32_t i = 0; i < size; i++)
        sum = (sum ^ bytes[i]) * UINT64_C(0x100000001b3);
    return sum;
}

int main(int argc, char **argv)
{
    lcm_eventlog_t *log = argc == 2 ? lcm_eventlog_create(argv[1], "r") : NULL;
    lcm_eventlog_event_t *event;
    if (!log) {
        fputs("usage: events LOG\n", stderr);
        return EXIT_FAILURE;
    }
    long end = 0;
    while ((event = lcm_eventlog_read_next_event(log))) {
        printf("%" PRId64 " %" PRId64 " %s %" PRId32 " %016" PRIx64 "\n", event->eventnum,
               event->timestamp, event->channel, event->datalen,
               checksum(event->data, event->datalen));
        lcm_eventlog_free_event(event);
        end = ftell(log->f);
    }
    fseek(log->f, 0, SEEK_END);
    const int code = ftell(log->f) == end ? EXIT_SUCCESS : EXIT_FAILURE;
    lcm_eventlog_destroy(log);
    return code;
}
