#define _GNU_SOURCE
#include "stopwatch.h"

#include <sched.h>
#include <stdlib.h>
#include <time.h>

enum { CALIBRATIONS_MAX = 1 << 14, CALIBRATION_STEPS = 20000 };

/* Of the first ones; a run has fewer. */
static double calibration[CALIBRATIONS_MAX];
static int calibrations;
static volatile double sink; /* so that the loop is not left out */

double stopwatch_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double) now.tv_sec * 1e9 + (double) now.tv_nsec;
}

bool stopwatch_pin(void)
{
    cpu_set_t one;
    const int cpu = sched_getcpu();
    CPU_ZERO(&one);
    CPU_SET(cpu < 0 ? 0 : cpu, &one);
    return cpu >= 0 && sched_setaffinity(0, sizeof one, &one) == 0;
}

static int by_size(const void *one, const void *other)
{
    const double x = *(const double *) one, y = *(const double *) other;
    return (x > y) - (x < y);
}

struct spread spread_of(double *values, int count)
{
    if (count == 0)
        return (struct spread){0, 0, 0};
    qsort(values, (size_t) count, sizeof *values, by_size);
    return (struct spread){values[count / 2], values[count / 4], values[count - 1 - count / 4]};
}

/* Each step waits for the one before: no cache, no branch, no throughput; only the clock. */
void stopwatch_calibrate(void)
{
    const double start = stopwatch_now();
    double x = 1;
    for (int i = 0; i < CALIBRATION_STEPS; i++)
        x = x * 0.75 + 0.5;
    sink = x;
    if (calibrations < CALIBRATIONS_MAX)
        calibration[calibrations++] = stopwatch_now() - start;
}

double stopwatch_noise(void)
{
    if (calibrations == 0)
        return 0;
    const double median = spread_of(calibration, calibrations).median;
    return (calibration[calibrations - 1 - calibrations / 10] - calibration[calibrations / 10]) /
           median;
}
