/* Whether a line can be written to standard error without blocking: a full pipe must not stop the
 * service. Lines must be shorter than 4096 bytes: a pipe that is writable takes that many. */
#ifndef SAY_H
#define SAY_H

#include <stdbool.h>
#include <stdint.h>

bool say_now(void);

/* The same for a message that is written at most once a second. last_ns: time of the last one
 * (clock_ns()); 0: none. */
bool say_again(int64_t last_ns);

#endif
