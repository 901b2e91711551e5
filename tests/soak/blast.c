/* Publishes numbered messages, which are not answered, at a given rate: how much does a recording
 * hold? The bus is that of LCM_DEFAULT_URL.
 *
 * soak-blast pairs|scenes RATE SECONDS: queries of pairs, or results of scenes as large as a
 * datagram takes, RATE a second; 0: as fast as it can. Prints a line of JSON. */
#include "big_endian.h"
#include "clock.h"
#include "geometry_write.h"
#include "process.h"
#include "wire.h"

#include <inttypes.h>
#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SEQUENCE_AT = 24 /* of a message's bytes */ };

struct blast {
    lcm_t *lcm;
    const char *channel;
    size_t size;
    unsigned char bytes[QUERY_BYTES_MAX];
};

static void prepare_pairs(struct blast *blast)
{
    static struct pair_query query = {.duration = 1};
    query.client_id = random_id();
    const struct plain_frame cube = {.shape = FMB_CUBOID,
                                     .components = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    static unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    const struct body_view geometry = geometry_write(3, &cube, bytes);
    for (int p = 0; p < 2; p++)
        query.placement[p] = (struct query_placement){.placed.id = p + 1, .body = geometry};
    blast->channel = WIRE_PAIR_QUERY;
    blast->size = wire_write_pair_query(&query, blast->bytes);
}

/* All of them contacts: a verdict and two times each. */
static void prepare_scenes(struct blast *blast)
{
    enum { CONTACTS = (QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES) / (1 + 2 * 8) };
    static struct scene_result result = {.status = FMB_OK, .method = 1, .has_times = true};
    result.client_id = random_id();
    result.server_id = random_id();
    result.verdict_count = result.contact_count = result.end_pair = CONTACTS;
    memset(result.verdict, FMB_TOUCHING, CONTACTS);
    for (int i = 0; i < CONTACTS; i++)
        result.times[2 * i + 1] = 1;
    blast->channel = WIRE_SCENE_RESULT;
    blast->size = wire_write_scene_result(&result, blast->bytes);
}

static void publish(struct blast *blast, int64_t number)
{
    big_endian_put_64(blast->bytes + SEQUENCE_AT, (uint64_t) number);
    lcm_publish(blast->lcm, blast->channel, blast->bytes, (unsigned) blast->size);
}

/* After a pause longer than this, the messages that were due meanwhile are left out: sent all at
 * once they would be another rate. */
static const int64_t late_ns = 2000000;

/* Returns how many were sent, and in *seconds how long it took. */
static int64_t run(struct blast *blast, double rate, double *seconds)
{
    const int64_t begin = clock_ns(), end = begin + (int64_t) (1e9 * *seconds);
    const double every_ns = rate > 0 ? 1e9 / rate : 0;
    double due_ns = (double) begin;
    int64_t sent = 0, now;
    while ((now = clock_ns()) < end) {
        if ((double) now < due_ns)
            continue;
        if ((double) (now - late_ns) > due_ns)
            due_ns = (double) now;
        due_ns += every_ns;
        publish(blast, sent++);
    }
    *seconds = 1e-9 * (double) (now - begin);
    return sent;
}

int main(int argc, char **argv)
{
    static struct blast blast;
    const bool pairs = argc == 4 && strcmp(argv[1], "pairs") == 0;
    const bool scenes = argc == 4 && strcmp(argv[1], "scenes") == 0;
    const double rate = argc == 4 ? atof(argv[2]) : -1;
    double seconds = argc == 4 ? atof(argv[3]) : 0;
    if (!(pairs || scenes) || !(rate >= 0 && rate <= 1e7 && seconds > 0 && seconds <= 86400)) {
        fputs("usage: soak-blast pairs|scenes RATE SECONDS\n", stderr);
        return 2;
    }
    blast.lcm = lcm_create(NULL); /* without a subscription: it does not listen */
    if (!blast.lcm)
        return EXIT_FAILURE;
    (pairs ? prepare_pairs : prepare_scenes)(&blast);
    const int64_t sent = run(&blast, rate, &seconds);
    printf("{\"what\": \"%s\", \"bytes\": %zu, \"sent\": %" PRId64
           ", \"rate\": %.0f, \"mb_per_s\": "
           "%.1f}\n",
           argv[1], blast.size, sent, (double) sent / seconds,
           1e-6 * (double) sent * (double) blast.size / seconds);
    lcm_destroy(blast.lcm);
    return EXIT_SUCCESS;
}
