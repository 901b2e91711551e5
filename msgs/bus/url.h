/* The URL of an LCM bus over UDP multicast. No shared state. */
#ifndef BUS_URL_H
#define BUS_URL_H

#include <netinet/in.h>
#include <stdbool.h>

#include "bus.h"

struct bus_url {
    struct sockaddr_in group; /* address and port */
    int ttl;                  /* 0 to 255; 0: datagrams stay on this host */
    int receive_buffer;       /* bytes to request, as for SO_RCVBUF */
};

/* On input: url as for bus_open(), not NULL. Does not read the environment.
 * On output: true and *out; or false, and why has one line, which shows the valid form. */
bool bus_url_parse(const char *url, struct bus_url *out, char why[BUS_WHY_MAX]);

#endif
