/* Receives what a service publishes, until that is enough, a signal arrives or time is up. */
#ifndef LISTEN_H
#define LISTEN_H

#include "args.h"
#include "fmb_client.h"

struct listener {
    struct fmb_client *client;
    int signals; /* readable after SIGINT or SIGTERM */
};

/* Returns false if the bus cannot be opened, which was reported on stderr. After true, SIGINT and
 * SIGTERM are blocked, and end listen_until(). */
bool listen_open(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                 struct listener *out);
void listen_close(struct listener *listener);

enum listen_end { LISTEN_ENOUGH, LISTEN_SIGNAL, LISTEN_TIMEOUT, LISTEN_FAILED };

/* Receives until a callback of the watcher sets *enough. timeout: seconds; negative: no limit. */
enum listen_end listen_until(struct listener *listener, const bool *enough, double timeout);

#endif
