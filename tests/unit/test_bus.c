/* The bus beside liblcm, and against raw datagrams. Runs itself in a network of its own (netns);
 * where there is none, it is skipped. */
#define _GNU_SOURCE
#include "unit.h"

#include "bus.h"
#include "leap_clock.h"
#include "relay.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <lcm/lcm.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "url.h"

#define GROUP "239.255.76.67"
enum { PATIENCE_MS = 60000, LARGEST = 65497 /* on a channel of one byte */ };

static int port; /* of this process */

/* ---- Helpers ---- */

static struct bus *open_bus(const char *options)
{
    char url[128], why[BUS_WHY_MAX];
    snprintf(url, sizeof url, "udpm://" GROUP ":%d?ttl=0%s", port, options);
    struct bus *bus = bus_open(url, why);
    if (!bus)
        fail_msg("%s", why);
    return bus;
}

static void listen_to(struct bus *bus, const char *channel)
{
    char why[BUS_WHY_MAX];
    if (!bus_listen(bus, channel, why))
        fail_msg("%s", why);
}

static struct bus *open_listening(const char *channel)
{
    struct bus *bus = open_bus("");
    listen_to(bus, channel);
    return bus;
}

/* What the handler was given last, and how often it was called. */
struct latest {
    int count, listener;
    char channel[BUS_CHANNEL_MAX];
    size_t size;
    int64_t utime;
    unsigned char bytes[BUS_PAYLOAD_MAX];
};

static struct latest latest;

static void on_message(void *user, const struct bus_message *message)
{
    struct latest *out = user;
    assert_true(message->size <= BUS_PAYLOAD_MAX);
    assert_true(strlen(message->channel) < BUS_CHANNEL_MAX);
    out->count++;
    out->listener = message->listener;
    out->utime = message->utime;
    out->size = message->size;
    strcpy(out->channel, message->channel);
    memcpy(out->bytes, message->bytes, message->size);
}

/* Reads until so many datagrams were read. Datagrams are on loopback: they wait already. */
static void receive_datagrams(struct bus *bus, int count)
{
    while (count > 0) {
        assert_int_equal(bus_wait(bus, -1, PATIENCE_MS), 1);
        const int received = bus_receive(bus, on_message, &latest);
        assert_in_range(received, 1, count);
        count -= received;
    }
    assert_int_equal(bus_receive(bus, on_message, &latest), 0);
}

/* One of the next datagrams is this message; the others are not delivered. */
static void expect_message_among(struct bus *bus, int datagrams, const char *channel,
                                 const void *bytes, size_t size)
{
    latest = (struct latest){0};
    receive_datagrams(bus, datagrams);
    assert_int_equal(latest.count, 1);
    assert_string_equal(latest.channel, channel);
    assert_int_equal(latest.size, size);
    if (size)
        assert_memory_equal(latest.bytes, bytes, size);
}

static void expect_message(struct bus *bus, const char *channel, const void *bytes, size_t size)
{
    expect_message_among(bus, 1, channel, bytes, size);
}

static int open_sender(void)
{
    const unsigned char ttl = 0;
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    assert_true(fd >= 0);
    assert_int_equal(setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl), 0);
    return fd;
}

static void send_raw(int fd, const char *address, const void *bytes, size_t size)
{
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons((uint16_t) port)};
    inet_pton(AF_INET, address, &to.sin_addr);
    assert_int_equal(sendto(fd, bytes, size, 0, (const struct sockaddr *) &to, sizeof to), size);
}

static const unsigned char *noise(void)
{
    static unsigned char bytes[LARGEST + 1];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char) (i * 2654435761u >> 13);
    return bytes;
}

/* ---- URLs ---- */

static void urls_mean_what_they_mean_to_lcm(void **state)
{
    enum { DEFAULT_BUFFER = 4 << 20 };
    static const struct {
        const char *url, *group;
        int port, ttl, receive_buffer;
    } good[] = {
        {"udpm://", GROUP, 7667, 0, DEFAULT_BUFFER},
        {"udpm://?", GROUP, 7667, 0, DEFAULT_BUFFER},
        {"udpm://?ttl=1", GROUP, 7667, 1, DEFAULT_BUFFER},
        {"udpm://224.0.0.1:1", "224.0.0.1", 1, 0, DEFAULT_BUFFER},
        {"udpm://239.255.255.255:65535?ttl=255", "239.255.255.255", 65535, 255, DEFAULT_BUFFER},
        {"udpm://" GROUP ":7667?recv_buf_size=1", GROUP, 7667, 0, 1},
        {"udpm://" GROUP ":7667?recv_buf_size=1073741823&ttl=2", GROUP, 7667, 2, 1073741823},
        {"udpm://?ttl=0x10&recv_buf_size=010", GROUP, 7667, 16, 8},
        {"udpm://?ttl=1&ttl=3", GROUP, 7667, 3, DEFAULT_BUFFER},
    };
    for (size_t i = 0; i < COUNT(good); i++) {
        struct bus_url url;
        char group[INET_ADDRSTRLEN], why[BUS_WHY_MAX];
        if (!bus_url_parse(good[i].url, &url, why))
            fail_msg("%s: %s", good[i].url, why);
        assert_string_equal(inet_ntop(AF_INET, &url.group.sin_addr, group, sizeof group),
                            good[i].group);
        assert_int_equal(url.group.sin_family, AF_INET);
        assert_int_equal(ntohs(url.group.sin_port), good[i].port);
        assert_int_equal(url.ttl, good[i].ttl);
        assert_int_equal(url.receive_buffer, good[i].receive_buffer);
    }
}

static void bad_urls_are_refused_in_one_line(void **state)
{
    static const char *const bad[] = {
        "tcpq://127.0.0.1:7700",
        "file:///p.log?mode=w",
        "udpm:/" GROUP ":7667",
        "udpm://127.0.0.1:7667",
        "udpm://240.0.0.1:7667",
        "udpm://223.255.255.255:7667",
        "udpm://239.255.76.67.1.2.3.4.5.6:7667",
        "udpm://:7667",
        "udpm://" GROUP,
        "udpm://" GROUP "?ttl=0",
        "udpm://" GROUP ":",
        "udpm://" GROUP ":0",
        "udpm://" GROUP ":65536",
        "udpm://" GROUP ":7667/",
        "udpm://" GROUP ":99999999999999999999",
        "udpm://?ttl=256",
        "udpm://?ttl=-1",
        "udpm://?ttl= 1",
        "udpm://?ttl=",
        "udpm://?ttl",
        "udpm://?ttl=1x",
        "udpm://?recv_buf_size=0",
        "udpm://?recv_buf_size=1073741824",
        "udpm://?ttl=0&",
        "udpm://?&ttl=0",
        "udpm://?TTL=0",
        "udpm://?ttl=0&bogus=1",
    };
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct bus_url url;
        char why[BUS_WHY_MAX] = "", quoted[128];
        snprintf(quoted, sizeof quoted, "'%s' is not an LCM bus", bad[i]);
        if (bus_url_parse(bad[i], &url, why) || strncmp(why, quoted, strlen(quoted)) != 0 ||
            !strstr(why, "write udpm://" GROUP ":7667"))
            fail_msg("%s: %s", bad[i], why);
        assert_null(strchr(why, '\n'));
        assert_null(bus_open(bad[i], why));
    }
}

static void long_urls_fit_the_reason(void **state)
{
    static const char *const heads[] = {"", "udpm://", "udpm://" GROUP ":", "udpm://?",
                                        "udpm://?ttl="};
    char url[2000], why[BUS_WHY_MAX + 1];
    for (size_t i = 0; i < COUNT(heads); i++) {
        memset(url, 'x', sizeof url - 1);
        url[sizeof url - 1] = '\0';
        memcpy(url, heads[i], strlen(heads[i]));
        why[BUS_WHY_MAX] = '!';
        assert_null(bus_open(url, why));
        assert_true(strlen(why) < BUS_WHY_MAX - 1);
        assert_int_equal(why[BUS_WHY_MAX], '!');
    }
}

static void environment_names_the_bus(void **state)
{
    char url[128], why[BUS_WHY_MAX];
    setenv("LCM_DEFAULT_URL", "tcpq://here", 1);
    assert_null(bus_open(NULL, why));
    assert_non_null(strstr(why, "tcpq://here"));
    snprintf(url, sizeof url, "udpm://" GROUP ":%d", port);
    setenv("LCM_DEFAULT_URL", url, 1);
    struct bus *other = open_listening("C"), *bus = bus_open("", why);
    assert_non_null(bus);
    assert_true(bus_publish(bus, "C", "x", 1));
    expect_message(other, "C", "x", 1);
    bus_close(bus);
    bus_close(other);
    unsetenv("LCM_DEFAULT_URL");
    bus = bus_open(NULL, why);
    assert_non_null(bus);
    bus_close(bus);
    bus_close(NULL);
}

static void no_free_descriptor_is_not_a_missing_route(void **state)
{
    char why[BUS_WHY_MAX] = "";
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    const int next = dup(STDERR_FILENO); /* the lowest free descriptor */
    close(next);
    const struct rlimit none = {(rlim_t) next, limit.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    struct bus *bus = bus_open("udpm://" GROUP ":7667?ttl=0", why);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_null(bus);
    assert_non_null(strstr(why, strerror(EMFILE)));
    assert_null(strstr(why, "route"));
}

/* ---- Names ---- */

static void prefixes_precede_channels(void **state)
{
    char channel[BUS_CHANNEL_MAX];
    assert_true(bus_prefix_ok(""));
    assert_true(bus_prefix_ok("ROBOT-1_a"));
    assert_true(bus_prefix_ok("12345678901234567890123456789012"));
    assert_false(bus_prefix_ok("123456789012345678901234567890123"));
    assert_false(bus_prefix_ok("A.*"));
    assert_false(bus_prefix_ok("A B"));
    bus_channel(channel, "ARM_", "FMB_STATUS");
    assert_string_equal(channel, "ARM_FMB_STATUS");
}

static void listeners_are_checked_and_numbered(void **state)
{
    char name[BUS_CHANNEL_MAX + 1], why[BUS_WHY_MAX] = "";
    struct bus *bus = open_bus("");
    memset(name, 'n', BUS_CHANNEL_MAX);
    name[BUS_CHANNEL_MAX] = '\0';
    assert_int_equal(bus_fileno(bus), -1);
    assert_false(bus_listen(bus, name, why));
    assert_false(bus_listen(bus, "", why));
    assert_int_equal(bus_fileno(bus), -1);
    assert_int_equal(bus_receive(bus, on_message, &latest), 0);
    name[BUS_CHANNEL_MAX - 1] = '\0';
    listen_to(bus, "FIRST");
    listen_to(bus, name);
    listen_to(bus, "FIRST");
    assert_true(fcntl(bus_fileno(bus), F_GETFD) & FD_CLOEXEC);
    assert_true(bus_publish(bus, name, "", 0));
    expect_message(bus, name, "", 0);
    assert_int_equal(latest.listener, 1);
    assert_true(bus_publish(bus, "FIRST", "", 0));
    expect_message(bus, "FIRST", "", 0);
    assert_int_equal(latest.listener, 0);
    listen_to(bus, NULL);
    assert_true(bus_publish(bus, "FIRS", "", 0));
    expect_message(bus, "FIRS", "", 0);
    assert_int_equal(latest.listener, 3);
    for (int i = 4; i < BUS_LISTENERS_MAX; i++)
        listen_to(bus, "MORE");
    assert_false(bus_listen(bus, "ONE TOO MANY", why));
    bus_close(bus);
}

/* ---- Messages ---- */

static void messages_of_every_size_arrive(void **state)
{
    static const size_t sizes[] = {0, 1, 7, 1400, 65000, LARGEST};
    struct bus *bus = open_listening("C");
    for (size_t i = 0; i < COUNT(sizes); i++) {
        assert_true(bus_publish(bus, "C", noise(), sizes[i]));
        expect_message(bus, "C", noise(), sizes[i]);
        assert_true(llabs(latest.utime - time(NULL) * INT64_C(1000000)) < 10000000);
    }
    bus_close(bus);
}

/* Longer messages would leave as fragments. */
static void what_fits_no_datagram_is_not_published(void **state)
{
    char name[BUS_CHANNEL_MAX + 1];
    struct bus *bus = open_listening(NULL);
    memset(name, 'n', BUS_CHANNEL_MAX);
    name[BUS_CHANNEL_MAX] = '\0';
    assert_false(bus_publish(bus, "C", noise(), LARGEST + 1));
    assert_false(bus_publish(bus, "CC", noise(), LARGEST));
    assert_false(bus_publish(bus, "C", noise(), SIZE_MAX));
    assert_false(bus_publish(bus, "", noise(), 1));
    assert_false(bus_publish(bus, name, noise(), 1));
    assert_int_equal(bus_receive(bus, on_message, &latest), 0);
    name[BUS_CHANNEL_MAX - 1] = '\0';
    assert_true(bus_publish(bus, name, noise(), LARGEST - 62));
    expect_message(bus, name, noise(), LARGEST - 62);
    bus_close(bus);
}

static void a_batch_ends_at_its_size(void **state)
{
    enum { SENT = BUS_BATCH + 36 };
    struct bus *bus = open_listening("C");
    latest.count = 0;
    for (int i = 0; i < SENT; i++)
        assert_true(bus_publish(bus, "C", &i, sizeof i));
    assert_int_equal(bus_receive(bus, on_message, &latest), BUS_BATCH);
    assert_int_equal(latest.bytes[0], BUS_BATCH - 1);
    assert_int_equal(bus_receive(bus, on_message, &latest), SENT - BUS_BATCH);
    assert_int_equal(latest.bytes[0], SENT - 1);
    assert_int_equal(latest.count, SENT);
    assert_int_equal(bus_counts(bus).received, SENT);
    bus_close(bus);
}

static void foreign_channels_are_counted(void **state)
{
    struct bus *bus = open_listening("CHANNEL");
    static const char *const others[] = {"CHANNEL2", "CHANNE", "channel", "X"};
    latest.count = 0;
    for (size_t i = 0; i < COUNT(others); i++)
        assert_true(bus_publish(bus, others[i], "x", 1));
    receive_datagrams(bus, 4);
    assert_int_equal(latest.count, 0);
    const struct bus_counts counts = bus_counts(bus);
    assert_int_equal(counts.foreign, 4);
    assert_int_equal(counts.received + counts.malformed + counts.dropped, 0);
    bus_close(bus);
}

/* A large message that arrived before its channel was added, and so was truncated, is dropped. */
static void a_channel_added_later_delivers_whole_messages_only(void **state)
{
    static const char *const added[] = {"B", NULL};
    for (size_t i = 0; i < COUNT(added); i++) {
        struct bus *bus = open_listening("A"), *other = open_bus("");
        assert_true(bus_publish(other, "A", noise(), LARGEST));
        assert_true(bus_publish(other, "B", noise(), LARGEST));
        listen_to(bus, added[i]);
        expect_message_among(bus, 2, "A", noise(), LARGEST);
        assert_int_equal(bus_counts(bus).received, 1);
        assert_int_equal(bus_counts(bus).foreign, 1);
        assert_int_equal(bus_counts(bus).malformed, 0);
        assert_true(bus_publish(other, "B", noise(), LARGEST));
        expect_message(bus, "B", noise(), LARGEST);
        bus_close(bus);
        bus_close(other);
    }
}

/* Channel names of every length modulo 4, which the filter compares by words and bytes. */
static void large_messages_are_whole_on_every_listened_channel(void **state)
{
    char names[BUS_LISTENERS_MAX][BUS_CHANNEL_MAX];
    struct bus *bus = open_bus("");
    for (int i = 0; i < BUS_LISTENERS_MAX; i++) {
        const size_t length = i < 12 ? (size_t) i + 1 : BUS_CHANNEL_MAX - 16 + (size_t) i;
        memset(names[i], 'a' + i, length);
        names[i][length] = '\0';
        listen_to(bus, names[i]);
    }
    for (int i = 0; i < BUS_LISTENERS_MAX; i++) {
        assert_true(bus_publish(bus, names[i], noise(), 60000));
        expect_message(bus, names[i], noise(), 60000);
        assert_int_equal(latest.listener, i);
    }
    bus_close(bus);
}

static ssize_t receive_raw(const struct bus *bus)
{
    char byte;
    return recv(bus_fileno(bus), &byte, 1, MSG_DONTWAIT | MSG_TRUNC);
}

/* Of a datagram on another channel from 1,016 bytes on (1,024 with the UDP header) only LCM's
 * header is received. */
static void large_datagrams_on_other_channels_are_truncated(void **state)
{
    static const char *const others[] = {"CHANNEL2", "CHANNE", "cHANNEL", "CHANNEl", "X"};
    struct bus *bus = open_listening("CHANNEL");
    for (size_t i = 0; i < COUNT(others); i++) {
        const size_t before = 8 + strlen(others[i]) + 1;
        assert_true(bus_publish(bus, others[i], noise(), 1015 - before));
        assert_int_equal(receive_raw(bus), 1015);
        assert_true(bus_publish(bus, others[i], noise(), 1016 - before));
        assert_int_equal(receive_raw(bus), 8);
    }
    listen_to(bus, NULL);
    assert_true(bus_publish(bus, "X", noise(), 60000));
    assert_int_equal(receive_raw(bus), 60010);
    bus_close(bus);
}

/* Everything that kills or deceives liblcm. What the buffer held before must not decide: it holds a
 * message when each arrives. */
static void malformed_datagrams_are_counted_and_harmless(void **state)
{
#define LONG_63 "nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn"
#define BYTES(text) text, sizeof text - 1
    static const struct {
        const char *bytes;
        size_t size;
    } malformed[] = {
        {"", 0},
        {BYTES("L")},
        {BYTES("LC02")},
        {BYTES("LC02\0\0\0")},
        {BYTES("LC02\0\0\0\1")},
        {BYTES("LC02\0\0\0\1C")},
        {BYTES("LC02\0\0\0\1CHANNEL")},
        {BYTES("LC02\0\0\0\1\0")},
        {BYTES("LC02\0\0\0\1\0payload")},
        {BYTES("LC02\0\0\0\1n" LONG_63 "\0payload")},
        {BYTES("LC02\0\0\0\1" LONG_63 LONG_63 LONG_63)},
        {BYTES("LC01\0\0\0\1C\0payload")},
        {BYTES("lc02\0\0\0\1C\0payload")},
        {BYTES("\0\0\0\0\0\0\0\1C\0payload")},
        /* LC03, sequence number, size, offset, fragment, fragments */
        {BYTES("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\1\0\2C\0abcd")},
        {BYTES("LC03\0\0\0\2\0\0\1\0\0\0\0\1\0\0\0\2C\0abcd")},
        {BYTES("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1")},
        {BYTES("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1\0abcd")},
        {BYTES("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1CHANNEL")},
        {BYTES("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1n" LONG_63 "\0abcd")},
        {BYTES("LC03\0\0\0\2\0\0\1\0\xff\xff\xff\xf0\0\1\0\2"
               "0123456789abcdef0123456789abcdef")},
        {BYTES("LC03\0\0\0\3")},
    };
    enum { COUNT = COUNT(malformed) };
    const int sender = open_sender();
    struct bus *bus = open_listening(NULL);
    for (uint64_t i = 0; i < COUNT; i++) {
        send_raw(sender, GROUP, BYTES("LC02\0\0\0\1C\0C\0C\0C\0C\0C\0C\0C\0C\0C\0C\0C\0C\0C"));
        receive_datagrams(bus, 1);
        const struct bus_counts before = bus_counts(bus);
        send_raw(sender, GROUP, malformed[i].bytes, malformed[i].size);
        receive_datagrams(bus, 1);
        assert_int_equal(bus_counts(bus).malformed, before.malformed + 1);
        assert_int_equal(bus_counts(bus).received, before.received);
    }
    send_raw(sender, GROUP, BYTES("LC02\0\0\0\1" LONG_63 "\0payload"));
    expect_message(bus, LONG_63, BYTES("payload"));
    send_raw(sender, GROUP,
             BYTES("LC02\xff\xff\xff\xff"
                   "C\0"));
    expect_message(bus, "C", "", 0);
    assert_int_equal(bus_counts(bus).malformed, COUNT);
    bus_close(bus);
    close(sender);
}

/* A fragment of this message, as large as LCM makes them; 20 bytes of header, and the name. */
static void send_fragment(int fd, const char *channel, uint32_t message_size, bool first)
{
    unsigned char bytes[20 + 65487] = "LC03";
    for (int i = 0; i < 4; i++)
        bytes[8 + i] = (unsigned char) (message_size >> (24 - 8 * i));
    bytes[17] = !first;
    bytes[19] = 2;
    strcpy((char *) bytes + 20, channel);
    send_raw(fd, GROUP, bytes, sizeof bytes);
}

static void first_fragments_of_listened_channels_are_counted(void **state)
{
    static const char *const names[] = {"A", "CHANNEL", LONG_63};
    static const uint32_t sizes[] = {0, 80619, UINT32_MAX};
    const int sender = open_sender();
    for (int every = 0; every < 2; every++) {
        struct bus *bus = open_bus("");
        for (size_t i = 0; i < COUNT(names); i++)
            listen_to(bus, names[i]);
        if (every)
            listen_to(bus, NULL);
        for (int i = 0; i < 3; i++) {
            send_fragment(sender, names[i], sizes[i], true);
            receive_datagrams(bus, 1);
            assert_int_equal(bus_counts(bus).fragmented, i + 1);
            assert_int_equal(bus_counts(bus).fragmented_listener, i);
            assert_int_equal(bus_counts(bus).fragmented_size, sizes[i]);
        }
        send_fragment(sender, names[0], 1, false);
        send_fragment(sender, "CHANNEL2", 1, true);
        receive_datagrams(bus, 2);
        assert_int_equal(bus_counts(bus).fragmented, every ? 4 : 3);
        assert_int_equal(bus_counts(bus).malformed, every ? 1 : 2);
        assert_int_equal(bus_counts(bus).received, 0);
        /* No more of a fragment is copied than header and name, unless all channels are received.
         */
        send_fragment(sender, names[1], 80619, true);
        assert_int_equal(receive_raw(bus), every ? 20 + 65487 : 20 + BUS_CHANNEL_MAX);
        bus_close(bus);
    }
    close(sender);
}

/* The number of sockets that have joined the group. liblcm's is one of them. */
static int count_joined(void)
{
    char line[128], group[16];
    struct in_addr address;
    int sockets = 0;
    FILE *file = fopen("/proc/net/igmp", "r");
    assert_non_null(file);
    inet_pton(AF_INET, GROUP, &address);
    snprintf(group, sizeof group, "%08X", (unsigned) address.s_addr);
    while (fgets(line, sizeof line, file))
        if (strstr(line, group))
            sscanf(strstr(line, group) + strlen(group), "%d", &sockets);
    fclose(file);
    return sockets;
}

static void the_group_is_joined_until_the_bus_is_closed(void **state)
{
    const char *netns = getenv("FMB_NETNS");
    if (netns && strcmp(netns, "in place") == 0) /* other processes join the group too */
        skip();
    struct bus *bus = open_bus("");
    const int before = count_joined();
    listen_to(bus, "C");
    assert_int_equal(count_joined(), before + 1);
    bus_close(bus);
    assert_int_equal(count_joined(), 0);
}

static void a_socket_that_fails_is_reported(void **state)
{
    struct bus *bus = open_listening("C");
    const int file = open("/dev/null", O_RDONLY);
    assert_true(dup2(file, bus_fileno(bus)) >= 0);
    assert_int_equal(bus_receive(bus, on_message, &latest), -1);
    assert_int_equal(errno, ENOTSOCK);
    close(file);
    bus_close(bus);
}

static void unicast_does_not_arrive(void **state)
{
    const int sender = open_sender();
    struct bus *bus = open_listening("C");
    send_raw(sender, "127.0.0.1", BYTES("LC02\0\0\0\1C\0unicast"));
    send_raw(sender, GROUP, BYTES("LC02\0\0\0\1C\0multicast"));
    expect_message(bus, "C", BYTES("multicast"));
    bus_close(bus);
    close(sender);
}

static void ttl_is_that_of_the_url(void **state)
{
    static const int ttls[] = {0, 1, 7};
    struct bus *listening = open_listening("C");
    const int on = 1, fd = bus_fileno(listening);
    assert_int_equal(setsockopt(fd, IPPROTO_IP, IP_RECVTTL, &on, sizeof on), 0);
    for (size_t i = 0; i < COUNT(ttls); i++) {
        char options[32], bytes[64];
        _Alignas(struct cmsghdr) char control[64];
        snprintf(options, sizeof options, "&ttl=%d", ttls[i]);
        struct bus *bus = open_bus(options);
        assert_true(bus_publish(bus, "C", "x", 1));
        struct iovec buffer = {bytes, sizeof bytes};
        struct msghdr header = {.msg_iov = &buffer,
                                .msg_iovlen = 1,
                                .msg_control = control,
                                .msg_controllen = sizeof control};
        assert_int_equal(recvmsg(fd, &header, 0), 11);
        const struct cmsghdr *ttl = CMSG_FIRSTHDR(&header);
        assert_non_null(ttl);
        assert_int_equal(ttl->cmsg_type, IP_TTL);
        assert_int_equal(*(const int *) CMSG_DATA(ttl), ttls[i]);
        bus_close(bus);
    }
    bus_close(listening);
}

/* ---- What the kernel drops ---- */

static uint32_t (*drops)(int fd);

uint32_t __real_bus_socket_drops(int fd);
uint32_t __wrap_bus_socket_drops(int fd);
uint32_t __wrap_bus_socket_drops(int fd)
{
    return drops ? drops(fd) : __real_bus_socket_drops(fd);
}

static uint64_t receive_all(struct bus *bus)
{
    latest.count = 0;
    while (bus_receive(bus, on_message, &latest) > 0)
        ;
    return (uint64_t) latest.count;
}

static void datagrams_dropped_by_the_kernel_are_counted(void **state)
{
    enum { SENT = 200, SIZE = 1400 };
    struct bus *bus = open_bus("&recv_buf_size=20000");
    listen_to(bus, "C");
    assert_int_equal(bus_counts(bus).receive_buffer, 40000);
    for (uint64_t burst = 1; burst <= 2; burst++) {
        for (int i = 0; i < SENT; i++)
            assert_true(bus_publish(bus, i % 2 ? "C" : "FOREIGN", noise(), SIZE));
        const uint64_t dropped = bus_counts(bus).dropped;
        assert_in_range(dropped, burst * SENT / 2, burst * SENT - 1);
        receive_all(bus);
        const struct bus_counts counts = bus_counts(bus);
        assert_int_equal(counts.dropped, dropped);
        assert_int_equal(counts.received + counts.foreign + dropped, burst * SENT);
    }
    bus_close(bus);
}

static uint32_t before_wrap(int fd)
{
    (void) fd;
    return 0xfffffff0;
}

static uint32_t after_wrap(int fd)
{
    (void) fd;
    return 5;
}

static void counter_of_drops_does_not_wrap(void **state)
{
    struct bus *bus = open_listening("C");
    drops = before_wrap;
    assert_int_equal(bus_counts(bus).dropped, 0xfffffff0);
    drops = after_wrap;
    assert_int_equal(bus_counts(bus).dropped, UINT64_C(0x100000005));
    assert_int_equal(bus_counts(bus).dropped, UINT64_C(0x100000005));
    drops = NULL;
    bus_close(bus);
}

static void default_receive_buffer_is_4_mb_where_granted(void **state)
{
    int granted = 0;
    const int wanted = 4 << 20, fd = open_sender();
    socklen_t size = sizeof granted;
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
    getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &size);
    close(fd);
    struct bus *bus = open_listening("C");
    assert_in_range(bus_counts(bus).receive_buffer, granted, 2 * wanted);
    bus_close(bus);
}

/* ---- Waiting ---- */

static int64_t ms_of(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (int64_t) time.tv_sec * 1000 + time.tv_nsec / 1000000;
}

static void wait_says_what_is_ready(void **state)
{
    int ends[2];
    struct bus *bus = open_listening("C");
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(bus_wait(bus, ends[0], 0), 0);
    assert_int_equal(write(ends[1], "x", 1), 1);
    assert_int_equal(bus_wait(bus, ends[0], -1), 2);
    assert_true(bus_publish(bus, "C", "x", 1));
    assert_int_equal(bus_wait(bus, ends[0], -1), 3);
    assert_int_equal(bus_wait(bus, ends[0], 0), 3);
    assert_int_equal(bus_wait(bus, -1, -1), 1);
    receive_datagrams(bus, 1);
    assert_int_equal(bus_wait(bus, ends[0], -1), 2);
    close(ends[0]);
    close(ends[1]);
    bus_close(bus);
}

static void wait_before_listening_and_after_messages_sleeps(void **state)
{
    enum { WAIT_MS = 300 };
    struct bus *bus = open_bus("");
    for (int round = 0; round < 2; round++) {
        const int64_t begin = ms_of(CLOCK_MONOTONIC), used = ms_of(CLOCK_THREAD_CPUTIME_ID);
        assert_int_equal(bus_wait(bus, -1, WAIT_MS), 0);
        assert_in_range(ms_of(CLOCK_MONOTONIC) - begin, WAIT_MS - 1, PATIENCE_MS);
        assert_in_range(ms_of(CLOCK_THREAD_CPUTIME_ID) - used, 0, WAIT_MS / 3);
        listen_to(bus, "C");
        assert_true(bus_publish(bus, "C", "x", 1));
        receive_datagrams(bus, 1);
    }
    bus_close(bus);
}

static int yields;
static int64_t yield_ns; /* time that each takes */

int __wrap_sched_yield(void);
int __wrap_sched_yield(void)
{
    yields++;
    clock_leap(yield_ns);
    return 0;
}

static int count_yields(struct bus *bus, int timeout_ms)
{
    yields = 0;
    assert_int_equal(bus_wait(bus, -1, timeout_ms), 0);
    return yields;
}

static void waits_actively_once_after_publishing(void **state)
{
    struct bus *bus = open_listening("C");
    assert_int_equal(count_yields(bus, 1), 0);
    assert_true(bus_publish(bus, "FOREIGN", "x", 1));
    assert_int_equal(bus_receive(bus, on_message, &latest), 1);
    assert_int_equal(count_yields(bus, 0), 0);
    assert_true(count_yields(bus, 1) > 0);
    assert_int_equal(count_yields(bus, 1), 0);
    bus_close(bus);
}

static void waits_actively_once_after_messages_of_its_channels(void **state)
{
    struct bus *bus = open_listening("C"), *other = open_bus("");
    assert_true(bus_publish(other, "FOREIGN", "x", 1));
    assert_int_equal(bus_receive(bus, on_message, &latest), 1);
    assert_int_equal(count_yields(bus, 1), 0);
    assert_true(bus_publish(other, "C", "x", 1));
    assert_int_equal(bus_receive(bus, on_message, &latest), 1);
    assert_true(count_yields(bus, 1) > 0);
    assert_int_equal(count_yields(bus, 1), 0);
    bus_close(bus);
    bus_close(other);
}

/* There a yield takes a whole time slice. */
static void does_not_wait_actively_on_a_busy_core(void **state)
{
    struct bus *bus = open_bus("");
    yield_ns = 3000000;
    assert_true(bus_publish(bus, "C", "x", 1));
    assert_int_equal(count_yields(bus, 1), 1);
    yield_ns = 0;
    assert_true(bus_publish(bus, "C", "x", 1));
    assert_int_equal(count_yields(bus, 1), 0);
    clock_leap(1100000000);
    assert_true(bus_publish(bus, "C", "x", 1));
    assert_true(count_yields(bus, 1) > 0);
    bus_close(bus);
}

/* ---- Beside liblcm ---- */

static void on_lcm(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct latest *out = user;
    out->count++;
    out->size = buffer->data_size;
    assert_true(buffer->data_size <= sizeof out->bytes);
    memcpy(out->bytes, buffer->data, buffer->data_size);
    snprintf(out->channel, sizeof out->channel, "%s", channel);
}

__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);

/* liblcm 1.5 never frees a lock that it takes here first. */
static int handle_without_leaks(lcm_t *lcm)
{
    if (__lsan_disable)
        __lsan_disable();
    const int handled = lcm_handle_timeout(lcm, PATIENCE_MS);
    if (__lsan_enable)
        __lsan_enable();
    return handled;
}

static void plain_lcm_understands_both_ways(void **state)
{
    static const size_t sizes[] = {0, 1, 1400, LARGEST};
    char url[128];
    snprintf(url, sizeof url, "udpm://" GROUP ":%d?ttl=0", port);
    lcm_t *lcm = lcm_create(url);
    assert_non_null(lcm);
    assert_non_null(lcm_subscribe(lcm, "B", on_lcm, &latest)); /* tests itself on the bus */
    struct bus *bus = open_listening("L");
    for (size_t i = 0; i < COUNT(sizes); i++) {
        latest = (struct latest){0};
        assert_true(bus_publish(bus, "B", noise(), sizes[i]));
        assert_true(handle_without_leaks(lcm) > 0);
        assert_int_equal(latest.count, 1);
        assert_string_equal(latest.channel, "B");
        assert_int_equal(latest.size, sizes[i]);
        assert_memory_equal(latest.bytes, noise(), sizes[i]);
        receive_datagrams(bus, 1);
        assert_int_equal(lcm_publish(lcm, "L", noise(), (unsigned) sizes[i]), 0);
        expect_message(bus, "L", noise(), sizes[i]);
    }
    bus_close(bus);
    lcm_destroy(lcm);
}

static int count_threads(void)
{
    char line[128];
    int threads = 0;
    FILE *file = fopen("/proc/self/status", "r");
    assert_non_null(file);
    while (!threads && fgets(line, sizeof line, file))
        sscanf(line, "Threads: %d", &threads);
    fclose(file);
    assert_true(threads > 0);
    return threads;
}

static void liblcm_starts_no_thread(void **state)
{
    const int threads = count_threads();
    struct bus *bus = open_listening("C");
    for (int i = 0; i < 10; i++) {
        assert_true(bus_publish(bus, "C", "x", 1));
        expect_message(bus, "C", "x", 1);
    }
    assert_int_equal(count_threads(), threads);
    bus_close(bus);
}

/* LCM's own select(2) ends the process there. */
static void many_descriptors_are_open(void **state)
{
    enum { OPEN = 1100 };
    static int open_fds[OPEN];
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    if (limit.rlim_max < OPEN + 100)
        skip();
    limit.rlim_cur = limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    for (int i = 0; i < OPEN; i++)
        assert_true((open_fds[i] = open("/dev/null", O_RDONLY | O_CLOEXEC)) >= 0);
    struct bus *bus = open_listening("C");
    assert_true(bus_fileno(bus) > OPEN);
    assert_true(bus_publish(bus, "C", "x", 1));
    expect_message(bus, "C", "x", 1);
    assert_int_equal(bus_wait(bus, open_fds[OPEN - 1], 10), 2);
    bus_close(bus);
    for (int i = 0; i < OPEN; i++)
        close(open_fds[i]);
}

static int count_descriptors(void)
{
    int count = 0;
    DIR *dir = opendir("/proc/self/fd");
    assert_non_null(dir);
    while (readdir(dir))
        count++;
    closedir(dir);
    return count;
}

static void a_closed_bus_leaves_no_descriptor(void **state)
{
    char why[BUS_WHY_MAX];
    bus_close(open_listening("C")); /* liblcm opens some only once */
    const int before = count_descriptors();
    for (int i = 0; i < 3; i++) {
        bus_close(open_bus(""));
        struct bus *bus = open_listening("C");
        assert_true(bus_publish(bus, "C", "x", 1));
        expect_message(bus, "C", "x", 1);
        bus_close(bus);
        assert_null(bus_open("udpm://127.0.0.1:1", why));
        assert_int_equal(count_descriptors(), before);
    }
}

static void child_closes_and_the_parent_goes_on(void **state)
{
    int status;
    struct bus *bus = open_listening("C");
    assert_true(bus_publish(bus, "C", "before", 6));
    const pid_t child = fork();
    if (child == 0) {
        bus_close(bus);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    expect_message(bus, "C", "before", 6);
    assert_true(bus_publish(bus, "C", "after", 5));
    expect_message(bus, "C", "after", 5);
    bus_close(bus);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(urls_mean_what_they_mean_to_lcm),
        cmocka_unit_test(bad_urls_are_refused_in_one_line),
        cmocka_unit_test(long_urls_fit_the_reason),
        cmocka_unit_test(environment_names_the_bus),
        cmocka_unit_test(no_free_descriptor_is_not_a_missing_route),
        cmocka_unit_test(prefixes_precede_channels),
        cmocka_unit_test(listeners_are_checked_and_numbered),
        cmocka_unit_test(messages_of_every_size_arrive),
        cmocka_unit_test(what_fits_no_datagram_is_not_published),
        cmocka_unit_test(a_batch_ends_at_its_size),
        cmocka_unit_test(foreign_channels_are_counted),
        cmocka_unit_test(a_channel_added_later_delivers_whole_messages_only),
        cmocka_unit_test(large_messages_are_whole_on_every_listened_channel),
        cmocka_unit_test(large_datagrams_on_other_channels_are_truncated),
        cmocka_unit_test(malformed_datagrams_are_counted_and_harmless),
        cmocka_unit_test(first_fragments_of_listened_channels_are_counted),
        cmocka_unit_test(the_group_is_joined_until_the_bus_is_closed),
        cmocka_unit_test(a_socket_that_fails_is_reported),
        cmocka_unit_test(unicast_does_not_arrive),
        cmocka_unit_test(ttl_is_that_of_the_url),
        cmocka_unit_test(datagrams_dropped_by_the_kernel_are_counted),
        cmocka_unit_test(counter_of_drops_does_not_wrap),
        cmocka_unit_test(default_receive_buffer_is_4_mb_where_granted),
        cmocka_unit_test(wait_says_what_is_ready),
        cmocka_unit_test(wait_before_listening_and_after_messages_sleeps),
        cmocka_unit_test(waits_actively_once_after_publishing),
        cmocka_unit_test(waits_actively_once_after_messages_of_its_channels),
        cmocka_unit_test(does_not_wait_actively_on_a_busy_core),
        cmocka_unit_test(plain_lcm_understands_both_ways),
        cmocka_unit_test(liblcm_starts_no_thread),
        cmocka_unit_test(many_descriptors_are_open),
        cmocka_unit_test(a_closed_bus_leaves_no_descriptor),
        cmocka_unit_test(child_closes_and_the_parent_goes_on),
    };
    (void) argc;
    relay_enter(argv);
    port = 20000 + (int) getpid() % 40000;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
