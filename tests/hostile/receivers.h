/* The unread datagrams of the receivers of a bus. Datagrams are lost if they arrive faster than a
 * receiver reads them, and its speed depends on the machine. A sender that waits for the receivers
 * loses none. */
#ifndef RECEIVERS_H
#define RECEIVERS_H

#include <stdbool.h>

/* Waits until no socket on the port of LCM_DEFAULT_URL holds more than a sixth of the smallest
 * usual receive buffer. Returns false if one still does after a minute, which means that nothing
 * reads it. */
bool receivers_wait(void);

#endif
