#include "leap_clock.h"

#include <stdatomic.h>
#include <time.h>

static _Atomic int64_t leapt;

void clock_leap(int64_t ns)
{
    leapt += ns;
}

static int64_t read_ns(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (int64_t) time.tv_sec * 1000000000 + time.tv_nsec;
}

int64_t clock_ns(void)
{
    return read_ns(CLOCK_MONOTONIC) + leapt;
}

int64_t clock_utime(void)
{
    return read_ns(CLOCK_REALTIME) / 1000;
}

int clock_left_ms(int64_t until_ns)
{
    const int64_t left_ns = until_ns - clock_ns();
    return left_ns > 0 ? (int) ((left_ns + 999999) / 1000000) : 0;
}
