/* How long something takes, on a machine that does other things too: the time of this thread, taken
 * in blocks, and of these the median. */
#ifndef STOPWATCH_H
#define STOPWATCH_H

/* CPU time of this thread, in nanoseconds. */
double stopwatch_now(void);

enum { STOPWATCH_BLOCKS = 15 };

struct stopwatch {
    double block[STOPWATCH_BLOCKS]; /* nanoseconds a call */
    int blocks;
};

/* Of the blocks so far. */
double stopwatch_median(const struct stopwatch *watch);

/* Ties the program to one CPU, where that is allowed. */
void stopwatch_pin(void);

#endif
