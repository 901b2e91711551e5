/* The time. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdint.h>

/* Nanoseconds since some moment before the start: for spans. */
int64_t clock_ns(void);

/* Microseconds since 1970, as messages carry it. */
int64_t clock_utime(void);

#endif
