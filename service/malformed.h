/* Datagrams that cannot be read: counted, and said at a limited rate. */
#ifndef MALFORMED_H
#define MALFORMED_H

#include <stdint.h>

/* All 0 at the start. */
struct malformed {
    int64_t count;
    int64_t said_ns; /* 0: never */
    int64_t unsaid;  /* how many came since */
    /* The last one. */
    const char *channel, *reason;
    uint32_t size;
};

/* On input: texts that stay. */
void malformed_note(struct malformed *malformed, const char *channel, uint32_t size,
                    const char *reason);

/* Says on stderr what is left to be said, if it may be said again. */
void malformed_say(struct malformed *malformed);

#endif
