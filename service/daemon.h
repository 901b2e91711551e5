/* The daemon process: opens the bus, drops privileges, and serves until SIGINT or SIGTERM. */
#ifndef DAEMON_H
#define DAEMON_H

#include <stddef.h>

struct daemon_options {
    const char *lcm_url; /* NULL: see bus_open() */
    const char *prefix;  /* of the channels; "": none */
    const char *user;    /* see confine_user() */
    size_t frames;       /* capacity of the cache */
};

/* Returns the exit code of the process. Errors are reported on stderr. */
int daemon_run(const struct daemon_options *options);

#endif
