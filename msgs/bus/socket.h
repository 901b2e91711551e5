/* The sockets of a bus. */
#ifndef BUS_SOCKET_H
#define BUS_SOCKET_H

#include <stdbool.h>
#include <stdint.h>

#include "bus.h"
#include "url.h"

/* Whether the system has a route to the group; sends nothing. If not, why has two lines: what is
 * wrong, and what to run. */
bool bus_socket_route(const struct sockaddr_in *group, char why[BUS_WHY_MAX]);

/* Opens a non-blocking, close-on-exec socket that only receives what is sent to the group: it is
 * bound to the group's address, so that unicast datagrams do not arrive.
 * Returns the descriptor, which the caller closes, and in *granted the receive buffer in bytes, as
 * SO_RCVBUF reports it; or -1, and why has one line. */
int bus_socket_open(const struct bus_url *url, long *granted, char why[BUS_WHY_MAX]);

/* Datagrams that the kernel dropped at this socket because the buffer was full, modulo 2^32. 0
 * where the kernel does not report it (before Linux 4.12). */
uint32_t bus_socket_drops(int fd);

#endif
