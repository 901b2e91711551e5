/* Notifies the service manager (protocol of sd_notify: datagrams to the socket NOTIFY_SOCKET). */
#ifndef NOTIFY_H
#define NOTIFY_H

#include <stdint.h>

struct notify {
    int fd;              /* -1: there is no manager */
    int64_t watchdog_ns; /* interval of watchdog messages, half of the limit; 0: none */
    int64_t due_ns;      /* time of the next one; clock_ns() */
};

/* Reads the environment: NOTIFY_SOCKET, WATCHDOG_USEC, WATCHDOG_PID. */
void notify_open(struct notify *notify);
void notify_close(struct notify *notify);

void notify_ready(struct notify *notify);
void notify_stopping(struct notify *notify);

/* Sends the watchdog message, if it is due. Returns the milliseconds until the next one, rounded
 * down, and at most most_ms. */
int notify_alive(struct notify *notify, int most_ms);

#endif
