/* A line that shows the progress of long work, on a terminal only. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool shown; /* something stands on the line */
    bool enabled;
    const char *unit; /* "pairs" */
    uint64_t steps, done, total;
    int64_t started_at, shown_at; /* clock_ns() */
};

/* Begins a count of pairs. Shows nothing unless standard error is a terminal and standard output is
 * not: on a terminal the answers themselves show the progress. */
struct progress progress_begin(uint64_t total);

/* Begins a count of other things, such as "bytes", where nothing is printed before the end:
 * standard output may be a terminal too. unit must live as long as the progress. */
struct progress progress_begin_of(const char *unit, uint64_t total);

/* Like progress_to(), and sets the total, which may be known only now. */
void progress_to_of(struct progress *progress, uint64_t done, uint64_t total);

/* Adds one to what is done, or sets it. The line is shown after the first second, then a few times
 * a second. */
void progress_step(struct progress *progress);
void progress_to(struct progress *progress, uint64_t done);

/* Clears the line. */
void progress_end(struct progress *progress);

#endif
