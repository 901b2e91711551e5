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

/* A filter that truncates large datagrams on other channels before the kernel copies them.
 *
 * Every member of the group receives all results. Without the filter a client, and the service
 * itself, would copy up to 63 kB for each result of another client, only to drop it by its channel.
 * A truncated datagram is still received and counted. (One that a filter drops would count as
 * lost.) */

/* Datagrams of fewer bytes, UDP header included, are received whole. */
enum { TRIM_FROM = 1024 };

/* Attaches the filter to a socket, in place of any other. Larger datagrams on channels other than
 * these are truncated after the longest possible channel name.
 * On input: at most BUS_LISTENERS_MAX names, of fewer than BUS_CHANNEL_MAX bytes each. Has no
 * effect where the system refuses filters. */
void trim_attach(int fd, const char *const channels[], int count);

#endif
