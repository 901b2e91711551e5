/* How a recording goes, while it runs, on a terminal. */
#ifndef RECORD_LINE_H
#define RECORD_LINE_H

#include "record_tally.h"

#include <stdbool.h>

struct record_line {
    bool enabled, shown;
    int64_t at_ns, events, bytes; /* when it was shown last, and how much there was */
};

/* Shows nothing unless standard error is a terminal. */
struct record_line record_line_begin(int64_t now_ns);

/* A few times a second, and not at all while the terminal takes nothing: so it may be called
 * often. On input: the file, and what has come so far. */
void record_line_show(struct record_line *line, int64_t now_ns, const char *path,
                      const struct tally *tally, int64_t lost);

/* Clears it. */
void record_line_end(struct record_line *line);

#endif
