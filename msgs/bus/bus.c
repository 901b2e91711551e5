#define _GNU_SOURCE
#include "bus.h"

#include <arpa/inet.h>
#include <errno.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clock.h"
#include "socket.h"
#include "url.h"

enum {
    DATAGRAM_MAX = 65507, /* UDP's limit over IPv4 */
    BUFFER_SIZE = 65536,
    MAGIC_SIZE = 4,
    HEADER_SIZE = 8,          /* magic number, sequence number */
    FRAGMENT_HEADER_SIZE = 20 /* these, size of the message, offset, number, count of fragments */
};

static const char short_magic[MAGIC_SIZE] = {'L', 'C', '0', '2'};
static const char fragment_magic[MAGIC_SIZE] = {'L', 'C', '0', '3'};

/* Values of bus.spin_until other than a time. */
enum { SPIN_NOT = 0, SPIN_FROM_NEXT_WAIT = -1 };

/* If another program keeps the core busy, sched_yield() gives it the core for a whole time slice
 * (some milliseconds), whereas a process that sleeps in poll() is woken up at once. A yield longer
 * than YIELD_LONG_NS is taken for such a slice: for SPIN_PAUSE_NS afterwards no wait spins, so that
 * at most one wait a second is late. On an idle machine less than one yield in 10,000 messages is
 * that long. */
enum { YIELD_LONG_NS = 1000000, SPIN_PAUSE_NS = 1000000000 };

struct bus {
    struct bus_url url;
    lcm_t *lcm;
    int fd;     /* -1 before bus_listen() */
    bool trims; /* the filter of socket.h has been attached */
    int listener_count;
    char listeners[BUS_LISTENERS_MAX][BUS_CHANNEL_MAX]; /* channels; "": every channel */
    struct mmsghdr datagrams[BUS_BATCH];
    struct iovec buffers[BUS_BATCH];
    unsigned char *memory; /* owned: [BUS_BATCH][BUFFER_SIZE], the buffers */
    int64_t spin_until;    /* of clock_ns(), or SPIN_* */
    int64_t pause_until;   /* no spinning before this time */
    struct bus_counts counts;
    uint32_t drops_read; /* the kernel's drop counter when it was last read */
};

bool bus_prefix_ok(const char *prefix)
{
    static const char allowed[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    const size_t length = strlen(prefix);
    return length <= BUS_PREFIX_MAX && strspn(prefix, allowed) == length;
}

void bus_channel(char out[BUS_CHANNEL_MAX], const char *prefix, const char *name)
{
    snprintf(out, BUS_CHANNEL_MAX, "%s%s", prefix, name);
}

/* ---- Opening and closing ---- */

/* Opens liblcm for publishing: a socket, and pipes that stay unused. */
static lcm_t *open_publisher(const struct bus_url *url)
{
    char group[INET_ADDRSTRLEN], full[64];
    inet_ntop(AF_INET, &url->group.sin_addr, group, sizeof group);
    snprintf(full, sizeof full, "udpm://%s:%d?ttl=%d", group, ntohs(url->group.sin_port), url->ttl);
    return lcm_create(full);
}

static struct bus *no_memory(char why[BUS_WHY_MAX])
{
    snprintf(why, BUS_WHY_MAX, "no memory for an LCM bus");
    return NULL;
}

struct bus *bus_open(const char *url, char why[BUS_WHY_MAX])
{
    struct bus_url parsed;
    if (!url || !*url)
        url = getenv("LCM_DEFAULT_URL");
    if (!url || !*url)
        url = "udpm://";
    /* The route is checked first, since without one liblcm prints advice of its own. */
    if (!bus_url_parse(url, &parsed, why) || !bus_socket_route(&parsed.group, why))
        return NULL;
    struct bus *bus = calloc(1, sizeof *bus);
    if (!bus)
        return no_memory(why);
    bus->url = parsed;
    bus->fd = -1;
    bus->lcm = open_publisher(&parsed);
    if (bus->lcm)
        return bus;
    snprintf(why, BUS_WHY_MAX, "liblcm cannot open the LCM bus (%s)", strerror(errno));
    free(bus);
    return NULL;
}

void bus_close(struct bus *bus)
{
    if (!bus)
        return;
    lcm_destroy(bus->lcm);
    if (bus->fd >= 0)
        close(bus->fd);
    free(bus->memory);
    free(bus);
}

/* The memory of the buffers is touched when a datagram is first read into it. */
static bool start_receiving(struct bus *bus, char why[BUS_WHY_MAX])
{
    if (bus->fd >= 0)
        return true;
    if (!bus->memory)
        bus->memory = malloc((size_t) BUS_BATCH * BUFFER_SIZE);
    if (!bus->memory) {
        no_memory(why);
        return false;
    }
    for (size_t i = 0; i < BUS_BATCH; i++) {
        bus->buffers[i] = (struct iovec){bus->memory + i * BUFFER_SIZE, BUFFER_SIZE};
        bus->datagrams[i].msg_hdr = (struct msghdr){.msg_iov = &bus->buffers[i], .msg_iovlen = 1};
    }
    bus->fd = bus_socket_open(&bus->url, &bus->counts.receive_buffer, why);
    return bus->fd >= 0;
}

static bool channel_ok(const char *channel)
{
    return *channel && memchr(channel, '\0', BUS_CHANNEL_MAX);
}

/* Truncates datagrams on channels without a listener; none, if a listener receives every channel.
 */
static void trim_others(struct bus *bus)
{
    const char *channels[BUS_LISTENERS_MAX];
    const int unused = 0; /* the kernel refuses to detach without an argument */
    for (int i = 0; i < bus->listener_count; i++) {
        if (!*bus->listeners[i]) {
            setsockopt(bus->fd, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
            return;
        }
        channels[i] = bus->listeners[i];
    }
    bus_socket_trim(bus->fd, channels, bus->listener_count);
    bus->trims = true;
}

bool bus_listen(struct bus *bus, const char *channel, char why[BUS_WHY_MAX])
{
    if (bus->listener_count == BUS_LISTENERS_MAX) {
        snprintf(why, BUS_WHY_MAX, "a bus receives at most %d channels", BUS_LISTENERS_MAX);
        return false;
    }
    if (channel && !channel_ok(channel)) {
        snprintf(why, BUS_WHY_MAX, "an LCM channel has a name of 1 to %d bytes",
                 BUS_CHANNEL_MAX - 1);
        return false;
    }
    if (!start_receiving(bus, why))
        return false;
    strcpy(bus->listeners[bus->listener_count++], channel ? channel : "");
    trim_others(bus);
    return true;
}

/* ---- Receiving ---- */

/* Finds channel and payload of a datagram with this header. An empty channel is malformed: no log
 * can hold it, and its payload could exceed BUS_PAYLOAD_MAX. */
static bool parse_datagram(const unsigned char *bytes, size_t size, const char magic[MAGIC_SIZE],
                           size_t header_size, struct bus_message *out)
{
    if (size < header_size || memcmp(bytes, magic, MAGIC_SIZE) != 0)
        return false;
    const size_t remaining = size - header_size;
    const unsigned char *channel = bytes + header_size;
    const unsigned char *end =
        memchr(channel, '\0', remaining < BUS_CHANNEL_MAX ? remaining : BUS_CHANNEL_MAX);
    if (!end || end == channel)
        return false;
    out->channel = (const char *) channel;
    out->bytes = end + 1;
    out->size = (size_t) (bytes + size - out->bytes);
    return true;
}

/* The first listener that receives the channel; -1: none. */
static int find_listener(const struct bus *bus, const char *channel)
{
    for (int i = 0; i < bus->listener_count; i++)
        if (!*bus->listeners[i] || strcmp(bus->listeners[i], channel) == 0)
            return i;
    return -1;
}

/* Counts a datagram that is not a whole message. Only the first fragment of a message names its
 * channel. */
static void count_malformed(struct bus *bus, const unsigned char *bytes, size_t size)
{
    static const unsigned char first[6] = {0}; /* offset and number */
    struct bus_message message;
    int listener = -1;
    if (parse_datagram(bytes, size, fragment_magic, FRAGMENT_HEADER_SIZE, &message) &&
        memcmp(bytes + 12, first, sizeof first) == 0)
        listener = find_listener(bus, message.channel);
    if (listener < 0) {
        bus->counts.malformed++;
        return;
    }
    bus->counts.fragmented++;
    bus->counts.fragmented_listener = listener;
    bus->counts.fragmented_size = (uint32_t) bytes[8] << 24 | (uint32_t) bytes[9] << 16 |
                                  (uint32_t) bytes[10] << 8 | bytes[11];
}

static void handle_datagram(struct bus *bus, const struct mmsghdr *datagram,
                            struct bus_message *message, bus_handler *handler, void *user)
{
    const unsigned char *bytes = datagram->msg_hdr.msg_iov->iov_base;
    const bool trimmed = bus->trims && datagram->msg_len == BUS_SOCKET_TRIMMED &&
                         memcmp(bytes, short_magic, MAGIC_SIZE) == 0;
    if (datagram->msg_hdr.msg_flags & MSG_TRUNC ||
        (!trimmed &&
         !parse_datagram(bytes, datagram->msg_len, short_magic, HEADER_SIZE, message))) {
        count_malformed(bus, bytes, datagram->msg_len);
        return;
    }
    message->listener = trimmed ? -1 : find_listener(bus, message->channel);
    if (message->listener < 0) {
        bus->counts.foreign++;
        return;
    }
    bus->counts.received++;
    bus->spin_until = SPIN_FROM_NEXT_WAIT;
    handler(user, message);
}

int bus_receive(struct bus *bus, bus_handler *handler, void *user)
{
    if (bus->fd < 0)
        return 0;
    const int count = recvmmsg(bus->fd, bus->datagrams, BUS_BATCH, MSG_DONTWAIT, NULL);
    if (count < 0)
        return errno == EAGAIN || errno == EINTR ? 0 : -1;
    struct bus_message message = {.utime = clock_utime()};
    for (int i = 0; i < count; i++)
        handle_datagram(bus, &bus->datagrams[i], &message, handler, user);
    return count;
}

/* ---- Waiting ---- */

/* Polls the bus and other_fd. Returns what bus_wait() returns. */
static int poll_both(const struct bus *bus, int other_fd, int timeout_ms)
{
    struct pollfd fds[] = {{.fd = bus->fd, .events = POLLIN}, {.fd = other_fd, .events = POLLIN}};
    if (poll(fds, 2, timeout_ms) < 0)
        return errno == EINTR ? 0 : -1;
    return (fds[0].revents ? 1 : 0) | (fds[1].revents ? 2 : 0);
}

/* Waits actively. Returns what bus_wait() returns; 0 also if there is no time left to spin. The
 * time starts at the first wait after the message, so that work of the caller in between does not
 * count. poll() costs no more than recv(MSG_PEEK) or recvmmsg() would, and tests both descriptors.
 */
static int spin(struct bus *bus, int other_fd)
{
    int64_t time = clock_ns();
    if (bus->spin_until == SPIN_FROM_NEXT_WAIT)
        bus->spin_until = time < bus->pause_until ? SPIN_NOT : time + BUS_SPIN_NS;
    while (time < bus->spin_until) {
        const int ready = poll_both(bus, other_fd, 0);
        if (ready)
            return ready;
        const int64_t before = time;
        sched_yield();
        time = clock_ns();
        if (time - before > YIELD_LONG_NS)
            bus->pause_until = time + SPIN_PAUSE_NS;
    }
    bus->spin_until = SPIN_NOT;
    return 0;
}

int bus_wait(struct bus *bus, int other_fd, int timeout_ms)
{
    const int ready = bus->spin_until != SPIN_NOT && timeout_ms != 0 ? spin(bus, other_fd) : 0;
    return ready ? ready : poll_both(bus, other_fd, timeout_ms);
}

int bus_fileno(const struct bus *bus)
{
    return bus->fd;
}

/* ---- Publishing, counts ---- */

bool bus_publish(struct bus *bus, const char *channel, const void *bytes, size_t size)
{
    if (!channel_ok(channel) || size > DATAGRAM_MAX - HEADER_SIZE - (strlen(channel) + 1))
        return false;
    bus->spin_until = SPIN_FROM_NEXT_WAIT;
    return lcm_publish(bus->lcm, channel, bytes, (unsigned) size) == 0;
}

/* The kernel's drop counter is read on demand (SO_MEMINFO). Receiving it with each datagram
 * (SO_RXQ_OVFL) would cost time, and would miss what was dropped after the last one. The counter
 * includes what a socket filter drops; so the filter drops nothing (socket.h), and this bus's own
 * messages on other channels are dropped after they were received. */
struct bus_counts bus_counts(struct bus *bus)
{
    if (bus->fd >= 0) {
        const uint32_t drops = bus_socket_drops(bus->fd);
        bus->counts.dropped += (uint32_t) (drops - bus->drops_read);
        bus->drops_read = drops;
    }
    return bus->counts;
}
