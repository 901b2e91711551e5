/* What the receivers of a bus have still to read. Datagrams are lost where they arrive faster than
 * a receiver reads them, and how fast that is depends on the machine: a sender that waits for its
 * receivers loses none. */
#ifndef RECEIVERS_H
#define RECEIVERS_H

#include <stdbool.h>

/* Waits until no socket on the port of LCM_DEFAULT_URL holds more than a sixth of the smallest
 * usual receive buffer. Returns false if one still does after a minute: it is not read at all. */
bool receivers_wait(void);

#endif
