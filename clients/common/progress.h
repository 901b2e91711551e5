/* A line that shows the progress of long work, on a terminal only. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool shown; /* the line has text on it */
    bool enabled;
    const char *unit; /* "pairs" */
    uint64_t steps;   /* calls of progress_to() */
    int64_t done, total;
    int64_t started_at, shown_at; /* clock_ns() */
};

/* Begins a count of things such as "bytes". Nothing is shown unless standard error is a terminal.
 * unit must live as long as the progress. */
struct progress progress_begin(const char *unit, int64_t total);

/* Sets what is done, and the total. The line is shown after the first second, then a few times a
 * second. progress: a struct progress; the type is that of a callback. */
void progress_to(void *progress, int64_t done, int64_t total);

/* Clears the line. */
void progress_end(struct progress *progress);

#endif
