/* What programs need of the system: signals, standard error, random ids. */
#ifndef PROCESS_H
#define PROCESS_H

#include <stdbool.h>
#include <stdint.h>

/* Blocks SIGINT and SIGTERM, and returns a descriptor that is readable after one of them has
 * arrived; the caller closes it. Returns -1, and sets errno, on failure. To be called after the bus
 * has been opened, which can take seconds: before the call the signals end the process. LCM's own
 * thread blocks all signals itself. */
int signals_open(void);

/* Whether a line can be written to standard error without blocking: a full pipe must not stop the
 * service. Lines must be shorter than 4096 bytes: a pipe that is writable takes that many. */
bool stderr_ready(void);

/* The same for a message that is written at most once a second. On input: time of the last one
 * (clock_ns()); 0: there was none. */
bool stderr_report_due(int64_t last_ns);

/* Returns a random number from 1 to 2^53 - 1 (QUERY_ID_MAX); if the system has no getrandom()
 * (Linux before 3.17), the time in microseconds. */
int64_t random_id(void);

#endif
