/* Does the service's memory stay as it is, whatever is sent to it? The bus is that of
 * LCM_DEFAULT_URL.
 *
 * soak-memory ids PID COUNT: asks scenes of so many bodies in all, each of them new.
 * soak-memory channels PID COUNT: publishes on so many channels that are none of the service's,
 * each of them new, among queries.
 *
 * Prints a line of JSON: the resident memory of process PID, which is the service's, in kB: at the
 * beginning, and at each tenth of the way. */
#include "bus.h"
#include "random_id.h"
#include "wire.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BODIES = 500, PARTS = 10, TRIES = 100, TRY_MS = 100 };

struct soak {
    lcm_t *lcm;
    struct scene_query query;
    struct scene_result result;
    bool answered;
    int64_t asked_again;
};

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct soak *soak = user;
    (void) channel;
    if (wire_read_scene_result(buffer->data, buffer->data_size, &soak->result))
        return;
    soak->answered =
        soak->answered || (soak->result.client_id == soak->query.client_id &&
                           soak->result.sequence_number == soak->query.sequence_number);
}

/* Until there is an answer. False: there was none. */
static bool ask(struct soak *soak)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    soak->query.sequence_number++;
    const size_t size = wire_write_scene_query(&soak->query, bytes);
    soak->answered = false;
    for (int i = 0; i < TRIES && !soak->answered; i++) {
        soak->asked_again += i > 0;
        lcm_publish(soak->lcm, WIRE_SCENE_QUERY, bytes, (unsigned) size);
        while (!soak->answered && lcm_handle_timeout(soak->lcm, TRY_MS) > 0)
            continue;
    }
    return soak->answered && soak->result.status == FMB_OK;
}

/* A scene of squares, whose ids go on from first. */
static void set_bodies(struct scene_query *query, int64_t first)
{
    query->which = QUERY_PAIRS_ALL;
    query->frame_count = BODIES;
    for (int i = 0; i < BODIES; i++) {
        struct query_frame *frame = &query->frame[i];
        *frame = (struct query_frame){.body_id = first + i, .shape = FMB_CUBOID, .dim = 2};
        frame->origin = (struct query_numbers){2, {2 * i, 0}};
        frame->components = (struct query_numbers){4, {1, 0, 0, 1}};
    }
}

static bool send_ids(struct soak *soak, int64_t done, int64_t count)
{
    for (int64_t i = 0; i < count; i += BODIES) {
        set_bodies(&soak->query, 1 + done + i);
        if (!ask(soak))
            return false;
    }
    return true;
}

/* A query now and then: its answer tells that what came before it was taken in. */
static bool send_channels(struct soak *soak, int64_t done, int64_t count)
{
    set_bodies(&soak->query, 1);
    soak->query.frame_count = 1;
    for (int64_t i = 0; i < count; i++) {
        char channel[BUS_CHANNEL_MAX];
        snprintf(channel, sizeof channel, "FOREIGN_%" PRId64, done + i);
        lcm_publish(soak->lcm, channel, "", 1);
        if (i % 100 == 99 && !ask(soak))
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
    printf("], \"asked_again\": %" PRId64 ", \"good\": %s}\n", soak->asked_again,
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
    soak.lcm = bus_open("soak-memory", NULL, NULL);
    if (!soak.lcm || !bus_subscribe(soak.lcm, WIRE_SCENE_RESULT, on_result, &soak, 100))
        return EXIT_FAILURE;
    soak.query.client_id = random_id();
    const int code = run(&soak, argv[1], argv[2], count);
    lcm_destroy(soak.lcm);
    return code;
}
