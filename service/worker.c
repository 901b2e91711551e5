#include "worker.h"

#include "bus.h"
#include "filter.h"
#include "fmb/fmb.h"
#include "random_id.h"
#include "say.h"
#include "server.h"
#include "signals.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Serves until a signal comes; returns the exit code. */
static int serve(lcm_t *lcm, struct server *server, int signals)
{
    enum { BUS, SIGNALS, SOURCES };
    struct pollfd source[SOURCES] = {
        [BUS] = {.fd = lcm_get_fileno(lcm), .events = POLLIN},
        [SIGNALS] = {.fd = signals, .events = POLLIN},
    };
    for (;;) {
        const int due_ms = server_beat(server);
        if (poll(source, SOURCES, server_is_waiting(server) ? 0 : due_ms) < 0) {
            if (errno == EINTR)
                continue;
            perror("fmbd: poll");
            return EXIT_FAILURE;
        }
        if (source[SIGNALS].revents)
            return EXIT_SUCCESS;
        if (source[BUS].revents && !server_drain(server)) {
            fputs("fmbd: the bus failed\n", stderr);
            return EXIT_FAILURE;
        }
        server_answer(server);
    }
}

static void tell_ready(int ready)
{
    const uint64_t one = 1;
    if (write(ready, &one, sizeof one) < 0)
        perror("fmbd: cannot tell that the worker is ready");
}

static void say_ready(const struct server *server, const struct server_options *options)
{
    if (!say_now())
        return;
    fprintf(stderr,
            "fmbd %s ready: answers %s on %s, %s on %s, heartbeat on %s; %zu bodies; receive "
            "buffer %ld bytes; server %" PRId64 "\n",
            fmb_version(), server_query_channel(server, SERVER_PAIRS),
            server_result_channel(server, SERVER_PAIRS),
            server_query_channel(server, SERVER_SCENES),
            server_result_channel(server, SERVER_SCENES), server_status_channel(server),
            options->bodies, options->receive_buffer, options->server_id);
}

/* What is not for this service is kept from LCM, where the bus is UDP. Without that it works too.
 */
static void keep_out_others(const struct server *server, const struct filter_others *others)
{
    const char *channels[] = {server_query_channel(server, SERVER_PAIRS),
                              server_query_channel(server, SERVER_SCENES),
                              server_status_channel(server)};
    if (filter_attach(others, channels, sizeof channels / sizeof *channels) < 0 && say_now())
        fprintf(stderr, "fmbd: the system takes no socket filter (%s): packets can crash workers\n",
                strerror(errno));
}

static int serve_until_signal(lcm_t *lcm, struct server *server,
                              const struct server_options *options, int ready)
{
    int signals = signals_open();
    if (signals < 0) {
        perror("fmbd: signals");
        return EXIT_FAILURE;
    }
    tell_ready(ready);
    say_ready(server, options);
    return serve(lcm, server, signals);
}

int worker_run(const void *worker_options, int64_t restarts, int ready)
{
    const struct worker_options *options = worker_options;
    struct server_options server_options = {
        .prefix = options->prefix,
        .bodies = options->bodies,
        .server_id = random_id(),
        .first_key = (random_id() + 1) / 2,
        .seed = (uint64_t) random_id() << 32 ^ (uint64_t) random_id(),
        .restarts = restarts};
    struct filter_others others;
    filter_note_others(&others);
    lcm_t *lcm = bus_open("fmbd", options->lcm_url, &server_options.receive_buffer);
    if (!lcm)
        return EXIT_FAILURE;
    int code = EXIT_FAILURE;
    struct server *server = server_create(lcm, &server_options);
    if (server && !options->unfiltered)
        keep_out_others(server, &others);
    if (server)
        code = serve_until_signal(lcm, server, &server_options, ready);
    else
        fprintf(stderr, "fmbd: cannot start: no memory for %zu bodies, or the bus refused\n",
                options->bodies);
    server_destroy(server);
    lcm_destroy(lcm);
    return code;
}
