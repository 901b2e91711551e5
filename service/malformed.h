/* Messages that cannot be decoded: counted, and reported at most once a second. */
#ifndef MALFORMED_H
#define MALFORMED_H

#include <stdint.h>

/* All 0 at the start. */
struct malformed {
    int64_t count;
    int64_t reported_ns; /* time of the last report (clock_ns()); 0: none */
    int64_t unreported;  /* messages since then */
    /* The last message. */
    const char *channel, *reason;
    uint32_t size;
};

/* Counts a message of size bytes, and reports it on stderr if a report is due. On input: texts that
 * outlive the struct. */
void malformed_note(struct malformed *malformed, const char *channel, uint32_t size,
                    const char *reason);

/* Reports messages not reported yet on stderr, if a report is due. */
void malformed_report(struct malformed *malformed);

#endif
