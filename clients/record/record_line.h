/* The progress of a recording, on a terminal. */
#ifndef RECORD_LINE_H
#define RECORD_LINE_H

#include <stdbool.h>
#include <stdint.h>

struct record_line {
    bool enabled, shown;
    int64_t at_ns, events, bytes; /* of the last display: time, and counts then */
};

/* A display that is only enabled if standard error is a terminal. */
struct record_line record_line_begin(int64_t now_ns);

/* Updates the line, at most a few times a second, and never blocks on the terminal: so it may be
 * called often. On input: the file, the messages and bytes so far, and the messages lost. */
void record_line_show(struct record_line *line, int64_t now_ns, const char *path, int64_t events,
                      int64_t bytes, int64_t lost);

/* Clears the line. */
void record_line_end(struct record_line *line);

#endif
