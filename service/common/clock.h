/* Clocks of the system. No shared state. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdint.h>

/* Monotonic clock: nanoseconds since an arbitrary moment before the start of the process. */
int64_t clock_ns(void);

/* Wall clock: microseconds since 1970, the utime of messages. */
int64_t clock_utime(void);

#endif
