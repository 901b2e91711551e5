/* The library's client, opened as a command opens it. */
#ifndef BUS_CLIENT_H
#define BUS_CLIENT_H

#include "args.h"
#include "fmb_client.h"

/* options: its bus is the one given here. NULL after lines on stderr. */
struct fmb_client *bus_client_open(const struct args_bus *bus, struct fmb_client_options options);

#endif
