#include "attack.h"

#include "bus.h"
#include "clock.h"
#include "geometry_write.h"
#include "wire.h"

#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { IDS_MAX = 64 };

const struct attack attacks[] = {
    {"pairs", 0, 2},  {"certificates", 0, 4}, {"mixed", 0, 4}, /* pairs and certificates in turns */
    {"boxes", 0, 4},  {"bodies", 0, 4},       {"rate", 26000, 0}, {"definitions", 0, 4},
    {"ids", 5000, 0}, {"flood", 26000, 0}, /* of certificates */
};
const int attack_count = sizeof attacks / sizeof *attacks;

const struct attack *attack_find(const char *name)
{
    for (int i = 0; i < attack_count; i++)
        if (strcmp(name, attacks[i].name) == 0)
            return &attacks[i];
    return NULL;
}

struct attacker {
    const struct attack *attack;
    struct bus *bus;
    long ids;
    int64_t first_id;
    int64_t sent; /* queries, which number them too */
    int64_t under_way[IDS_MAX];
    int64_t answered_ns[IDS_MAX];
};

/* ---- Queries ---- */

static struct scene_query scene;
static unsigned char geometries[QUERY_PLACEMENTS_MAX][GEOMETRY_FRAME_BYTES_MAX];
static unsigned char bytes[QUERY_BYTES_MAX];

/* Its exponents go from one end of the doubles to the other: exact arithmetic takes long. */
static void set_costly(int i, struct query_placement *out,
                       unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    static const double numbers[2][12] = {
        {7, 0, -7e-310, -0.1, -1e300, 0, 0x1p-1074, -1e300, 0, -3e-300, 3e-300, 3e-160},
        {0.1, 0, 0, -0.1, 7, -1e150, 1e300, -3e-160, 3e-300, -0x1p-1074, 7, 0.1},
    };
    struct plain_frame frame = {.shape = FMB_FACE};
    *out = (struct query_placement){
        .body.dim = 3, .body.frame_count = 1, .body.number_count = 9, .velocity_count = 3};
    memcpy(out->placed.position, numbers[i % 2], sizeof out->placed.position);
    memcpy(out->placed.velocity, numbers[i % 2] + 3, sizeof out->placed.velocity);
    memcpy(frame.components, numbers[i % 2] + 6, 6 * sizeof(double));
    out->body = geometry_write(3, &frame, geometry);
}

/* A unit square. size: new for a new body. */
static void set_plain(int64_t id, double x, double size, struct query_placement *out,
                      unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    const struct plain_frame frame = {.shape = FMB_CUBOID, .components = {size, 0, 0, 1}};
    *out = (struct query_placement){
        .placed.id = id, .body.dim = 2, .body.frame_count = 1, .body.number_count = 6};
    out->placed.position[0] = x;
    out->body = geometry_write(2, &frame, geometry);
}

static size_t write_pair(const struct attacker *attacker, int64_t id, bool costly)
{
    struct pair_query query = {.client_id = id, .sequence_number = attacker->sent, .duration = 1};
    query.want = costly ? FMB_WANT_BOX | FMB_WANT_CERTIFICATE : 0;
    for (int i = 0; i < 2; i++)
        if (costly)
            set_costly(i, &query.placement[i], geometries[i]);
        else
            set_plain(0, i, 1, &query.placement[i], geometries[i]);
    return wire_write_pair_query(&query, bytes);
}

static size_t write_boxes(const struct attacker *attacker, int64_t id)
{
    scene = (struct scene_query){.client_id = id, .sequence_number = attacker->sent, .duration = 1};
    scene.want = FMB_WANT_BOX | FMB_WANT_TIMES;
    scene.which = FMB_PAIRS_ALL;
    scene.placement_count = 300;
    for (int i = 0; i < scene.placement_count; i++)
        set_costly(i, &scene.placement[i], geometries[i]);
    return wire_write_scene_query(&scene, bytes);
}

/* As many bodies as fit, none seen before, and no pairs. */
static size_t write_bodies(const struct attacker *attacker, int64_t id)
{
    size_t size = WIRE_SCENE_QUERY_BYTES;
    scene = (struct scene_query){.client_id = id, .sequence_number = attacker->sent, .duration = 1};
    for (int i = 0; i < QUERY_PLACEMENTS_MAX; i++) {
        const int64_t number = attacker->sent * QUERY_PLACEMENTS_MAX + i + 1;
        set_plain(number, i, (double) (number + (id << 32)), &scene.placement[i], geometries[i]);
        size += wire_placement_bytes(&scene.placement[i]);
        if (size > QUERY_BYTES_MAX)
            break;
        scene.placement_count++;
    }
    return wire_write_scene_query(&scene, bytes);
}

static size_t write_definitions(const struct attacker *attacker, int64_t id)
{
    static struct definition_query query;
    query = (struct definition_query){.client_id = id, .sequence_number = attacker->sent};
    return wire_write_definition_query(&query, bytes);
}

static void send_query(struct attacker *attacker, long i)
{
    const char *name = attacker->attack->name, *channel = WIRE_PAIR_QUERY;
    int64_t id = attacker->first_id + i;
    size_t size;
    attacker->sent++;
    if (strcmp(name, "boxes") == 0) {
        size = write_boxes(attacker, id);
        channel = WIRE_SCENE_QUERY;
    } else if (strcmp(name, "bodies") == 0) {
        size = write_bodies(attacker, id);
        channel = WIRE_SCENE_QUERY;
    } else if (strcmp(name, "definitions") == 0) {
        size = write_definitions(attacker, id);
        channel = WIRE_DEFINITION_QUERY;
    } else if (strcmp(name, "ids") == 0) {
        size = write_pair(attacker, id + attacker->sent, false);
    } else {
        const bool plain = strcmp(name, "rate") == 0 || strcmp(name, "pairs") == 0 ||
                           (strcmp(name, "mixed") == 0 && attacker->sent % 2);
        size = write_pair(attacker, id, !plain);
    }
    attacker->under_way[i]++;
    bus_publish(attacker->bus, channel, bytes, size);
}

/* ---- The process ---- */

/* All results begin with the fingerprint, utime and client_id. */
static int64_t client_of(const struct bus_message *message)
{
    uint64_t id = 0;
    for (size_t i = 16; i < 24 && message->size >= 24; i++)
        id = id << 8 | message->bytes[i];
    return (int64_t) id;
}

static void on_result(void *user, const struct bus_message *message)
{
    struct attacker *attacker = user;
    const int64_t i = client_of(message) - attacker->first_id;
    if (i < 0 || i >= attacker->ids)
        return;
    attacker->under_way[i]--;
    attacker->answered_ns[i] = clock_ns();
}

/* Answers that were lost are not waited for longer than a second. */
static void refill(struct attacker *attacker)
{
    for (long i = 0; i < attacker->ids; i++) {
        if (clock_ns() - attacker->answered_ns[i] > 1000000000) {
            attacker->under_way[i] = 0;
            attacker->answered_ns[i] = clock_ns();
        }
        while (attacker->under_way[i] < attacker->attack->window)
            send_query(attacker, i);
    }
}

static void follow_answers(struct attacker *attacker)
{
    for (;;) {
        refill(attacker);
        bus_wait(attacker->bus, -1, 100);
        while (bus_receive(attacker->bus, on_result, attacker) > 0)
            continue;
    }
}

/* In bursts of a millisecond. */
static void keep_rate(struct attacker *attacker)
{
    const struct timespec pause = {.tv_nsec = 1000000};
    const int64_t begin_ns = clock_ns();
    for (;;) {
        const double seconds = 1e-9 * (double) (clock_ns() - begin_ns);
        while ((double) attacker->sent < seconds * (double) attacker->attack->rate)
            send_query(attacker, attacker->sent % attacker->ids);
        nanosleep(&pause, NULL);
    }
}

static _Noreturn void run(const struct attack *attack, long ids, int64_t first_id, const char *url)
{
    static struct attacker attacker;
    static const char *const results[] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT, WIRE_DEFINITION};
    char why[BUS_WHY_MAX];
    attacker = (struct attacker){
        .attack = attack, .ids = ids, .first_id = first_id, .bus = bus_open(url, why)};
    attacker.sent = clock_utime() % 1000000000 * 1000; /* bodies that no run before had */
    for (int i = 0; i < 3 && attacker.bus && !attack->rate; i++)
        bus_listen(attacker.bus, results[i], why);
    if (!attacker.bus)
        exit(EXIT_FAILURE);
    if (attack->rate) {
        attacker.sent = 0;
        keep_rate(&attacker);
    } else {
        follow_answers(&attacker);
    }
    exit(EXIT_SUCCESS);
}

pid_t attack_start(const struct attack *attack, long ids, int64_t first_id, const char *url)
{
    const pid_t process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        run(attack, ids, first_id, url);
    }
    return process;
}

void attack_end(pid_t process)
{
    kill(process, SIGKILL);
    waitpid(process, NULL, 0);
}
