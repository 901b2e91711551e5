/* Whether a line on standard error would be taken at once: a pipe that nobody reads must not stop
 * the service. Lines are to have less than 4096 bytes: a pipe that takes any takes as many. */
#ifndef SAY_H
#define SAY_H

#include <stdbool.h>
#include <stdint.h>

bool say_now(void);

/* The same for something that is said once a second at most. last_ns: when it was said last
 * (clock_ns()); 0: never. */
bool say_again(int64_t last_ns);

#endif
