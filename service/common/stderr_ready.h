/* Tests whether a line can be written to standard error without blocking, since a full pipe must
 * not stop the service. Lines must be shorter than 4096 bytes: a pipe that is writable takes that
 * many. */
#ifndef STDERR_READY_H
#define STDERR_READY_H

#include <stdbool.h>
#include <stdint.h>

/* Whether a line can be written now. */
bool stderr_ready(void);

/* The same for a message that is written at most once a second. On input: time of the last one
 * (clock_ns()); 0: there was none. */
bool stderr_report_due(int64_t last_ns);

#endif
