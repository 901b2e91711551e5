/* Listens to one channel until enough was heard, a signal asks to end, or it takes too long. */
#ifndef LISTEN_H
#define LISTEN_H

#include "args.h"

#include <lcm/lcm.h>

struct listener {
    lcm_t *lcm;
    int signals; /* readable after SIGINT or SIGTERM */
};

/* name: the channel without its prefix. handler gets user. On output: false after lines on stderr.
 * From true on SIGINT and SIGTERM are blocked: listen_until() sees them. */
bool listen_open(const struct args_bus *bus, const char *name, lcm_msg_handler_t handler,
                 void *user, struct listener *out);
void listen_close(struct listener *listener);

enum listen_end { LISTEN_ENOUGH, LISTEN_SIGNAL, LISTEN_TIMEOUT, LISTEN_FAILED };

/* Until *enough, which the handler sets. timeout in seconds; negative: none. */
enum listen_end listen_until(struct listener *listener, const bool *enough, double timeout);

#endif
