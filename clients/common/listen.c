#include "listen.h"

#include "clock.h"
#include "complain.h"
#include "fmb_client_raw.h"
#include "process.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static enum listen_end listen_to(struct fmb_client *client, int signals, const bool *enough,
                                 double timeout)
{
    int64_t end = timeout < 0 ? 0 : clock_ns() + (int64_t) (1e9 * timeout);
    struct pollfd source[2] = {{.fd = fmb_client_fileno(client), .events = POLLIN},
                               {.fd = signals, .events = POLLIN}};
    while (!*enough) {
        int ready = poll(source, 2, timeout < 0 ? -1 : clock_left_ms(end));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready == 0)
            return LISTEN_TIMEOUT;
        if (ready > 0 && source[1].revents)
            return LISTEN_SIGNAL;
        if (ready < 0 || fmb_client_handle(client, 0) < 0) {
            complain("the bus has failed: %s", strerror(errno));
            return LISTEN_FAILED;
        }
    }
    return LISTEN_ENOUGH;
}

/* Signals come last: until the bus is open they end the process. */
enum listen_end listen_until(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                             bus_handler *tap, void *user, const bool *enough, double timeout)
{
    enum listen_end end = LISTEN_FAILED;
    struct fmb_client *client = args_open_client(bus, (struct fmb_client_options){0});
    if (client && !(watcher ? fmb_client_watch(client, watcher) == FMB_OK
                            : fmb_client_raw_listen(client, false, tap, user))) {
        complain("cannot listen on %s", args_bus_name(bus));
    } else if (client) {
        const int signals = signals_open();
        if (signals >= 0) {
            if (!watcher)
                complain("watching %sFMB_PAIR_RESULT and %sFMB_SCENE_RESULT of %s", bus->prefix,
                         bus->prefix, args_bus_name(bus));
            end = listen_to(client, signals, enough, timeout);
            close(signals);
        } else {
            perror("fmb: signals");
        }
    }
    fmb_client_close(client);
    return end;
}
