/* Does the service's memory stay as it is, whatever is sent to it? The bus is that of
 * LCM_DEFAULT_URL.
 *
 * soak-memory ids PID COUNT: queries scenes of so many bodies in all, each of them new.
 * soak-memory channels PID COUNT: publishes on so many channels that are none of the service's,
 * each of them new, among queries.
 *
 * Prints a line of JSON: the resident memory of process PID, which is the service's, in kB: at the
 * beginning, and at each tenth of the way. */
#include "bus.h"
#include "geometry_write.h"
#include "process.h"
#include "wire.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BODIES = 480, PARTS = 10, TRIES = 100, TRY_MS = 100 };

struct soak {
    struct bus *bus;
    unsigned char geometries[BODIES][GEOMETRY_FRAME_BYTES_MAX];
    struct scene_query query;
    struct scene_result result;
    bool answered;
    int64_t repeated;
};

static void on_result(void *user, const struct bus_message *message)
{
    struct soak *soak = user;
    if (wire_read_scene_result(message->bytes, (uint32_t) message->size, &soak->result))
        return;
    soak->answered =
        soak->answered || (soak->result.client_id == soak->query.client_id &&
                           soak->result.sequence_number == soak->query.sequence_number);
}

/* Until there is an answer. False: there was none. */
static bool query(struct soak *soak)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    soak->query.sequence_number++;
    const size_t size = wire_write_scene_query(&soak->query, bytes);
    soak->answered = false;
    for (int i = 0; i < TRIES && !soak->answered; i++) {
        soak->repeated += i > 0;
        bus_publish(soak->bus, WIRE_SCENE_QUERY, bytes, size);
        while (!soak->answered && bus_wait(soak->bus, -1, TRY_MS) > 0)
            bus_receive(soak->bus, on_result, soak);
    }
    return soak->answered && soak->result.status == FMB_OK;
}

/* A scene of rectangles, whose ids and sizes go on from first. */
static void set_bodies(struct soak *soak, int64_t first)
{
    struct scene_query *query = &soak->query;
    query->which = FMB_PAIRS_ALL;
    query->placement_count = BODIES;
    for (int i = 0; i < BODIES; i++) {
        const struct plain_frame frame = {.shape = FMB_CUBOID,
                                          .components = {1, 0, 0, (double) (first + i)}};
        struct query_placement *placement = &query->placement[i];
        *placement = (struct query_placement){.placed.id = first + i,
                                              .body.dim = 2,
                                              .body.frame_count = 1,
                                              .body.number_count = 6,
                                              .placed.position = {2 * i}};
        placement->body = geometry_write(2, &frame, soak->geometries[i]);
    }
}

static bool send_ids(struct soak *soak, int64_t done, int64_t count)
{
    for (int64_t i = 0; i < count; i += BODIES) {
        set_bodies(soak, 1 + done + i);
        if (!query(soak))
            return false;
    }
    return true;
}

/* A query from time to time: its answer shows that earlier messages were read. */
static bool send_channels(struct soak *soak, int64_t done, int64_t count)
{
    set_bodies(soak, 1);
    soak->query.placement_count = 1;
    for (int64_t i = 0; i < count; i++) {
        char channel[BUS_CHANNEL_MAX];
        snprintf(channel, sizeof channel, "FOREIGN_%" PRId64, done + i);
        bus_publish(soak->bus, channel, "", 1);
        if (i % 100 == 99 && !query(soak))
            return false;
    }
    return true;
}

/* kB; 0: there is no such process. */
static long resident(const char *pid)
{
    char name[64], line[128];
    long kilobytes = 0;
    snprintf(name, sizeof name, "/proc/%s/status", pid);
    FILE *in = fopen(name, "r");
    while (in && fgets(line, sizeof line, in))
        if (sscanf(line, "VmRSS: %ld", &kilobytes) == 1)
            break;
    if (in)
        fclose(in);
    return kilobytes;
}

static int run(struct soak *soak, const char *what, const char *pid, int64_t count)
{
    const bool ids = strcmp(what, "ids") == 0;
    printf("{\"what\": \"%s\", \"count\": %" PRId64 ", \"resident_kb\": [%ld", what, count,
           resident(pid));
    bool good = true;
    for (int part = 0; part < PARTS && good; part++) {
        good = (ids ? send_ids : send_channels)(soak, part * (count / PARTS), count / PARTS);
        printf(", %ld", resident(pid));
        fflush(stdout);
    }
    printf("], \"repeated\": %" PRId64 ", \"good\": %s}\n", soak->repeated,
           good ? "true" : "false");
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    static struct soak soak;
    char *end = NULL;
    const long long count = argc == 4 ? strtoll(argv[3], &end, 10) : 0;
    if (argc != 4 || *end || count < PARTS ||
        (strcmp(argv[1], "ids") != 0 && strcmp(argv[1], "channels") != 0)) {
        fputs("usage: soak-memory ids|channels PID COUNT\n", stderr);
        return 2;
    }
    char why[BUS_WHY_MAX];
    soak.bus = bus_open(NULL, why);
    if (!soak.bus || !bus_listen(soak.bus, WIRE_SCENE_RESULT, why)) {
        fprintf(stderr, "soak-memory: %s\n", why);
        return EXIT_FAILURE;
    }
    soak.query.client_id = random_id();
    const int code = run(&soak, argv[1], argv[2], count);
    bus_close(soak.bus);
    return code;
}
