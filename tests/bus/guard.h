/* A limit on what waits: once it is over, what waits in the kernel is woken again and again, so
 * that lcm_handle() gives up (and says so on stderr). One at a time. */
#ifndef GUARD_H
#define GUARD_H

#include <stdbool.h>

void guard_begin(double seconds);
void guard_end(void);
/* Whether the limit that began last was reached. */
bool guard_hit(void);

#endif
