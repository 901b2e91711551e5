/* The heartbeat. Nobody asks for it, so there is no round trip to compare: what it costs the
 * service to put one together and publish it, beside the publishing of as many bytes; in this
 * process, by the service's own code, in turns. */
#include "bus_bench.h"

#include <stdio.h>

#include "bus.h"
#include "random_id.h"
#include "server.h"
#include "wire.h"

enum { BLOCKS_MAX = 256, BEATS = 100 };

/* A server that nobody asks, on a bus of its own. */
struct idle {
    lcm_t *lcm;
    struct server *server;
};

static struct idle open_idle(const char *url)
{
    const struct server_options options = {.prefix = "IDLE_",
                                           .bodies = 65536,
                                           .server_id = random_id(),
                                           .first_key = 1,
                                           .seed = (uint64_t) random_id()};
    struct idle idle = {bus_open("bench-bus", url, NULL), NULL};
    if (idle.lcm)
        idle.server = server_create(idle.lcm, &options);
    if (!idle.server)
        bus_bench_fail("no server, or no bus for it");
    return idle;
}

/* Its own heartbeats come back to it; they are read in between. */
static void drain(lcm_t *lcm)
{
    while (lcm_handle_timeout(lcm, 0) > 0)
        ;
}

/* Microseconds each. */
static double time_beats(const struct idle *idle)
{
    const double begin = stopwatch_now();
    for (int i = 0; i < BEATS; i++)
        server_publish_status(idle->server);
    const double us = (stopwatch_now() - begin) / 1e3 / BEATS;
    drain(idle->lcm);
    return us;
}

static double time_bare(const struct idle *idle, size_t size)
{
    static const unsigned char bytes[WIRE_BYTES_MAX];
    const double begin = stopwatch_now();
    for (int i = 0; i < BEATS; i++)
        lcm_publish(idle->lcm, "IDLE_NOTHING", bytes, (unsigned) size);
    return (stopwatch_now() - begin) / 1e3 / BEATS;
}

static size_t status_bytes(void)
{
    struct wire_status status = {.server_id = 1};
    unsigned char bytes[WIRE_BYTES_MAX];
    snprintf(status.version, sizeof status.version, "%s", fmb_version());
    return wire_write_status(&status, bytes);
}

void heartbeat_run(struct bus_bench *bench)
{
    double beats[BLOCKS_MAX], bare[BLOCKS_MAX], ratio[BLOCKS_MAX];
    const size_t size = status_bytes();
    struct idle idle = open_idle(bench->parties.echo_url);
    for (int block = 0; block < bench->blocks; block++) {
        beats[block] = time_beats(&idle);
        bare[block] = time_bare(&idle, size);
        ratio[block] = beats[block] / bare[block];
    }
    server_destroy(idle.server);
    lcm_destroy(idle.lcm);
    const struct spread own = spread_of(beats, bench->blocks);
    const struct spread plain = spread_of(bare, bench->blocks);
    const struct spread times = spread_of(ratio, bench->blocks);
    json_number(&bench->json, "bytes", (double) size);
    bus_bench_put(&bench->json, "publish_us", own);
    bus_bench_put(&bench->json, "bare_publish_us", plain);
    bus_bench_put(&bench->json, "ratio", times);
    printf(
        "%zu bytes: %.2f us of the service's time (%.2f-%.2f); lcm_publish() of as many bytes "
        "%.2f; ratio %.2f\n",
        size, own.median, own.low, own.high, plain.median, times.median);
}
