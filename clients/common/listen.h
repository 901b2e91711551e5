/* Receives what a service publishes, until that is enough, a signal arrives or time is up. */
#ifndef LISTEN_H
#define LISTEN_H

#include "args.h"

enum listen_end { LISTEN_ENOUGH, LISTEN_SIGNAL, LISTEN_TIMEOUT, LISTEN_FAILED };

/* Opens the bus and receives until a callback of the watcher sets *enough, which is false at first.
 * timeout: seconds; negative: no limit. SIGINT and SIGTERM end it once the bus is open, and stay
 * blocked. LISTEN_FAILED: the bus or the signals failed, which was reported on stderr. */
enum listen_end listen_until(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                             const bool *enough, double timeout);

#endif
