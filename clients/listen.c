#include "listen.h"

#include "bus.h"
#include "clock.h"
#include "signals.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Results may come in bursts faster than they are printed. */
enum { QUEUE_CAPACITY = 10000 };

static bool subscribe(const struct args_bus *bus, const char *name, lcm_msg_handler_t handler,
                      void *user, lcm_t *lcm)
{
    char channel[BUS_CHANNEL_MAX];
    bus_channel(channel, bus->prefix, name);
    if (bus_subscribe(lcm, channel, handler, user, QUEUE_CAPACITY))
        return true;
    fprintf(stderr, "fmb: cannot listen to %s on %s\n", channel, args_bus_name(bus));
    return false;
}

/* The signals come last: until the bus is open they simply end the process. */
bool listen_open(const struct args_bus *bus, const char *name, lcm_msg_handler_t handler,
                 void *user, struct listener *out)
{
    out->signals = -1;
    out->lcm = bus_open("fmb", bus->url, NULL);
    if (out->lcm && subscribe(bus, name, handler, user, out->lcm)) {
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
    if (listener->lcm)
        lcm_destroy(listener->lcm);
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
    struct pollfd source[2] = {{.fd = lcm_get_fileno(listener->lcm), .events = POLLIN},
                               {.fd = listener->signals, .events = POLLIN}};
    while (!*enough) {
        int ready = poll(source, 2, timeout < 0 ? -1 : time_left_ms(end));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready == 0)
            return LISTEN_TIMEOUT;
        if (ready > 0 && source[1].revents)
            return LISTEN_SIGNAL;
        if (ready < 0 || lcm_handle(listener->lcm) < 0) {
            fprintf(stderr, "fmb: the bus has failed: %s\n", strerror(errno));
            return LISTEN_FAILED;
        }
    }
    return LISTEN_ENOUGH;
}
