/* A libfmb-client on the bus that the options of a command name. */
#ifndef BUS_CLIENT_H
#define BUS_CLIENT_H

#include "args.h"
#include "fmb_client.h"

/* On input: options, with url and prefix ignored. NULL: the reason was reported on stderr. */
struct fmb_client *bus_client_open(const struct args_bus *bus, struct fmb_client_options options);

#endif
