/* A limit of time on blocking calls. Once it is over, a signal interrupts them again and again, so
 * that lcm_handle() returns with an error (and reports it on stderr). One at a time. */
#ifndef GUARD_H
#define GUARD_H

#include <stdbool.h>

void guard_begin(double seconds);
void guard_end(void);
/* Whether the limit that began last was reached. */
bool guard_hit(void);

#endif
