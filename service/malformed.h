/* Messages that cannot be decoded: counted, and reported at most once a second. */
#ifndef MALFORMED_H
#define MALFORMED_H

#include <stdint.h>

/* All 0 at the start. */
struct malformed {
    int64_t count;
    int64_t said_ns; /* time of the last report; 0: none */
    int64_t unsaid;  /* messages since then */
    /* Of the last message. */
    const char *channel, *reason;
    uint32_t size;
};

/* Counts a message, and reports it if a report is due. On input: texts that outlive
 * the struct. */
void malformed_note(struct malformed *malformed, const char *channel, uint32_t size,
                    const char *reason);

/* Reports messages not reported yet on stderr, if a report is due. */
void malformed_say(struct malformed *malformed);

#endif
