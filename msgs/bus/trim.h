/* A socket filter that truncates large datagrams on other channels before the kernel copies them.
 *
 * Every member of the group receives all results. Without the filter a client, and the service
 * itself, would copy up to 63 kB for each result of another client, only to drop it by its channel.
 * A truncated datagram is still received and counted. (One that a filter drops would count as
 * lost.) */
#ifndef TRIM_H
#define TRIM_H

#include "bus.h"

/* Datagrams of fewer bytes, UDP header included, are received whole. */
enum { TRIM_FROM = 1024 };

/* Attaches the filter to a socket, in place of any other. Larger datagrams on channels other than
 * these are truncated after the longest possible channel name.
 * On input: at most BUS_LISTENERS_MAX names, of fewer than BUS_CHANNEL_MAX bytes each. Has no
 * effect where the system refuses filters. */
void trim_attach(int fd, const char *const channels[], int count);

#endif
