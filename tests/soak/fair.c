/* What does a client get beside others that cost the service as much as they can? The bus is that
 * of LCM_DEFAULT_URL.
 *
 * soak-fair ATTACK [--ids N] [--seconds S] [--scenes] [--window W]
 *
 * The client has W queries under way (1), of pairs or of scenes of 40 bodies. In turn it runs alone
 * and beside the attack (attack.c) from N client ids (1), for S seconds in all (4). Prints a line
 * of JSON. Exit code 0: no answer was lost, and beside one id the client kept at least a third of
 * its rate alone, beside N at least 1 / (2 (N + 1)). */
#include "attack.h"
#include "bus.h"
#include "clock.h"
#include "geometry_write.h"
#include "wire.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CLIENT = 77, BODIES = 40, ROUNDS = 8, WINDOW_MAX = 64 };

/* A query without an answer after so long counts as lost. */
static const int64_t lost_ns = 2000000000;

struct plan {
    const struct attack *attack;
    long ids, window;
    double seconds;
    bool scenes;
};

struct client {
    const struct plan *plan;
    struct bus *bus;
    int64_t sequence_number;
    int64_t expected[WINDOW_MAX]; /* sequence number under way; 0: none */
    int64_t sent_ns[WINDOW_MAX];
    int64_t answers, lost, failed, longest_ns;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* ---- Queries ---- */

static void set_cube(int i, struct placement *out, unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    const struct geometry_frame frame = {.shape = FMB_CUBOID,
                                         .components = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    *out = (struct placement){.body_id = i + 1,
                              .dim = 3,
                              .frame_count = 1,
                              .number_count = 12,
                              .velocity_count = 3,
                              .position = {0.7 * i, 0.1 * i, 0},
                              .velocity = {0.1 * (i % 3), 0, 0}};
    out->geometry = (struct geometry){geometry, geometry_write(3, &frame, geometry)};
}

static void send_query(struct client *client, long slot)
{
    static struct scene_query scene;
    static struct pair_query pair;
    static unsigned char geometries[BODIES][GEOMETRY_FRAME_BYTES_MAX];
    const int64_t number = ++client->sequence_number;
    size_t size;
    if (client->plan->scenes) {
        scene = (struct scene_query){.client_id = CLIENT, .sequence_number = number, .duration = 1};
        scene.which = QUERY_PAIRS_ALL;
        scene.placement_count = BODIES;
        for (int i = 0; i < BODIES; i++)
            set_cube(i, &scene.placement[i], geometries[i]);
        size = wire_write_scene_query(&scene, client->bytes);
    } else {
        pair = (struct pair_query){.client_id = CLIENT, .sequence_number = number, .duration = 1};
        for (int i = 0; i < 2; i++)
            set_cube(i, &pair.placement[i], geometries[i]);
        size = wire_write_pair_query(&pair, client->bytes);
    }
    client->expected[slot] = number;
    client->sent_ns[slot] = clock_ns();
    bus_publish(client->bus, client->plan->scenes ? WIRE_SCENE_QUERY : WIRE_PAIR_QUERY,
                client->bytes, size);
}

/* ---- Answers ---- */

static void take(struct client *client, int64_t sequence_number, int32_t status)
{
    for (long slot = 0; slot < client->plan->window; slot++) {
        if (client->expected[slot] != sequence_number)
            continue;
        const int64_t time_ns = clock_ns() - client->sent_ns[slot];
        client->longest_ns = time_ns > client->longest_ns ? time_ns : client->longest_ns;
        client->expected[slot] = 0;
        client->answers += status == FMB_OK;
        client->failed += status != FMB_OK;
    }
}

static void on_result(void *user, const struct bus_message *message)
{
    static struct pair_result pair;
    static struct scene_result scene;
    struct client *client = user;
    const uint32_t size = (uint32_t) message->size;
    if (client->plan->scenes) {
        struct query_header header;
        if (!wire_read_scene_result_header(message->bytes, size, &header) &&
            header.client_id == CLIENT && !wire_read_scene_result(message->bytes, size, &scene))
            take(client, scene.sequence_number, scene.status);
    } else if (!wire_read_pair_result(message->bytes, size, &pair) && pair.client_id == CLIENT) {
        take(client, pair.sequence_number, pair.status);
    }
}

static bool is_under_way(struct client *client)
{
    bool any = false;
    for (long slot = 0; slot < client->plan->window; slot++) {
        if (client->expected[slot] && clock_ns() - client->sent_ns[slot] > lost_ns) {
            client->expected[slot] = 0;
            client->lost++;
        }
        any = any || client->expected[slot];
    }
    return any;
}

static void receive(struct client *client)
{
    bus_wait(client->bus, -1, 50);
    while (bus_receive(client->bus, on_result, client) > 0)
        continue;
}

/* Answers a second. */
static double measure(struct client *client, double seconds)
{
    /* What other clients sent and got meanwhile would leave no space for an answer. */
    while (bus_receive(client->bus, on_result, client) > 0)
        continue;
    const int64_t begin_ns = clock_ns(), end_ns = begin_ns + (int64_t) (1e9 * seconds);
    const int64_t before = client->answers;
    while (clock_ns() < end_ns) {
        for (long slot = 0; slot < client->plan->window; slot++)
            if (!client->expected[slot])
                send_query(client, slot);
        receive(client);
        is_under_way(client);
    }
    const int64_t after = client->answers;
    while (is_under_way(client))
        receive(client);
    return (double) (after - before) / seconds;
}

/* ---- The trial ---- */

static void pause_ms(long ms)
{
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000};
    nanosleep(&pause, NULL);
}

static int run_trial(struct client *client)
{
    const struct plan *plan = client->plan;
    const double slice = plan->seconds / (2 * ROUNDS);
    double alone = 0, beside = 0;
    measure(client, 0.2);
    for (int round = 0; round < ROUNDS; round++) {
        alone += measure(client, slice) / ROUNDS;
        const pid_t process = attack_start(plan->attack, plan->ids);
        pause_ms(50);
        beside += measure(client, slice) / ROUNDS;
        attack_end(process);
        pause_ms(150); /* its last queries are answered */
    }
    const double share = beside / alone,
                 least = plan->ids == 1 ? 1. / 3 : 0.5 / ((double) plan->ids + 1);
    printf(
        "{\"attack\": \"%s\", \"ids\": %ld, \"client\": \"%s\", \"window\": %ld, "
        "\"alone_per_second\": %.0f, \"beside_per_second\": %.0f, \"share\": %.3f, "
        "\"least\": %.3f, \"lost\": %" PRId64 ", \"failed\": %" PRId64 ", \"longest_ms\": %.1f}\n",
        plan->attack->name, plan->ids, plan->scenes ? "scenes" : "pairs", plan->window, alone,
        beside, share, least, client->lost, client->failed, 1e-6 * (double) client->longest_ns);
    return share >= least && client->lost == 0 && client->failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

static bool parse(int argc, char **argv, struct plan *out)
{
    *out = (struct plan){.ids = 1, .window = 1, .seconds = 4};
    if (argc < 2 || !(out->attack = attack_find(argv[1])))
        return false;
    for (int i = 2; i < argc; i++) {
        char none[] = "", *end = none;
        if (strcmp(argv[i], "--scenes") == 0)
            out->scenes = true;
        else if (i + 1 < argc && strcmp(argv[i], "--ids") == 0)
            out->ids = strtol(argv[++i], &end, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--window") == 0)
            out->window = strtol(argv[++i], &end, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--seconds") == 0)
            out->seconds = strtod(argv[++i], &end);
        else
            return false;
        if (*end)
            return false;
    }
    return out->ids >= 1 && out->ids <= 64 && out->window >= 1 && out->window <= WINDOW_MAX &&
           out->seconds > 0;
}

int main(int argc, char **argv)
{
    static struct client client;
    struct plan plan;
    char why[BUS_WHY_MAX];
    if (!parse(argc, argv, &plan)) {
        fputs("usage: soak-fair ATTACK [--ids N] [--seconds S] [--scenes] [--window W]\n", stderr);
        return 2;
    }
    client.plan = &plan;
    client.bus = bus_open(NULL, why);
    if (!client.bus ||
        !bus_listen(client.bus, plan.scenes ? WIRE_SCENE_RESULT : WIRE_PAIR_RESULT, why)) {
        fprintf(stderr, "soak-fair: %s\n", why);
        return EXIT_FAILURE;
    }
    const int code = run_trial(&client);
    bus_close(client.bus);
    return code;
}
