#include "bus_client.h"
#include "complain.h"

struct fmb_client *bus_client_open(const struct args_bus *bus, struct fmb_client_options options)
{
    char why[FMB_CLIENT_WHY_MAX];
    options.url = bus->url;
    options.prefix = bus->prefix;
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    if (!client)
        complain("%s", why);
    return client;
}
