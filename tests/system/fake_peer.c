/* A peer on the bus that does what no service and no client does. The bus is that of
 * LCM_DEFAULT_URL.
 *
 * fake-peer CHANNEL TYPE: publishes every damaged message of the type on the channel, and prints
 * how many there were.
 *
 * fake-peer flood TYPE CLIENT SECONDS: publishes good queries, pair_query or scene_query, of this
 * client as fast as it can, and prints how many there were.
 *
 * fake-peer numbers CLIENT NUMBER...: publishes good pair queries of this client with these
 * sequence numbers.
 *
 * fake-peer listen PATH: prints the datagrams that a service manager gets at this socket, one a
 * line; until it is ended.
 *
 * When it sends damaged messages or numbers, it waits for slow receivers, so that no datagram is
 * lost, unless its first word is burst.
 *
 * fake-peer wait: waits for slow receivers.
 *
 * fake-peer lie CERTIFICATE: a service that says of every pair, with this certificate, that it
 * overlaps, and of the first pair of every scene; until it is ended. */
#include "hostile.h"
#include "receivers.h"

#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>

/* Number of datagrams that are sent before it waits for the receivers. */
enum { PORTION = 40 };

struct sending {
    lcm_t *lcm;
    const char *channel;
    bool burst;
    size_t sent, failed;
};

static void publish(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    struct sending *sending = context;
    (void) what;
    if (lcm_publish(sending->lcm, sending->channel, bytes, (unsigned) size) != 0 ||
        (!sending->burst && ++sending->sent % PORTION == 0 && !receivers_wait()))
        sending->failed++;
}

static int damage(struct sending *sending, const char *channel, const char *type)
{
    sending->channel = channel;
    printf("%zu\n", hostile_each(type, publish, sending));
    return sending->failed != 0;
}

static int flood(lcm_t *lcm, const char *type, long long client_id, long seconds)
{
    const char *channel = strcmp(type, "scene_query") == 0 ? "FMB_SCENE_QUERY" : "FMB_PAIR_QUERY";
    const time_t end = time(NULL) + seconds;
    long long count = 0;
    for (; time(NULL) < end; count++) {
        unsigned char bytes[HOSTILE_BYTES_MAX];
        const size_t size = hostile_flood(type, client_id, count, bytes);
        lcm_publish(lcm, channel, bytes, (unsigned) size);
    }
    printf("%lld\n", count);
    return 0;
}

static int numbers(struct sending *sending, long long client_id, int count, char **number)
{
    sending->channel = "FMB_PAIR_QUERY";
    for (int i = 0; i < count; i++) {
        unsigned char bytes[HOSTILE_BYTES_MAX];
        publish(sending, "", bytes,
                hostile_flood("pair_query", client_id, atoll(number[i]), bytes));
    }
    return sending->failed != 0;
}

static int listen_at(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    char text[256];
    const int fd = socket(AF_UNIX, SOCK_DGRAM, 0);
    snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
    if (fd < 0 || bind(fd, (const struct sockaddr *) &address, sizeof address) != 0)
        return 1;
    for (;;) {
        const ssize_t size = recv(fd, text, sizeof text, 0);
        if (size < 0)
            return 1;
        printf("%.*s\n", (int) size, text);
        fflush(stdout);
    }
}

struct liar {
    lcm_t *lcm;
    char *certificate;
};

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct liar *liar = user;
    unsigned char bytes[HOSTILE_BYTES_MAX];
    size_t size = hostile_lie(buffer->data, buffer->data_size, liar->certificate, bytes);
    (void) channel;
    if (size > 0)
        lcm_publish(liar->lcm, "FMB_PAIR_RESULT", bytes, (unsigned) size);
}

static void on_scene_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct liar *liar = user;
    unsigned char bytes[HOSTILE_BYTES_MAX];
    size_t size = hostile_lie_scene(buffer->data, buffer->data_size, bytes);
    (void) channel;
    if (size > 0)
        lcm_publish(liar->lcm, "FMB_SCENE_RESULT", bytes, (unsigned) size);
}

static int lie(lcm_t *lcm, char *certificate)
{
    struct liar liar = {.lcm = lcm, .certificate = certificate};
    lcm_subscribe(lcm, "FMB_PAIR_QUERY", on_query, &liar);
    lcm_subscribe(lcm, "FMB_SCENE_QUERY", on_scene_query, &liar);
    while (lcm_handle(lcm) == 0)
        continue;
    return 1;
}

int main(int argc, char **argv)
{
    struct sending sending = {.burst = argc > 1 && strcmp(argv[1], "burst") == 0};
    argc -= sending.burst;
    argv += sending.burst;
    const char *what = argc > 1 ? argv[1] : "";
    if (argc == 2 && strcmp(what, "wait") == 0)
        return !receivers_wait();
    const bool floods = strcmp(what, "flood") == 0, counts = strcmp(what, "numbers") == 0;
    if (counts ? argc < 4 : argc != (floods ? 5 : 3)) {
        fputs(
            "usage: fake-peer [burst] CHANNEL TYPE\n"
            "       fake-peer flood TYPE CLIENT SECONDS\n"
            "       fake-peer [burst] numbers CLIENT NUMBER...\n"
            "       fake-peer wait\n"
            "       fake-peer listen PATH\n"
            "       fake-peer lie CERTIFICATE\n",
            stderr);
        return 2;
    }
    if (strcmp(what, "listen") == 0)
        return listen_at(argv[2]);
    lcm_t *lcm = sending.lcm = lcm_create(NULL);
    if (!lcm)
        return 1;
    int code;
    if (floods)
        code = flood(lcm, argv[2], atoll(argv[3]), atol(argv[4]));
    else if (counts)
        code = numbers(&sending, atoll(argv[2]), argc - 3, argv + 3);
    else
        code = strcmp(what, "lie") == 0 ? lie(lcm, argv[2]) : damage(&sending, what, argv[2]);
    lcm_destroy(lcm);
    return code;
}
