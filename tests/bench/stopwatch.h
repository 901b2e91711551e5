/* How long something takes, on a machine that does other things too: the time of this thread, taken
 * in blocks, and of these the median and the quartiles. */
#ifndef STOPWATCH_H
#define STOPWATCH_H

#include <stdbool.h>

/* CPU time of this thread, in nanoseconds. */
double stopwatch_now(void);

/* Ties the program to the CPU it is on. False: that is not allowed here. */
bool stopwatch_pin(void);

/* Of times of one thing: the median, and the quartiles. */
struct spread {
    double median, low, high;
};

/* The values are put in order. All 0 of none. */
struct spread spread_of(double *values, int count);

/* Takes the time of a loop that is always the same, between other things. */
void stopwatch_calibrate(void);

/* How far apart the times of that loop were, from the tenth part of them to the last but one tenth,
 * against their median: what the machine adds, whatever is measured. */
double stopwatch_noise(void);

#endif
