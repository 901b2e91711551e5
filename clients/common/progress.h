/* How far a long work has come, on a terminal only. */
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

/* Shows nothing unless standard error is a terminal and standard output is not: there the answers
 * themselves show how far it is. */
struct progress progress_begin(uint64_t total);

/* Of other things: "bytes". Standard output may be a terminal too: nothing is printed before the
 * end. unit must live as long as the progress. */
struct progress progress_begin_of(const char *unit, uint64_t total);

/* As progress_to(), with the total, which may be known late. */
void progress_to_of(struct progress *progress, uint64_t done, uint64_t total);

/* One more is done; or so many are now. Shows after the first second, then a few times a second. */
void progress_step(struct progress *progress);
void progress_to(struct progress *progress, uint64_t done);

/* Clears the line. */
void progress_end(struct progress *progress);

#endif
