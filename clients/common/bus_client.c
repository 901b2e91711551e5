#include "bus_client.h"

#include <stdio.h>
#include <string.h>

void complain(const char *text)
{
    while (*text) {
        const int length = (int) strcspn(text, "\n");
        fprintf(stderr, "fmb: %.*s\n", length, text);
        text += length + (text[length] == '\n');
    }
}

struct fmb_client *bus_client_open(const struct args_bus *bus, struct fmb_client_options options)
{
    char why[FMB_CLIENT_WHY_MAX];
    options.url = bus->url;
    options.prefix = bus->prefix;
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    if (!client)
        complain(why);
    return client;
}
