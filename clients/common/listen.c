#include "listen.h"

#include "bus_client.h"
#include "clock.h"
#include "complain.h"
#include "process.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Signals come last: until the bus is open they end the process. */
bool listen_open(const struct args_bus *bus, const struct fmb_client_watcher *watcher,
                 struct listener *out)
{
    out->signals = -1;
    out->client = bus_client_open(bus, (struct fmb_client_options){0});
    if (out->client && fmb_client_watch(out->client, watcher) != FMB_OK) {
        complain("cannot listen on %s", args_bus_name(bus));
    } else if (out->client) {
        out->signals = signals_open();
        if (out->signals >= 0)
            return true;
        perror("fmb: signals");
    }
    listen_close(out);
    return false;
}

void listen_close(struct listener *listener)
{
    fmb_client_close(listener->client);
    if (listener->signals >= 0)
        close(listener->signals);
}

/* For poll(): milliseconds until end, rounded up. */
static int time_left_ms(int64_t end)
{
    int64_t left = end - clock_ns();
    return left > 0 ? (int) ((left + 999999) / 1000000) : 0;
}

enum listen_end listen_until(struct listener *listener, const bool *enough, double timeout)
{
    int64_t end = timeout < 0 ? 0 : clock_ns() + (int64_t) (1e9 * timeout);
    struct pollfd source[2] = {{.fd = fmb_client_fileno(listener->client), .events = POLLIN},
                               {.fd = listener->signals, .events = POLLIN}};
    while (!*enough) {
        int ready = poll(source, 2, timeout < 0 ? -1 : time_left_ms(end));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready == 0)
            return LISTEN_TIMEOUT;
        if (ready > 0 && source[1].revents)
            return LISTEN_SIGNAL;
        if (ready < 0 || fmb_client_handle(listener->client, 0) < 0) {
            complain("the bus has failed: %s", strerror(errno));
            return LISTEN_FAILED;
        }
    }
    return LISTEN_ENOUGH;
}
