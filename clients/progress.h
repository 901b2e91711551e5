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

/* Of a file, whose bytes are counted. Standard output may be a terminal too: nothing is printed
 * before the end. */
struct progress progress_begin_bytes(uint64_t total);

/* Likewise of other things: "boxes". unit lives as long as the progress. */
struct progress progress_begin_of(uint64_t total, const char *unit);

/* One more is done; or so many are now. Shows after the first second, then a few times a second. */
void progress_step(struct progress *progress);
void progress_to(struct progress *progress, uint64_t done);

/* Clears the line. */
void progress_end(struct progress *progress);

#endif
