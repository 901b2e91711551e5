/* Clocks of the system. No shared state. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdint.h>

/* Monotonic clock: nanoseconds since an arbitrary moment before the start of the process. */
int64_t clock_ns(void);

/* Wall clock: microseconds since 1970, the utime of messages. */
int64_t clock_utime(void);

/* Returns the earlier of two times. */
static inline int64_t clock_earlier(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* For poll(): milliseconds until a time of clock_ns(), rounded up; 0 if it is over. */
int clock_left_ms(int64_t until_ns);

#endif
