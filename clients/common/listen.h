/* Receives what a service publishes, until that is enough, a signal arrives or time is up. */
#ifndef LISTEN_H
#define LISTEN_H

#include "args.h"
#include "bus.h"

enum listen_end { LISTEN_ENOUGH, LISTEN_SIGNAL, LISTEN_TIMEOUT, LISTEN_FAILED };

/* Opens the bus and receives until a callback sets *enough, which is false at first. The callbacks
 * belong to the watcher; if it is NULL, tap (with user) gets all messages on the service's
 * channels; a line on stderr then reports that receiving begins. timeout: seconds;
 * negative: no limit. SIGINT and SIGTERM end it once the bus is open, and stay blocked.
 * LISTEN_FAILED: the bus or the signals failed, which was reported on stderr. */
enum listen_end listen_until(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                             bus_handler *tap, void *user, const bool *enough, double timeout);

#endif
