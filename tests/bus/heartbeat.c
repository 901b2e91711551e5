/* The heartbeat, which is no answer to anything: what it costs the service to write and publish it,
 * beside publishing as many bytes; in this process, by the service's own code, in turns. */
#include "bus_bench.h"

#include <stdio.h>

#include "fmb.h"
#include "process.h"
#include "server.h"
#include "wire.h"

enum { BLOCKS_MAX = 256, BEATS = 100 };

static bool publish(void *user, const char *channel, const unsigned char *bytes, size_t size)
{
    return bus_publish(user, channel, bytes, size);
}

/* Microseconds each. */
static double time_beats(struct server *server, struct bus *bus)
{
    const double begin = stopwatch_now();
    for (int i = 0; i < BEATS; i++) {
        const struct bus_counts counts = bus_counts(bus);
        server_heartbeat(server, &counts);
    }
    return (stopwatch_now() - begin) / 1e3 / BEATS;
}

static double time_bare(struct bus *bus, size_t size)
{
    static const unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    const double begin = stopwatch_now();
    for (int i = 0; i < BEATS; i++)
        bus_publish(bus, "IDLE_NOTHING", bytes, size);
    return (stopwatch_now() - begin) / 1e3 / BEATS;
}

static size_t status_bytes(void)
{
    struct wire_status status = {.server_id = 1};
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    snprintf(status.version, sizeof status.version, "%s", fmb_version());
    return wire_write_status(&status, bytes);
}

void heartbeat_run(struct bus_bench *bench)
{
    double beats[BLOCKS_MAX], bare[BLOCKS_MAX], ratio[BLOCKS_MAX];
    char why[BUS_WHY_MAX];
    const size_t size = status_bytes();
    struct bus *bus = bus_open(bench->parties.echo_url, why);
    const struct server_options options = {.prefix = "IDLE_",
                                           .frames = 65536,
                                           .server_id = random_id(),
                                           .publish = publish,
                                           .user = bus};
    struct server *server = bus ? server_create(&options) : NULL;
    /* Listening, so that the kernel's counter is read as in the service. */
    if (!server || !bus_listen(bus, server_query_channel(server, SERVER_PAIRS), why))
        bus_bench_fail("no server, or no bus for it");
    for (int block = 0; block < bench->blocks; block++) {
        beats[block] = time_beats(server, bus);
        bare[block] = time_bare(bus, size);
        ratio[block] = beats[block] / bare[block];
    }
    server_destroy(server);
    bus_close(bus);
    const struct spread own = spread_of(beats, bench->blocks);
    const struct spread plain = spread_of(bare, bench->blocks);
    const struct spread times = spread_of(ratio, bench->blocks);
    json_number(&bench->json, "bytes", (double) size);
    bus_bench_put(&bench->json, "publish_us", own);
    bus_bench_put(&bench->json, "bare_publish_us", plain);
    bus_bench_put(&bench->json, "ratio", times);
    printf(
        "%zu bytes: %.2f us of the service's time (%.2f-%.2f); publishing as many bytes %.2f; "
        "ratio %.2f\n",
        size, own.median, own.low, own.high, plain.median, times.median);
}
