#define _GNU_SOURCE
#include "stopwatch.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double stopwatch_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double) now.tv_sec * 1e9 + (double) now.tv_nsec;
}

static int by_size(const void *one, const void *other)
{
    double x = *(const double *) one, y = *(const double *) other;
    return (x > y) - (x < y);
}

double stopwatch_median(const struct stopwatch *watch)
{
    double sorted[STOPWATCH_BLOCKS];
    memcpy(sorted, watch->block, sizeof sorted);
    qsort(sorted, (size_t) watch->blocks, sizeof *sorted, by_size);
    return watch->blocks ? sorted[watch->blocks / 2] : 0;
}

void stopwatch_pin(void)
{
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    sched_setaffinity(0, sizeof one, &one);
}
