#include "listen.h"

#include "bus.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

/* Results may come in bursts faster than they are printed. */
enum { QUEUE_CAPACITY = 10000 };

static int open_signals(void)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    if (sigprocmask(SIG_BLOCK, &set, NULL) != 0)
        return -1;
    return signalfd(-1, &set, SFD_CLOEXEC);
}

static bool subscribe(const struct args_bus *bus, const char *name, lcm_msg_handler_t handler,
                      void *user, lcm_t *lcm)
{
    char channel[BUS_CHANNEL_MAX];
    bus_channel(channel, bus->prefix, name);
    lcm_subscription_t *subscription = lcm_subscribe(lcm, channel, handler, user);
    if (subscription && lcm_subscription_set_queue_capacity(subscription, QUEUE_CAPACITY) == 0)
        return true;
    fprintf(stderr, "fmb: cannot listen to %s on %s\n", channel, args_bus_name(bus));
    return false;
}

bool listen_open(const struct args_bus *bus, const char *name, lcm_msg_handler_t handler,
                 void *user, struct listener *out)
{
    out->lcm = NULL;
    out->signals = open_signals();
    if (out->signals < 0)
        perror("fmb: signals");
    else
        out->lcm = bus_open("fmb", bus->url, NULL);
    if (out->lcm && subscribe(bus, name, handler, user, out->lcm))
        return true;
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

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double) time.tv_sec + 1e-9 * (double) time.tv_nsec;
}

/* For poll(): milliseconds until end, rounded up; -1 where there is none. */
static int time_left_ms(double end)
{
    if (!isfinite(end))
        return -1;
    double left = ceil(1e3 * (end - now()));
    return left > 0 ? (int) left : 0;
}

enum listen_end listen_until(struct listener *listener, const bool *enough, double timeout)
{
    double end = timeout < 0 ? (double) INFINITY : now() + timeout;
    struct pollfd source[2] = {{.fd = lcm_get_fileno(listener->lcm), .events = POLLIN},
                               {.fd = listener->signals, .events = POLLIN}};
    while (!*enough) {
        int ready = poll(source, 2, time_left_ms(end));
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
