/* SIGINT and SIGTERM as a descriptor that can be polled. */
#ifndef SIGNALS_H
#define SIGNALS_H

/* Blocks both signals, and returns a descriptor that is readable after one has arrived; the caller
 * closes it. Returns -1, and sets errno, on failure. To be called after the bus has been opened,
 * which can take seconds: before the call the signals end the process. LCM's own thread blocks all
 * signals itself. */
int signals_open(void);

#endif
