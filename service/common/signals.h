/* SIGINT and SIGTERM as something to poll. */
#ifndef SIGNALS_H
#define SIGNALS_H

/* Blocks both, and returns a descriptor that is readable once one has come; -1: errno. To be
 * called once the bus is open, which can take seconds: until then they simply end the process.
 * LCM's own thread blocks all signals itself. */
int signals_open(void);

#endif
