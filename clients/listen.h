/* Listens to a service until enough was heard, a signal asks to end, or it takes too long. */
#ifndef LISTEN_H
#define LISTEN_H

#include "args.h"
#include "fmb_client.h"

struct listener {
    struct fmb_client *client;
    int signals; /* readable after SIGINT or SIGTERM */
};

/* On output: false after lines on stderr. From true on SIGINT and SIGTERM are blocked:
 * listen_until() sees them. */
bool listen_open(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                 struct listener *out);
void listen_close(struct listener *listener);

enum listen_end { LISTEN_ENOUGH, LISTEN_SIGNAL, LISTEN_TIMEOUT, LISTEN_FAILED };

/* Until *enough, which the callbacks set. timeout in seconds; negative: none. */
enum listen_end listen_until(struct listener *listener, const bool *enough, double timeout);

#endif
