/* Notifies the service manager (protocol of sd_notify: datagrams to the socket NOTIFY_SOCKET). */
#ifndef NOTIFY_H
#define NOTIFY_H

#include <stdint.h>

struct notify {
    int fd;              /* -1: there is no manager */
    int64_t watchdog_ns; /* interval of watchdog messages, half of the limit; 0: none */
    int64_t due_ns;      /* when the next one is due (clock_ns()) */
};

/* Opens the socket that the environment names (NOTIFY_SOCKET), and reads the watchdog's interval
 * (WATCHDOG_USEC, WATCHDOG_PID). Without a manager the functions below have no effect. None of them
 * blocks. */
void notify_open(struct notify *notify);
void notify_close(struct notify *notify);

/* Report that the service is ready, or that it is stopping. */
void notify_ready(struct notify *notify);
void notify_stopping(struct notify *notify);

/* Sends the watchdog message, if it is due. Returns the milliseconds until the next one, rounded
 * down, or most_ms if that is less or there is no watchdog. */
int notify_alive(struct notify *notify, int most_ms);

#endif
