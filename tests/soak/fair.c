/* What does a client get beside others that cost the service as much as they can? The bus is that
 * of LCM_DEFAULT_URL.
 *
 * soak-fair ATTACK [--and ATTACK] [--ids N] [--seconds S] [--scenes] [--window W]
 *           [--turnaround US] [--headroom H] [--service PID]
 *
 * The client has W queries under way (1), of pairs or of scenes of 40 bodies, and sends the next
 * one US microseconds after an answer (0). The attack, or each of the two (attack.c), comes from N
 * client ids (1). The attackers send alternately to a port without a service and to the service,
 * for S seconds in all (4), so that they use the same share of the machine in both. Prints a line
 * of JSON. Exit code 0: no answer was lost, and the client kept the promised share of its rate: a
 * third beside one id, 0.4 / N beside N, divided by H (1). 77: it did not, but other programs used
 * more than a tenth of the machine. PID is the process of the service. */
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
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum { CLIENT = 77, FIRST_ID = 1000000, BODIES = 40, ROUNDS = 8, WINDOW_MAX = 64 };

/* A bus on which there is no service. */
static const char unserved[] = "udpm://239.255.76.67:7669?ttl=0";

/* A query without an answer after so long counts as lost. */
static const int64_t lost_ns = 2000000000;

struct plan {
    const struct attack *attack[2]; /* the second may be NULL */
    long ids, window, turnaround_us;
    long service;
    double seconds, headroom;
    bool scenes;
};

struct client {
    const struct plan *plan;
    struct bus *bus;
    int64_t sequence_number;
    int64_t expected[WINDOW_MAX]; /* sequence number under way; 0: none */
    int64_t sent_ns[WINDOW_MAX];
    int64_t due_ns[WINDOW_MAX]; /* while none is under way: when the next one is sent */
    int64_t answers, lost, failed, longest_ns;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* ---- Queries ---- */

static void set_cube(int i, struct query_placement *out,
                     unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    const struct plain_frame frame = {.shape = FMB_CUBOID,
                                      .components = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    *out = (struct query_placement){.placed.id = i + 1,
                                    .body.dim = 3,
                                    .body.frame_count = 1,
                                    .body.number_count = 12,
                                    .velocity_count = 3,
                                    .placed.position = {0.7 * i, 0.1 * i, 0},
                                    .placed.velocity = {0.1 * (i % 3), 0, 0}};
    out->body = geometry_write(3, &frame, geometry);
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
        scene.which = FMB_PAIRS_ALL;
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
        client->due_ns[slot] = clock_ns() + client->plan->turnaround_us * 1000;
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

static void receive(struct client *client, int timeout_ms)
{
    bus_wait(client->bus, -1, timeout_ms);
    while (bus_receive(client->bus, on_result, client) > 0)
        continue;
}

/* Sends the queries that are due. Returns whether one will be due without an answer. */
static bool send_due(struct client *client)
{
    bool later = false;
    for (long slot = 0; slot < client->plan->window; slot++) {
        if (client->expected[slot])
            continue;
        if (clock_ns() >= client->due_ns[slot])
            send_query(client, slot);
        else
            later = true;
    }
    return later;
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
        receive(client, send_due(client) ? 0 : 50);
        is_under_way(client);
    }
    const int64_t after = client->answers;
    while (is_under_way(client))
        receive(client, 50);
    return (double) (after - before) / seconds;
}

/* ---- The trial ---- */

static void pause_ms(long ms)
{
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000};
    nanosleep(&pause, NULL);
}

struct usage {
    double busy, all; /* seconds of all cores */
    double own;       /* seconds of CPU of this trial */
};

static double seconds_of(const struct timeval *time)
{
    return (double) time->tv_sec + 1e-6 * (double) time->tv_usec;
}

/* The time of interrupts counts as idle, since those of this trial cannot be separated from others.
 */
static struct usage measure_usage(long service)
{
    const double tick = 1 / (double) sysconf(_SC_CLK_TCK);
    double t[8] = {0}, user = 0, kernel = 0;
    struct rusage self, children;
    char path[64];
    FILE *file = fopen("/proc/stat", "r");
    if (file && fscanf(file, "cpu %lf %lf %lf %lf %lf %lf %lf %lf", t, t + 1, t + 2, t + 3, t + 4,
                       t + 5, t + 6, t + 7) == 8)
        fclose(file);
    snprintf(path, sizeof path, "/proc/%ld/stat", service);
    file = fopen(path, "r");
    if (file && fscanf(file, "%*d %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %lf %lf", &user,
                       &kernel) == 2)
        fclose(file);
    getrusage(RUSAGE_SELF, &self);
    getrusage(RUSAGE_CHILDREN, &children);
    struct usage usage = {.busy = tick * (t[0] + t[1] + t[2] + t[7])};
    for (int i = 0; i < 8; i++)
        usage.all += tick * t[i];
    usage.own = tick * (user + kernel) + seconds_of(&self.ru_utime) + seconds_of(&self.ru_stime) +
                seconds_of(&children.ru_utime) + seconds_of(&children.ru_stime);
    return usage;
}

/* The client's rate while the attackers send to this bus. */
static double measure_beside(struct client *client, const char *url)
{
    const struct plan *plan = client->plan;
    const int count = plan->attack[1] ? 2 : 1;
    pid_t process[2];
    for (int i = 0; i < count; i++)
        process[i] = attack_start(plan->attack[i], plan->ids, FIRST_ID * (i + 1), url);
    pause_ms(50);
    const double rate = measure(client, plan->seconds / (2 * ROUNDS));
    for (int i = 0; i < count; i++)
        attack_end(process[i]);
    if (!url)
        pause_ms(150); /* their last queries are answered */
    return rate;
}

static int run_trial(struct client *client)
{
    const struct plan *plan = client->plan;
    const long ids = plan->ids * (plan->attack[1] ? 2 : 1);
    const struct usage before = measure_usage(plan->service);
    double undisturbed = 0, beside = 0;
    measure(client, 0.2);
    for (int round = 0; round < ROUNDS; round++) {
        undisturbed += measure_beside(client, unserved) / ROUNDS;
        beside += measure_beside(client, NULL) / ROUNDS;
    }
    const struct usage after = measure_usage(plan->service);
    const double others =
        (after.busy - before.busy - (after.own - before.own)) / (after.all - before.all);
    const double share = beside / undisturbed;
    const double least = (ids == 1 ? 1. / 3 : 0.4 / (double) ids) / plan->headroom;
    printf(
        "{\"attack\": \"%s%s%s\", \"ids\": %ld, \"client\": \"%s\", \"window\": %ld, "
        "\"turnaround_us\": %ld, "
        "\"undisturbed_per_second\": %.0f, \"beside_per_second\": %.0f, \"share\": %.3f, "
        "\"least\": %.3f, \"lost\": %" PRId64 ", \"failed\": %" PRId64
        ", \"longest_ms\": %.1f, "
        "\"others\": %.2f}\n",
        plan->attack[0]->name, plan->attack[1] ? "+" : "",
        plan->attack[1] ? plan->attack[1]->name : "", ids, plan->scenes ? "scenes" : "pairs",
        plan->window, plan->turnaround_us, undisturbed, beside, share, least, client->lost,
        client->failed, 1e-6 * (double) client->longest_ns, others);
    if (share >= least && client->lost == 0 && client->failed == 0)
        return EXIT_SUCCESS;
    return others > 0.1 ? 77 : EXIT_FAILURE;
}

static bool parse(int argc, char **argv, struct plan *out)
{
    *out = (struct plan){.ids = 1, .window = 1, .seconds = 4, .headroom = 1};
    if (argc < 2 || !(out->attack[0] = attack_find(argv[1])))
        return false;
    for (int i = 2; i < argc; i++) {
        char none[] = "", *end = none;
        if (strcmp(argv[i], "--scenes") == 0)
            out->scenes = true;
        else if (i + 1 < argc && strcmp(argv[i], "--and") == 0 &&
                 (out->attack[1] = attack_find(argv[i + 1])))
            i++;
        else if (i + 1 < argc && strcmp(argv[i], "--ids") == 0)
            out->ids = strtol(argv[++i], &end, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--window") == 0)
            out->window = strtol(argv[++i], &end, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--turnaround") == 0)
            out->turnaround_us = strtol(argv[++i], &end, 10);
        else if (i + 1 < argc && strcmp(argv[i], "--seconds") == 0)
            out->seconds = strtod(argv[++i], &end);
        else if (i + 1 < argc && strcmp(argv[i], "--headroom") == 0)
            out->headroom = strtod(argv[++i], &end);
        else if (i + 1 < argc && strcmp(argv[i], "--service") == 0)
            out->service = strtol(argv[++i], &end, 10);
        else
            return false;
        if (*end)
            return false;
    }
    return out->ids >= 1 && out->ids <= 64 && out->window >= 1 && out->window <= WINDOW_MAX &&
           out->turnaround_us >= 0 && out->turnaround_us <= 1000000 && out->seconds > 0 &&
           out->headroom > 0;
}

int main(int argc, char **argv)
{
    static struct client client;
    struct plan plan;
    char why[BUS_WHY_MAX];
    if (!parse(argc, argv, &plan)) {
        fputs(
            "usage: soak-fair ATTACK [--and ATTACK] [--ids N] [--seconds S] [--scenes] "
            "[--window W] [--turnaround US] [--headroom H] [--service PID]\n",
            stderr);
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
