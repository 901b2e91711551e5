/* The receiving socket of a bus. No shared state. */
#ifndef BUS_SOCKET_H
#define BUS_SOCKET_H

#include <stdbool.h>
#include <stdint.h>

#include "bus.h"
#include "url.h"

/* Returns whether the system has a route to the group; sends nothing. If it has none, why has two
 * lines: what is wrong, and what to run. */
bool bus_socket_route(const struct sockaddr_in *group, char why[BUS_WHY_MAX]);

/* Opens a non-blocking, close-on-exec socket that receives only what is sent to the group: it is
 * bound to the group's address, so that it gets no unicast datagrams.
 * Returns the descriptor, which the caller closes, and in *granted the receive buffer in bytes, as
 * SO_RCVBUF reports it; or -1, and why has one line. */
int bus_socket_open(const struct bus_url *url, long *granted, char why[BUS_WHY_MAX]);

/* Datagrams that the kernel dropped at this socket because the buffer was full, modulo 2^32. 0
 * if the kernel does not report it (before Linux 4.12). */
uint32_t bus_socket_drops(int fd);

/* A socket filter that truncates large datagrams on other channels, and large fragments, before the
 * kernel copies them. It leaves only LCM's header; of a fragment, also the channel name.
 *
 * Every member of the group receives all results. Without the filter a client, and the service
 * itself, would copy up to 63 kB for each result of another client, and then drop it because of its
 * channel. A truncated datagram is still received and counted; one that a filter drops would count
 * as lost.
 *
 * The filter is applied when a datagram arrives. If the channel of a truncated datagram is added
 * while the datagram waits in the buffer, the datagram remains truncated. It is not mistaken for a
 * message: every message is longer. */

enum {
    BUS_SOCKET_TRIM_FROM = 1024, /* smaller datagrams, UDP header included, are received whole */
    BUS_SOCKET_TRIMMED = 8,      /* bytes received of a truncated datagram: LCM's header */
    BUS_SOCKET_FRAGMENT = 20 + BUS_CHANNEL_MAX /* the same, of a fragment */
};

/* Attaches the filter to a socket, in place of any other. Larger datagrams on channels other than
 * these are truncated to BUS_SOCKET_TRIMMED bytes, and fragments to BUS_SOCKET_FRAGMENT.
 * On input: count names, at most BUS_LISTENERS_MAX, of fewer than BUS_CHANNEL_MAX bytes each; they
 * are copied. Has no effect if the system refuses filters. */
void bus_socket_trim(int fd, const char *const channels[], int count);

#endif
